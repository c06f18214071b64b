"""Names of files and folders: what they say, and which a system can write."""

from __future__ import annotations

import ntpath
import os
import unicodedata
from pathlib import Path

from ...physics.errors import InvalidInputError

__all__ = ["StrPath", "check_windows_name", "is_folder_name", "plain_name", "same_name", "spelled", "suffix_of"]

StrPath = str | os.PathLike[str]
_RESERVED = {"CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$"} | {
    f"{port}{n}" for port in ("COM", "LPT") for n in "123456789¹²³"
}
_FORBIDDEN = '<>:"|?*'

_LONGEST = 80  # letters of a name that go into a file's
_MOST_BYTES = 200  # of them; file systems take 255, a number and an ending among them


def is_folder_name(path: StrPath) -> bool:
    """Whether a name is that of a folder: it ends in a slash."""
    return spelled(path).endswith(("/", os.sep))


def plain_name(name: str, *, or_else: str) -> str:
    """A name as a part of a file's that any system can write, without an ending.

    Args:
        name: such as a layer's.
        or_else: what stands for a name of which nothing is left.
    """
    kept = "".join("_" if each in '<>:"/\\|?*' or not each.isprintable() else each for each in name)[:_LONGEST]
    kept = kept.encode("utf-8", "ignore")[:_MOST_BYTES].decode("utf-8", "ignore").strip(" .") or or_else
    return f"{kept}_" if kept.partition(".")[0].rstrip().upper() in _RESERVED else kept


def suffix_of(path: StrPath) -> str:
    """The ending of a name in small letters, such as ``.mp4``.

    Raises:
        InvalidInputError: it cannot be a name on this system.
    """
    return Path(spelled(path)).suffix.lower()


def spelled(path: StrPath) -> str:
    """A path as text that the system can take.

    Raises:
        InvalidInputError: it cannot be a name on this system.
    """
    try:
        given = os.fspath(path)
    except TypeError:
        raise InvalidInputError(f"output must be a path. Got: {type(path).__name__}") from None
    if not isinstance(given, str):
        raise InvalidInputError(f"output must be a path as text. Got: {type(given).__name__}")
    if not given:
        raise InvalidInputError("output must be a name. Got: nothing")
    try:
        possible = "\0" not in given and bool(os.fsencode(given))
    except UnicodeEncodeError:
        possible = False
    if not possible:
        raise InvalidInputError(f"output must be a name that this system can write. Got: {given}")
    if os.name == "nt":
        check_windows_name(given)
    return given


def check_windows_name(path: str) -> None:
    """Refuse names that Windows gives another meaning: devices, streams, and ends that it drops.

    Raises:
        InvalidInputError: the last part of the path is such a name.
    """
    name = ntpath.basename(ntpath.splitdrive(path)[1].rstrip("\\/"))
    if name in ("", ".", ".."):
        return
    device = name.split(".")[0].rstrip(" ").upper() in _RESERVED
    if device or name[-1] in ". " or any(each in _FORBIDDEN or ord(each) < 32 for each in name):
        raise InvalidInputError(f"output must be a name that Windows can write. Got: {path}")


def same_name(first: str, second: str) -> bool:
    """Whether two names are one on systems that tell neither case nor ways to write an accent apart."""
    return _folded(first) == _folded(second)


def _folded(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()
