"""Results that are text: checked before the work, and written whole or not at all."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from ...physics.errors import InvalidInputError
from .atomic import replacing
from .path_names import StrPath, suffix_of
from .places import check_file_place

__all__ = ["check_text_output", "write_text"]


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
