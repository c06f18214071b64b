"""Results appear whole or not at all: they are written beside their place and moved there at the end."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..physics.errors import InvalidInputError

__all__ = ["replacing"]


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """A temporary path in the same folder that becomes ``path`` when the block ends without an error.

    An interrupted or failed block leaves an earlier file at ``path`` as it was, and nothing half done beside it.

    Args:
        path: where the result belongs.

    Yields:
        The path to write to, with the same suffix; the block creates a file or a folder there.

    Raises:
        InvalidInputError: the result cannot be moved to its place, for example because another program holds it.
    """
    temporary = path.with_name(f".{path.stem}.{secrets.token_hex(4)}{path.suffix}")
    try:
        yield temporary
        try:
            os.replace(temporary, path)
        except OSError as error:
            raise InvalidInputError(f"cannot write {path}: {error.strerror}; is it open in another program?") from error
    finally:
        if temporary.is_dir():
            shutil.rmtree(temporary)
        else:
            temporary.unlink(missing_ok=True)
