"""Results that are text: checked before the work, and written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from ..physics.errors import InvalidInputError
from .atomic import replacing

__all__ = ["check_text_output", "write_text"]

StrPath = str | os.PathLike[str]


def check_text_output(path: StrPath, suffix: str) -> None:
    """Refuse a place that :func:`write_text` could not write to, before any long work.

    Args:
        path: where the file is to be.
        suffix: how its name must end, such as ``.json``.

    Raises:
        InvalidInputError: the name ends otherwise, or the folder does not exist.
    """
    target = Path(path)
    if target.suffix.lower() != suffix:
        raise InvalidInputError(f"the name must end in {suffix}. Got: {path}")
    if target.is_dir():
        raise InvalidInputError(f"{path} must be a file. Got: a folder of that name")
    if not target.parent.is_dir():
        raise InvalidInputError(f"the folder for {path} must exist. Got: no folder {target.parent}")


def write_text(path: StrPath, text: str) -> None:
    """Write a text as UTF-8; an earlier file is replaced only by a complete one.

    Args:
        path: where to; the folder must exist.
        text: the whole text.

    Raises:
        InvalidInputError: the file cannot be replaced.
    """
    with replacing(Path(path)) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
