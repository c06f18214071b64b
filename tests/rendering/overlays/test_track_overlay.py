"""Tracks on pictures."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.motion import Tracks
from physanimator.rendering.overlays import draw_tracks, reframed

WIDTH, HEIGHT, FRAMES = 320, 180, 20


@pytest.fixture
def found() -> Tracks:
    """One point that moves right, one that stands still, one that is hidden in the second half."""
    time = np.arange(FRAMES)
    moving = np.stack([40 + 10.0 * time, np.full(FRAMES, 40.5)], axis=1)
    still = np.tile([100.5, 90.5], (FRAMES, 1))
    hidden = np.stack([40 + 10.0 * time, np.full(FRAMES, 140.5)], axis=1)
    visibility = np.ones((FRAMES, 3), dtype=bool)
    visibility[10:, 2] = False
    path = np.stack([moving, still, hidden], axis=1).astype(np.float32)
    return Tracks(path, visibility, WIDTH, HEIGHT, 24.0)


def changed(found: Tracks, sample: int, scale: int = 1, **options: int) -> np.ndarray:
    black = np.zeros((HEIGHT * scale, WIDTH * scale, 3), np.uint8)
    return (draw_tracks(black, found, sample, **options) > 60).any(axis=2)


def test_dots_and_tails_are_where_the_points_are_and_were(found: Tracks) -> None:
    seen = changed(found, 15)
    assert seen[40, 190]
    assert seen[40, 120:190].any()
    assert not seen[40, 200:].any()  # nothing ahead of the point
    assert seen[90, 100]
    assert not seen[80:101, 110:].any()  # what stands still has no tail
    assert not seen[140, 60:180].any()  # what is hidden has none either
    assert seen[130:150, 184:196].any()  # but a ring


def test_tails_are_as_long_as_wanted(found: Tracks) -> None:
    short, long = (np.flatnonzero(changed(found, 15, tail=tail)[38:43].any(axis=0)).min() for tail in (3, 12))
    assert short > long + 50


def test_the_overlay_scales_with_the_picture(found: Tracks) -> None:
    seen = changed(found, 15, scale=2)
    assert seen[81, 380]
    assert seen[181, 201]


def test_type_and_input_stay(found: Tracks) -> None:
    picture = np.full((HEIGHT, WIDTH, 3), 0.5, np.float32)
    drawn = draw_tracks(picture, found, 3)
    assert drawn.dtype == np.float32
    assert drawn.shape == picture.shape
    assert (picture == 0.5).all()
    assert np.abs(drawn - 0.5).max() > 0.2


@pytest.mark.parametrize("sample", [-1, FRAMES])
def test_unknown_samples_are_refused(found: Tracks, sample: int) -> None:
    with pytest.raises(InvalidInputError, match="sample must be 0 to 19"):
        draw_tracks(np.zeros((HEIGHT, WIDTH, 3), np.uint8), found, sample)


def test_positions_far_outside_do_no_harm(found: Tracks) -> None:
    far = Tracks(found.path * 1e6 - 1e5, found.visibility, WIDTH, HEIGHT, 24.0)
    assert not changed(far, 15)[20:].any()


@pytest.mark.parametrize("size", [(160, 160), (400, 100), (320, 180)])
def test_cropping_keeps_the_middle_and_stretching_everything(size: tuple[int, int]) -> None:
    x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    picture = np.stack([x, y, x], axis=-1).astype(np.float32)
    scale = max(size[0] / WIDTH, size[1] / HEIGHT)
    columns, rows = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    cropped = reframed(picture, *size, "crop")
    assert cropped.shape == (size[1], size[0], 3)
    assert np.abs(cropped[..., 0] - ((columns - size[0] / 2) / scale + WIDTH / 2))[5:-5, 5:-5].max() < 1.1
    assert np.abs(cropped[..., 1] - ((rows - size[1] / 2) / scale + HEIGHT / 2))[5:-5, 5:-5].max() < 1.1
    stretched = reframed(picture, *size, "stretch")
    assert np.abs(stretched[..., 0] - columns * WIDTH / size[0])[5:-5, 5:-5].max() < 1.1
