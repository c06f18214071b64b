"""The record beside a finished shot: what it was made from, what was written, where and how long it took."""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ... import __version__
from ..files import WrittenFile, recorded, write_text
from .shot import Shot

__all__ = ["ENDING", "ShotRecord", "is_finished", "read_shot_record", "write_shot_record", "written_by"]

ENDING = ".shot.json"
"""Of a record's name, after that of what the shot has written."""

_FORMAT = "physanimator-shot"
_MOST_BYTES = 64 << 20


@dataclass(frozen=True)
class ShotRecord:
    """What is known of a finished shot.

    Attributes:
        name: of the shot.
        identity: see :func:`~physanimator.rendering.shots.shot.identity_of`.
        files: all that it has written; names from the record's folder on.
        seconds: that it took [s].
        machine: where.
        said: what ``animate`` has said of it.
        settings: its options.
        version: of PhysAnimator.
        listed: name of the list's file that the shot is in.
    """

    name: str
    identity: str
    files: tuple[WrittenFile, ...]
    seconds: float
    machine: str
    said: tuple[str, ...] = ()
    settings: dict[str, Any] = field(default_factory=dict)
    version: str = __version__
    listed: str = ""


def written_by(
    record: str, outputs: Iterable[str], files_of: Callable[[str], Sequence[str]]
) -> tuple[WrittenFile, ...]:
    """What a shot has written, for its record.

    Args:
        record: where that is.
        outputs: files and folders that the shot writes.
        files_of: the files that were written of one of them.

    Raises:
        OSError: one of them is not there.
    """
    folder = Path(record).parent
    return tuple(recorded(folder, _from(folder, file)) for path in outputs for file in files_of(path))


def _from(folder: Path, file: str) -> str:
    place, top = os.path.realpath(file), os.path.realpath(folder)
    inside = (
        os.path.commonpath([place, top]) == top if os.path.splitdrive(place)[0] == os.path.splitdrive(top)[0] else 0
    )
    return Path(os.path.relpath(place, top)).as_posix() if inside else place


def write_shot_record(path: str, record: ShotRecord) -> None:
    """Write a record; it appears whole or not at all.

    Raises:
        OSError: it cannot be written.
    """
    write_text(path, json.dumps({"format": _FORMAT, "format_version": 1, **asdict(record)}, indent=1) + "\n")


def read_shot_record(path: str) -> ShotRecord | None:
    """A record; None where there is none that can be read. It is trusted with nothing but that work may be left out."""
    try:
        status = os.lstat(path)
        if not stat.S_ISREG(status.st_mode) or status.st_size > _MOST_BYTES:
            return None
        data = json.loads(Path(path).read_text(encoding="utf-8"))
        if data.pop("format") != _FORMAT or data.pop("format_version") != 1:
            return None
        files = tuple(WrittenFile(**each) for each in data.pop("files"))
        record = ShotRecord(files=files, said=tuple(map(str, data.pop("said"))), **data)
        texts = (record.name, record.identity, record.machine, record.listed, *(each.name for each in files))
        numbers = (record.seconds, *(each.size for each in files))
        right = all(isinstance(each, str) for each in texts) and all(isinstance(each, int | float) for each in numbers)
        return record if right else None
    except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None


def described(record: ShotRecord, shot: Shot, path: str) -> bool:
    """Whether a file of a shot is what its record says was written; a damaged record says nothing."""
    folder = Path(shot.record).parent
    try:
        name = _from(folder, path)
        return all(each.describes(folder, each.name) for each in record.files if each.name == name)
    except (TypeError, ValueError):
        return True


def is_finished(shot: Shot, identity: str) -> ShotRecord | None:
    """The record of a shot that need not be done again: it was made from the same, and its results are unchanged."""
    record = read_shot_record(shot.record)
    if record is None or record.identity != identity or not record.files:
        return None
    folder = Path(shot.record).parent
    try:
        unchanged = all(each.describes(folder, each.name) for each in record.files)
    except (TypeError, ValueError):
        return None
    return record if unchanged else None
