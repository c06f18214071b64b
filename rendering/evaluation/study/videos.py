"""Clips as browsers play them, and clips that are broken so that everyone sees it."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from ....physics.errors import InvalidInputError
from ...pictures import read_clip, write_animation

__all__ = ["MOST_FRAMES", "broken", "frame_rate_of", "write_video"]

MOST_FRAMES = 1500
"""Of a clip in a study, a minute at 24 a second; raters watch it more than once."""

_LOT = 48  # frames that are mixed up with each other, and held in memory for it

Frame = NDArray[np.uint8]


def frame_rate_of(path: Path, usual: float) -> float:
    """Frames a second of a video or an animated picture, where it says; ``usual`` of other clips."""
    if path.is_dir():
        return usual
    import av

    try:
        with av.open(str(path.absolute()), options={"protocol_whitelist": "file"}) as container:
            rate = container.streams.video[0].average_rate
    except (OSError, IndexError, ValueError):
        return usual
    return float(rate) if rate and Fraction(1) <= rate <= 240 else usual


def write_video(source: Path, path: Path, *, rate: float, longest: int, broken_by: int | None = None) -> None:
    """Write a clip as H.264 in 4:2:0, without what the file said about itself.

    Args:
        source: the clip.
        path: file to write, ``.mp4``.
        rate: frames a second.
        longest: side that larger clips are brought to [px].
        broken_by: seed of the damage of :func:`broken`; None for none.

    Raises:
        InvalidInputError: the clip cannot be read, or is too long.
    """
    frames = _within(source, longest)
    write_animation(frames if broken_by is None else broken(frames, broken_by), path, rate)


def _within(source: Path, longest: int) -> Iterator[Frame]:
    for number, frame in enumerate(read_clip(source)):
        if number >= MOST_FRAMES:
            raise InvalidInputError(f"clip {source} must have at most {MOST_FRAMES} frames for a study. Got: more")
        side = max(frame.shape[:2])
        if side > longest:
            height, width = (max(2, round(n * longest / side)) for n in frame.shape[:2])
            frame = cv2.resize(frame, (width, height), interpolation=cv2.INTER_AREA)
        yield frame


def broken(frames: Iterable[Frame], seed: int) -> Iterator[Frame]:
    """As many frames in a wild order, torn into stripes that are shifted, with false colours and blocks.

    Args:
        frames: of a true clip, uint8 [h, w, 3].
        seed: of the damage.
    """
    chance = np.random.default_rng(seed)
    rest = iter(frames)
    while lot := list(itertools.islice(rest, _LOT)):
        for place in chance.permutation(len(lot)):
            yield _torn(lot[int(place)].copy(), chance)


def _torn(frame: Frame, chance: np.random.Generator) -> Frame:
    height, width = frame.shape[:2]
    stripe = max(2, height // 14)
    for top in range(0, height, stripe):
        shift = int(chance.normal(0, 0.12 * width))
        frame[top : top + stripe] = np.roll(frame[top : top + stripe], shift, axis=1)
    small = cv2.resize(frame, (max(1, width // 14), max(1, height // 14)), interpolation=cv2.INTER_AREA)
    blocks = cv2.resize(small, (width, height), interpolation=cv2.INTER_NEAREST)
    mask = np.kron(chance.random((8, 8)) < 0.35, np.ones((height // 8 + 1, width // 8 + 1)))[:height, :width]
    frame = np.where(mask[..., None] > 0, blocks[..., ::-1], frame)
    return frame.astype(np.uint8)
