"""The record of a folder: which of its files were written by this program, and still are as it wrote them."""

from __future__ import annotations

import hashlib
import json
import stat
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from .text_files import write_text

__all__ = ["Record", "WrittenFile", "read_record", "recorded", "write_record"]

_MOST_BYTES = 64 << 20


@dataclass(frozen=True)
class WrittenFile:
    """A file as it was written.

    Attributes:
        name: of the file, from its folder on, with slashes.
        size: of the file [bytes].
        modified: when it was written [ns].
        sha256: of its content, as hexadecimal digits.
    """

    name: str
    size: int
    modified: int
    sha256: str

    def describes(self, folder: Path, name: str) -> bool:
        """Whether a file of a folder is this one still. It is read only where its time differs, as in a copy."""
        if name != self.name:
            return False
        file = folder / name
        try:
            status = file.lstat()
            if not stat.S_ISREG(status.st_mode) or status.st_size != self.size:
                return False
            return status.st_mtime_ns == self.modified or _digest(file) == self.sha256
        except OSError:
            return False


Record = Sequence[WrittenFile]


def recorded(folder: Path, name: str) -> WrittenFile:
    """What the record says of a file that has just been written."""
    file = folder / name
    status = file.stat()
    return WrittenFile(name, status.st_size, status.st_mtime_ns, _digest(file))


def write_record(place: Path, kind: str, record: Record) -> None:
    """Write the record of a folder.

    Args:
        place: the record's own file.
        kind: what the files are, such as frames.
        record: the files.
    """
    written = {"format": f"physanimator-{kind}", "version": 1, kind: [asdict(each) for each in record]}
    write_text(place, json.dumps(written, indent=0) + "\n")


def read_record(place: Path, kind: str) -> Record | None:
    """The record of a folder: empty where there is none, None where there is something else of its name.

    It is not trusted: it only says of files that are there and named as the program's are that they may be replaced.
    """
    try:
        status = place.lstat()
    except OSError:
        return ()
    if not stat.S_ISREG(status.st_mode) or status.st_size > _MOST_BYTES:
        return None
    try:
        data = json.loads(place.read_text(encoding="utf-8"))
        if data["format"] != f"physanimator-{kind}" or data["version"] != 1:
            return None
        return tuple(_file(entry) for entry in data[kind])
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return None


def _file(entry: Any) -> WrittenFile:
    found = WrittenFile(entry["name"], entry["size"], entry["modified"], entry["sha256"])
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
