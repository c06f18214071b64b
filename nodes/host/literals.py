"""Values that are typed into a widget and can be refused before any work: points, paths, times, choices."""

from __future__ import annotations

import json
import unicodedata
from collections.abc import Callable, Collection, Mapping
from typing import Any

from ...physics.errors import InvalidInputError, PhysAnimatorError, require
from .wording import with_known_places

__all__ = ["PATH_FORMS", "boxes_of", "chosen", "keys_of", "numbers_of", "refusal", "times_of", "whole_numbers_of"]

PATH_FORMS = "as JSON: [[x, y], ...], or objects with x and y, as spline editors write it."
"""How a tooltip says what may be typed for a path."""

# The ideographic comma and the minus sign, which normalisation leaves as they are.
_MEANT = str.maketrans({"\u3001": ",", "\u2212": "-"})


def refusal(*checks: Callable[[], Any]) -> bool | str:
    """What ``validate_inputs`` returns: True when every check passes, else the sentence of the first that does not.

    Args:
        checks: called in order; each raises when a value is unusable.
    """
    for check in checks:
        try:
            check()
        except PhysAnimatorError as error:
            return with_known_places(str(error))
    return True


def chosen(choice: Mapping[str, Any] | None, name: str, options: Collection[str]) -> tuple[str, dict[str, Any]]:
    """The option that was chosen in a dynamic combo, and the values of the inputs that it brings.

    The host accepts a prompt whose choice is missing or unknown, and then calls the node without it.

    Args:
        choice: what the host hands over: the option under the combo's own name, beside the inputs it brings.
        name: the combo's name.
        options: what may be chosen.

    Raises:
        InvalidInputError: nothing or something unknown was chosen.
    """
    values = dict(choice or {})
    option = values.pop(name, None)
    if option not in options:
        raise InvalidInputError(f"{name} must be one of {', '.join(options)}. Got: {option!r}")
    return option, values


def times_of(text: str, *, name: str = "times") -> tuple[float, ...]:
    """Seconds from text: a JSON list of numbers, or numbers with commas between them; empty text gives none.

    Args:
        text: what was typed.
        name: what the node calls the input.

    Raises:
        InvalidInputError: the text holds something else.
    """
    return numbers_of(text, name=name, like="seconds such as [0, 0.5, 2]")


def numbers_of(text: str, *, name: str, like: str) -> tuple[float, ...]:
    """Numbers from text: a JSON list, or numbers with commas between them; empty text gives none.

    Args:
        text: what was typed.
        name: what the node calls the input.
        like: what the list holds, with an example, for the message.

    Raises:
        InvalidInputError: the text holds something else.
    """
    bare = _plain(text).removeprefix("[").removesuffix("]").strip()
    if not bare:
        return ()
    try:
        values = json.loads(f"[{bare}]")
        return tuple(float(value) for value in values)
    except (TypeError, ValueError, OverflowError, RecursionError):
        raise InvalidInputError(f"{name} must be a list of {like}. Got: {text[:60]}") from None


def whole_numbers_of(text: str, *, name: str) -> tuple[int, ...]:
    """Frame numbers from text: a JSON list, or numbers with commas between them; empty text gives none.

    Args:
        text: what was typed.
        name: what the node calls the input.

    Raises:
        InvalidInputError: the text holds something else.
    """
    numbers = numbers_of(text, name=name, like="frame numbers such as 0, 12, 15")
    require(name, text[:60], all(number.is_integer() for number in numbers), "whole numbers")
    return tuple(int(number) for number in numbers)


def boxes_of(text: str, *, name: str) -> tuple[tuple[float, float, float, float], ...]:
    """Boxes from text: one JSON list of four numbers, or a list of such; empty text gives none.

    Args:
        text: what was typed.
        name: what the node calls the input.

    Raises:
        InvalidInputError: the text holds something else.
    """
    if not text.strip():
        return ()
    try:
        value = json.loads(_plain(text))
        boxes = value if isinstance(value[0], list) else [value]
        x_y = [tuple(float(number) for number in box) for box in boxes]
    except (TypeError, ValueError, KeyError, IndexError, OverflowError, RecursionError):
        x_y = [()]
    if not all(len(box) == 4 and box[0] < box[2] and box[1] < box[3] for box in x_y):
        raise InvalidInputError(f"{name} must be [x0, y0, x1, y1] in pixels, or a list of such. Got: {text[:60]}")
    return tuple((box[0], box[1], box[2], box[3]) for box in x_y)


def keys_of(text: str, *, name: str) -> tuple[tuple[float, float], ...]:
    """Keys along a path from text: a JSON list of pairs [part of the path, factor]; empty text gives none.

    Args:
        text: what was typed.
        name: what the node calls the input.

    Raises:
        InvalidInputError: the text holds something else.
    """
    if not text.strip():
        return ()
    try:
        return tuple((float(part), float(factor)) for part, factor in json.loads(_plain(text)))
    except (TypeError, ValueError, OverflowError, RecursionError):
        raise InvalidInputError(
            f"{name} must be a list of pairs [part of the path from 0 to 1, factor] such as [[0, 1], [1, 0.5]]."
            f" Got: {text[:60]}"
        ) from None


def _plain(text: str) -> str:
    """Digits, commas and brackets of East Asian keyboards as the plain ones that they stand for."""
    return unicodedata.normalize("NFKC", text).translate(_MEANT).strip()
