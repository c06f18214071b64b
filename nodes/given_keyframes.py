"""Pictures that the node Interpolate is given: which of them are keyframes, and which frames of the clip those are."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from ..physics.errors import require
from .host import whole_numbers_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..physics.motion import Motion

__all__ = ["ALL_FRAMES", "IMAGES_ARE", "GivenPictures", "keyframe_numbers"]

ALL_FRAMES, _KEYFRAMES = IMAGES_ARE = ("all frames", "keyframes")


def keyframe_numbers(keyframes_at: str, images_are: str | None) -> tuple[int, ...]:
    """The typed frame numbers; InvalidInputError where no clip can have such keyframes.

    Args:
        keyframes_at: value of the input.
        images_are: one of ``IMAGES_ARE``.
    """
    at = whole_numbers_of(keyframes_at, name="keyframes_at")
    require("keyframes_at", keyframes_at[:60], min(at, default=0) >= 0, "frame numbers from 0")
    if images_are == _KEYFRAMES and at:
        rising = all(one < next_one for one, next_one in pairwise(at))
        require("keyframes_at", keyframes_at[:60], rising, "increasing frame numbers, one for each keyframe")
    return at


@dataclass(frozen=True, eq=False)
class GivenPictures:
    """All frames of a clip, or its keyframes alone.

    Attributes:
        pictures: shape [n, h, w, 3 or 4].
        images_are: one of ``IMAGES_ARE``.
        every: frames from one keyframe to the next.
        at: numbers of the keyframes, instead of that; empty where none were typed.
        motion: that is known, or None.
    """

    pictures: NDArray[Any]
    images_are: str
    every: int
    at: tuple[int, ...] = ()
    motion: Motion | None = None

    @property
    def _all_there(self) -> bool:
        return self.images_are != _KEYFRAMES

    @property
    def cycle(self) -> int:
        """How many frames the clip has if it is a loop."""
        if self._all_there:
            return len(self.pictures)
        if self.motion is not None:
            return len(self.motion)
        return self.at[-1] + self.every if self.at else self.every * len(self.pictures)

    def keyframes(self, *, loops: bool) -> tuple[NDArray[Any], list[int]]:
        """The keyframes among the pictures and their frame numbers.

        Args:
            loops: the clip closes.
        """
        from ..rendering.inbetweens import keyframe_indices

        if self._all_there:
            indices = keyframe_indices(len(self.pictures), self.every, at=self.at, loops=loops)
            return self.pictures[indices], indices
        count = len(self.pictures)
        last = len(self.motion) - 1 if self.motion else self.every * count
        regular = [min(self.every * number, last) for number in range(count)]
        return self.pictures, list(self.at) or regular

    def count(self, indices: list[int], *, loops: bool) -> int:
        """How many frames the clip has.

        Args:
            indices: frame numbers of its keyframes.
            loops: it closes.
        """
        if loops:
            return self.cycle
        return len(self.pictures) if self._all_there else indices[-1] + 1

    def kept(self, indices: list[int]) -> tuple[list[NDArray[Any]], list[NDArray[Any]]]:
        """What is shown before the first keyframe and after the last.

        Args:
            indices: frame numbers of the keyframes.
        """
        if self._all_there:
            return list(self.pictures[: indices[0]]), list(self.pictures[indices[-1] + 1 :])
        return [self.pictures[0]] * indices[0], []
