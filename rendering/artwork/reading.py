"""Layered files are read without trust: whatever is wrong with one is said in a sentence."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from ...physics.errors import InvalidInputError, PhysAnimatorError
from ..files import check_regular
from .limits import MAX_FILE_BYTES

__all__ = ["reading"]

StrPath = str | os.PathLike[str]


@contextmanager
def reading(path: StrPath, name: str) -> Iterator[None]:
    """Say in a sentence whatever is wrong with a file.

    Args:
        path: of the file or folder.
        name: what the user calls it.

    Raises:
        InvalidInputError: it cannot be read.
    """
    check_regular(path, "artwork")
    try:
        if os.stat(path).st_size > MAX_FILE_BYTES:
            raise InvalidInputError(f"{name} must have at most {MAX_FILE_BYTES / 2**30:.0f} GiB. Got: more")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (PhysAnimatorError, MemoryError):
        raise
    except FileNotFoundError:
        raise InvalidInputError(f"artwork must be an existing file. Got: {path}") from None
    except RecursionError as error:
        raise InvalidInputError(f"{name} cannot be read: it is nested too deeply") from error
    except OSError as error:
        if error.strerror is None:  # a reader's own, about what is in the file
            raise InvalidInputError(f"{name} cannot be read: it is damaged or cut off") from error
        raise InvalidInputError(f"artwork must be a readable file. Got: {path}: {error.strerror}") from None
    except Exception as error:  # a damaged file makes the readers raise nearly anything
        raise InvalidInputError(f"{name} cannot be read: it is damaged or cut off") from error
