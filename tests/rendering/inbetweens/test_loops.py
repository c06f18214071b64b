"""In-betweens around the place where a loop begins again."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.inbetweens import Clip, interpolate, keyframe_indices

Image = NDArray[Any]


def grey(level: float) -> Image:
    return np.full((8, 8, 3), level, np.uint8)


def levels(frames: Iterator[Image]) -> list[int]:
    return [int(frame[0, 0, 0]) for frame in frames]


def test_in_betweens_lead_back_to_the_first_keyframe() -> None:
    frames = levels(interpolate([grey(0), grey(100)], [0, 4], backend="blend", loop=9))
    assert frames == [0, 25, 50, 75, 100, 80, 60, 40, 20], "nine frames, of which none comes twice at the wrap"


@pytest.mark.parametrize(("indices", "loop"), [([2, 5], 8), ([1, 7], 8), ([0, 7], 8), ([3, 4, 7], 9), ([1, 2], 3)])
def test_frames_before_the_first_keyframe_are_those_after_the_last(indices: list[int], loop: int) -> None:
    keyframes = [grey(40 * (number + 1)) for number in range(len(indices))]
    frames = levels(interpolate(keyframes, indices, backend="blend", loop=loop))
    known = {t: 40 * (number + 1) for number, t in enumerate(indices)}
    expected = np.interp(range(loop), [indices[-1] - loop, *known, indices[0] + loop], [
        known[indices[-1]], *known.values(), known[indices[0]]
    ])  # fmt: skip
    np.testing.assert_allclose(frames, expected, atol=1)


class Noting:
    """A backend that knows what it was asked for."""

    name, description, requires = "noting", "", ()

    def __init__(self) -> None:
        self.asked: list[tuple[int, int, int, int, list[float]]] = []

    def in_betweens(self, clip: Clip, number: int) -> Iterator[Image]:
        ends = [int(clip.keyframes[number + k][0, 0, 0]) for k in (0, 1)]
        led = [float(np.mean(sketch)) for sketch in clip.sketches[clip.indices[number] : clip.indices[number + 1] + 1]]
        self.asked.append((clip.indices[number], clip.indices[number + 1], *ends, led))
        return (clip.keyframes[number] for _ in clip.times(number))


@pytest.mark.parametrize("start", [0, 2])
def test_the_last_pair_is_last_first_with_the_sketches_between(start: int) -> None:
    backend, drawn = Noting(), [np.full((8, 8), t, np.uint8) for t in range(10)]
    frames = list(interpolate([grey(5), grey(9)], [start, start + 4], backend=backend, sketches=drawn, loop=10))
    assert len(frames) == 10
    closing = next(each for each in backend.asked if each[0] == start + 4)
    assert closing[:4] == (start + 4, 10 + start, 9, 5)
    assert closing[4] == [t % 10 for t in range(start + 4, 10 + start + 1)]
    assert len(backend.asked) == 2


def moving(count: int) -> tuple[Motion, list[Image]]:
    """A square that goes around on a circle."""
    mask = np.pad(np.ones((20, 20)), 30)
    mesh = mesh_from_mask(mask, spacing=8)
    angles = 2 * np.pi * np.arange(count) / count
    offsets = np.round(12 * np.stack([np.cos(angles), np.sin(angles)], axis=1))
    positions = (mesh.vertices + offsets[:, None]).astype(np.float32)
    pictures = []
    for x, y in offsets.astype(int):
        picture = np.full((80, 80, 3), 220, np.uint8)
        picture[30 + y : 50 + y, 30 + x : 50 + x] = (200, 60, 40)
        pictures.append(picture)
    return Motion((Body(mesh),), positions, 24.0), pictures


@pytest.mark.parametrize("at", [[0, 4, 8], [2, 7]])
def test_known_motion_is_followed_across_the_wrap(at: list[int]) -> None:
    motion, truth = moving(12)
    frames = list(interpolate([truth[t] for t in at], at, motion=motion, loop=12))
    faded = list(interpolate([truth[t] for t in at], at, backend="blend", loop=12))
    assert len(frames) == 12
    for number in {0, 1, 9, 10, 11} - {*at}:
        errors = [np.abs(each[number].astype(float) - truth[number]).mean() for each in (frames, faded)]
        assert errors[0] < errors[1] / 3, number


def test_transparent_keyframes_stay_so() -> None:
    clear = np.zeros((8, 8, 4), np.uint8)
    full = np.full((8, 8, 4), 255, np.uint8)
    frames = list(interpolate([clear, full], [0, 2], backend="blend", loop=4))
    assert [int(frame[0, 0, 3]) for frame in frames] == [0, 128, 255, 128]


def test_progress_counts_the_frames_of_the_loop() -> None:
    seen: list[tuple[int, int]] = []
    list(interpolate([grey(0), grey(9)], [1, 3], backend="blend", loop=6, progress=lambda *now: seen.append(now)))
    assert seen == [(number, 6) for number in range(1, 7)]


@pytest.mark.parametrize(
    ("count", "every", "at"),
    [
        (48, 16, [0, 16, 32]),
        (48, 15, [0, 15, 30, 45]),
        (17, 16, [0, 16]),
        (16, 16, [0, 8]),
        (3, 15, [0, 1]),
        (1, 4, [0]),
    ],
)
def test_keyframes_of_a_loop(count: int, every: int, at: list[int]) -> None:
    assert keyframe_indices(count, every, loops=True) == at
    assert keyframe_indices(count, at=[0, 0], loops=True) == [0]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"loop": 4}, "loop must be a number of frames above the last keyframe's 4. Got: 4"),
        ({"loop": 7.5}, "loop must be a number of frames"),
        ({"loop": True}, "loop must be a number of frames"),
        ({"keyframes": [grey(0)], "indices": [0]}, "keyframes must be 2 or more in a loop. Got: 1"),
        ({"after": [grey(0)]}, "before and after must be left out in a loop"),
        ({"sketches": [np.ones((8, 8))] * 5}, "sketches must be one for each of the 9 frames. Got: 5"),
    ],
)
def test_what_no_loop_can_be_is_refused(change: dict[str, Any], sentence: str) -> None:
    given: dict[str, Any] = {"keyframes": [grey(0), grey(9)], "indices": [0, 4], "backend": "blend", "loop": 9}
    given |= change
    with pytest.raises(InvalidInputError) as refused:
        interpolate(given.pop("keyframes"), given.pop("indices"), **given)
    assert str(refused.value).startswith(sentence)
