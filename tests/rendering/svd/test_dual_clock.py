"""Clips that follow an animation: what is held to it, for how long, and that nothing of it is left otherwise."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import random_svd
import torch
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.networks import Frame
from physanimator.rendering.networks.placement import Placement
from physanimator.rendering.svd import CLIP_FRAMES, CrudeAnimation, FrameLayout, SVDOptions
from physanimator.rendering.svd.conditioning import condition_on
from physanimator.rendering.svd.decoding import decode, decoding_chunks
from physanimator.rendering.svd.dual_clock import DualClock, step_at
from physanimator.rendering.svd.encoded_animation import encode_animation, latent_mask
from physanimator.rendering.svd.models import SVDModels, load_models
from physanimator.rendering.svd.noise_schedule import denoised, euler_step, noise_levels
from physanimator.rendering.svd.plain_segments import plan_plain_segments
from physanimator.rendering.svd.renderer import SVDRenderer
from physanimator.rendering.svd.sampler import LATENT_SCALE, SampledStep, sample_clip
from physanimator.rendering.svd.segments import plan_segments
from torch import Tensor

Image = NDArray[np.float32]

WIDTH, HEIGHT = 70, 60
PLAIN = replace(SVDOptions.following("animation"), steps=3, area=64 * 64, seed=3, weak=0.0, strong=1.0)
CPU = Placement(torch.device("cpu"))


@pytest.fixture(scope="module")
def plain(single_file: Path) -> SVDModels:
    return load_models(single_file, sizes=random_svd.TINY)


def picture(shift: int = 0) -> Image:
    y, x = np.mgrid[:HEIGHT, :WIDTH].astype(np.float32)
    drawn = np.stack([x / WIDTH, y / HEIGHT, np.full_like(x, 0.5)], axis=2)
    drawn[20:40, 10 + shift : 30 + shift] = (0.9, 0.1, 0.2)
    return drawn


def moving(count: int, *, everywhere: bool = False) -> CrudeAnimation:
    """A square that moves to the right."""
    masks = [np.full((HEIGHT, WIDTH), float(everywhere), np.float32) for _ in range(count)]
    for number, mask in enumerate(masks):
        mask[20:40, 10 + number : 30 + number] = 1
    return CrudeAnimation.of([picture(number) for number in range(count)], masks)


def sketches(count: int, step: int = 2) -> list[Image]:
    drawn = [np.ones((HEIGHT, WIDTH), np.float32) for _ in range(count)]
    for number, sketch in enumerate(drawn):
        sketch[:, 10 + step * number : 13 + step * number] = 0
    return drawn


def clip(models: SVDModels, options: SVDOptions, count: int, lines: list[Image] | None = None) -> Image:
    animation = moving(count) if options.follows_animation else None
    return np.stack(list(SVDRenderer(models, options=options).frames(picture(), lines or (), animation=animation)))


def wild(x: Tensor, condition: Tensor, lines: Tensor, level: Tensor, layout: FrameLayout) -> Tensor:
    """Stands for networks that draw something else."""
    return torch.sin(7 * x + condition + level) + 0.5


def clocked(frames: int, weak: int, strong: int) -> DualClock:
    generator = torch.Generator().manual_seed(5)
    latents = torch.randn(frames, 4, 3, 4, generator=generator)
    return DualClock(latents, torch.rand(frames, 1, 3, 4, generator=generator) > 0.5, weak, strong)


def sampled(clock: DualClock | None, frames: int, *, references: bool, steps: int = 6, **how: object) -> Tensor:
    segments = (plan_segments if references else plan_plain_segments)(frames)
    noise = torch.randn(segments[0].layout.count, 4, 3, 4, generator=torch.Generator().manual_seed(1))
    first = torch.full((1, 4, 3, 4), 0.3)
    told = {"sigmas": noise_levels(steps), "segments": segments, "clock": clock, **how}
    return sample_clip(wild, first, torch.empty(frames, 0), noise, **told)  # type: ignore[arg-type]


def test_parts_of_the_steps_are_the_published_steps() -> None:
    usual = SVDOptions.following("animation")
    assert (step_at(usual.weak, 50), step_at(usual.strong, 50), usual.motion_bucket) == (16, 21, 17)
    assert [step_at(part, 25) for part in (0, usual.weak, usual.strong, 1)] == [0, 8, 11, 25]


@pytest.mark.parametrize("references", [False, True])
@pytest.mark.parametrize("frames", [2, 9, 13, 14, 15, 16, 24, 31, 60])
def test_led_to_the_end_a_clip_of_any_length_is_the_animation_where_it_moves(frames: int, references: bool) -> None:
    clock = clocked(frames, 2, 6)
    found = sampled(clock, frames, references=references)
    assert found.shape == (frames, 4, 3, 4)
    moves = clock.moves.expand_as(found)
    torch.testing.assert_close(found[moves], clock.latents[moves], rtol=0, atol=0)
    assert (found[1:] - clock.latents[1:])[~moves[1:]].abs().min() > 1e-4, "elsewhere the networks have drawn"


@pytest.mark.parametrize("references", [False, True])
def test_moving_parts_are_held_at_each_noise_level_until_strong_and_then_free(references: bool) -> None:
    frames, weak, strong = 20, 2, 4
    clock, seen, levels = clocked(frames, weak, strong), list[SampledStep](), noise_levels(6)
    sampled(clock, frames, references=references, watch=seen.append)
    segments = (plan_segments if references else plan_plain_segments)(frames)
    noise = torch.randn(segments[0].layout.count, 4, 3, 4, generator=torch.Generator().manual_seed(1))
    assert [(step.segment, step.step) for step in seen] == [(s, n) for s in range(len(segments)) for n in range(2, 6)]
    assert [(step.done, step.total) for step in seen] == [(n, 4 * len(segments)) for n in range(1, len(seen) + 1)]
    for step in seen:
        segment = segments[step.segment]
        shown = list(segment.sketches)
        expected = clock.latents[shown] + levels[step.step] * noise[list(segment.noise)]
        same = (step.noisy == expected) | ((step.noisy - expected).abs() < 1e-5)
        moves = clock.moves[shown].expand_as(same)
        assert bool(same[moves].all()) == (step.step <= strong), step.step
        assert bool(same[~moves].all()) == (step.step == weak), step.step


@pytest.mark.parametrize("frames", [2, 13, 14, 15, 24, 25, 100])
@pytest.mark.parametrize("overlap", [3, 4, 7])
def test_plain_segments_make_every_frame_once_and_share_frames_with_their_noise(frames: int, overlap: int) -> None:
    segments = plan_plain_segments(frames, overlap)
    assert [segment.sketches[slot] for segment in segments for slot in segment.made] == list(range(1, frames))
    for before, after in pairwise(segments):
        shared = list(before.blended or range(CLIP_FRAMES - overlap, CLIP_FRAMES))
        assert list(after.blended) == list(range(CLIP_FRAMES - overlap, CLIP_FRAMES))
        assert [before.sketches[slot] for slot in after.blended] == list(after.sketches[:overlap])
        assert [before.noise[slot] for slot in after.blended] == list(after.noise[:overlap])
        assert sorted(after.noise) == list(range(CLIP_FRAMES))
        assert after.conditioned_on == shared[0]


@torch.no_grad()
def test_without_steps_of_the_animation_it_is_plain_stable_video_diffusion_to_the_bit(plain: SVDModels) -> None:
    """Against a loop of its own, without anything of ours but the network, the encoders and the schedule."""
    options = replace(PLAIN, weak=0.0, strong=0.0, guidance=2.0, picture_noise=0.02)
    got = clip(plain, options, CLIP_FRAMES)
    frame, generator = Frame.around(WIDTH, HEIGHT, area=64 * 64), torch.Generator().manual_seed(3)
    noise = torch.randn((CLIP_FRAMES, 4, 8, 8), generator=generator)
    given = torch.from_numpy(frame.inward(picture())).permute(2, 0, 1)[None].contiguous()
    told = condition_on(given, plain, options=options, placement=CPU, generator=generator)
    sigmas, condition = noise_levels(3), told.latent.repeat(CLIP_FRAMES, 1, 1, 1)
    x, scale = noise * (1 + sigmas[0] ** 2).sqrt(), torch.linspace(1, 2, CLIP_FRAMES)[:, None, None, None]
    for sigma, following in pairwise(sigmas):
        into, level = x * (1 / (sigma**2 + 1).sqrt()), (sigma.log() / 4)[None]
        outputs = [
            plain.unet(torch.cat([into, c], dim=1)[None], level, text, told.ids, FrameLayout.plain())[0]
            for c, text in ((condition, told.context), (0 * condition, 0 * told.context))
        ]
        x = euler_step(x, denoised(x, outputs[1] + scale * (outputs[0] - outputs[1]), sigma), sigma, following)
    latents = torch.cat([LATENT_SCALE * told.latent, x[1:]]) / LATENT_SCALE
    decoder = plain.autoencoder
    for number, made in enumerate(
        torch.cat(list(decode(lambda z: decoder.decode(z, num_frames=len(z)).sample, latents)))
    ):
        expected = frame.outward(((made + 1) / 2).permute(1, 2, 0).contiguous().numpy())
        np.testing.assert_array_equal(got[number], expected)


def test_both_without_steps_of_the_animation_is_sketch_guided_to_the_bit(models: SVDModels) -> None:
    options = SVDOptions(steps=2, area=64 * 64, seed=3)
    both = replace(options, follow="both", weak=0.0, strong=0.0)
    lines = sketches(4)
    np.testing.assert_array_equal(clip(models, both, 4, lines), clip(models, options, 4, lines))


@pytest.mark.parametrize("count", [3, 17])
def test_led_to_the_end_everywhere_it_is_the_animation_to_the_codec_s_error(plain: SVDModels, count: int) -> None:
    animation = moving(count, everywhere=True)
    renderer = SVDRenderer(plain, options=PLAIN)
    got = np.stack(list(renderer.frames(picture(), animation=animation)))
    frame = Frame.around(WIDTH, HEIGHT, area=64 * 64)
    latents, moves = encode_animation(animation, frame, plain, placement=CPU)
    assert moves.all()
    decoder, pictures = plain.autoencoder, []
    for chunk in decoding_chunks(count):
        with torch.no_grad():
            made = decoder.decode(latents[list(chunk.frames)] / LATENT_SCALE, num_frames=len(chunk.frames)).sample
        pictures += list(((made[chunk.kept :].clamp(-1, 1) + 1) / 2).permute(0, 2, 3, 1).numpy())
    codec = np.stack([frame.outward(np.ascontiguousarray(each)) for each in pictures])
    np.testing.assert_allclose(got, codec, atol=1e-4)
    other = np.stack(list(SVDRenderer(plain, options=replace(PLAIN, seed=8)).frames(picture(), animation=animation)))
    np.testing.assert_allclose(got, other, atol=1e-4)


@pytest.mark.parametrize("count", [2, 15])
def test_progress_counts_encoded_frames_steps_and_chunks_and_can_stop(plain: SVDModels, count: int) -> None:
    options, done = replace(PLAIN, weak=1 / 3, strong=2 / 3, guidance=1.0), list[tuple[int, int]]()
    frames = list(
        SVDRenderer(plain, options=options).frames(
            picture(), animation=moving(count), progress=lambda *now: done.append(now)
        )
    )
    assert [frame.shape for frame in frames] == [(HEIGHT, WIDTH, 3)] * count
    total = count + 2 * len(plan_plain_segments(count)) + len(list(decoding_chunks(count)))
    assert done == [(number, total) for number in range(1, total + 1)]

    def stop(number: int, _: int) -> None:
        if number == 2:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        list(SVDRenderer(plain, options=options).frames(picture(), animation=moving(count), progress=stop))


def test_both_follow_the_sketches_and_the_animation(models: SVDModels) -> None:
    both = SVDOptions(steps=3, area=64 * 64, seed=3, follow="both", weak=1 / 3, strong=2 / 3)
    found = clip(models, both, 4, sketches(4))
    assert np.abs(clip(models, both, 4, sketches(4, step=5)) - found)[1:].max() > 1e-3, "another sketch, another frame"
    later = clip(models, replace(both, strong=1.0), 4, sketches(4))
    assert np.abs(later - found)[1:].max() > 1e-3, "held for longer, another frame"
    assert np.abs(clip(models, replace(both, seed=4), 4, sketches(4)) - found)[1:].max() > 1e-3


def test_settings_of_the_animation_matter(plain: SVDModels) -> None:
    options = replace(PLAIN, weak=1 / 3, strong=2 / 3, guidance=1.0)
    found = clip(plain, options, 4)
    np.testing.assert_array_equal(clip(plain, options, 4), found)
    for change in ({"weak": 0.0}, {"strong": 1.0}, {"guidance": 3.0}, {"motion_bucket": 200}, {"seed": 4}):
        assert np.abs(clip(plain, replace(options, **change), 4) - found)[1:].max() > 1e-4, change


def test_guidance_leaves_the_first_frame_of_a_segment_as_it_is(plain: SVDModels) -> None:
    from physanimator.rendering.svd.prediction import plain_predictor

    told = condition_on(
        torch.rand(1, 3, 64, 64), plain, options=PLAIN, placement=CPU, generator=torch.Generator().manual_seed(0)
    )
    x, condition, level = torch.randn(14, 4, 8, 8), told.latent.repeat(14, 1, 1, 1), torch.tensor(0.5)
    with torch.no_grad():
        none, some, more = (
            plain_predictor(plain, told, scale)(x, condition, torch.empty(14, 0), level, FrameLayout.plain())
            for scale in (1.0, 2.0, 3.0)
        )
    torch.testing.assert_close(some[0], none[0])
    torch.testing.assert_close(more[-1] - none[-1], 2 * (some[-1] - none[-1]), rtol=1e-3, atol=1e-4)
    assert (some[-1] - none[-1]).abs().max() > 1e-4


def test_faint_rims_do_not_count_and_thin_strands_do() -> None:
    frame, coverage = Frame.around(640, 400), np.full((400, 640), 0.04, np.float32)
    assert not latent_mask(coverage, frame).any()
    coverage[:, 301:303] = 0.5
    assert latent_mask(coverage, frame).any(axis=1).all()


def test_networks_and_guides_that_do_not_fit_are_refused(plain: SVDModels, models: SVDModels) -> None:
    with pytest.raises(InvalidInputError, match=r"models must be with LVCD, .*, to follow both. Got: networks without"):
        SVDRenderer(plain, options=SVDOptions(follow="both"))
    with pytest.raises(
        InvalidInputError, match=r"models must be with LVCD, .*, to follow sketches. Got: networks with"
    ):
        SVDRenderer(plain)
    with pytest.raises(InvalidInputError, match=r"models must be Stable Video Diffusion's alone, to follow animation"):
        SVDRenderer(models, options=PLAIN)
    alone, both = SVDRenderer(plain, options=PLAIN), SVDRenderer(models, options=SVDOptions(follow="both"))
    for renderer, lines, animation, fault in (
        (alone, sketches(3), moving(3), "sketches must be left out where frames follow the animation alone. Got: 3"),
        (alone, (), None, "frames of the animation must be 2 or more: the illustration and another. Got: 0"),
        (alone, (), moving(1), "frames of the animation must be 2 or more"),
        (both, sketches(3), moving(4), "frames of the animation must be 3, one for each sketch. Got: 4"),
        (both, sketches(3), None, "frames of the animation must be 3, one for each sketch. Got: 0"),
        (both, (), moving(3), "sketches must be 2 or more"),
        (SVDRenderer(models), sketches(3), moving(3), "animation must be left out where frames follow sketches alone"),
    ):
        with pytest.raises(InvalidInputError, match=fault):
            renderer.frames(picture(), lines, animation=animation)
    small = CrudeAnimation.of([picture()[:-1]] * 2, [np.zeros((HEIGHT, WIDTH))] * 2)
    with pytest.raises(
        InvalidInputError, match=r"animation must be of the illustration's size, 70 x 60 px. Got: 70 x 59"
    ):
        list(alone.frames(picture(), animation=small))
    with pytest.raises(InvalidInputError, match=r"coverage must be one for each of the 2 frames. Got: 1"):
        CrudeAnimation.of([picture()] * 2, [np.zeros((HEIGHT, WIDTH))])


@pytest.mark.parametrize(
    ("given", "fault"),
    [
        ({"follow": "film"}, "follow must be one of sketches, animation, both. Got: 'film'"),
        ({"follow": "animation", "weak": 0.5}, r"strong must be weak, which is 0.5, or more. Got: 0.42"),
        ({"weak": 0.1}, "weak must be left out unless follow is animation or both. Got: 0.1"),
        ({"strong": 0.9}, "strong must be left out unless follow is animation or both. Got: 0.9"),
        ({"follow": "both", "guidance": 2.0}, "guidance must be left out unless follow is animation. Got: 2.0"),
        ({"follow": "animation", "strong": 1.5}, "strong must be a number from 0 to 1. Got: 1.5"),
        ({"follow": "animation", "guidance": 0.5}, "guidance must be a number from 1 to 30. Got: 0.5"),
    ],
)
def test_settings_that_do_not_go_together_are_refused(given: dict[str, object], fault: str) -> None:
    with pytest.raises(InvalidInputError, match=fault):
        SVDOptions(**given)  # type: ignore[arg-type]
