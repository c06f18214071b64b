"""The parser: options that take several values may stand before the picture, which is then the last of them."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator, Sequence
from typing import NoReturn

from ...physics.errors import InvalidInputError, printable

__all__ = ["SEVERAL", "CommandParser", "PictureParser", "RefusingParser"]

SEVERAL = ("--mask", "--preset", "--collider")
"""Options that take several values at once."""

_PICTURE = "IMAGE"


class _Refused(Exception):
    """What argparse would have said before it ended the process."""


_KINDS = {"int": "a whole number", "float": "a number"}

_SENTENCES = (
    (r"argument (?P<name>[^:]+): invalid (?P<kind>int|float) value: (?P<got>.*)", "{name} must be {kind}. Got: {got}"),
    (
        r"argument (?P<name>[^:]+): invalid choice: (?P<got>.*) \(choose from (?P<choices>.*)\)",
        "{name} must be one of {choices}. Got: {got}",
    ),
    (r"argument (?P<name>[^:]+): expected (one|at least one) argument", "{name} must have a value. Got: none"),
    (
        r"the following arguments are required: (?P<name>.*)",
        "{name} must be given, as --help tells. Got: nothing for it",
    ),
    (r"unrecognized arguments: (?P<got>.*)", "options must be among those of --help. Got: {got}"),
)
"""What argparse says, and the same in the words of our other messages."""


class CommandParser(argparse.ArgumentParser):
    """A parser that refuses in one sentence, which stays in its line whatever it quotes."""

    def error(self, message: str) -> NoReturn:
        """Refuse the command."""
        self.exit(2, f"{self.prog.split()[0]}: {printable(_sentence(message))}\n")


class RefusingParser(CommandParser):
    """A parser that raises instead of ending the process."""

    def error(self, message: str) -> NoReturn:
        """Refuse the words.

        Raises:
            InvalidInputError: always.
        """
        raise InvalidInputError(_sentence(message))


class PictureParser(CommandParser):
    """A parser of ``IMAGE --mask A B`` that also understands ``--mask A B IMAGE``.

    Where no picture was found elsewhere, the last value of the one option that has more than it needs is the picture.
    Where several options could have it, the command is refused. ``options.image_after`` names the option.
    """

    _trying = False

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """See :class:`argparse.ArgumentParser`."""
        given = list(args or ())
        try:
            self._trying = True
            options, rest = super().parse_known_args(given, namespace)
        except _Refused as refused:
            self._trying = False
            taken = self._picture_among_values(given) if f" {_PICTURE}" in str(refused) else None
            if taken is None:
                self.error(str(refused))
            option, place = taken
            options, rest = super().parse_known_args([given[place], *given[:place], *given[place + 1 :]], namespace)
            options.image_after = option
        finally:
            self._trying = False
        return options, rest

    def error(self, message: str) -> NoReturn:
        """Refuse the command, unless this is the first try at it."""
        if self._trying:
            raise _Refused(message)
        super().error(message)

    def _picture_among_values(self, given: Sequence[str]) -> tuple[str, int] | None:
        """The option that has the picture among its values, and where the picture stands."""
        found = [(option, last) for option, first, last in _runs(given) if last > first]
        if any(option == "--preset" for option, _ in found):
            from ...physics.material import PRESETS

            found = [each for each in found if each[0] != "--preset" or given[each[1]] not in PRESETS]
        if len(found) > 1:
            could = " or ".join(given[place] for _, place in found)
            self.error(f"{_PICTURE} must stand before the options where it could be {could}. Got: no {_PICTURE}")
        return found[0] if found else None


def _sentence(message: str) -> str:
    for pattern, sentence in _SENTENCES:
        if found := re.fullmatch(pattern, message, flags=re.DOTALL):
            words = found.groupdict()
            return sentence.format_map({**words, "kind": _KINDS.get(words.get("kind", ""), "")})
    return message


def _runs(given: Sequence[str]) -> Iterator[tuple[str, int, int]]:
    """Options of ``SEVERAL`` with the places of their first and last value."""
    option, first = "", 0
    for place, word in enumerate([*given, "--"]):
        if not word.startswith("-") or word == "-":
            continue
        if option and place > first:
            yield option, first, place - 1
        option, first = (word if word in SEVERAL else ""), place + 1
        if word == "--":
            return
