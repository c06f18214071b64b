"""Shots of a video: what lies between two cuts, with its bars, its repeated drawings and its dynamics score."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...physics.errors import InvalidInputError
from .black_bars import Box, picture_box
from .dynamics import SCORED_WIDTH, dynamics_score
from .exposures import exposed_frames, thinned
from .source_videos import TimedFrame, VideoFacts, decoded

__all__ = ["Shot", "check_cuts_are_found", "shots_of"]

Tick = Callable[[], None]

_CUT = 27.0  # PySceneDetect's own threshold, for pictures of about the width that it is asked at here
_LEAST_SIDE = 16


@dataclass(frozen=True)
class Shot:
    """What lies between two cuts, or a part of it where that is too long.

    Attributes:
        start, end: time since the video's first frame [s].
        frames: numbers of the video's frames that remain when repeated drawings are taken out.
        fps: frames a second of what remains.
        box: where the picture is between its bars.
        score: see :func:`~physanimator.rendering.training.dynamics.dynamics_score`.
    """

    start: float
    end: float
    frames: tuple[int, ...]
    fps: float
    box: Box
    score: float


def check_cuts_are_found() -> None:
    """Refuse to begin where PySceneDetect is missing.

    Raises:
        InvalidInputError: it is.
    """
    try:
        import scenedetect  # noqa: F401
    except ImportError:
        raise InvalidInputError(
            'videos are cut by PySceneDetect: pip install "physanimator[train]". Got: no module scenedetect'
        ) from None


def shots_of(
    path: Path, facts: VideoFacts, *, longest: int = 240, fps: float = 0.0, tick: Tick | None = None
) -> Iterator[Shot]:
    """The shots of a video, in turn.

    Cuts are those that PySceneDetect's ContentDetector finds in small copies of the frames.

    Args:
        path: the video.
        facts: what its header says.
        longest: frames of the video in a shot; of a longer one several are made.
        fps: highest rate of what remains [frames/s]; 0: any.
        tick: called with each frame; may raise to stop.

    Raises:
        InvalidInputError: the video cannot be read; on the way, where it is damaged there.
    """
    waiting: list[TimedFrame] = []
    try:
        for frame in decoded(path, _small_size(facts)):
            if tick is not None:
                tick()
            if waiting and _is_cut(waiting[-1], frame):
                yield from _parts(waiting, frame.time, longest, fps)
                waiting = []
            if len(waiting) >= 2 * longest:
                yield _shot(waiting[:longest], waiting[longest].time, fps)
                del waiting[:longest]
            waiting.append(frame)
    except InvalidInputError:  # what was read before the damage is whole; who asked hears of the rest by the error
        if waiting:
            yield from _parts(waiting, _end_of(waiting, facts.fps), longest, fps)
        raise
    if waiting:
        yield from _parts(waiting, _end_of(waiting, facts.fps), longest, fps)


def _is_cut(first: TimedFrame, second: TimedFrame) -> bool:
    """Whether PySceneDetect sees a cut between two frames, looked at within their bars, which would weaken it."""
    from scenedetect import ContentDetector, FrameTimecode

    rows, columns = _inside(picture_box([first.pixels, second.pixels]), first.pixels.shape)
    detector: Any = ContentDetector(threshold=_CUT, min_scene_len=0)
    found: Any = []
    for number, frame in enumerate((first, second)):
        blue_first = np.ascontiguousarray(frame.pixels[rows, columns, ::-1])
        found = detector.process_frame(FrameTimecode(number, 24.0), blue_first)
    return bool(found)


def _inside(box: Box, shape: Sequence[int]) -> tuple[slice, slice]:
    height, width = shape[:2]
    rows = slice(math.ceil(box[1] * height - 1e-6), math.floor(box[3] * height + 1e-6))
    return rows, slice(math.ceil(box[0] * width - 1e-6), math.floor(box[2] * width + 1e-6))


def _small_size(facts: VideoFacts) -> tuple[int, int]:
    width = min(SCORED_WIDTH, facts.width)
    return max(width, _LEAST_SIDE), max(_LEAST_SIDE, round(facts.height * width / facts.width))


def _end_of(frames: Sequence[TimedFrame], fps: float) -> float:
    between = (frames[-1].time - frames[0].time) / (len(frames) - 1) if len(frames) > 1 else 1 / fps
    return frames[-1].time + between


def _parts(frames: list[TimedFrame], end: float, longest: int, fps: float) -> Iterator[Shot]:
    """One shot, or two of about equal length where it is too long."""
    half = len(frames) if len(frames) <= longest else math.ceil(len(frames) / 2)
    for part, ends in ((frames[:half], frames[half].time if half < len(frames) else end), (frames[half:], end)):
        if part:
            yield _shot(part, ends, fps)


def _shot(frames: Sequence[TimedFrame], end: float, fps: float) -> Shot:
    box = picture_box([frame.pixels for frame in frames])
    rows, columns = _inside(box, frames[0].pixels.shape)
    pictures = [frame.pixels[rows, columns] for frame in frames]
    lasts = max(end - frames[0].time, 1e-3)
    distinct = exposed_frames(pictures)
    kept = thinned(distinct, len(distinct) / lasts, fps)
    score = dynamics_score([pictures[number] for number in kept])
    rate = min(max(len(kept) / lasts, 0.1), 120.0)
    return Shot(frames[0].time, end, tuple(frames[number].number for number in kept), rate, box, score)
