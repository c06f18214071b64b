"""Whether values that somebody gives are of the kind that is meant, asked so that nothing else than an answer comes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Integral, Real
from typing import Any

import numpy as np

from .errors import InvalidInputError, require

__all__ = ["check_number", "check_whole", "is_number", "is_whole", "numbers_of", "require_kind", "within"]


def is_number(value: object) -> bool:
    """Whether something is a number, and no truth value."""
    return isinstance(value, Real) and not isinstance(value, bool | np.bool_)


def is_whole(value: object, low: int, high: int) -> bool:
    """Whether something is a whole number from ``low`` to ``high``, such as 3 or 3.0."""
    return within(value, low, high) and int(value) == value  # type: ignore[call-overload]


def within(value: object, low: float, high: float = math.inf, *, above: bool = False, below: bool = False) -> bool:
    """Whether something is a finite number from ``low`` to ``high``.

    Args:
        value: anything.
        low: the smallest that may be.
        high: the largest that may be.
        above: whether it must lie above ``low``.
        below: whether it must lie below ``high``.
    """
    if not is_number(value) or (above and value == low) or (below and value == high):
        return False
    number: Any = value  # whole numbers of any length compare with floats
    return bool(low <= number <= high and abs(number) < math.inf)


def numbers_of(name: str, values: object, expected: str) -> tuple[float, ...]:
    """A list of numbers as floats.

    Args:
        name: what the user calls it.
        values: the numbers.
        expected: what they must be, for the message.

    Raises:
        InvalidInputError: it is no list of numbers.
    """
    try:
        found = tuple(values) if isinstance(values, Iterable) and not isinstance(values, str | bytes) else None
    except TypeError:  # an array without a dimension
        found = None
    if found is None or not all(map(is_number, found)):
        raise InvalidInputError(f"{name} must be {expected}. Got: {values!r:.60}")
    try:
        return tuple(float(value) for value in found)
    except OverflowError:
        raise InvalidInputError(f"{name} must be {expected}. Got: a number beyond every bound") from None


def require_kind(name: str, value: object, kind: type | tuple[type, ...], expected: str) -> None:
    """Refuse what is of another kind, naming the kind that it is of.

    Raises:
        InvalidInputError: it is.
    """
    require(name, type(value).__name__, isinstance(value, kind), expected)


def check_number(name: str, value: object, low: float, high: float = math.inf, *, unit: str = "") -> None:
    """Refuse anything but a finite number from ``low`` to ``high``, as an option is.

    Args:
        name: what the user calls it.
        value: what was given.
        low: smallest usable value.
        high: largest usable value.
        unit: to stand after the range, such as " px".

    Raises:
        InvalidInputError: it is something else.
    """
    expected = f"a number of at least {low:g}{unit}" if high == math.inf else f"a number from {low:g} to {high:g}{unit}"
    require(name, value, within(value, low, high), expected)


def check_whole(name: str, value: object, low: int, high: int, *, unit: str = "") -> None:
    """Refuse anything but a whole number from ``low`` to ``high`` that is no float; arguments as ``check_number``.

    Raises:
        InvalidInputError: it is something else.
    """
    whole = isinstance(value, Integral) and is_whole(value, low, high)
    require(name, value, whole, f"a whole number from {low} to {high}{unit}")
