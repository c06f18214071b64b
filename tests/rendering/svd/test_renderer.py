"""Whole clips with small random networks, through the code that the real ones use."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import random_svd
import torch
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.networks.placement import Placement
from physanimator.rendering.svd import SVDOptions
from physanimator.rendering.svd.models import SVDModels, load_models
from physanimator.rendering.svd.renderer import SVDRenderer

Image = NDArray[np.float32]

OPTIONS = SVDOptions(steps=2, area=64 * 64, seed=3)
STEPS_AND_CHUNKS = {2: 2 + 1, 12: 2 + 2, 16: 4 + 2}


def illustration(width: int = 70, height: int = 60) -> Image:
    y, x = np.mgrid[:height, :width].astype(np.float32)
    return np.stack([x / width, y / height, np.full_like(x, 0.5)], axis=2)


def sketches(count: int, width: int = 70, height: int = 60) -> list[Image]:
    """A vertical line that moves to the right."""
    drawn = []
    for number in range(count):
        sketch = np.ones((height, width), np.float32)
        sketch[:, 10 + 2 * number : 13 + 2 * number] = 0
        drawn.append(sketch)
    return drawn


def clip(models: SVDModels, count: int = 3, options: SVDOptions = OPTIONS) -> Image:
    return np.stack(list(SVDRenderer(models, options=options).frames(illustration(), sketches(count))))


@pytest.fixture(scope="module")
def short(models: SVDModels) -> Image:
    return clip(models)


@pytest.mark.parametrize("count", STEPS_AND_CHUNKS)
def test_one_frame_for_each_sketch(models: SVDModels, count: int) -> None:
    done: list[tuple[int, int]] = []
    renderer = SVDRenderer(models, options=OPTIONS)
    frames = list(renderer.frames(illustration(), sketches(count), progress=lambda *now: done.append(now)))
    assert [frame.shape for frame in frames] == [(60, 70, 3)] * count
    assert all(frame.dtype == np.float32 and 0 <= frame.min() < frame.max() <= 1 for frame in frames)
    total = STEPS_AND_CHUNKS[count]
    assert done == [(number, total) for number in range(1, total + 1)]


def test_every_format_gives_the_same_clip(
    short: Image, weights: dict[str, dict[str, torch.Tensor]], folder: Path, tmp_path: Path
) -> None:
    lvcd = random_svd.write_lvcd(tmp_path / "lvcd.safetensors", weights)
    np.testing.assert_allclose(clip(load_models(folder, lvcd)), short, atol=1e-3)


def test_the_seed_decides(models: SVDModels, short: Image) -> None:
    np.testing.assert_array_equal(clip(models), short)
    other = clip(models, options=replace(OPTIONS, seed=4))
    assert np.abs(other[1:] - short[1:]).max() > 0.02


def test_sketches_and_settings_matter(models: SVDModels, short: Image) -> None:
    renderer = SVDRenderer(models, options=OPTIONS)
    still = np.stack(list(renderer.frames(illustration(), sketches(1) * 3)))
    assert np.abs(still[2] - short[2]).max() > 1e-3
    for change in ({"motion_bucket": 20}, {"frames_per_second": 24}, {"picture_noise": 0.3}, {"steps": 3}):
        assert np.abs(clip(models, options=replace(OPTIONS, **change)) - short).max() > 1e-4, change


@pytest.mark.parametrize("dtype", [torch.bfloat16])
def test_half_precision_gives_nearly_the_same(short: Image, single_file: Path, lvcd: Path, dtype: torch.dtype) -> None:
    half = clip(load_models(single_file, lvcd, dtype=dtype, sizes=random_svd.TINY))
    assert np.abs(half - short).max() < 0.1
    assert np.abs(half - short).mean() < 0.02


def test_bytes_and_colour_sketches_are_accepted(models: SVDModels, short: Image) -> None:
    renderer = SVDRenderer(models, options=OPTIONS)
    coloured = [np.repeat((255 * sketch).astype(np.uint8)[..., None], 3, axis=2) for sketch in sketches(3)]
    frames = np.stack(list(renderer.frames(illustration(), coloured)))
    np.testing.assert_allclose(frames, short, atol=1e-5)


def test_progress_and_steps_can_stop(models: SVDModels) -> None:
    def stop(*_: object) -> None:
        raise InterruptedError

    renderer = SVDRenderer(models, options=OPTIONS)
    with pytest.raises(InterruptedError):
        next(renderer.frames(illustration(), sketches(3), progress=stop))
    with pytest.raises(InterruptedError):
        next(renderer.frames(illustration(), sketches(3), watch=stop))


def test_room_is_asked_for_before_and_given_back_after(models: SVDModels) -> None:
    before = {name: each.data_ptr() for name, each in models.unet.named_parameters()}
    asked: list[int] = []
    left: list[int] = []
    placement = Placement(torch.device("cpu"), make_room=asked.append, left=lambda: left.append(len(asked)))
    list(SVDRenderer(models, options=OPTIONS, placement=placement).frames(illustration(), sketches(3)))
    both = sum(4 * each.numel() for network in (models.unet, models.control) for each in network.parameters())
    assert len(asked) == 4  # picture encoder, autoencoder, ControlNet with UNet, autoencoder
    assert left == [1, 2, 3, 4]
    assert both < asked[2] < both + 2**28
    assert {name: each.data_ptr() for name, each in models.unet.named_parameters()} == before


def test_networks_leave_the_device_even_after_an_error(models: SVDModels) -> None:
    placement = Placement(torch.device("meta"))

    def fail() -> None:
        with placement.at_work(models.unet):
            assert all(each.is_meta for each in models.unet.parameters())
            raise RuntimeError("stopped")

    with pytest.raises(RuntimeError, match="stopped"):
        fail()
    assert not any(each.is_meta for each in models.unet.parameters())


@pytest.mark.parametrize(
    ("given", "fault"),
    [
        (sketches(1), "sketches must be 2 or more"),
        (sketches(3, width=64), r"sketches must be of the illustration's size, 70 x 60 px. Got: \[\(60, 64\)\]"),
    ],
)
def test_sketches_that_do_not_fit_are_refused(models: SVDModels, given: list[Image], fault: str) -> None:
    with pytest.raises(InvalidInputError, match=fault):
        SVDRenderer(models, options=OPTIONS).frames(illustration(), given)


@pytest.mark.parametrize(
    "change", [{"steps": 1}, {"motion_bucket": 0}, {"frames_per_second": 0}, {"picture_noise": -1}]
)
def test_settings_out_of_range_are_refused(change: dict[str, int]) -> None:
    with pytest.raises(InvalidInputError, match=next(iter(change))):
        replace(OPTIONS, **change)
