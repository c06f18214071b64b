"""Clips of any length, and the sampler's agreement with diffusers' own."""

from __future__ import annotations

import pytest
import torch
from diffusers import EulerDiscreteScheduler
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.svd import CLIP_FRAMES, FrameLayout
from physanimator.rendering.svd.decoding import decode, decoding_chunks
from physanimator.rendering.svd.noise_schedule import denoised, euler_step, noise_levels
from physanimator.rendering.svd.sampler import LATENT_SCALE, SampledStep, sample_clip
from physanimator.rendering.svd.segments import plan_segments
from torch import Tensor


@pytest.mark.parametrize("frames", [*range(2, 60), 121])
@pytest.mark.parametrize("overlap", [3, 4, 6])
def test_every_frame_is_made_once_from_its_own_sketch(frames: int, overlap: int) -> None:
    made = [(segment, slot) for segment in plan_segments(frames, overlap) for slot in segment.made]
    assert [segment.sketches[slot] for segment, slot in made] == list(range(1, frames))
    assert len(plan_segments(frames, overlap)) == 1 + max(0, -(-(frames - 15) // (CLIP_FRAMES - overlap)))


def ends_on(value: float) -> object:
    """A predictor whose denoised latents are its sketches' mean plus a value, whatever the noise."""

    def predict(x: Tensor, condition: Tensor, sketches: Tensor, level: Tensor, layout: FrameLayout) -> Tensor:
        sigma = (4 * level).exp()
        noisy = x * (sigma**2 + 1).sqrt()
        clean = sketches.mean(dim=(1, 2, 3), keepdim=True) + value
        return (clean - noisy / (sigma**2 + 1)) * -(sigma**2 + 1).sqrt() / sigma

    return predict


@pytest.mark.parametrize("frames", [2, 9, 15, 17, 31])
def test_a_clip_of_any_length_follows_its_sketches(frames: int) -> None:
    brightness = torch.arange(frames) / frames
    sketches = brightness[:, None, None, None].expand(-1, 3, 16, 16)
    first, seen = torch.full((1, 4, 2, 2), 3.0), []
    got = sample_clip(
        ends_on(1.0), first, sketches, torch.randn(19, 4, 2, 2), sigmas=noise_levels(5), watch=seen.append
    )
    torch.testing.assert_close(got[:1], LATENT_SCALE * first)
    torch.testing.assert_close(got[1:, 0, 0, 0], 1 + brightness[1:], rtol=1e-3, atol=1e-3)
    assert [step.done for step in seen] == list(range(1, 5 * len(plan_segments(frames)) + 1))
    assert {step.total for step in seen} == {len(seen)}


def test_watching_can_stop() -> None:
    def stop(step: SampledStep) -> None:
        if step.done == 2:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        sample_clip(
            ends_on(0.0), torch.zeros(1, 4, 1, 1), torch.zeros(3, 3, 8, 8), torch.zeros(19, 4, 1, 1), watch=stop
        )


@pytest.mark.filterwarnings("ignore:__array__ implementation:DeprecationWarning")  # diffusers with NumPy 2
def test_agrees_with_diffusers_scheduler() -> None:
    scheduler = EulerDiscreteScheduler(
        prediction_type="v_prediction",
        use_karras_sigmas=True,
        sigma_min=0.002,
        sigma_max=700.0,
        timestep_type="continuous",
    )
    scheduler.set_timesteps(25)
    sigmas = noise_levels(25)
    torch.testing.assert_close(sigmas, scheduler.sigmas, rtol=1e-5, atol=0)
    x = ours = torch.randn(2, 4, 3, 3) * 700
    for step, time in enumerate(scheduler.timesteps):
        x = scheduler.step(torch.sin(x), time, x).prev_sample
        ours = euler_step(ours, denoised(ours, torch.sin(ours), sigmas[step]), sigmas[step], sigmas[step + 1])
    torch.testing.assert_close(ours, x, rtol=1e-2, atol=1e-2)


@pytest.mark.parametrize("count", [1, 2, 9, 10, 11, 16, 17, 40])
@pytest.mark.parametrize("size", [5, 10, 14])
def test_decoding_gives_every_frame_once(count: int, size: int) -> None:
    latents = torch.linspace(-1.5, 1.5, count)[:, None, None, None].expand(-1, 3, 1, 1)
    frames = torch.cat(list(decode(lambda x: x, latents, size=size)))
    torch.testing.assert_close(frames, latents.clamp(-1, 1))
    assert all(len(chunk.frames) <= size and chunk.frames[0] == 0 for chunk in decoding_chunks(count, size))


def test_bad_numbers_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="frames must be 2 or more"):
        plan_segments(1)
    with pytest.raises(InvalidInputError, match="overlap must be 3 to 13 frames"):
        plan_segments(20, 2)
