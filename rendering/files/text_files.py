"""Results that are text: checked before the work, and written whole or not at all."""

from __future__ import annotations

import os
import sys
from collections.abc import Collection
from pathlib import Path
from typing import Any

from ...physics.errors import InvalidInputError
from ...physics.limits import MAX_DOCUMENT_BYTES
from .atomic import replacing
from .path_names import StrPath, suffix_of
from .places import check_file_place
from .regular import check_regular

__all__ = ["check_text_output", "parsed_toml", "read_text_file", "write_text"]


def check_text_output(path: StrPath, suffix: str, *, coming: Collection[Path] = ()) -> None:
    """Refuse a place that :func:`write_text` could not write to, before any long work.

    Args:
        path: where the file is to be.
        suffix: how its name must end, such as ``.json``.
        coming: see :func:`~physanimator.rendering.files.check_file_place`.

    Raises:
        InvalidInputError: the name ends otherwise, or nothing can be written there; see
            :func:`~physanimator.rendering.files.check_file_place`.
    """
    if suffix_of(path) != suffix:
        raise InvalidInputError(f"the name must end in {suffix}. Got: {path}")
    check_file_place(path, coming=coming)


def write_text(path: StrPath, text: str) -> None:
    """Write a text as UTF-8; an earlier file is replaced only by a complete one.

    Args:
        path: where to; the folder must exist.
        text: the whole text.

    Raises:
        InvalidInputError: the file cannot be replaced.
        OSError: the disk is full.
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def read_text_file(path: StrPath, name: str, *, most: int = MAX_DOCUMENT_BYTES) -> str:
    """The text of a file, in UTF-8 or, with a mark at its start, UTF-16.

    Args:
        path: the file.
        name: what the user calls it.
        most: how large it may be [bytes].

    Raises:
        InvalidInputError: it cannot be read, is too large, or no text.
    """
    check_regular(path, name)
    try:
        with Path(path).open("rb") as file:
            content = file.read(most + 1)
        # Windows writes what is piped into a file as UTF-16, with a mark at its start.
        text = content.decode("utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not text in UTF-8"
        raise InvalidInputError(f"{name} must be a readable text file. Got: {os.fspath(path)}: {reason}") from None
    if len(content) > most:
        raise InvalidInputError(f"{name} {os.fspath(path)} must be at most {most >> 20} MB of text. Got: more")
    return text


def parsed_toml(text: str, path: StrPath, name: str) -> dict[str, Any]:
    """What a TOML file says.

    Args:
        text: of the file.
        path: the file, for the message.
        name: what the user calls it.

    Raises:
        InvalidInputError: it is no TOML.
    """
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # among them numbers of thousands of digits
        raise InvalidInputError(f"{name} {os.fspath(path)} must be TOML. Got: {error}") from None
