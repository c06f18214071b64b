"""Measures of clips, on clips whose faults are known."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.metrics import chamfer_distance, measure_clip
from physanimator.rendering.metrics.dynamic_degree import DynamicDegree
from physanimator.rendering.metrics.metrics import ClipMetrics
from physanimator.rendering.sketch import extract_sketch

HEIGHT, WIDTH, FRAMES = 96, 160, 5
STEP = 6


def texture(height: int, width: int, seed: int) -> NDArray[np.float32]:
    coarse = np.random.default_rng(seed).random((height // 4, width // 4, 3), dtype=np.float32)
    return np.clip(cv2.resize(coarse, (width, height), interpolation=cv2.INTER_CUBIC), 0, 1)


BACKGROUND, SPRITE = texture(HEIGHT, WIDTH, 1), texture(40, 40, 2)


def motion_of(step: float = STEP, *, hidden: bool = False) -> Motion:
    """A square that goes to the right by so many pixels a frame, behind a still one if it is to be hidden."""
    masks = [np.zeros((HEIGHT, WIDTH), bool) for _ in range(1 + hidden)]
    masks[0][30:70, 20:60] = True
    if hidden:
        masks[1][20:80, 70:110] = True
    bodies = tuple(Body(mesh_from_mask(mask, spacing=6), preset("hair"), k) for k, mask in enumerate(masks))
    moved = [np.arange(FRAMES)[:, None, None] * np.array([step * (k == 0), 0.0]) for k in range(len(bodies))]
    rest = [body.mesh.vertices + shift for body, shift in zip(bodies, moved, strict=True)]
    return Motion(bodies, np.concatenate(rest, axis=1), 24)


def clip(step: int = STEP, change: Callable[[NDArray[np.float32], int], None] | None = None) -> Iterator[np.ndarray]:
    for t in range(FRAMES):
        frame = BACKGROUND.copy()
        frame[30:70, 20 + step * t : 60 + step * t] = SPRITE
        if change:
            change(frame, t)
        yield frame


def measured(change: Callable[[NDArray[np.float32], int], None] | None = None, **options: object) -> ClipMetrics:
    return measure_clip(clip(change=change), motion_of(), **options)


def test_a_perfect_clip_has_no_error() -> None:
    found = measured()
    assert found.flow_warp_error == pytest.approx(0, abs=1e-5)
    assert found.flow_warp_error_to_first == pytest.approx(0, abs=1e-5)
    assert found.static_drift == 0
    assert found.worst_static_drift == 0
    assert found.sketch_adherence is None


def test_flicker_of_a_known_height_is_the_flow_warp_error() -> None:
    def flicker(frame: NDArray[np.float32], t: int) -> None:
        frame[30:70, 20 + STEP * t : 60 + STEP * t] = 0.5 + 0.1 * (t % 2)

    found = measured(flicker)
    assert found.flow_warp_error == pytest.approx(0.1, abs=1e-4)
    assert found.flow_warp_error_to_first == pytest.approx(0.05, abs=1e-4)


def test_a_slow_change_is_small_from_frame_to_frame_and_large_against_the_first() -> None:
    def fade(frame: NDArray[np.float32], t: int) -> None:
        frame[30:70, 20 + STEP * t : 60 + STEP * t] = 0.2 + 0.05 * t

    found = measured(fade)
    assert found.flow_warp_error == pytest.approx(0.05, abs=1e-4)
    assert found.flow_warp_error_to_first == pytest.approx(0.125, abs=1e-4)


def test_a_clip_that_does_not_follow_the_motion_has_a_large_flow_warp_error() -> None:
    still, following = measure_clip(clip(step=0), motion_of()), measured()
    assert still.flow_warp_error is not None
    assert still.flow_warp_error > 0.1
    assert following.flow_warp_error < 1e-4


def test_half_a_pixel_is_followed_too() -> None:
    def half(frame: NDArray[np.float32], t: int) -> None:
        shift = np.float32([[1, 0, -STEP * t / 2], [0, 1, 0]])
        moved = cv2.warpAffine(frame, shift, (WIDTH, HEIGHT), flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
        frame[:] = moved

    found = measure_clip(clip(change=half), motion_of(STEP / 2))
    assert found.flow_warp_error < 0.01


def test_what_is_hidden_is_left_out() -> None:
    def covered(frame: NDArray[np.float32], t: int) -> None:
        frame[20:80, 70:110] = 0.5

    found = measure_clip(clip(change=covered), motion_of(hidden=True))
    assert found.flow_warp_error == pytest.approx(0, abs=1e-4)


def test_what_leaves_the_picture_is_left_out() -> None:
    frames = [BACKGROUND.copy() for _ in range(FRAMES)]
    frames[0][30:70, 20:60] = SPRITE
    found = measure_clip(frames, motion_of(200))
    assert found.flow_warp_error is None
    assert found.hole_ratio == pytest.approx(0.8 * 1600 / (HEIGHT * WIDTH), rel=0.05)


def test_drift_of_a_known_height() -> None:
    def drift(frame: NDArray[np.float32], t: int) -> None:
        frame[:20] = np.clip(BACKGROUND[:20], 0.1, 0.9) + 0.02 * t

    def limited(frame: NDArray[np.float32], t: int) -> None:
        frame[:20] = np.clip(BACKGROUND[:20], 0.1, 0.9)

    reference = next(clip(change=limited))
    found = measured(drift, drawing=reference)
    changed = np.zeros((HEIGHT, WIDTH), bool)
    changed[:20] = True
    moving = np.zeros((HEIGHT, WIDTH), bool)
    moving[26:74, 16 : 64 + STEP * (FRAMES - 1)] = True
    share = changed.sum() / (~moving).sum()
    assert found.worst_static_drift == pytest.approx(0.08 * share, rel=0.02)
    assert found.static_drift == pytest.approx(0.04 * share, rel=0.02)
    assert found.flow_warp_error == pytest.approx(0, abs=1e-4)


def test_a_change_of_the_bodies_is_no_drift() -> None:
    def dark(frame: NDArray[np.float32], t: int) -> None:
        frame[30:70, 20 + STEP * t : 60 + STEP * t] = 0

    assert measured(dark, drawing=next(clip())).static_drift == 0


def test_holes_are_what_the_body_leaves() -> None:
    steps = np.arange(FRAMES) * STEP * 40
    assert measured().hole_ratio == pytest.approx(steps.mean() / (HEIGHT * WIDTH), rel=0.05)


def sketch(column: int) -> NDArray[np.float32]:
    page = np.ones((50, 80), np.float32)
    page[:, column] = 0
    return page


@pytest.mark.parametrize("shift", [0, 1, 7])
def test_chamfer_distance_of_a_shifted_line_is_its_shift(shift: int) -> None:
    assert chamfer_distance(sketch(30), sketch(30 + shift)) == pytest.approx(shift)


def test_chamfer_distance_counts_what_is_missing_and_what_is_too_many() -> None:
    both = np.minimum(sketch(30), sketch(40))
    assert chamfer_distance(both, sketch(30)) == chamfer_distance(sketch(30), both) == pytest.approx(10 / 4)
    assert chamfer_distance(sketch(0), sketch(79)) == 20
    assert chamfer_distance(np.ones((50, 80)), sketch(3), limit=9) == 9
    assert chamfer_distance(np.ones((50, 80)), np.ones((50, 80))) == 0


def test_sketch_adherence_is_the_distance_of_the_frames_lines() -> None:
    def outlined(frame: NDArray[np.float32], t: int) -> None:
        frame[:] = 1
        cv2.rectangle(frame, (20 + STEP * t, 30), (60 + STEP * t, 70), (0, 0, 0), 2)

    own = [extract_sketch(frame) for frame in clip(change=outlined)]
    beside = [np.roll(each, 8, axis=1) for each in own]
    assert measured(outlined, sketches=own).sketch_adherence == 0
    assert 2 < measured(outlined, sketches=beside).sketch_adherence < 8


def test_dynamic_degree_is_the_motion_that_is_seen() -> None:
    wide, moving, still = texture(96, 240, 3), DynamicDegree(), DynamicDegree()
    for t in range(4):
        moving.add(wide[:, 3 * t : 3 * t + WIDTH])
        still.add(wide[:, :WIDTH])
    assert moving.value == pytest.approx(3, abs=0.5)
    assert still.value == pytest.approx(0, abs=0.01)


def test_the_least_pictures_and_clips_are_measured() -> None:
    first = motion_of()[:1]
    found = measure_clip([next(clip())], first)
    assert found.flow_warp_error is None
    assert found.dynamic_degree is None
    assert found.static_drift == 0
    assert found.hole_ratio == 0


def test_uint8_frames_and_progress() -> None:
    steps: list[tuple[int, int]] = []
    frames = [np.rint(frame * 255).astype(np.uint8) for frame in clip()]
    found = measure_clip(frames, motion_of(), progress=lambda done, total: steps.append((done, total)))
    assert found.flow_warp_error < 0.005
    assert steps == [(t, FRAMES) for t in range(1, FRAMES + 1)]
    assert set(found.as_dict()) >= {"flow_warp_error", "static_drift", "sketch_adherence", "hole_ratio"}


@pytest.mark.parametrize(
    ("frames", "options", "message"),
    [
        (list(clip())[:3], {}, "frames must be one for each of the motion's 5 frames. Got: 3"),
        ([*clip(), BACKGROUND], {}, "frames must be one for each of the motion's 5 frames. Got: at least 6"),
        ([np.zeros((9, 9, 3), np.float32)], {}, "frames must have the motion's size, 160 x 96 px"),
        ([np.zeros((9, 9), np.float32)], {}, "frames must be an RGB picture"),
        (list(clip()), {"sketches": [np.ones((HEIGHT, WIDTH))]}, "sketches must be one for each of 5 frames"),
        (list(clip()), {"sketches": [sketch(3)] * 5}, "sketches must be of one shape"),
    ],
)
def test_bad_input(frames: list[np.ndarray], options: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        measure_clip(frames, motion_of(), **options)
