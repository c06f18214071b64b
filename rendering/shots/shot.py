"""One shot: the words of its command, what it reads and writes, and by what it is known again."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ... import __version__
from .option_words import Word, spelled

__all__ = ["FileDigests", "Shot", "files_read", "identity_of"]

_BLOCK = 1 << 20


@dataclass(frozen=True)
class Shot:
    """One shot that can be worked on.

    Attributes:
        name: of the shot, unlike all others of its list.
        words: of its command, without the command's own name.
        settings: what its options are, by name, without files and places; JSON.
        record: where its record is.
        line: of the list's file, where the shot begins.
        lines: of the list's file, for each option.
        on_gpu: whether it asks for a graphics card.
        frames: how many it has, as far as its options tell.
        moving: pixels that move, as far as its masks tell.
        listed: name of the list's file.
    """

    name: str
    words: tuple[Word, ...]
    settings: Mapping[str, Any]
    record: str
    line: int | None = None
    lines: Mapping[str, int] = field(default_factory=dict)
    on_gpu: bool = False
    frames: int = 0
    moving: int = 0
    listed: str = ""

    def command(self, places: Mapping[str, str] | None = None) -> Sequence[str]:
        """The words as a command has them; see :meth:`Word.spelled`."""
        return spelled(self.words, places)

    def paths(self, kind: str) -> list[Word]:
        """The words that name files of a kind; see :attr:`Word.kind`."""
        return [each for each in self.words if each.kind == kind and each.text is not None]


def files_read(path: str) -> Iterator[str]:
    """Every file that is read of an input: itself, what is in a folder, and what lies beside a list of layers."""
    if os.path.isdir(path):
        for folder, folders, names in os.walk(path):
            folders.sort()
            yield from (os.path.join(folder, name) for name in sorted(names) if not name.startswith("."))
        return
    yield path
    if path.lower().endswith("layers.json"):
        folder = os.path.dirname(path)
        names = sorted(os.listdir(folder or "."))
        yield from (os.path.join(folder, name) for name in names if name.lower().endswith(".png"))


class FileDigests:
    """SHA-256 of files; each is read once as long as neither its size nor its time change."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, int, int], str] = {}

    def of(self, path: str) -> str:
        """The digest of a file, as hexadecimal digits.

        Raises:
            OSError: it cannot be read.
        """
        status = os.stat(path)
        key = (path, status.st_size, status.st_mtime_ns)
        if key not in self._known:
            digest = hashlib.sha256()
            with open(path, "rb") as file:
                while block := file.read(_BLOCK):
                    digest.update(block)
            self._known[key] = digest.hexdigest()
        return self._known[key]


def identity_of(shot: Shot, digests: FileDigests) -> str:
    """By what a finished shot is known again: what it reads, its options and our version; not where anything lies.

    Weights of networks are known by their size and time: reading gigabytes would take longer than many a shot.

    Raises:
        OSError: a file cannot be read.
    """
    known = {
        "version": __version__,
        "settings": shot.settings,
        "inputs": [[each.option, _content(each.text or "", digests)] for each in shot.paths("input")],
        "models": [[each.option, *_outside(each.text or "")] for each in shot.paths("model")],
        "outputs": [[each.option, _ending(each.text or "")] for each in shot.paths("output")],
    }
    return hashlib.sha256(json.dumps(known, sort_keys=True).encode()).hexdigest()


def _content(path: str, digests: FileDigests) -> Any:
    if not os.path.exists(path):  # a layer's name
        return path
    if not os.path.isdir(path) and not path.lower().endswith("layers.json"):
        return digests.of(path)
    top = path if os.path.isdir(path) else os.path.dirname(path)
    return [[os.path.relpath(each, top), digests.of(each)] for each in files_read(path)]


def _outside(path: str) -> tuple[str, list[list[int]]]:
    """A network's weights from outside."""
    sizes = []
    for each in files_read(path):
        status = os.stat(each)
        sizes.append([status.st_size, status.st_mtime_ns])
    return os.path.basename(path), sizes


def _ending(path: str) -> str:
    return "/" if path.endswith(("/", os.sep)) else os.path.splitext(path)[1].lower()
