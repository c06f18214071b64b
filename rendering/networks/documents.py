"""JSON documents that lie beside weights."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ...physics.errors import InvalidInputError
from ..files import check_regular

__all__ = ["read_document"]


def read_document(file: Path, *, wanted: str, most: int) -> dict[str, Any]:
    """A JSON object beside weights, such as a configuration.

    Args:
        file: the document.
        wanted: what is wanted in its place, for the message.
        most: how large it may be [bytes].

    Raises:
        CheckpointError: it is missing, too large, or no such thing.
    """
    from .checkpoints import CheckpointError

    try:
        check_regular(file, file.name)
        if file.stat().st_size > most:
            raise ValueError
        found = json.loads(file.read_text(encoding="utf-8"))
        if not isinstance(found, dict):
            raise TypeError
    except (InvalidInputError, OSError, ValueError, TypeError, RecursionError) as error:
        raise CheckpointError(f"{file} is missing or cannot be read. Wanted: {wanted}") from error
    return found
