"""The end of a drawn line or of an edge of colour."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["HALF_WIDTH", "LEAST_REACH", "LineEnd"]

FloatArray = NDArray[np.float64]

HALF_WIDTH = 6
"""A line and what is beside it lie within this of its middle [px]."""

LEAST_REACH = 3
"""The narrowest line reaches this far from its middle, with what is beside it [px]."""

# Half and twice each of these draw between as much and two and a half times as much, measured as in line_continuation.

# Colours rest where they differ by less than this share of the line's contrast over this distance [px].
_REST = 0.3
# And where, for all their texture, the mean before and behind differs by less than this share.
_REST_IN_MEAN = 0.5
_RESTING = 4


@dataclass(frozen=True, eq=False)
class LineEnd:
    """The end of a line or edge at the rim of a hole.

    Attributes:
        position: where it ends [px], shape [2].
        direction: the way that it takes into the hole, unit, shape [2].
        profile: RGB across it, a pixel apart and as far beyond as lines are compared, on the positive side of the
            normal (-y, x) of its direction last, shape [n, 3]; its middle is the position's.
    """

    position: FloatArray
    direction: FloatArray
    profile: FloatArray

    @property
    def contrast(self) -> float:
        """How much the colours across it differ from their mean."""
        near = self.across(np.arange(-HALF_WIDTH, HALF_WIDTH + 1.0))
        return float(np.sqrt(((near - near.mean(axis=0)) ** 2).sum(axis=1).mean()))

    @property
    def reach(self) -> tuple[int, int]:
        """How far the line itself goes to its negative and its positive side [px]: up to where colours rest.

        0 where they do not.
        """
        middle = len(self.profile) // 2
        return self._reach(self.profile[middle::-1]), self._reach(self.profile[middle:])

    def _reach(self, side: FloatArray) -> int:
        for first in range(LEAST_REACH, len(side) - _RESTING):
            if np.ptp(side[first : first + _RESTING + 1], axis=0).max() < _REST * self.contrast:
                return first + 1
        near, far = side[LEAST_REACH + 1 : HALF_WIDTH + 1].mean(axis=0), side[HALF_WIDTH + 1 :].mean(axis=0)
        return HALF_WIDTH if np.abs(near - far).max() < _REST_IN_MEAN * self.contrast else 0

    def across(self, offsets: FloatArray) -> FloatArray:
        """The profile at any distances from the middle [px], shape [..., 3]."""
        middle = len(self.profile) // 2
        at = np.clip(offsets + middle, 0, len(self.profile) - 1.001)
        first = np.floor(at).astype(np.int64)
        part = (at - first)[..., None]
        return np.asarray((1 - part) * self.profile[first] + part * self.profile[first + 1])

    def distance(self, other: LineEnd) -> float:
        """How far another end lies to the side of this line [px]; infinite if it lies on it or far from the end."""
        way = other.position - self.position
        along, aside = way @ self.direction, abs(self.direction[0] * way[1] - self.direction[1] * way[0])
        return float(aside) if aside > LEAST_REACH and abs(along) < 4 * aside else np.inf

    def moved(self, aside: float) -> LineEnd:
        """The same end with its middle moved to the positive side [px]."""
        normal = np.array([-self.direction[1], self.direction[0]])
        at = np.arange(float(len(self.profile))) - len(self.profile) // 2
        return LineEnd(self.position + aside * normal, self.direction, self.across(at + aside))
