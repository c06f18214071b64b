"""Names of pictures and methods, which become names of folders, and what somebody may have meant by a wrong one."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from ...physics.errors import InvalidInputError, require
from ..files import plain_name, same_name

__all__ = ["check_different", "check_name", "suggestion"]

_LONGEST = 60


def check_name(name: str) -> None:
    """Refuse a name that cannot be a folder's on every system.

    Raises:
        InvalidInputError: it is such a name.
    """
    writable = name == plain_name(name, or_else="") and 0 < len(name) <= _LONGEST
    require(
        "name",
        repr(name),
        writable,
        f'1 to {_LONGEST} letters that can name a folder, without / \\ : * ? " < > | and without dots around it',
    )


def check_different(what: str, names: Iterable[str]) -> None:
    """Refuse names of which two are one on systems that tell neither case nor ways to write an accent apart.

    Raises:
        InvalidInputError: the message names them.
    """
    seen: list[str] = []
    for name in names:
        if twin := next((each for each in seen if same_name(each, name)), None):
            raise InvalidInputError(f"{what} must have names of their own. Got: {twin!r} and {name!r}")
        seen.append(name)


def suggestion(given: str, known: Iterable[str]) -> str:
    """What somebody may have meant, as the end of a sentence's clause; empty where nothing is near."""
    near = difflib.get_close_matches(given[:200], list(known), n=1)
    return f" (did you mean {near[0]}?)" if near else ""
