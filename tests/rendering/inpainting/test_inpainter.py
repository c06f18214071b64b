"""What soft inpainting keeps and what it paints; diffusers' own pipelines are the authority for a hard mask."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import torch
from diffusers import StableDiffusionImg2ImgPipeline, StableDiffusionInpaintPipeline
from diffusers.models.autoencoders.vae import DiagonalGaussianDistribution
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.inpainting import InpaintingOptions
from physanimator.rendering.inpainting.inpainter import SoftInpainter
from physanimator.rendering.inpainting.models import InpaintingModels

Picture = NDArray[np.float32]

SIZE = (48, 64)
PICTURE = np.random.default_rng(5).random((*SIZE, 3), dtype=np.float32)
OPTIONS: dict[str, Any] = {"prompt": "girl", "negative_prompt": "girls", "steps": 5, "seed": 3, "guidance": 4.0}


def painted(models: InpaintingModels, change: Picture, picture: NDArray[Any] = PICTURE, **options: Any) -> Picture:
    inpainter = SoftInpainter(models, options=InpaintingOptions(**(OPTIONS | options)))
    (frame,) = inpainter.frames([(picture, change)], 1)
    return frame


def everywhere(value: float) -> Picture:
    return np.full(SIZE, value, np.float32)


def ramp() -> Picture:
    """0 on the left, 1 on the right."""
    return np.tile(np.clip(np.linspace(-0.3, 1.3, SIZE[1], dtype=np.float32), 0, 1), (SIZE[0], 1))


def rectangle() -> Picture:
    """A hole of whole latents."""
    change = everywhere(0)
    change[16:40, 8:40] = 1
    return change


@pytest.fixture
def certain(monkeypatch: pytest.MonkeyPatch) -> None:
    """Diffusers' pipelines draw latents at random around what the autoencoder says; here they take that itself."""
    monkeypatch.setattr(DiagonalGaussianDistribution, "sample", lambda self, generator=None: self.mode())


def by_diffusers(kind: Any, models: InpaintingModels, strength: float, **given: Any) -> Picture:
    parts = {"safety_checker": None, "feature_extractor": None, "requires_safety_checker": False}
    pipeline = kind(models.autoencoder, models.text_encoder, models.tokenizer, models.unet, models.scheduler(), **parts)
    pipeline.set_progress_bar_config(disable=True)
    drawn = pipeline(
        prompt="girl",
        negative_prompt="girls",
        num_inference_steps=5,
        guidance_scale=4.0,
        generator=torch.Generator().manual_seed(3),
        strength=strength,
        image=torch.from_numpy(PICTURE).permute(2, 0, 1)[None],
        output_type="np",
        **given,
    )
    return np.asarray(drawn.images[0])


@pytest.mark.usefixtures("certain")
@pytest.mark.parametrize("strength", [0.4, 0.8])
def test_change_everywhere_is_plain_image_to_image(plain: InpaintingModels, strength: float) -> None:
    expected = by_diffusers(StableDiffusionImg2ImgPipeline, plain, strength)
    assert np.abs(painted(plain, everywhere(1), strength=strength) - expected).max() < 1e-5


@pytest.mark.usefixtures("certain")
@pytest.mark.parametrize("strength", [0.6, 1.0])
@pytest.mark.parametrize("network", ["plain", "seeing"])
def test_a_hard_mask_is_plain_inpainting(network: str, strength: float, request: pytest.FixtureRequest) -> None:
    """Also where the mask is 0, wherever the model for pictures is concerned, until the frame is put back there."""
    models, change = request.getfixturevalue(network), rectangle() if network == "plain" else everywhere(1)
    mask = torch.from_numpy(change)[None, None]
    expected = by_diffusers(
        StableDiffusionInpaintPipeline, models, strength, mask_image=mask, height=SIZE[0], width=SIZE[1]
    )
    got = painted(models, change, strength=strength)
    assert np.abs(got - expected)[change == 1].max() < 1e-5
    assert np.array_equal(got[change == 0], PICTURE[change == 0])


@pytest.mark.parametrize("network", ["plain", "seeing"])
def test_nothing_changes_where_the_mask_is_0(network: str, request: pytest.FixtureRequest) -> None:
    models, change = request.getfixturevalue(network), ramp()
    got = painted(models, change)
    assert np.array_equal(got[change == 0], PICTURE[change == 0])
    assert np.abs(got - PICTURE)[change == 1].mean() > 0.05
    assert np.array_equal(painted(models, everywhere(0)), PICTURE)


def test_what_may_change_more_is_freed_earlier(plain: InpaintingModels) -> None:
    """Until a place is freed it is the noised original, whatever the network says of it."""
    from physanimator.rendering.inpainting.sampler import sample_softly

    generator, freed, steps = torch.Generator().manual_seed(0), [], 10
    original, noise = (torch.randn((1, 4, 1, 11), generator=generator) for _ in range(2))
    change = torch.linspace(0, 1, 11)[None, None, None]
    scheduler = plain.scheduler()

    def predict(x: torch.Tensor, time: torch.Tensor) -> torch.Tensor:
        follows = (x - scheduler.add_noise(original, noise, time[None])).abs().amax(dim=1)[0, 0] < 1e-6
        freed.append((~follows).tolist())
        return torch.full_like(x, 2.0)

    got = sample_softly(predict, scheduler, original, noise, change, steps=steps, strength=0.999)
    assert len(freed) == 9
    counts = [sum(each) for each in freed]
    assert counts[0] == 0
    assert counts == sorted(counts)
    assert len(set(counts)) > 6
    assert all(each == sorted(each) for each in freed)  # from the right
    left = (got - original).abs().amax(dim=1)[0, 0]
    assert left[0] == 0
    assert left[1] == 0
    assert (left[2:] > 0).all()
    assert (left.diff() >= 0).all()


@pytest.mark.parametrize("network", ["plain", "seeing"])
def test_more_change_leaves_the_frame_further(network: str, request: pytest.FixtureRequest) -> None:
    models = request.getfixturevalue(network)
    left = [np.abs(painted(models, everywhere(value)) - PICTURE).mean() for value in (0, 0.1, 0.3, 0.6, 1)]
    assert left == sorted(left)
    assert len(set(left)) == 5


def test_seeds(plain: InpaintingModels) -> None:
    change = ramp()
    assert np.array_equal(painted(plain, change), painted(plain, change))
    assert not np.array_equal(painted(plain, change), painted(plain, change, seed=4))


def test_prompts_and_guidance(plain: InpaintingModels) -> None:
    one = painted(plain, everywhere(1))
    assert not np.array_equal(one, painted(plain, everywhere(1), prompt="girls girl"))
    assert not np.array_equal(one, painted(plain, everywhere(1), negative_prompt=""))
    alone, other = (painted(plain, everywhere(1), guidance=1.0, negative_prompt=text) for text in ("girl", ""))
    assert np.array_equal(alone, other)


def test_frames_share_their_noise(plain: InpaintingModels) -> None:
    still = [(PICTURE, ramp())] * 3
    frames = list(SoftInpainter(plain, options=InpaintingOptions(**OPTIONS)).frames(still, 3))
    assert np.array_equal(frames[0], frames[1])
    assert np.array_equal(frames[0], frames[2])
    options = InpaintingOptions(**OPTIONS, shared_noise=False)
    frames = list(SoftInpainter(plain, options=options).frames(still, 3))
    assert not np.array_equal(frames[0], frames[1])
    assert not np.array_equal(frames[1], frames[2])
    assert np.array_equal(frames[0], painted(plain, ramp()))


@pytest.mark.parametrize("size", [(1, 1), (7, 9), (33, 130), (64, 64)])
def test_any_size(plain: InpaintingModels, size: tuple[int, int]) -> None:
    picture = np.random.default_rng(1).integers(0, 256, (*size, 3), dtype=np.uint8)
    change = np.ones(size, np.float32)
    change[: size[0] // 2] = 0
    got = painted(plain, change, picture)
    assert got.shape == picture.shape
    assert np.array_equal(np.round(got[change == 0] * 255), picture[change == 0])
    assert np.abs(got[change == 1] - picture[change == 1] / np.float32(255)).mean() > 0.02
    got = painted(plain, change, picture, area=64 * 64)
    assert got.shape == picture.shape
    assert np.array_equal(np.round(got[change == 0] * 255), picture[change == 0])


def test_progress_ends_at_its_total_and_cancels(plain: InpaintingModels) -> None:
    seen: list[tuple[int, int]] = []
    clip = [(PICTURE, everywhere(value)) for value in (0, 1, 0.5)]
    options = InpaintingOptions(**OPTIONS)
    list(SoftInpainter(plain, options=options).frames(clip, 3, progress=lambda *now: seen.append(now)))
    assert seen == [(done, 15) for done in range(5, 16)]

    class StopError(Exception):
        pass

    def stop(done: int, total: int) -> None:
        if done == 7:
            raise StopError

    before = {name: tensor.data_ptr() for name, tensor in plain.unet.state_dict().items()}
    with pytest.raises(StopError):
        list(SoftInpainter(plain, options=options).frames(clip, 3, progress=stop))
    assert {name: tensor.data_ptr() for name, tensor in plain.unet.state_dict().items()} == before


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"steps": 0}, "steps"),
        ({"strength": 1.5}, "strength"),
        ({"strength": 0.03}, "strength must be 0.04 to 1"),
        ({"guidance": float("nan")}, "guidance"),
        ({"seed": -1}, "seed"),
        ({"prompt": 3}, "prompt"),
        ({"area": 3}, "area"),
    ],
)
def test_unusable_options(options: dict[str, Any], named: str) -> None:
    with pytest.raises(InvalidInputError, match=named):
        InpaintingOptions(**options)


@pytest.mark.parametrize("change", [np.zeros((3, 4), np.float32), everywhere(1.5), everywhere(float("nan"))])
def test_unusable_change_maps(plain: InpaintingModels, change: Picture) -> None:
    with pytest.raises(InvalidInputError, match="change map"):
        painted(plain, change)


def test_more_steps_than_the_model_knows(plain: InpaintingModels) -> None:
    assert plain.schedule["num_train_timesteps"] == 1000
    few = InpaintingModels(**(vars(plain) | {"schedule": {**plain.schedule, "num_train_timesteps": 4}}))
    with pytest.raises(InvalidInputError, match="steps must be 4 or less"):
        painted(few, everywhere(1))
