"""Numbers of every kind mean the same picture everywhere, or are refused in one sentence."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import coverage_of
from physanimator.rendering.inbetweens import interpolate
from physanimator.rendering.options import Timing, Touching
from physanimator.rendering.pictures import (
    as_dtype,
    as_float,
    as_grey,
    as_picture,
    as_uint8,
    data_address,
    save_image,
    write_animation,
)
from physanimator.rendering.pipeline import animate
from physanimator.rendering.plate import clean_plate
from physanimator.rendering.segmentation import segment
from physanimator.rendering.sketch import extract_sketch
from PIL import Image

HEIGHT, WIDTH = 40, 60


def drawing() -> np.ndarray:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    picture = np.stack([x * 4, y * 6, np.full_like(x, 90)], axis=-1).astype(np.uint8)
    picture[10:30, 20:40] = (250, 10, 30)
    return picture


def part() -> np.ndarray:
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[10:30, 20:40] = True
    return mask


SAME: dict[str, Callable[[np.ndarray], Any]] = {
    "uint8": lambda picture: picture,
    "uint16": lambda picture: picture.astype(np.uint16) * 257,
    "big-endian uint16": lambda picture: (picture.astype(np.uint16) * 257).astype(">u2"),
    "int64": lambda picture: picture.astype(np.int64),
    "int16": lambda picture: picture.astype(np.int16),
    "float32": lambda picture: picture.astype(np.float32) / 255,
    "float64": lambda picture: picture / 255,
    "tensor": lambda picture: torch.from_numpy(picture.astype(np.float32) / 255).requires_grad_(),
    "list": lambda picture: picture.tolist(),
    "Pillow": Image.fromarray,
    "a view": lambda picture: picture[::-1][::-1],
}


@pytest.mark.parametrize("kind", SAME)
def test_every_kind_of_number_is_the_same_picture(kind: str) -> None:
    picture = as_picture(SAME[kind](drawing()))
    assert picture.dtype in (np.uint8, np.float32)
    assert np.abs(as_float(picture) - drawing() / 255).max() < 1e-6


@pytest.mark.parametrize("kind", ["float16", "bfloat16", "overshoot"])
def test_coarse_numbers_are_nearly_the_same_picture(kind: str) -> None:
    values = torch.from_numpy(drawing().astype(np.float32) / 255)
    given = {"float16": values.half().numpy(), "bfloat16": values.bfloat16(), "overshoot": values * 1.06 - 0.03}[kind]
    picture = as_picture(given)
    assert np.abs(picture - drawing() / 255).max() < 0.035
    assert picture.min() >= 0
    assert picture.max() <= 1


BAD: dict[str, tuple[Any, str]] = {
    "float 0..255": (drawing().astype(np.float32), "from 0 to 1. Got: 0 to 250; divide by 255"),
    "-1..1": (drawing() / 127.5 - 1, "from 0 to 1. Got: -1 to"),
    "NaN": (np.where(drawing() > 249, np.nan, 0.5), "finite numbers. Got: NaN"),
    "infinite": (np.where(drawing() > 249, np.inf, 0.5), "finite numbers"),
    "8 bits in 16": (drawing().astype(np.uint16), "of 16 bits must reach up to 65535.*at most 250"),
    "negative": (drawing().astype(np.int64) - 1, "whole numbers from 0 to 255. Got: -1"),
    "objects": (np.full((HEIGHT, WIDTH, 3), None), "booleans, integers or floating-point numbers. Got: dtype object"),
    "ragged": ([[1, 2], [3]], "image must"),
    "complex": (drawing().astype(complex), "complex128"),
    "text": ("girl.png", "Got: str"),
    "nothing": (None, "Got: NoneType"),
    "grey": (drawing()[..., 0], "an RGB picture of shape"),
    "channels first": (np.moveaxis(drawing(), 2, 0), r"an RGB picture.*Got: shape \(3, 40, 60\)"),
    "RGBA": (np.dstack([drawing(), drawing()[..., :1]]), r"an RGB picture.*Got: shape \(40, 60, 4\)"),
    "empty": (np.zeros((0, 3, 3), np.uint8), "an RGB picture"),
}


@pytest.mark.parametrize("kind", BAD)
def test_other_numbers_are_refused_in_a_sentence(kind: str) -> None:
    given, message = BAD[kind]
    with pytest.raises(InvalidInputError, match=message) as caught:
        as_picture(given)
    assert "\n" not in str(caught.value)


def test_rgba_where_it_is_asked_for() -> None:
    rgba = np.dstack([drawing(), drawing()[..., :1]])
    assert as_picture(rgba, alpha=True) is rgba
    with pytest.raises(InvalidInputError, match=r"RGB or RGBA picture of shape \[h, w, 3 or 4\]"):
        as_picture(rgba[..., :2], alpha=True)


USERS: dict[str, Callable[[Any], Any]] = {
    "animate": lambda picture: animate(picture, [part()], timing=Timing(frames=1)).renderer.frame(0),
    "plate": lambda picture: animate(drawing(), [part()], plate=picture, timing=Timing(frames=1)).renderer.frame(0),
    "clean_plate": lambda picture: clean_plate(picture, part()),
    "sketch": extract_sketch,
    "segment": lambda picture: segment(picture, [[30, 20]], [1]),
    "in-betweens": lambda picture: list(interpolate([picture, picture], [0, 2], backend="blend"))[1],
}


@pytest.mark.parametrize("user", USERS)
def test_all_that_takes_a_picture_takes_the_same_numbers(user: str) -> None:
    expected = as_float(USERS[user](drawing()))
    for kind in ("uint16", "int64", "float64", "tensor"):
        assert np.abs(as_float(USERS[user](SAME[kind](drawing()))) - expected).max() < 0.01, kind
    for kind in ("float 0..255", "NaN", "objects"):
        with pytest.raises(InvalidInputError, match=BAD[kind][1].split(".")[0]):
            USERS[user](BAD[kind][0])


def test_writers_refuse_what_would_be_white(tmp_path: Path) -> None:
    wrong = drawing().astype(np.float32)
    for write in (
        lambda: save_image(tmp_path / "a.png", wrong),
        lambda: write_animation([wrong], tmp_path / "a.mp4", 24),
        lambda: data_address(wrong),
    ):
        with pytest.raises(InvalidInputError, match="divide by 255"):
            write()
    assert not list(tmp_path.iterdir())


def test_the_first_frame_of_any_kind_is_the_picture() -> None:
    for kind in ("uint16", "int64", "float64"):
        animation = animate(SAME[kind](drawing()), [part()], plate=drawing(), timing=Timing(frames=2))
        assert np.abs(as_float(animation.renderer.frame(0)) - drawing() / 255).max() < 1e-6


@pytest.mark.parametrize(
    "mask",
    [
        part(),
        part().astype(np.uint8),
        part().astype(np.uint8) * 255,
        part().astype(np.int64),
        part().astype(np.uint16) * 65535,
        part().astype(np.float16),
        part() * 1.04 - 0.02,
        part()[None],
        part()[..., None] * 1.0,
        torch.from_numpy(part()),
        Image.fromarray(part().astype(np.uint8) * 255),
    ],
)
def test_masks_of_every_kind(mask: Any) -> None:
    coverage = coverage_of(mask)
    assert coverage.dtype == np.float32
    np.testing.assert_allclose(coverage, part(), atol=0.021)
    assert coverage.max() <= 1


@pytest.mark.parametrize(
    ("mask", "message"),
    [
        (part() * 255.0, "from 0 to 1. Got: 0 to 255; divide by 255"),
        (part().astype(np.int64) * 3, "of labels choose one, as in mask == 1. Got: 0 to 3"),
        (part().astype(np.uint8) * 5, "of labels choose one"),
        (part().astype(np.int64) - 1, "Got: -1 to 0"),
        (part().astype(np.int64) * 70_000, "Got: 0 to 70000"),
        (np.where(part(), np.nan, 0.0), "finite"),
        (np.full(part().shape, None), "booleans, integers or floating"),
        (np.stack([part()] * 3, axis=-1), "one plane"),
    ],
)
def test_masks_that_say_something_else(mask: Any, message: str) -> None:
    with pytest.raises(InvalidInputError, match=r"masks\[0\] must.*" + message):
        animate(drawing(), [mask], timing=Timing(frames=1))


def test_masks_of_the_same_proportions_are_scaled_for_every_route() -> None:
    half = part()[::2, ::2]
    animation = animate(drawing(), [half], touching=Touching(contact=None), timing=Timing(frames=1))
    assert animation.masks[0].shape == (HEIGHT, WIDTH)
    assert np.abs(animation.masks[0] - part()).mean() < 0.02
    with pytest.raises(InvalidInputError, match=r"colliders\[0\] must have the picture's size.*Got: 40 x 40 px"):
        animate(drawing(), [part()], touching=Touching(colliders=[part()[:, :40]]), timing=Timing(frames=1))


def test_bytes_become_floats_by_a_quotient_or_by_a_product() -> None:
    levels = np.arange(256, dtype=np.uint8)
    quotients, products = as_float(levels), as_float(levels, exact=False)
    assert np.array_equal(quotients, (levels.astype(np.float64) / 255).astype(np.float32))
    assert np.array_equal(products, levels.astype(np.float32) * np.float32(1 / 255))
    assert 0 < np.abs(quotients - products).max() < 1e-7
    assert np.array_equal(as_uint8(quotients), levels)
    assert np.array_equal(as_uint8(products), levels)


def test_grey_is_the_mean_of_the_channels() -> None:
    picture = drawing()
    assert as_grey(picture[..., 0]).shape == picture.shape[:2]
    assert np.abs(as_grey(picture) - picture.mean(axis=2) / 255).max() < 1e-6


@pytest.mark.parametrize("dtype", [np.uint8, np.float32, np.float64])
def test_a_picture_goes_back_into_its_type(dtype: type) -> None:
    found = as_dtype(np.array([-0.1, 0.5, 1.2], np.float32), np.dtype(dtype))
    assert found.dtype == dtype
    assert found.tolist() == ([0, 128, 255] if dtype == np.uint8 else [0, 0.5, 1])
