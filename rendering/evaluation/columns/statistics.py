"""Means over pictures, and how certain they are."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Summary", "mean_of_samples", "summary", "summary_of_whole"]

_RESAMPLED = 10_000
"""So many times pictures are drawn again."""

_AT_ONCE = 1_000_000
"""So many numbers are drawn at once."""

_TAILS = (2.5, 97.5)
_NORMAL = 1.959964
"""So many standard deviations hold 95 % of a normal distribution."""


@dataclass(frozen=True)
class Summary:
    """A value over pictures and the interval in which it lies with 95 % confidence.

    Attributes:
        mean: over the pictures; None without any.
        low, high: of the interval; None with fewer than two pictures, which say nothing of others.
        count: pictures that had a value.
    """

    mean: float | None
    low: float | None
    high: float | None
    count: int


def mean_of_samples(values: Iterable[float | None]) -> float | None:
    """The value of a picture: the mean over its samples, of those that have one.

    Samples of one picture are alike, so they do not count as further pictures.
    """
    known = [value for value in values if value is not None and np.isfinite(value)]
    return float(np.mean(known)) if known else None


def summary(values: Iterable[float | None], *, seed: int = 0) -> Summary:
    """Mean and bootstrap interval (Efron, 1979) of values, one a picture.

    Pictures are drawn anew from those that are there, with repetition, and the interval holds the middle 95 % of the
    means that come of it (percentile method). Where there are few pictures, it is too narrow rather than too wide.

    Args:
        values: one a picture, as of :func:`mean_of_samples`; None for pictures without.
        seed: the same values with the same seed give the same interval.

    Examples:
        >>> from physanimator.rendering.evaluation.columns import summary
        >>> summary([2.0, 2.0, 2.0])
        Summary(mean=2.0, low=2.0, high=2.0, count=3)
        >>> summary([2.0])
        Summary(mean=2.0, low=None, high=None, count=1)
    """
    known = np.array([value for value in values if value is not None and np.isfinite(value)], dtype=np.float64)
    if len(known) < 2:
        return Summary(float(known[0]) if len(known) else None, None, None, len(known))
    low, high = np.percentile(_resampled_means(known, np.random.default_rng(seed)), _TAILS)
    return Summary(float(known.mean()), float(low), float(high), len(known))


def summary_of_whole(pictures: Sequence[int], value: Callable[[Sequence[int]], float | None]) -> Summary:
    """A value that only all pictures have together, with the interval of a jackknife (Tukey, 1958) over them.

    Each picture is left out in turn. A bootstrap would take some pictures twice, which changes a covariance and with
    it a Frechet distance far more than another choice of pictures does.

    Args:
        pictures: their numbers.
        value: of some of them.
    """
    whole = value(pictures)
    if whole is None:
        return Summary(None, None, None, 0)
    without = [value([each for each in pictures if each != left_out]) for left_out in pictures]
    known = np.array([each for each in without if each is not None], dtype=np.float64)
    if len(known) < len(pictures) or len(known) < 2:
        return Summary(whole, None, None, len(pictures))
    error = _NORMAL * float(np.sqrt((len(known) - 1) * known.var()))
    return Summary(whole, max(0.0, whole - error), whole + error, len(pictures))


def _resampled_means(values: NDArray[np.float64], random: np.random.Generator) -> NDArray[np.float64]:
    each = max(1, min(_RESAMPLED, _AT_ONCE // len(values)))
    means = []
    for begin in range(0, _RESAMPLED, each):
        drawn = random.integers(len(values), size=(min(each, _RESAMPLED - begin), len(values)))
        means.append(values[drawn].mean(axis=1))
    return np.concatenate(means)
