"""Travel: how far along its path a flow particle is at an age, also where its speed is keyed along the path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import numbers_of
from ..errors import InvalidInputError, counted, require
from ..limits import LEAST_FACTOR, MOST_FACTOR

__all__ = ["MOST_KEYS", "Key", "Travel", "checked_keys", "factors"]

FloatArray = NDArray[np.float64]

Key = tuple[float, float]
"""Share of the path's length from 0 to 1, and a factor there."""

MOST_KEYS = 100


def checked_keys(name: str, keys: Sequence[Key], *, positive: bool = False) -> tuple[Key, ...]:
    """Keys as floats.

    Args:
        name: what the user calls them.
        keys: pairs (share, factor), the shares increasing.
        positive: whether factors must lie above 0.

    Raises:
        InvalidInputError: a share is not from 0 to 1 or not above the one before, or a factor is out of bounds.
    """
    expected = "pairs of a share of the path and a factor"
    if not isinstance(keys, tuple | list | np.ndarray):
        raise InvalidInputError(f"{name} must be {expected}. Got: {keys!r:.60}")
    require(name, counted(len(keys), "key"), len(keys) <= MOST_KEYS, f"at most {MOST_KEYS} keys")
    pairs = [numbers_of(name, key, expected) for key in keys]
    if not all(len(pair) == 2 for pair in pairs):
        raise InvalidInputError(f"{name} must be {expected}. Got: {keys!r:.60}")
    checked = tuple((pair[0], pair[1]) for pair in pairs)
    shares = [share for share, _ in checked]
    rising = all(0 <= share <= 1 for share in shares) and all(a < b for a, b in pairwise(shares))
    require(name, shares, rising, "at increasing shares of the path from 0 to 1")
    least = LEAST_FACTOR if positive else -MOST_FACTOR
    bounded = all(least <= factor <= MOST_FACTOR for _, factor in checked)
    require(name, [factor for _, factor in checked], bounded, f"factors from {least:g} to {MOST_FACTOR:g}")
    return checked


def factors(keys: Sequence[Key], shares: ArrayLike) -> FloatArray:
    """Factor at each share: straight between keys, that of the nearest key before the first and after the last."""
    if not keys:
        return np.ones(np.shape(shares))
    known, values = zip(*keys, strict=True)
    return np.interp(np.asarray(shares, dtype=np.float64), known, values)


@dataclass(frozen=True)
class Travel:
    """A particle's way along a path.

    Between two keys the speed is linear in the place, so the place is exponential in time.

    Attributes:
        length: of the path [px].
        speed: where the factor is 1 [px/s].
        keys: factors on the speed by share of the length; none for 1 everywhere.
    """

    length: float
    speed: float
    keys: tuple[Key, ...] = ()

    @cached_property
    def lifetime(self) -> float:
        """Time from the first point of the path to the last [s]; infinite where nothing moves."""
        if self.speed == 0:
            return math.inf
        return float(self._table[2][-1]) * self.length / self.speed

    def distance(self, ages: ArrayLike) -> FloatArray:
        """How far a particle of each age is along the path [px]; ages [s], shape [n]."""
        ages = np.asarray(ages, dtype=np.float64)
        if not self.keys:
            return np.clip(ages * self.speed, 0.0, self.length)
        shares, values, times = self._table
        passed = np.clip(ages * (self.speed / self.length), 0.0, times[-1])
        here = np.clip(np.searchsorted(times, passed, side="right") - 1, 0, len(times) - 2)
        slopes = np.diff(values)[here] / np.diff(shares)[here]
        elapsed = passed - times[here]
        flat = slopes == 0
        grown = np.expm1(np.where(flat, 0.0, slopes) * elapsed) / np.where(flat, 1.0, slopes)
        moved = values[here] * np.where(flat, elapsed, grown)
        return np.clip(shares[here] + moved, 0.0, 1.0) * self.length

    @cached_property
    def _table(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Shares, the factor there, and the time until there at a length and a speed of 1, each of shape [k]."""
        shares = np.unique([0.0, *(share for share, _ in self.keys), 1.0])
        values = factors(self.keys, shares)
        a, b = values[:-1], values[1:]
        flat = a == b
        logarithms = np.log(b / a) / np.where(flat, 1.0, b - a)
        steps = np.diff(shares) * np.where(flat, 1 / a, logarithms)
        return shares, values, np.concatenate([[0.0], np.cumsum(steps)])
