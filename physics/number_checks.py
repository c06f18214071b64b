"""Numbers of options, checked before any work: right kind, finite, in range."""

from __future__ import annotations

import math
import numbers
from typing import Any

import numpy as np

from .errors import require

__all__ = ["check_number", "check_whole"]


def check_number(name: str, value: Any, low: float, high: float = math.inf, *, unit: str = "") -> None:
    """Refuse anything but a finite number from ``low`` to ``high``.

    Args:
        name: what the user calls it.
        value: what was given.
        low: smallest usable value.
        high: largest usable value.
        unit: to stand after the range, such as " px".

    Raises:
        InvalidInputError: it is something else.
    """
    real = isinstance(value, numbers.Real) and not isinstance(value, bool | np.bool_)
    expected = f"a number of at least {low:g}{unit}" if high == math.inf else f"a number from {low:g} to {high:g}{unit}"
    require(name, _shown(value), real and low <= value <= high and value < math.inf, expected)


def check_whole(name: str, value: Any, low: int, high: int, *, unit: str = "") -> None:
    """Refuse anything but a whole number from ``low`` to ``high``.

    Args:
        name: see :func:`check_number`, as are value, low, high and unit.
        value: what was given.
        low: smallest usable value.
        high: largest usable value.
        unit: to stand after the range.

    Raises:
        InvalidInputError: it is something else.
    """
    whole = isinstance(value, numbers.Integral) and not isinstance(value, bool | np.bool_)
    require(name, _shown(value), whole and low <= value <= high, f"a whole number from {low} to {high}{unit}")


def _shown(value: Any) -> str:
    try:
        return repr(value)[:60]
    except ValueError:  # Python does not write whole numbers of thousands of digits
        return "a number of thousands of digits"
