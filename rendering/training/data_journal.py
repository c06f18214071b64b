"""What keeps a data folder whole over interruptions: its options, its finished videos, and lines added at once."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ... import __version__
from ...physics.errors import InvalidInputError
from ..files import check_folder_place, uninterrupted, write_text
from .data_folder import ClipRecord, index_file

__all__ = ["DataJournal", "check_data_folder"]

_FOLDERS = ("clips", "sketches")
_LONGEST_LINE = 1 << 16
_LARGEST_OPTIONS = 1 << 20


def check_data_folder(data: Path) -> None:
    """Refuse a place where no data folder is and none may be made: what others have put there stays as it is.

    Raises:
        InvalidInputError: it cannot be written to, or holds files that are not ours.
    """
    check_folder_place(data)
    ours = not data.is_dir() or _options_file(data).is_file()
    others = [] if ours else sorted(each.name for each in data.iterdir() if not each.name.startswith("."))
    if others:
        raise InvalidInputError(
            f"output must be a new folder, or one that physanimator dataset made. Got: {data}, which holds {others[0]}"
        )


class DataJournal:
    """A data folder that is written to.

    ``DATA/dataset.json`` has the options that its clips were made with, ``DATA/sources.jsonl`` a line for each video
    that was begun or is done.
    """

    def __init__(self, data: Path) -> None:
        self.data = data
        self.states: dict[str, str] = {}

    def open(self, options: Mapping[str, Any]) -> None:
        """Make the folder, or go on with it.

        Args:
            options: that clips are made with; the same as before.

        Raises:
            InvalidInputError: see :func:`check_data_folder`; or its clips were made with other options.
        """
        check_data_folder(self.data)
        known = self.options()
        for name, value in options.items():
            if name in known and known[name] != value:
                raise InvalidInputError(
                    f"{name} must stay {known[name]!r}, with which {self.data} was made, or output be another folder."
                    f" Got: {value!r}"
                )
        for folder in (self.data, *(self.data / name for name in _FOLDERS)):
            folder.mkdir(exist_ok=True)
        if set(options) - set(known):
            told = {"physanimator": __version__, "options": {**known, **options}}
            write_text(_options_file(self.data), json.dumps(told, indent=2, ensure_ascii=False) + "\n")
        for place in (index_file(self.data), self._sources):
            _end_last_line(place)
        self.states = self._read_states()

    def options(self) -> dict[str, Any]:
        """The options that its clips were made with; none of a new folder.

        Raises:
            InvalidInputError: the record is none of ours.
        """
        place = _options_file(self.data)
        if not place.is_file():
            return {}
        with place.open("rb") as opened:
            content = opened.read(_LARGEST_OPTIONS)
        try:
            options = json.loads(content)["options"]
        except (ValueError, KeyError, TypeError, RecursionError):
            options = None
        if not isinstance(options, dict):
            raise InvalidInputError(f"{place} must be what physanimator dataset wrote. Got: something else")
        return options

    def is_done(self, identity: str) -> bool:
        """Whether all clips of a video are there."""
        return self.states.get(identity) == "done"

    def begin(self, begun: Sequence[tuple[str, str, Path]]) -> None:
        """From now on, the files of these videos are ours.

        Args:
            begun: identity, begin of the names of its files, and path of each video.

        Raises:
            InvalidInputError: there are such files already, which somebody else put there.
        """
        new = {names: (identity, source) for identity, names, source in begun if identity not in self.states}
        for folder in _FOLDERS:
            for entry in os.scandir(self.data / folder):
                if entry.name.rpartition("_")[0] in new:
                    raise InvalidInputError(f"output must hold no files that are not ours. Got: {entry.path}")
        self._mark(list(new.values()), "begun")

    def finish(self, identity: str, source: Path, records: Sequence[ClipRecord]) -> None:
        """Add a video's clips to the index."""
        _append(index_file(self.data), [record.as_line() for record in records])
        self._mark([(identity, source)], "done")

    def _mark(self, videos: Sequence[tuple[str, Path]], state: str) -> None:
        told = [{"identity": identity, "source": str(source), "state": state} for identity, source in videos]
        _append(self._sources, [json.dumps(each, ensure_ascii=False) for each in told])
        self.states.update({identity: state for identity, _ in videos})

    @property
    def _sources(self) -> Path:
        return self.data / "sources.jsonl"

    def _read_states(self) -> dict[str, str]:
        found: dict[str, str] = {}
        if not self._sources.is_file():
            return found
        with self._sources.open("rb") as lines:
            while line := lines.readline(_LONGEST_LINE):
                try:
                    told = json.loads(line)
                    found[str(told["identity"])] = str(told["state"])
                except (ValueError, KeyError, TypeError, RecursionError):
                    raise InvalidInputError(
                        f"{self._sources} must be what physanimator dataset wrote. Got: {line[:60]!r}"
                    ) from None
        return found


def _options_file(data: Path) -> Path:
    return data / "dataset.json"


def _append(place: Path, lines: Sequence[str]) -> None:
    """Whole lines, on the disk before anything else is done."""
    if not lines:
        return
    with uninterrupted(), place.open("ab") as opened:
        opened.write("".join(f"{line}\n" for line in lines).encode())
        opened.flush()
        os.fsync(opened.fileno())


def _end_last_line(place: Path) -> None:
    """Take away what was written of a line when the power went: its video is not done, and will be built again."""
    if not place.is_file() or not place.stat().st_size:
        return
    with place.open("r+b") as opened:
        size = opened.seek(0, os.SEEK_END)
        start = max(0, size - _LONGEST_LINE)
        opened.seek(start)
        last = opened.read()
        if not last.endswith(b"\n"):
            opened.truncate(start + last.rfind(b"\n") + 1)
