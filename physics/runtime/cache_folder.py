"""Where compiled kernels are kept from one process to the next.

Taichi makes its folder when its program ends, even if it shall keep nothing there, and where it cannot it ends the
process. So the folder is chosen here, and is there before Taichi begins. What lies in it is run as code: nobody else
may be able to write into it.
"""

from __future__ import annotations

import os
import stat
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

__all__ = ["KernelCache", "kernel_cache"]

_LOCK = "ticache.lock"
_LOCKED_FOR = 60.0  # [s]: Taichi holds its lock for far less, unless its process was killed meanwhile
_OTHERS_WRITE = stat.S_IWGRP | stat.S_IWOTH


class KernelCache(NamedTuple):
    """A folder that is there.

    Attributes:
        folder: where; an absolute path.
        usable: whether kernels can be kept in it.
    """

    folder: str
    usable: bool


def kernel_cache() -> KernelCache:
    """The folder named by ``TI_OFFLINE_CACHE_FILE_PATH``, else one of the user's own, else one of the temporary files.

    Where none can be written, a folder that is there, in which nothing is to be kept.
    """
    wanted = os.environ.get("TI_OFFLINE_CACHE_FILE_PATH")
    if wanted and _can_be_named(wanted) and _is_made(Path(wanted)) and _takes_files(Path(wanted)):
        return _unlocked(Path(os.path.abspath(wanted)))
    for folder in _own_folders():
        if _can_be_named(str(folder)) and _is_private(folder) and _takes_files(folder):
            return _unlocked(folder)
    return KernelCache(os.path.abspath(os.sep), usable=False)


def _own_folders() -> Iterator[Path]:
    home = _cache_home()
    if home is not None and _may_begin(home):
        yield home / "physanimator" / "taichi"
    try:
        temporary = Path(tempfile.gettempdir())
    except OSError:  # there is none
        return
    if temporary != Path.cwd():  # what Python takes where it finds none
        user = f"-{os.geteuid()}" if hasattr(os, "geteuid") else ""
        yield temporary / f"physanimator{user}"


def _cache_home() -> Path | None:
    """Where programs keep what they can make again, for this user; None where that is nowhere."""
    if sys.platform == "win32":
        given = os.environ.get("LOCALAPPDATA", "")
    else:
        home = os.path.expanduser("~")
        usual = os.path.join(home, "Library", "Caches") if sys.platform == "darwin" else os.path.join(home, ".cache")
        given = os.environ.get("XDG_CACHE_HOME", "")
        given = given if os.path.isabs(given) else usual
    return Path(given) if os.path.isabs(given) else None


def _may_begin(home: Path) -> bool:
    """Whether root, who may write everywhere, would not leave files in another user's home."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        return True
    for folder in (home, *home.parents):
        with suppress(OSError):
            return folder.stat().st_uid == 0
    return False


def _can_be_named(folder: str) -> bool:
    """Taichi takes UTF-8, which Windows reads as something else."""
    try:
        folder.encode("ascii" if sys.platform == "win32" else "utf-8")
    except UnicodeEncodeError:
        return False
    return "\0" not in folder


def _is_made(folder: Path) -> bool:
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except (OSError, ValueError):
        return False
    return True


def _is_private(folder: Path) -> bool:
    """Whether a folder is there, no link, and nobody else can write into it."""
    if not _is_made(folder):
        return False
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode):
        return False
    return not hasattr(os, "geteuid") or (found.st_uid == os.geteuid() and not found.st_mode & _OTHERS_WRITE)


def _takes_files(folder: Path) -> bool:
    try:
        with tempfile.TemporaryFile(dir=folder):
            return True
    except (OSError, ValueError):
        return False


def _unlocked(folder: Path) -> KernelCache:
    """The folder without a lock that a killed process has left there, for which Taichi would keep nothing any more."""
    lock = folder / _LOCK
    with suppress(OSError):
        if time.time() - lock.stat().st_mtime > _LOCKED_FOR:
            lock.unlink()
    return KernelCache(str(folder), usable=os.environ.get("TI_OFFLINE_CACHE") != "0")
