"""The animation that frames follow in dual-clock denoising: its pictures, and what moves in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["CrudeAnimation"]


@dataclass(frozen=True)
class CrudeAnimation:
    """Frames of an animation, each made when it is asked for.

    Attributes:
        count: number of frames.
        at: gives a frame by its number: its picture, RGB, uint8 or float in 0..1, shape [h, w, 3], and how much of each
            pixel moving parts cover in it, 0..1, shape [h, w]. Frame 0 is the illustration.
    """

    count: int
    at: Callable[[int], tuple[NDArray[Any], NDArray[Any]]]

    @classmethod
    def of(cls, frames: Sequence[NDArray[Any]], coverage: Sequence[NDArray[Any]]) -> CrudeAnimation:
        """From pictures and masks that are all there.

        Raises:
            InvalidInputError: they are not as many.
        """
        require("coverage", len(coverage), len(coverage) == len(frames), f"one for each of the {len(frames)} frames")
        return cls(len(frames), lambda number: (frames[number], coverage[number]))
