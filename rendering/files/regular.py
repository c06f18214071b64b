"""Inputs that can be read to their end: a pipe or a device may wait for ever, or never end."""

from __future__ import annotations

import os
import stat

from ...physics.errors import InvalidInputError

__all__ = ["check_regular"]

StrPath = str | os.PathLike[str]

_KINDS = (
    (stat.S_ISFIFO, "a named pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def check_regular(path: StrPath, name: str) -> None:
    """Refuse pipes, sockets and devices, which opening or reading would wait for.

    What the process was given open, such as its standard input or ``<(...)`` of a shell, has a writer and may be read.
    What does not exist, and folders, are left to whoever opens them.

    Args:
        path: of an input.
        name: what the user calls it.

    Raises:
        InvalidInputError: it is none of a file, a folder and nothing.
    """
    try:
        status = os.stat(path)
    except (OSError, ValueError):
        return
    kind = next((each for is_kind, each in _KINDS if is_kind(status.st_mode)), None)
    if kind is not None and not _is_open_here(status):
        raise InvalidInputError(f"{name} must be a file. Got: {os.fspath(path)}, which is {kind}")


def _is_open_here(status: os.stat_result) -> bool:
    """Whether one of the process's descriptors is this."""
    try:
        numbers = [int(each) for each in os.listdir("/dev/fd") if each.isdigit()]
    except OSError:  # not on Windows
        return False
    for number in numbers:
        try:
            own = os.fstat(number)
        except OSError:  # that of the listing itself
            continue
        if (own.st_dev, own.st_ino) == (status.st_dev, status.st_ino):
            return True
    return False
