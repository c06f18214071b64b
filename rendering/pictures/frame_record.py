"""The record of a folder of frames: which of its files were written by this program, and still are as it wrote them."""

from __future__ import annotations

import hashlib
import json
import stat
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..files import write_text

__all__ = ["RECORD", "Record", "WrittenFrame", "read_record", "recorded", "write_record"]

RECORD = ".physanimator.json"
"""Name of the record in its folder; hidden, where a leading dot hides."""

_FORMAT = "physanimator-frames"
_MOST_BYTES = 64 << 20


@dataclass(frozen=True)
class WrittenFrame:
    """A frame as it was written.

    Attributes:
        name: of the file.
        size: of the file [bytes].
        modified: when it was written [ns].
        sha256: of its content, as hexadecimal digits.
    """

    name: str
    size: int
    modified: int
    sha256: str

    def describes(self, file: Path) -> bool:
        """Whether a file is this frame still. Its content is read only where its time differs, as after copying."""
        if file.name != self.name:
            return False
        try:
            status = file.lstat()
            if not stat.S_ISREG(status.st_mode) or status.st_size != self.size:
                return False
            return status.st_mtime_ns == self.modified or _digest(file) == self.sha256
        except OSError:
            return False


Record = Sequence[WrittenFrame]


def recorded(file: Path) -> WrittenFrame:
    """What the record says of a file that has just been written."""
    status = file.stat()
    return WrittenFrame(file.name, status.st_size, status.st_mtime_ns, _digest(file))


def write_record(folder: Path, record: Record) -> None:
    """Write the record of a folder."""
    written = {"format": _FORMAT, "version": 1, "frames": [asdict(each) for each in record]}
    write_text(folder / RECORD, json.dumps(written, indent=0) + "\n")


def read_record(folder: Path) -> Record | None:
    """The record of a folder: empty where there is none, None where there is something else of its name.

    It is not trusted: it only says of files that are there and named as frames are that they may be replaced.
    """
    file = folder / RECORD
    try:
        status = file.lstat()
    except OSError:
        return ()
    if not stat.S_ISREG(status.st_mode) or status.st_size > _MOST_BYTES:
        return None
    try:
        data = json.loads(file.read_text(encoding="utf-8"))
        if data["format"] != _FORMAT or data["version"] != 1:
            return None
        return tuple(_frame(entry) for entry in data["frames"])
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return None


def _frame(entry: Any) -> WrittenFrame:
    found = WrittenFrame(entry["name"], entry["size"], entry["modified"], entry["sha256"])
    kinds = (type(found.name), type(found.size), type(found.modified), type(found.sha256))
    if kinds != (str, int, int, str):
        raise TypeError(f"{kinds} in the record")
    return found


def _digest(file: Path) -> str:
    digest = hashlib.sha256()
    with file.open("rb") as stream:
        while block := stream.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()
