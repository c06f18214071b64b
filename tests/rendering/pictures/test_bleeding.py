"""Colours under alpha 0, and resizing of pictures with transparency: no rims."""

from __future__ import annotations

from pathlib import Path

import av
import numpy as np
import pytest
from physanimator.rendering.pictures import carried_on, over, premultiplied, resized, straight, write_animation
from physanimator.rendering.pictures.bleeding import bled
from PIL import Image

YELLOW = np.array([250, 230, 60])
GROUNDS = ((0, 0, 0), (255, 255, 255), (255, 0, 255))


def disc(size: int = 96, *, shift: float = 0.0) -> np.ndarray:
    """A bright soft-edged disc, black under alpha 0."""
    y, x = np.mgrid[:size, :size] + 0.5
    alpha = np.clip(size / 3 - np.hypot(x - size / 2 - shift, y - size / 2) + 0.5, 0, 1)
    image = np.zeros((size, size, 4), np.uint8)
    image[..., :3] = np.where(alpha[..., None] > 0, YELLOW, 0)
    image[..., 3] = np.rint(255 * alpha)
    image[image[..., 3] == 0] = 0
    return image


def test_visible_pixels_stay_and_hidden_ones_take_the_colours_beside() -> None:
    image = disc()
    image[:, :48, :3] = np.where(image[:, :48, 3:] > 0, 255 - YELLOW, 0)
    carried = bled(image)
    seen = image[..., 3] > 0
    assert (carried[seen] == image[seen]).all()
    assert (carried[..., 3] == image[..., 3]).all()
    assert np.abs(carried[40:56, 12:16, :3].astype(int) - (255 - YELLOW)).max() <= 12
    assert np.abs(carried[40:56, 81:85, :3].astype(int) - YELLOW).max() <= 12


def test_nothing_known_gives_nothing() -> None:
    assert (bled(np.zeros((7, 9, 4), np.uint8)) == 0).all()
    one = carried_on(np.full((5, 3, 3), 0.25, np.float32), np.eye(5, 3, dtype=np.float32))
    assert np.allclose(one, 0.25)


@pytest.mark.parametrize("suffix", [".webm", ".webp", ".mov"])
def test_no_rim_after_lossy_compression(tmp_path: Path, suffix: str) -> None:
    frames = [disc(shift=number) for number in range(3)]
    path = tmp_path / f"disc{suffix}"
    write_animation(frames, path, 24)
    for ground in GROUNDS:
        apart = np.abs(over(_second(path), ground).astype(int) - over(frames[1], ground))
        assert apart.max() <= 12  # without the colours carried on it is above 50, a grey rim


def _second(path: Path) -> np.ndarray:
    if path.suffix == ".webp":
        with Image.open(path) as picture:
            picture.seek(1)
            return np.array(picture.convert("RGBA"))
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        if path.suffix == ".mov":
            return list(container.decode(stream))[1].to_ndarray(format="rgba")
        decoder = av.CodecContext.create("libvpx-vp9", "r")
        decoder.extradata = stream.codec_context.extradata
        frames = [frame for packet in container.demux(stream) for frame in decoder.decode(packet)]
    return frames[1].to_ndarray(format="rgba")


@pytest.mark.parametrize("width", [40, 57, 96, 131, 288])
@pytest.mark.parametrize("dtype", [np.uint8, np.float32])
def test_resizing_mixes_no_hidden_colours(width: int, dtype: type) -> None:
    image = disc()
    image[image[..., 3] == 0] = (0, 0, 255, 0)
    given = image if dtype == np.uint8 else image.astype(np.float32) / 255
    small = resized(given, width, width)
    assert small.dtype == dtype
    assert small.shape == (width, width, 4)
    colours = small * (1 if dtype == np.uint8 else 255)
    assert np.abs(colours[small[..., 3] > small.max() / 20, :3] - YELLOW).max() <= 6


def test_premultiplied_and_back() -> None:
    image = np.random.default_rng(0).integers(0, 256, (40, 30, 4), dtype=np.uint8)
    image[..., 3] = np.maximum(image[..., 3], 1)
    back = np.rint(255 * straight(premultiplied(image))).astype(np.uint8)
    assert (back == image).all()


@pytest.mark.parametrize("width", [10, 45, 50, 120])
def test_nearest_resizing_makes_no_colours(width: int) -> None:
    image = np.random.default_rng(1).integers(0, 256, (30, 40, 3), dtype=np.uint8)
    large = resized(image, width, width * 3 // 4, nearest=True)
    assert large.shape[:2] == (width * 3 // 4, width)
    assert {*map(tuple, large.reshape(-1, 3))} <= {*map(tuple, image.reshape(-1, 3))}
    if width == 120:
        assert (large == image.repeat(3, axis=0).repeat(3, axis=1)).all()
