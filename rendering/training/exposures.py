"""Drawings that stand for several frames: animation is drawn on ones, twos and threes, and films repeat frames."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["are_same_drawing", "exposed_frames", "thinned"]

_BLOCK = 4  # pixels on a side: noise averages out within, a mouth that opens does not
_NEARLY_ALL = 99  # percent of the blocks,
_MOSTLY = 3.0  # which differ by fewer levels where the drawing is the same;
_ANYWHERE = 12.0  # no block does by as many: what H.264 makes anew in B-frames differs by up to 9 here and there
_OF_COMPRESSION = 6.0  # levels by which most blocks may differ beside a change that is much larger,
_MUCH = 3  # namely so many times,
_NEAR = 3  # at most so many frames away: strong compression improves a drawing while it stands
_LONGEST_EXPOSURE = 3  # frames; what stands longer is held on purpose


def are_same_drawing(first: NDArray[np.uint8], second: NDArray[np.uint8]) -> bool:
    """Whether two frames show one drawing, apart from what compression makes of it.

    Args:
        first, second: RGB, uint8, of one size, best small, shape [h, w, 3].
    """
    mostly, most = _change(first, second)
    return most < _ANYWHERE and mostly < _MOSTLY


def _change(first: NDArray[np.uint8], second: NDArray[np.uint8]) -> tuple[float, float]:
    """By how many levels nearly all blocks, and all, differ at most."""
    difference = cv2.subtract(first.astype(np.float32), second.astype(np.float32))
    height, width = (max(1, side // _BLOCK) for side in first.shape[:2])
    blocks = np.abs(cv2.resize(difference, (width, height), interpolation=cv2.INTER_AREA)).max(axis=2)
    return float(np.percentile(blocks, _NEARLY_ALL)), float(blocks.max())


def _stands_beside_motion(changes: Sequence[tuple[float, float]], number: int) -> bool:
    """Whether a change is little beside another one near it, as it is on twos and threes, and not in a slow pan."""
    mostly, most = changes[number]
    near = max(each for each, _ in changes[max(0, number - _NEAR) : number + _NEAR + 1])
    return most < _ANYWHERE and mostly < _OF_COMPRESSION and _MUCH * mostly <= near


def exposed_frames(frames: Sequence[NDArray[np.uint8]]) -> list[int]:
    """Numbers of the frames that remain when repeated drawings are taken out.

    A drawing on ones, twos or threes remains once. One that is held longer remains as often as the clip's usual
    exposure (1 to 3 frames, the median) goes into it, so that a pause stays a pause.

    Args:
        frames: RGB, uint8, of one size, best small, shape [h, w, 3] each.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.training.exposures import exposed_frames
        >>> drawings = [np.full((8, 8, 3), level, np.uint8) for level in (0, 0, 90, 90, 180, 180)]
        >>> exposed_frames(drawings)
        [0, 2, 4]
    """
    changes = [_change(first, second) for first, second in pairwise(frames)]
    drawing, drawings = 0, [0] * len(frames)
    # Compared with the first frame of a drawing: what fades slowly does become another drawing.
    begin = 0
    for number in range(1, len(frames)):
        stands = _stands_beside_motion(changes, number - 1)
        if not stands and not are_same_drawing(frames[begin], frames[number]):
            drawing, begin = drawing + 1, number
        drawings[number] = drawing
    runs = [[number for number, _ in group] for _, group in groupby(enumerate(drawings), key=lambda each: each[1])]
    if not runs:
        return []
    usual = min(_LONGEST_EXPOSURE, max(1, int(np.median([len(run) for run in runs]))))
    return [number for run in runs for number in (run[::usual] if len(run) > _LONGEST_EXPOSURE else run[:1])]


def thinned(numbers: Sequence[int], rate: float, wanted: float) -> list[int]:
    """As many of these frames as a lower rate has, evenly spread; all of them where the rate is not lower.

    Args:
        numbers: of frames.
        rate: of these frames [frames/s].
        wanted: the highest rate that shall remain [frames/s]; 0: any.
    """
    if not wanted or rate <= wanted or len(numbers) < 2:
        return list(numbers)
    places = np.arange(0, len(numbers), rate / wanted).round().astype(int)
    places = np.minimum(places, len(numbers) - 1)
    return [numbers[place] for place in [places[0], *(b for a, b in pairwise(places) if b > a)]]
