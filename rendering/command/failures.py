"""What an error that ends a command means for whoever gave it: a sentence, and an exit status."""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.errors import PhysAnimatorError
from ..files import is_full

__all__ = ["BAD_INPUT", "FAILED", "Failure", "failure_of"]

FAILED = 1
BAD_INPUT = 2


@dataclass(frozen=True)
class Failure:
    """How a command failed.

    Attributes:
        status: its exit status.
        message: why.
        full: whether the disk takes no more, so that the next would fail as well.
    """

    status: int
    message: str
    full: bool = False


def failure_of(error: Exception) -> Failure | None:
    """What is said of an error; None for one that is a fault of ours."""
    if isinstance(error, PhysAnimatorError):
        return Failure(BAD_INPUT, str(error))
    if isinstance(error, OSError):
        where = "" if error.filename is None else f"{error.filename}: "
        return Failure(FAILED, f"{where}{error.strerror or error}", is_full(error))
    if isinstance(error, MemoryError):
        return Failure(FAILED, "the memory does not suffice for a picture of this size")
    return None
