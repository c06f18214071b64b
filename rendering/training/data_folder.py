"""A folder of training data: clips, their sketches, and what is known of each.

DATA/index.jsonl              a line of JSON for each clip that was found, kept or not
DATA/clips/NAME.mp4           frames of a kept clip
DATA/sketches/NAME.mp4        its sketches, dark lines on white, frame by frame
DATA/encoded/KIND/NAME.safetensors   what the frozen networks make of it, written once
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from ...physics.checks import is_whole, within
from ...physics.errors import InvalidInputError

__all__ = [
    "ClipRecord",
    "clip_file",
    "encoded_file",
    "hash_of",
    "index_file",
    "kept_clips",
    "read_index",
    "sketch_file",
]

_LONGEST_LINE, _MOST_CLIPS = 1 << 16, 10_000_000
_LARGEST_NUMBER = 1_000_000_000
_FORBIDDEN = set('/\\:*?"<>|')


@dataclass(frozen=True)
class ClipRecord:
    """One clip.

    Attributes:
        name: of its files, without an ending.
        source: file that it was cut from.
        start, end: of it in the source [s].
        frames: number of frames.
        fps: frames a second.
        width: of the frames [px].
        height: of the frames [px].
        score: dynamics score.
        kept: whether it is part of the data.
        why: it is kept or dropped.
        sketches: what drew its sketches.
        licence: under which it may be used, as its collector says.
    """

    name: str
    source: str
    start: float
    end: float
    frames: int
    fps: float
    width: int
    height: int
    score: float
    kept: bool
    why: str = ""
    sketches: str = ""
    licence: str = ""

    def as_line(self) -> str:
        """Its line of the index, without the end of line."""
        return json.dumps(asdict(self), ensure_ascii=False)


def index_file(data: Path) -> Path:
    """Where the index of a data folder is."""
    return data / "index.jsonl"


def clip_file(data: Path, name: str) -> Path:
    """Where a clip's frames are."""
    return data / "clips" / f"{name}.mp4"


def sketch_file(data: Path, name: str) -> Path:
    """Where a clip's sketches are."""
    return data / "sketches" / f"{name}.mp4"


def encoded_file(data: Path, kind: str, name: str) -> Path:
    """Where a clip's latents and embeddings for one video model (``svd`` or ``tooncrafter``) are."""
    return data / "encoded" / kind / f"{name}.safetensors"


def hash_of(file: Path) -> str:
    """SHA-256 of a file's content, in hexadecimal digits."""
    with file.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest() if hasattr(hashlib, "file_digest") else _hashed(opened)


def read_index(data: Path) -> Iterator[ClipRecord]:
    """The records of a data folder, in the order of its index; a later line about a clip stands beside the earlier.

    Raises:
        InvalidInputError: there is no index, or a line of it is none of ours.
    """
    place = index_file(data)
    if not place.is_file():
        raise InvalidInputError(f"data must be a folder that physanimator dataset made. Got: no {place.name} in {data}")
    with place.open("rb") as lines:
        for number in range(1, _MOST_CLIPS + 1):
            line = lines.readline(_LONGEST_LINE)
            if not line:
                return
            if line.strip():
                yield _record(line, f"{place}, line {number}")


def kept_clips(data: Path) -> list[ClipRecord]:
    """The clips to train on, by their names; of several lines about one clip the last counts.

    Raises:
        InvalidInputError: see :func:`read_index`; or no clip is kept.
    """
    newest = {record.name: record for record in read_index(data)}
    found = [newest[name] for name in sorted(newest) if newest[name].kept]
    if not found:
        raise InvalidInputError(f"data must have clips that are kept. Got: none in {index_file(data)}")
    return found


def _record(line: bytes, where: str) -> ClipRecord:
    try:
        told = json.loads(line)
    except (ValueError, RecursionError):
        raise InvalidInputError(f"{where} must be a JSON object on one line. Got: {line[:60]!r}") from None
    if not isinstance(told, Mapping):
        raise InvalidInputError(f"{where} must be a JSON object. Got: {type(told).__name__}")
    kinds = {field.name: str(field.type) for field in fields(ClipRecord)}
    values: dict[str, Any] = {}
    for name, kind in kinds.items():
        if name not in told:
            if name in ("why", "sketches", "licence"):
                continue
            raise InvalidInputError(f"{where} must tell {name}. Got: {', '.join(map(str, told))[:80]}")
        values[name] = _value(told[name], kind, f"{where}: {name}")
    _check_name(values["name"], where)
    return ClipRecord(**values)


def _value(value: Any, kind: str, where: str) -> Any:
    fits = {
        "str": isinstance(value, str),
        "bool": isinstance(value, bool),
        "float": within(value, -_LARGEST_NUMBER, _LARGEST_NUMBER),
        "int": is_whole(value, 0, _LARGEST_NUMBER),
    }[kind]
    if not fits:
        raise InvalidInputError(f"{where} must be a value of kind {kind}. Got: {value!r:.60}")
    return {"float": float, "int": int}.get(kind, lambda same: same)(value)


def _check_name(name: str, where: str) -> None:
    """A name must not lead out of the folder."""
    if not name or name[0] == "." or set(name) & _FORBIDDEN or any(ord(each) < 32 for each in name):
        raise InvalidInputError(f"{where} must have a name that is a file's. Got: {name!r:.60}")


def _hashed(opened: Any) -> str:
    digest = hashlib.sha256()
    while block := opened.read(1 << 20):
        digest.update(block)
    return digest.hexdigest()
