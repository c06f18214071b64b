"""The errors that PhysAnimator raises on purpose: one tree, each a sentence that a person can act on."""

from __future__ import annotations

import re

__all__ = [
    "Cancelled",
    "InvalidInputError",
    "MeshingError",
    "PhysAnimatorError",
    "SceneError",
    "SimulationError",
    "counted",
    "printable",
    "require",
    "shown",
]

_LONGEST_MESSAGE = 1200
_LONGEST_VALUE = 120
_MANY_DIGITS = re.compile(r"\d{25,}")
_HARMLESS = "\u00a0\u200c\u200d\u3000"
"""Spaces of written languages, and joiners, which are invisible but part of words and emoji in names of files."""


class PhysAnimatorError(Exception):
    """Base of every error that this package raises on purpose.

    Its message is one line of printable text of bounded length, whatever a file or a user put into it.
    """

    def __init__(self, message: str = "") -> None:
        super().__init__(_one_line(message, _LONGEST_MESSAGE))


class InvalidInputError(PhysAnimatorError, ValueError):
    """An input value is unusable; the message names what was expected and what was got."""


class MeshingError(InvalidInputError):
    """A mask cannot become a mesh."""


class SceneError(InvalidInputError):
    """A scene document is wrong.

    Attributes:
        path: where the wrong value stands, such as ``strokes[2].radius``; empty for the document itself.
    """

    def __init__(self, path: str, message: str) -> None:
        super().__init__(f"{path}: {message}" if path else message)
        self.path = _one_line(path, _LONGEST_MESSAGE)


class SimulationError(InvalidInputError):
    """A scene cannot be simulated in reasonable work; the message gives the reason and the remedy."""


class Cancelled(PhysAnimatorError):
    """The caller asked to stop; nothing went wrong."""


def counted(number: int, thing: str) -> str:
    """How many there are, such as "1 point" or "2 points".

    Args:
        number: how many.
        thing: one of them; its plural ends in s, or in ies where it ends in y.
    """
    if number == 1:
        return f"1 {thing}"
    return f"{number} {thing[:-1]}ies" if thing.endswith("y") else f"{number} {thing}s"


def require(name: str, got: object, holds: bool, expected: str) -> None:
    """Raise unless a value holds: the one wording for a bad value.

    Args:
        name: what the user calls the value.
        got: the value.
        holds: whether it is usable.
        expected: what would be, to stand after "must be".

    Raises:
        InvalidInputError: ``holds`` is false.
    """
    if not holds:
        raise InvalidInputError(f"{name} must be {expected}. Got: {shown(got)}")


def printable(text: str) -> str:
    """A text for a person: in one line, without what else in it a terminal would obey."""
    if text.isprintable():
        return text
    return "".join(each if each.isprintable() or each in _HARMLESS else _escaped(each) for each in text)


def shown(value: object) -> str:
    """A value that somebody gave, for a message: one printable line, short whatever the value holds."""
    if isinstance(value, list | tuple | set | dict | bytes) and len(value) > _LONGEST_VALUE // 3:
        return f"{type(value).__name__} of {len(value)}"
    try:
        return _one_line(str(value), _LONGEST_VALUE)
    except ValueError:  # Python does not write whole numbers of thousands of digits
        return "a number of thousands of digits"
    except RecursionError:
        return f"a deeply nested {type(value).__name__}"


def _one_line(text: str, longest: int) -> str:
    text = _MANY_DIGITS.sub(lambda digits: f"{digits[0][:6]}... ({len(digits[0])} digits)", str(text))
    if len(text) > longest:
        text = f"{text[: longest * 2 // 3]} ... {text[-longest // 4 :]}"
    return printable(text)


def _escaped(character: str) -> str:
    return character.encode("unicode_escape").decode("ascii")
