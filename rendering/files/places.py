"""Places that can be written to: checked before the work, the same way for every kind of result."""

from __future__ import annotations

import os
import stat
from collections.abc import Collection
from pathlib import Path

from ...physics.errors import InvalidInputError
from .path_names import StrPath, spelled
from .unfinished import made_beside

__all__ = ["check_file_place", "check_folder_place", "check_replaceable", "is_read_only", "place_of"]


def place_of(path: StrPath) -> Path:
    """Where a result really comes to lie: links are followed, and stay as they are.

    Raises:
        InvalidInputError: it cannot be a name on this system.
    """
    given = spelled(path)
    place = Path(os.path.realpath(given))
    if os.path.islink(place):
        raise InvalidInputError(f"output {given} must lead to a file. Got: a link that leads in a circle")
    return place


def check_file_place(path: StrPath, *, coming: Collection[Path] = ()) -> Path:
    """Refuse a file that could not be written.

    Args:
        path: where the file is to be.
        coming: folders that are not there yet, but will be before the file is written; checked by
            :func:`check_folder_place`.

    Returns:
        Where it really comes to lie.

    Raises:
        InvalidInputError: see :func:`check_replaceable`; or the folder is read-only.
    """
    place = check_replaceable(path, coming=coming)
    _check_writable(_present(place.parent, coming), place.name, path)
    return place


def check_replaceable(path: StrPath, *, coming: Collection[Path] = ()) -> Path:
    """Refuse what can be seen to be wrong with a file's place, without trying to write there.

    Args:
        path: where the file is to be.
        coming: see :func:`check_file_place`.

    Returns:
        Where it really comes to lie.

    Raises:
        InvalidInputError: the name is impossible or too long, the folder is missing, or what is there is no file or
            must not be changed.
    """
    place = place_of(path)
    status = _status(place, path)
    if status is not None:
        _check_replaceable(place, status, path)
    _check_folder(_present(place.parent, coming), path)
    return place


def check_folder_place(path: StrPath, *, coming: Collection[Path] = ()) -> Path:
    """Refuse a folder that could be neither made nor filled.

    Args:
        path: where the folder is, or is to be.
        coming: see :func:`check_file_place`.

    Returns:
        Where it really comes to lie.

    Raises:
        InvalidInputError: see :func:`check_file_place`.
    """
    place = place_of(path)
    status = _status(place, path)
    if status is None:
        _check_folder(_present(place.parent, coming), path)
        _check_writable(_present(place.parent, coming), place.name, path)
    elif not stat.S_ISDIR(status.st_mode):
        raise InvalidInputError(f"output {path} must be a folder. Got: {_kind(status)}")
    else:
        _check_writable(place, "frame_0000.png", path)
    return place


def _present(folder: Path, coming: Collection[Path]) -> Path:
    """The folder itself, or, where it is only to come, the nearest one around it that is not."""
    while folder in coming and not os.path.isdir(folder):
        folder = folder.parent
    return folder


def _status(place: Path, given: StrPath) -> os.stat_result | None:
    """What is at a place; None where nothing is."""
    try:
        return place.stat()
    except (FileNotFoundError, NotADirectoryError):
        return None
    except OSError as error:
        raise InvalidInputError(f"output {given} must be a name that can be written. Got: {error.strerror}") from None


def _check_replaceable(place: Path, status: os.stat_result, given: StrPath) -> None:
    if not stat.S_ISREG(status.st_mode):
        raise InvalidInputError(f"output {given} must be a file. Got: {_kind(status)}")
    if is_read_only(status):
        raise InvalidInputError(f"output {given} must be a file that may be replaced. Got: a read-only file")
    try:
        os.close(os.open(place, os.O_WRONLY))
    except OSError as error:
        raise InvalidInputError(
            f"output {given} must be a file that may be replaced. Got: {error.strerror}; is it open in another program?"
        ) from None


def _check_folder(folder: Path, given: StrPath) -> None:
    if not os.path.isdir(folder):
        there = f"{folder}, which is no folder" if os.path.exists(folder) else f"no folder {folder}"
        raise InvalidInputError(f"the folder for {given} must exist. Got: {there}")


def _check_writable(folder: Path, name: str, given: StrPath) -> None:
    try:
        # Asking the system for permissions is not reliable on Windows and network drives; trying is.
        with made_beside(name, folder):
            pass
    except OSError as error:
        raise InvalidInputError(f"the folder for {given} must be writable. Got: {error.strerror}") from None


def _kind(status: os.stat_result) -> str:
    if stat.S_ISDIR(status.st_mode):
        return "a folder of that name"
    return "a file" if stat.S_ISREG(status.st_mode) else "a device or pipe"


def is_read_only(status: os.stat_result) -> bool:
    """Whether nobody may write to a file: an administrator could, but whoever set this wants it kept."""
    return not status.st_mode & 0o222
