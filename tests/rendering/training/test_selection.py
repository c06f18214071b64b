"""What is measured of clips, and which are kept."""

from __future__ import annotations

import math
from pathlib import Path

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.training.black_bars import picture_box
from physanimator.rendering.training.dynamics import dynamics_score
from physanimator.rendering.training.exposures import exposed_frames, thinned
from physanimator.rendering.training.framing import framed, size_of, window_of
from physanimator.rendering.training.score_column import read_scores, score_between
from physanimator.rendering.training.selection import Bounds
from small_videos import panned


@pytest.mark.parametrize(
    ("frames", "score", "kept"),
    [
        (23, 0.3, False),
        (24, 0.3, True),
        (24, 0.049, False),
        (24, 0.05, True),
        (24, 0.7, True),
        (24, 0.701, False),
        (24, math.nan, False),
    ],
)
def test_each_bound_is_inside(frames: int, score: float, kept: bool) -> None:
    assert (Bounds().why_not(frames, score) == "") is kept


@pytest.mark.parametrize("step", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("size", [(256, 160), (512, 320)])
def test_the_score_is_that_of_the_known_speed_at_any_size(step: float, size: tuple[int, int]) -> None:
    scale = size[0] / 256
    frames = panned(1, 8, step * scale, size=size)
    known = 1 - math.exp(-100 * step * scale / math.hypot(*size))
    assert dynamics_score(frames) == pytest.approx(known, rel=0.15)


def test_a_picture_that_crosses_its_diagonal_in_three_and_a_half_seconds_scores_the_upper_bound() -> None:
    step = math.hypot(256, 160) / (3.5 * 24)
    assert dynamics_score(panned(2, 8, step, size=(256, 160))) == pytest.approx(0.7, abs=0.06)


def test_a_moving_mouth_scores_near_the_lower_bound_and_a_still_picture_nothing() -> None:
    """A fortieth of the picture moves by 2 % of the diagonal a frame."""
    still = panned(3, 1, 0, size=(256, 160))[0]
    mouth = panned(4, 8, 6, size=(36, 28))
    frames = []
    for each in mouth:
        frame = still.copy()
        frame[100:128, 100:136] = each
        frames.append(frame)
    assert 0.02 < dynamics_score(frames) < 0.12
    assert dynamics_score([still] * 8) == 0


@pytest.mark.parametrize("hold", [1, 2, 3])
def test_repeated_drawings_are_taken_out_in_spite_of_noise(hold: int) -> None:
    chance = np.random.default_rng(0)
    frames = [
        np.clip(each + chance.normal(0, 1.0, each.shape), 0, 255).astype(np.uint8)
        for each in panned(5, 12 * hold, 2, hold=hold)
    ]
    assert exposed_frames(frames) == list(range(0, 12 * hold, hold))


def test_strong_compression_does_not_make_twos_ones_nor_a_slow_pan_twos() -> None:
    chance = np.random.default_rng(0)

    def worn(frames: list[np.ndarray]) -> list[np.ndarray]:
        noise = [cv2.GaussianBlur(chance.normal(0, 1, each.shape), (0, 0), 4) for each in frames]
        return [
            np.clip(each + 0.9 * one / one.std(), 0, 255).astype(np.uint8)
            for each, one in zip(frames, noise, strict=True)
        ]

    assert exposed_frames(worn(panned(5, 24, 3, hold=2))) == list(range(0, 24, 2))
    assert len(exposed_frames(panned(5, 24, 0.5))) == 24


def test_a_small_mouth_is_another_drawing() -> None:
    still = panned(6, 1, 0)[0]
    spoken = still.copy()
    cv2.ellipse(spoken, (60, 30), (4, 2), 0, 0, 360, (0, 0, 0), -1)
    assert exposed_frames([still, spoken, still]) == [0, 1, 2]


def test_a_pause_stays_a_pause() -> None:
    on_twos = panned(7, 24, 2, hold=2)
    frames = [*on_twos, *[on_twos[-1]] * 10]
    assert exposed_frames(frames) == [*range(0, 22, 2), 22, 24, 26, 28, 30, 32]


def test_thinning_spreads_frames_evenly() -> None:
    assert thinned(list(range(24)), 24, 12) == list(range(0, 24, 2))
    assert thinned([0, 2, 4], 12, 24) == [0, 2, 4]


def test_bars_must_be_alike_and_black_in_every_frame() -> None:
    frame = np.full((90, 160, 3), 200, np.uint8)
    barred = frame.copy()
    barred[:10] = barred[80:] = 17
    assert picture_box([barred]) == (0, pytest.approx(11 / 90), 1, pytest.approx(79 / 90))
    assert picture_box([barred, frame]) == (0, 0, 1, 1)
    night = frame.copy()
    night[:30] = night[87:] = 10
    assert picture_box([night]) == (0, 0, 1, 1)
    assert picture_box([np.zeros((90, 160, 3), np.uint8)]) == (0, 0, 1, 1)


def test_frames_are_cut_not_stretched() -> None:
    circle = np.zeros((300, 800, 3), np.uint8)
    cv2.circle(circle, (400, 150), 100, (255, 255, 255), -1)
    window = window_of(800, 300, (0, 0, 1, 1), (256, 192))
    assert window is not None
    found = framed(circle, window, (256, 192))[..., 0] > 127
    assert found.any(axis=0).sum() == pytest.approx(found.any(axis=1).sum(), abs=1)
    assert found.any(axis=0).sum() == pytest.approx(128, abs=2)
    assert window_of(100, 100, (0, 0, 1, 1), (256, 192)) is None


def test_pixels_that_are_not_square_are_told_from_square_ones() -> None:
    window = window_of(720, 480, (0, 0, 1, 1), (512, 384), pixel_aspect=8 / 9)
    assert window == (0, 0, 720, 480)


@pytest.mark.parametrize("text", ["512", "500x320", "0x64", "4096x64", "64x64x64", "64 64"])
def test_sizes_that_no_model_takes_are_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="multiples of 64"):
        size_of(text)


def test_scores_of_an_index_belong_to_their_video_and_time(tmp_path: Path) -> None:
    videos = [tmp_path / "a" / "one.mp4", tmp_path / "b" / "one.mp4", tmp_path / "two.mkv"]
    index = tmp_path / "index.csv"
    index.write_text(
        "identifier,start,end,Dynamic Score\na/one.mp4,0,2,0.2\na/one.mp4,2,4,0.6\ntwo,0,9,0.4\nthree,0,9,1\ntwo,0,9,\n"
    )
    found = read_scores(index, "Dynamic Score", videos)
    assert set(found) == {videos[0], videos[2]}
    assert score_between(found[videos[0]], 1.5, 3.5) == 0.6
    assert score_between(found[videos[0]], 5, 6) is None
    with pytest.raises(InvalidInputError, match="score_column must be a column"):
        read_scores(index, "score", videos)
    index.write_text("a" * (2 << 20))
    with pytest.raises(InvalidInputError, match="lines up to"):
        read_scores(index, "score", videos)
