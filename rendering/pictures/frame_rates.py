"""Frame rates of clips: which can be written, and as which exact ratio."""

from __future__ import annotations

import math
import numbers
from fractions import Fraction

import numpy as np

from ...physics.errors import require

__all__ = ["FRAME_RATES", "check_frame_rate", "exact_frame_rate"]

FRAME_RATES = (0.01, 240.0)
"""The slowest and the fastest clip that can be written [frames/s]; every format holds these."""


def check_frame_rate(frame_rate: float | Fraction) -> None:
    """Refuse a frame rate that the formats cannot hold, before any long work.

    Raises:
        InvalidInputError: it is no number from ``FRAME_RATES``.
    """
    slowest, fastest = FRAME_RATES
    number = isinstance(frame_rate, numbers.Real) and not isinstance(frame_rate, bool | np.bool_)
    held = number and math.isfinite(frame_rate) and slowest <= frame_rate <= fastest
    require("frame_rate", frame_rate, held, f"a number from {slowest:g} to {fastest:g} frames a second")


def exact_frame_rate(frame_rate: float | Fraction) -> Fraction:
    """A frame rate as a ratio; what television calls 23.976 is 24000/1001.

    Args:
        frame_rate: frames a second.
    """
    if isinstance(frame_rate, Fraction):
        return frame_rate.limit_denominator(100_000)
    for nominal in (24, 30, 48, 60, 120):
        if abs(frame_rate - nominal / 1.001) < 0.005:
            return Fraction(nominal * 1000, 1001)
    return Fraction(float(frame_rate)).limit_denominator(1000)
