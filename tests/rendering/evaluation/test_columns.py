"""Columns that need no weights, on clips whose values are known."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.evaluation.columns import COLUMNS, ClipOfPicture, Missing, clip_values, method_values
from physanimator.rendering.metrics import measure_clip
from physanimator.rendering.sketch import extract_sketch

HEIGHT, WIDTH, FRAMES, RATE, STEP = 96, 160, 6, 12.0, 3

Picture = NDArray[np.uint8]


def texture(height: int, width: int, seed: int) -> Picture:
    coarse = np.random.default_rng(seed).random((height // 4, width // 4, 3), dtype=np.float32)
    return (255 * np.clip(cv2.resize(coarse, (width, height), interpolation=cv2.INTER_CUBIC), 0, 1)).astype(np.uint8)


BACKGROUND, SPRITE = texture(HEIGHT, WIDTH, 1), texture(40, 40, 2)


def frame(t: int, *, step: int = STEP) -> Picture:
    """A square that has gone to the right by so many pixels a frame."""
    drawn = BACKGROUND.copy()
    drawn[30:70, 20 + step * t : 60 + step * t] = SPRITE
    return drawn


def motion() -> Motion:
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[30:70, 20:60] = True
    body = Body(mesh_from_mask(mask, spacing=6))
    return Motion((body,), body.mesh.vertices + np.arange(FRAMES)[:, None, None] * np.array([STEP, 0.0]), RATE)


def clip(frames: list[Picture], **known: Any) -> ClipOfPicture:
    return ClipOfPicture(frames, RATE, frame(0), **known)


def following() -> list[Picture]:
    return [frame(t) for t in range(FRAMES)]


def value(key: str, of: ClipOfPicture) -> float | None:
    found = clip_values(of)[key]
    assert not isinstance(found, Missing)
    return found


def test_a_clip_that_stands_still_has_no_error_and_no_motion() -> None:
    found = clip_values(clip([frame(0)] * FRAMES, moving=np.zeros((HEIGHT, WIDTH), bool), loops=True))
    for key in ("flow_warp_error", "static_drift", "dynamic_degree", "loop_residual"):
        assert found[key] == 0


def test_what_a_clip_does_not_allow_is_none() -> None:
    found = clip_values(clip(following()))
    for key in ("simulated_flow_error", "static_drift", "sketch_adherence", "hole_ratio", "loop_residual"):
        assert found[key] is None
    assert found["flow_warp_error"] is not None


def test_a_shifted_copy_drifts_by_its_difference() -> None:
    shifted = np.roll(frame(0), 5, axis=1)
    difference = np.abs(shifted.astype(float) - frame(0)).mean() / 255
    still = np.zeros((HEIGHT, WIDTH), bool)
    assert value("static_drift", clip([shifted] * 3, moving=still)) == pytest.approx(difference, rel=1e-5)


def test_outlines_beside_a_moving_part_do_not_drift() -> None:
    moving = np.zeros((HEIGHT, WIDTH), bool)
    moving[30:70, 20:60] = True
    changed = frame(0)
    changed[28:72, 18:62] = 0
    assert value("static_drift", clip([changed], moving=moving)) == 0
    changed[0, 0] ^= 255
    drift = value("static_drift", clip([changed], moving=moving))
    assert drift is not None
    assert drift > 0


def test_a_picture_that_slides_moves_by_its_speed_and_has_no_flow_warp_error() -> None:
    wide = texture(HEIGHT, WIDTH + 40, 3)
    sliding = clip([wide[:, STEP * t : STEP * t + WIDTH] for t in range(FRAMES)])
    assert value("dynamic_degree", sliding) == pytest.approx(STEP * RATE, rel=0.1)
    error = value("flow_warp_error", sliding)
    assert error is not None
    assert error < 0.01


def test_the_same_motion_at_twice_the_rate_is_as_fast() -> None:
    wide = texture(HEIGHT, WIDTH + 40, 3)
    often = [wide[:, 2 * t : 2 * t + WIDTH] for t in range(FRAMES)]
    seldom = ClipOfPicture(often[::2], RATE / 2, frame(0))
    assert value("dynamic_degree", clip(often)) == pytest.approx(value("dynamic_degree", seldom), rel=0.05)


def test_flicker_is_the_flow_warp_error() -> None:
    flat = [np.full((HEIGHT, WIDTH, 3), 100 + 20 * (t % 2), np.uint8) for t in range(FRAMES)]
    assert value("flow_warp_error", clip(flat)) == pytest.approx(20 / 255, rel=1e-4)


def test_what_is_hidden_in_the_next_frame_is_no_error() -> None:
    """A square of one colour goes over a sloping background, which it covers and uncovers."""
    slope = np.repeat(np.linspace(0, 120, WIDTH, dtype=np.uint8)[None, :, None], HEIGHT, axis=0)
    frames = [np.repeat(slope, 3, axis=2) for _ in range(3)]
    for t, each in enumerate(frames):
        each[30:70, 20 + 12 * t : 60 + 12 * t] = texture(40, 40, 2) // 4 + 190
    hidden = 2 * 12 * 40 / (HEIGHT * WIDTH) * 150 / 255
    error = value("flow_warp_error", clip(frames))
    assert error is not None
    assert error < hidden / 4


def test_clips_that_follow_a_simulation_are_measured_as_measure_does() -> None:
    frames = following()
    sketches = [extract_sketch(each) for each in frames]
    found = clip_values(clip(frames, motion=motion(), sketches=sketches))
    known = measure_clip(frames, motion(), drawing=frame(0), sketches=sketches)
    assert found["simulated_flow_error"] == pytest.approx(known.flow_warp_error, abs=1e-9)
    assert found["static_drift"] == known.static_drift == 0
    assert found["sketch_adherence"] == known.sketch_adherence == 0
    assert found["hole_ratio"] == pytest.approx(known.hole_ratio)
    assert found["dynamic_degree"] == pytest.approx(known.dynamic_degree * RATE)


def test_frames_that_do_not_follow_the_simulation_have_its_error() -> None:
    still, sprite = value("simulated_flow_error", clip([frame(0)] * 2, motion=motion())), SPRITE.astype(float)
    away = np.abs(sprite[2:-2, 2 : -2 - STEP] - sprite[2:-2, 2 + STEP : -2]).mean() / 255
    assert still == pytest.approx(away, rel=0.15)


def test_a_shorter_clip_is_compared_with_the_begin_of_the_motion() -> None:
    short = clip_values(clip(following()[:3], motion=motion()))
    assert short["simulated_flow_error"] == pytest.approx(0, abs=1e-5)
    assert short["hole_ratio"] == pytest.approx((0 + 3 + 6) / 3 * 40 / (HEIGHT * WIDTH), rel=0.05)
    with pytest.raises(InvalidInputError, match=r"motion must be of at least the clip's 7 frames\. Got: 6 frames"):
        clip([frame(0)] * 7, motion=motion())


def test_a_loop_of_even_steps_has_no_residual_and_a_jump_has_its_height() -> None:
    wheel = [np.roll(texture(HEIGHT, 36, 4), 6 * t, axis=1) for t in range(6)]
    round_and_round = ClipOfPicture(wheel, RATE, wheel[0], loops=True)
    assert value("loop_residual", round_and_round) == pytest.approx(0, abs=0.002)
    ramp = [np.full((HEIGHT, WIDTH, 3), 10 * t, np.uint8) for t in range(6)]
    assert value("loop_residual", clip(ramp, loops=True)) == pytest.approx((50 - 10) / 255)


def test_frames_of_another_size_are_measured_in_the_pictures_pixels() -> None:
    wide = texture(HEIGHT, WIDTH + 40, 3)
    sliding = [wide[:, STEP * t : STEP * t + WIDTH] for t in range(FRAMES)]
    halved = [cv2.resize(each, (WIDTH // 2, HEIGHT // 2), interpolation=cv2.INTER_AREA) for each in sliding]
    assert value("dynamic_degree", clip(halved)) == pytest.approx(STEP * RATE, rel=0.25)


class Decoded:
    """Frames that are made anew in each pass, and counted."""

    def __init__(self) -> None:
        self.passes = 0

    def __len__(self) -> int:
        return FRAMES

    def __iter__(self) -> Iterator[Picture]:
        self.passes += 1
        return (frame(t) for t in range(FRAMES))


def test_frames_are_read_once_with_progress_that_may_stop() -> None:
    frames, seen = Decoded(), []
    clip_values(ClipOfPicture(frames, RATE, frame(0)), progress=lambda done, total: seen.append((done, total)))
    assert frames.passes == 1
    assert seen == [(done, FRAMES) for done in range(1, FRAMES + 1)]

    def stop(done: int, total: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        clip_values(ClipOfPicture(frames, RATE, frame(0)), progress=stop)


def test_frames_that_end_early_are_said() -> None:
    class Short(Decoded):
        def __len__(self) -> int:
            return FRAMES + 1

    with pytest.raises(InvalidInputError, match=r"frames must be the 7 that they say\. Got: 6"):
        clip_values(ClipOfPicture(Short(), RATE, frame(0)))


def test_columns_can_be_chosen() -> None:
    chosen = [column for column in COLUMNS if column.key in ("static_drift", "fid")]
    assert list(clip_values(clip(following()), chosen)) == ["static_drift"]
    one_of_two = [column for column in COLUMNS if column.key == "dynamic_degree"]
    assert list(clip_values(clip(following()), one_of_two)) == ["dynamic_degree"]


def test_every_key_is_told_once_for_a_clip_or_for_a_method() -> None:
    keys = [column.key for column in COLUMNS]
    assert len(set(keys)) == len(keys)
    clips = [clip(following())]
    assert [*clip_values(clips[0]), *method_values(clips)] == [
        column.key for kind in ("clip", "method") for column in COLUMNS if column.of == kind
    ]


@pytest.mark.parametrize(
    ("known", "sentence"),
    [
        ({"moving": np.zeros((3, 3), bool)}, r"moving must be of the picture's shape \(96, 160\). Got: shape \(3, 3\)"),
        ({"rate": 0.0}, "rate must be above 0 frames a second. Got: 0.0"),
        ({"frames": []}, "frames must be at least 1. Got: 0"),
        ({"picture": np.zeros((4, 4), np.uint8)}, "picture must be an RGB picture"),
    ],
)
def test_what_does_not_fit_is_one_sentence(known: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InvalidInputError, match=sentence):
        ClipOfPicture(**{"frames": following(), "rate": RATE, "picture": frame(0), **known})


def test_lines_beside_the_sketch_are_as_far_from_it_as_they_are() -> None:
    drawn = np.full((HEIGHT, WIDTH, 3), 255, np.uint8)
    drawn[:, 80:82] = 0
    sketch = np.roll(extract_sketch(drawn), 4, axis=1)
    found = clip_values(ClipOfPicture([drawn], RATE, drawn, sketches=[sketch]))["sketch_adherence"]
    assert found == pytest.approx(4, abs=0.5)


def test_too_few_sketches_are_said() -> None:
    with pytest.raises(InvalidInputError, match=r"sketches must be one for each frame\. Got: 1"):
        clip_values(clip(following(), sketches=[np.ones((HEIGHT, WIDTH), np.float32)]))
