"""Keyed values between their keys, and how fast they change."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

__all__ = ["BLEND", "eased", "eased_rate"]

FloatArray = NDArray[np.float64]
Keys = tuple[float, ...] | tuple[tuple[float, float], ...]

BLEND = 1 / 24
"""How long before its time a held key is left for the next one, at most [s]: no speed is infinite."""


def eased(times: tuple[float, ...], values: Keys, easing: str, t: FloatArray) -> FloatArray:
    """The values at any time: the first before the first key, the last after the last one.

    Args:
        times: of the keys, rising [s], shape [k].
        values: at the keys, shape [k] or [k, c].
        easing: one of ``turns.EASINGS``.
        t: time [s], any shape.

    Returns:
        shape of t, and c.
    """
    inside = np.clip(t, times[0], times[-1])
    if easing == "smooth":
        return np.asarray(_monotone(times, values)(inside))
    before, after, start, length = _span(times, values, easing, inside)
    return before + _course(easing, np.clip((inside - start) / length, 0.0, 1.0), before) * (after - before)


def eased_rate(times: tuple[float, ...], values: Keys, easing: str, t: FloatArray) -> FloatArray:
    """The time derivative of ``eased``, 0 before the first key and from the last one on; its arguments."""
    inside = np.clip(t, times[0], times[-1])
    moving = (times[0] <= t) & (t < times[-1])
    if easing == "smooth":
        rate = np.asarray(_monotone(times, values)(inside, 1))
    else:
        before, after, start, length = _span(times, values, easing, inside)
        s = (inside - start) / length
        slope = np.ones_like(s) if easing == "linear" else 6 * s * (1 - s) * (s >= 0)
        rate = _spread(slope / length, before) * (after - before)
    return np.where(_spread(moving, rate), rate, 0.0)


def _span(
    times: tuple[float, ...], values: Keys, easing: str, t: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Values before and after each time, when the way from one to the other begins, and how long it takes."""
    keys, at = np.array(times), np.array(values, dtype=np.float64)
    index = np.clip(np.searchsorted(keys, t, side="right") - 1, 0, len(keys) - 2)
    start, end = keys[index], keys[index + 1]
    if easing == "hold":
        start = np.maximum(start, end - BLEND)
    return at[index], at[index + 1], start, end - start


def _course(easing: str, s: FloatArray, values: FloatArray) -> FloatArray:
    return _spread(s if easing == "linear" else s * s * (3 - 2 * s), values)


def _spread(array: NDArray[Any], like: FloatArray) -> NDArray[Any]:
    """The array with an axis of length 1 where the values have their coordinates."""
    return array[..., None] if like.ndim > array.ndim else array


@lru_cache(maxsize=1024)
def _monotone(times: tuple[float, ...], values: Keys) -> PchipInterpolator:
    from scipy.interpolate import PchipInterpolator

    return PchipInterpolator(times, values, axis=0)
