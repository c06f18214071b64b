"""Keyframes of a motion in their places."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.control import (
    ModelFormat,
    known_latents,
    line_frames,
    moments,
    motion_keyframes,
    placed_keyframes,
    warped_frames,
)

SIZE = 96
FORM = ModelFormat(frames=17, width=SIZE, height=SIZE, fit="stretch")


@pytest.fixture(scope="module")
def mask() -> np.ndarray:
    part = np.zeros((SIZE, SIZE), np.float32)
    part[20:60, 20:60] = 1
    return part


@pytest.fixture(scope="module")
def picture(mask: np.ndarray) -> np.ndarray:
    return np.where(mask[..., None] > 0, np.uint8([200, 40, 30]), np.uint8([240, 235, 230])).astype(np.uint8)


@pytest.fixture(scope="module")
def motion(mask: np.ndarray) -> Motion:
    """A slide to the right by 24 px in 9 frames."""
    mesh = mesh_from_mask(mask, spacing=8)
    positions = np.stack([mesh.vertices + (3 * t, 0) for t in range(9)]).astype(np.float32)
    return Motion((Body(mesh),), positions, frame_rate=8.0)


def left_edge(frame: np.ndarray) -> int:
    """First column of the red square in the middle of its height."""
    return int(np.argmax(frame[40, :, 1] < 0.5))


@pytest.mark.parametrize(("numbers", "found"), [([0, 40, -1], (0, 40, 80)), ([-81], (0,)), ([5, 3], (3, 5))])
def test_numbers_count_from_either_end_and_come_in_order(numbers: list[int], found: tuple[int, ...]) -> None:
    assert moments(numbers, 81) == found


@pytest.mark.parametrize(
    ("numbers", "said"), [([], "at least one"), ([81], "-81 to 80"), ([-82], "-81"), ([0, -81], "twice")]
)
def test_numbers_that_are_no_frames_are_refused(numbers: list[int], said: str) -> None:
    with pytest.raises(InvalidInputError, match=said):
        moments(numbers, 81)


def test_a_keyframe_is_the_frame_of_the_whole_clip_at_its_number(
    picture: np.ndarray, mask: np.ndarray, motion: Motion
) -> None:
    drawn = motion_keyframes(picture, [mask], motion, FORM, at=[0, 8, -1])
    assert [left_edge(frame) for frame in drawn] == [20, 32, 44]
    clip = [frame for frame, _ in warped_frames(picture, [mask], motion, FORM, grow=0)]
    covered = mask > 0
    np.testing.assert_allclose(drawn[0][covered], clip[0][covered], atol=1e-6)


def test_sketches_are_bent_to_the_same_frames(motion: Motion) -> None:
    sketch = np.ones((SIZE, SIZE), np.float32)
    sketch[:, 40] = 0
    every = list(line_frames(sketch, motion, FORM, bright_lines=False))
    some = list(line_frames(sketch, motion, FORM, bright_lines=False, at=[0, 8, 16]))
    assert [int(np.argmin(lines[40])) for lines in some] == [40, 52, 64]
    for lines, t in zip(some, (0, 8, 16), strict=True):
        np.testing.assert_array_equal(lines, every[t])


def test_a_clip_shows_keyframes_where_nothing_is_to_be_painted() -> None:
    pictures = [np.full((4, 6, 3), value, np.float32) for value in (0.1, 0.9)]
    clip, missing = placed_keyframes(pictures, [8, 0], 17)
    assert clip.shape == (17, 4, 6, 3)
    assert clip[0].max() == np.float32(0.9)
    assert clip[8].max() == np.float32(0.1)
    given = missing.min(axis=(1, 2)) == 0
    assert np.flatnonzero(given).tolist() == [0, 8]
    assert np.unique(clip[~given]).tolist() == [0.5]
    with pytest.raises(InvalidInputError, match="one frame for each of 2 keyframes"):
        placed_keyframes(pictures, [0], 17)


@pytest.mark.parametrize("at", [(0,), (0, 80), (0, 40, 80), (8, 16, 24), (3,), (80,)])
def test_latents_know_given_frames_as_anisora_counts_them(at: tuple[int, ...]) -> None:
    """As in AniSora's own code: the first frame four times, then every further one once."""
    known = np.zeros(81)
    known[list(at)] = 1
    expected = np.concatenate([[known[0]] * 4, known[1:]]).reshape(21, 4)
    np.testing.assert_array_equal(known_latents(at, 81), expected)
    assert known_latents(at, 81).sum() == len(at) + 3 * (0 in at)
