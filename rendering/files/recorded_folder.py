"""A folder whose files are known again by a record: only those that the record knows, unchanged, are ever replaced."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ...physics.errors import InvalidInputError
from .atomic import naming_place, putting_in_place
from .path_names import StrPath
from .places import check_folder_place, check_replaceable, is_read_only, place_of
from .record import Record, WrittenFile, read_record, recorded, write_record
from .signals import uninterrupted
from .unfinished import made_beside

__all__ = ["RecordedFiles", "check_recorded_folder", "write_recorded_folder"]


@dataclass(frozen=True)
class RecordedFiles:
    """Files of one kind in a folder.

    Attributes:
        kind: as the record calls them, such as frames.
        record: name of the record; hidden, where a leading dot hides.
        refusal: what the folder must hold of them, as an error says it.
        present: names of all files of a folder that are named as these are, whoever wrote them; with slashes.
    """

    kind: str
    record: str
    refusal: str
    present: Callable[[Path], Sequence[str]]


def check_recorded_folder(path: StrPath, files: RecordedFiles, *, coming: Collection[Path] = ()) -> Path:
    """Refuse a folder that could not be written, or holds files that :func:`write_recorded_folder` did not write.

    Args:
        path: the folder, which need not exist yet.
        files: which of its files count.
        coming: see :func:`~physanimator.rendering.files.check_file_place`.

    Returns:
        Where it really comes to lie.

    Raises:
        InvalidInputError: see above.
    """
    place = check_folder_place(path, coming=coming)
    if os.path.isdir(place):
        _record_of(place, files, path)
        check_replaceable(place / files.record)
    return place


def write_recorded_folder(path: StrPath, files: RecordedFiles, write: Callable[[Path], Iterable[str]]) -> None:
    """Write files that appear, while earlier ones go, when all are complete.

    Args:
        path: the folder, which is made if it does not exist.
        files: which of its files count.
        write: writes into an empty folder and gives the names of what it has written.

    Raises:
        InvalidInputError: see :func:`check_recorded_folder`.
        OSError: the disk is full or the like; it names ``path``.
    """
    place = place_of(path)
    inside = os.path.isdir(place)
    name, parent = (f".{files.kind}", place) if inside else (place.name, place.parent)
    with naming_place(path), made_beside(name, parent, is_folder=True) as staging:
        record = [recorded(staging, each) for each in write(staging)]
        write_record(staging / files.record, files.kind, record)
        with uninterrupted(), putting_in_place(path):
            if inside:
                _exchange(place, staging, files, record, path)
            else:
                staging.rename(place)


def _record_of(folder: Path, files: RecordedFiles, path: StrPath) -> Record:
    """What the record says of the files in a folder, all of which it must know.

    Raises:
        InvalidInputError: it does not.
    """
    record = read_record(folder / files.record, files.kind)
    if record is None:
        raise InvalidInputError(
            f"folder {path} must have a readable record of its {files.kind}. Got: a damaged {files.record}; choose"
            " another folder"
        )
    known: dict[str, list[WrittenFile]] = {}
    for each in record:
        known.setdefault(each.name, []).append(each)
    for name in files.present(folder):
        described = any(each.describes(folder, name) for each in known.get(name, ()))
        if described and not is_read_only((folder / name).stat()):
            continue
        changed = "is read-only" if described else "was changed after it was written"
        reason = changed if name in known else "PhysAnimator did not write"
        raise InvalidInputError(
            f"folder {path} must hold {files.refusal}. Got: {name}, which {reason}; choose another folder"
        )
    return record


def _exchange(folder: Path, staging: Path, files: RecordedFiles, record: Record, path: StrPath) -> None:
    """Take the earlier files away, then put the new ones in their place: never both are there.

    While this lasts the record knows both, so that the files are known again should the machine stop in the middle.
    An error puts everything back.
    """
    place = folder / files.record
    present = files.present(folder)
    earlier = _record_of(folder, files, path)
    aside = staging / "earlier"
    aside.mkdir()
    write_record(place, files.kind, [*earlier, *record])
    moved: list[tuple[Path, Path]] = []

    def move(source: Path, target: Path) -> None:
        if os.path.lexists(target):
            raise FileExistsError(errno.EEXIST, f"{target.name} has appeared meanwhile")
        target.parent.mkdir(parents=True, exist_ok=True)
        source.rename(target)
        moved.append((source, target))

    try:
        for name in present:
            move(folder / name, aside / name)
        for each in record:
            move(staging / each.name, folder / each.name)
        write_record(place, files.kind, record)
    except BaseException:
        _put_back(place, files, moved, earlier)
        raise


def _put_back(place: Path, files: RecordedFiles, moved: Sequence[tuple[Path, Path]], earlier: Record) -> None:
    for source, target in reversed(moved):
        target.rename(source)
    if earlier:
        write_record(place, files.kind, earlier)
    else:
        place.unlink()
