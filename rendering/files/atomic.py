"""Results appear whole or not at all: they are written beside their place and moved there at the end."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ...physics.errors import InvalidInputError, PhysAnimatorError
from .path_names import StrPath
from .places import check_replaceable
from .signals import uninterrupted
from .unfinished import made_beside

__all__ = ["is_full", "naming_place", "putting_in_place", "replacing"]

_FULL = {getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EROFS") if hasattr(errno, name)}
_OF_THE_DISK = {getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EFBIG", "EIO", "EROFS") if hasattr(errno, name)}


@contextmanager
def replacing(path: StrPath) -> Iterator[Path]:
    """An empty temporary file in the same folder that becomes ``path`` when the block ends without an error.

    An interrupted or failed block leaves an earlier file at ``path`` as it was, and nothing half done beside it. Where
    ``path`` is a link, the file that it leads to is replaced. The temporary name is absolute and no longer than the
    final one, so it need not have the same suffix.

    Args:
        path: where the result belongs.

    Yields:
        The file to write to.

    Raises:
        InvalidInputError: there is no such place (see :func:`~physanimator.rendering.files.check_replaceable`), or the
            result cannot be moved there, for example because another program holds it.
        OSError: the disk is full or the like; it names ``path``.
    """
    place = check_replaceable(path)
    with naming_place(path), made_beside(place.name, place.parent) as temporary:
        yield temporary
        with uninterrupted(), putting_in_place(path):
            with suppress(FileNotFoundError):
                os.chmod(temporary, stat.S_IMODE(place.stat().st_mode))
            os.replace(temporary, place)


@contextmanager
def putting_in_place(path: StrPath) -> Iterator[None]:
    """Say in a sentence why a complete result cannot be moved to its place.

    Raises:
        InvalidInputError: another program holds what is there, or the like.
    """
    try:
        yield
    except OSError as error:
        if error.errno in _OF_THE_DISK:
            raise
        raise InvalidInputError(f"cannot write {path}: {error.strerror}; is it open in another program?") from error


@contextmanager
def naming_place(path: StrPath) -> Iterator[None]:
    """Let errors of the disk name the result, not the file under work.

    Libraries that write files by themselves, such as OpenEXR, raise errors of their own kinds, in whose texts the
    system's stand.
    """
    try:
        yield
    except Exception as error:
        number = error.errno if isinstance(error, OSError) else _number_in(error)
        if number is None or number not in _OF_THE_DISK:
            raise
        raise OSError(number, os.strerror(number), str(path)) from error


def _number_in(error: Exception) -> int | None:
    """The number of the error of the disk that an error's text tells of."""
    if isinstance(error, PhysAnimatorError):
        return None
    return next((number for number in _OF_THE_DISK if os.strerror(number) in str(error)), None)


def is_full(error: BaseException) -> bool:
    """Whether an error says that a disk takes no more, so that the next result would fail as well."""
    return isinstance(error, OSError) and error.errno in _FULL
