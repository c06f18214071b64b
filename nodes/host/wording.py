"""Sentences in the words of the person at the browser: parts by name, files by their place in the host's folders."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager

from ...physics.errors import InvalidInputError, PhysAnimatorError

__all__ = ["in_users_words", "named_part", "parts_named", "placed_errors", "with_known_places"]

_PART = re.compile(r"^(?:masks|bodies)\[(\d+)\](?: \([^)]*\))?(?=[:. ])")
_LIST = re.compile(r"^(bodies|rig_points)\[(\d+)\](?=[: ])")
_LISTED = {"bodies": "Body", "rig_points": "Rig point"}
_SLASH = r"[\\/]+"
_BEFORE, _BELOW = r"(?<![\w.\-\\/])", rf"(?P<below>{_SLASH}[^\s'\"]*|(?![\w.\-]))"


@contextmanager
def parts_named(names: Sequence[str]) -> Iterator[None]:
    """Let errors call the parts by their names.

    Args:
        names: of the parts, in their order.
    """
    try:
        yield
    except InvalidInputError as error:
        said = named_part(str(error), names)
        if names and said.startswith("masks must "):
            said = "the parts" + said[len("masks") :]
        error.args = (said,)
        raise


def named_part(sentence: str, names: Sequence[str]) -> str:
    """A sentence about one of the parts, with its name in place of its number.

    Args:
        sentence: as the library says it.
        names: of the parts, in their order.
    """
    found = _PART.match(sentence)
    if found is None or int(found[1]) >= len(names):
        return sentence
    return names[int(found[1])] + sentence[found.end() :]


def in_users_words(sentence: str) -> str:
    """A sentence about a scene that counts bodies and rig points as inputs of nodes do, from 0 along their chain."""
    said = _LIST.sub(lambda found: f"{_LISTED[found[1]]} {found[2]}", sentence)
    return with_known_places(said)


def with_known_places(text: str) -> str:
    """A text whose paths begin with the host's folder that they are in, such as ``input/girl.psd``."""
    for folder, name in _folders():
        path = _SLASH.join(re.escape(part) for part in re.split(_SLASH, folder.rstrip("\\/")))
        place = re.compile(_BEFORE + path + _BELOW)
        text = place.sub(lambda found, name=name: name + _plain(found["below"]), text)  # type: ignore[misc]
    return text


@contextmanager
def placed_errors() -> Iterator[None]:
    """Let errors name files by their place in the host's folders."""
    try:
        yield
    except PhysAnimatorError as error:
        if error.args and isinstance(error.args[0], str):
            error.args = (with_known_places(error.args[0]), *error.args[1:])
        raise


def _plain(below: str) -> str:
    return re.sub(r"\\+", "/", below) if os.sep == "\\" else below


def _folders() -> Iterable[tuple[str, str]]:
    """The host's folders and what a person calls them, the innermost first."""
    try:
        import folder_paths
    except ImportError:
        return []
    found: dict[str, str] = {}
    for name in ("base_path", "models_dir"):
        found[str(getattr(folder_paths, name, ""))] = {"base_path": "ComfyUI", "models_dir": "models"}[name]
    for kind, (folders, *_) in getattr(folder_paths, "folder_names_and_paths", {}).items():
        name = kind if kind == "custom_nodes" else f"models/{kind}"
        found.update({str(folder): name for folder in folders})
    for name in ("input", "output", "temp"):
        found[str(getattr(folder_paths, f"get_{name}_directory")())] = name
    both = {
        each: name for folder, name in found.items() if len(folder) > 1 for each in (folder, os.path.realpath(folder))
    }
    return sorted(both.items(), key=lambda each: -len(each[0]))
