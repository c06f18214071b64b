"""Values of a list as the words of a command, by what the command's own parser says of its options."""

from __future__ import annotations

import argparse
import difflib
import os
import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ...physics.errors import InvalidInputError, shown
from ..files import plain_name
from .document import ShotRow
from .problems import Problem

__all__ = ["OptionNames", "Word", "shot_name", "spelled", "words_of"]

_PLACEHOLDER = re.compile(r"\{(name|out)\}")
_YES_OR_NO = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}


@dataclass(frozen=True)
class Word:
    """One word of a command.

    Attributes:
        flag: the option, empty for what stands without one.
        text: its value; None for an option that has none.
        kind: "input" and "output" for what is read and written, "model" for weights, which stay where they are.
        option: as the parser calls it.
    """

    flag: str
    text: str | None
    kind: str = ""
    option: str = ""

    def spelled(self, places: Mapping[str, str] | None = None) -> str:
        """As a command has it.

        Args:
            places: what stands for some of the values.
        """
        if self.text is None:
            return self.flag
        text = (places or {}).get(self.text, self.text) if self.kind in ("input", "output") else self.text
        return f"{self.flag}={text}" if self.flag else text


@dataclass(frozen=True)
class OptionNames:
    """What options of a command are, all as its parser calls them.

    Attributes:
        actions: each option's, by name.
        inputs: those that name files to read.
        models: those of them that name weights of networks.
        outputs: those that name files to write.
    """

    actions: Mapping[str, argparse.Action]
    inputs: Collection[str]
    models: Collection[str]
    outputs: Collection[str]

    def kind_of(self, name: str) -> str:
        """See :attr:`Word.kind`."""
        if name in self.outputs:
            return "output"
        if name in self.models:
            return "model"
        return "input" if name in self.inputs else ""


def shot_name(row: ShotRow) -> str:
    """A shot's name: as said, or the picture's.

    Raises:
        InvalidInputError: no file can have that name.
    """
    said = row.values.get("name")
    if said is None:
        image = row.values.get("image")
        said = os.path.splitext(os.path.basename(image.rstrip("/\\")))[0] if isinstance(image, str) else ""
        return plain_name(said, or_else=f"shot {row.number}").lstrip(".") or f"shot {row.number}"
    name = str(said) if isinstance(said, str | int) and not isinstance(said, bool) else ""
    if not name or name.startswith((".", "-")) or plain_name(name, or_else="") != name:
        raise InvalidInputError(f"name must be such that a file can have it on any system. Got: {shown(said)}")
    return name


def words_of(row: ShotRow, name: str, names: OptionNames, *, folder: str, out: str) -> tuple[list[Word], list[Problem]]:
    """The words of one shot's command, and what of the list cannot be one.

    Args:
        row: of the list.
        name: of the shot.
        names: of the command's options.
        folder: from which relative paths go.
        out: where results go that say nothing else.
    """
    words: list[Word] = []
    problems: list[Problem] = []
    for option, value in {"output": os.path.join("{out}", "{name}.mp4"), **row.values}.items():
        if option == "name":
            continue
        written = option.replace("_", "-")
        try:
            action = _action(option, names)
            texts = _texts(action, value, as_text=row.as_text)
            kind = names.kind_of(option)
            if kind == "output":
                texts = [_PLACEHOLDER.sub(lambda found: {"name": name, "out": out}[found[1]], each) for each in texts]
            if kind:
                texts = [_path(each, folder, maybe=option == "collider") for each in texts]
        except InvalidInputError as error:
            line = row.lines.get(option, row.line)
            if option not in names.actions and row.head is not None:  # the whole column is wrong
                line = row.head
            problems.append(Problem(str(error), name, written, line))
            continue
        if not action.option_strings:
            words[:0] = [Word("", each, kind, option) for each in texts]
        elif action.nargs == 0:
            words += [Word(each, None, kind, option) for each in texts]
        else:
            words += [Word(_flag(action), each, kind, option) for each in texts]
    return words, problems


def _action(option: str, names: OptionNames) -> argparse.Action:
    if option in names.actions:
        return names.actions[option]
    near = difflib.get_close_matches(option, names.actions, n=1)
    hint = f"; is {near[0].replace('_', '-')} meant?" if near else ""
    written = option.replace("_", "-")
    raise InvalidInputError(f"options must be those of animate, and name. Got: {shown(written)}{hint}")


def _texts(action: argparse.Action, value: Any, *, as_text: bool) -> list[str]:
    """The texts that the parser would get for a value."""
    written = action.dest.replace("_", "-")
    if action.nargs == 0:
        return _switched(action, value, written, as_text=as_text)
    several = action.nargs == "+" or isinstance(action, argparse._AppendAction)
    if isinstance(value, list) and several:
        return [_text(each, written) for each in value]
    if isinstance(value, list) and all(isinstance(each, str | int) for each in value) and action.dest == "keyframes_at":
        return [",".join(str(each) for each in value)]
    return [_text(value, written)]


def _switched(action: argparse.Action, value: Any, written: str, *, as_text: bool) -> list[str]:
    """The words of an option that is on or off."""
    if as_text and isinstance(value, str):
        value = _YES_OR_NO.get(value.lower(), value)
    if not isinstance(value, bool):
        kind = "yes or no" if as_text else "true or false"
        raise InvalidInputError(f"{written} must be {kind}. Got: {shown(value)}")
    off = [each for each in action.option_strings if each.startswith("--no-")]
    if value:
        return [_flag(action)]
    return off[:1]


def _flag(action: argparse.Action) -> str:
    return next(each for each in action.option_strings if each.startswith("--"))


def _text(value: Any, written: str) -> str:
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise InvalidInputError(f"{written} must be a text or a number. Got: {shown(value)}")
    if isinstance(value, str) and "\0" in value:
        raise InvalidInputError(f"{written} must be a text without zero bytes. Got: {shown(value)}")
    return shown(value) if isinstance(value, int) and abs(value) > 10**18 else str(value)


def _path(text: str, folder: str, *, maybe: bool) -> str:
    """A path from the list's folder on; a collider may be a layer's name instead, where there is no such file."""
    if not text:
        raise InvalidInputError("a path must be given. Got: nothing")
    path = os.path.join(folder, os.path.expanduser(text))
    return text if maybe and not os.path.exists(path) else path


def spelled(words: Iterable[Word], places: Mapping[str, str] | None = None) -> Sequence[str]:
    """All words as a command has them; see :meth:`Word.spelled`."""
    return [each.spelled(places) for each in words]
