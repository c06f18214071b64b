"""The errors that PhysAnimator raises on purpose: one tree, each a sentence that a person can act on."""

from __future__ import annotations

__all__ = [
    "Cancelled",
    "InvalidInputError",
    "MeshingError",
    "PhysAnimatorError",
    "SceneError",
    "SimulationError",
    "require",
]


class PhysAnimatorError(Exception):
    """Base of every error that this package raises on purpose."""


class InvalidInputError(PhysAnimatorError, ValueError):
    """An input value is unusable; the message names what was expected and what was got."""


class MeshingError(InvalidInputError):
    """A mask cannot become a mesh."""


class SceneError(InvalidInputError):
    """A scene document is wrong.

    Attributes:
        path: where the wrong value stands, such as ``strokes[2].radius``; empty for the document itself.
    """

    def __init__(self, path: str, message: str) -> None:
        super().__init__(f"{path}: {message}" if path else message)
        self.path = path


class SimulationError(InvalidInputError):
    """A scene cannot be simulated in reasonable work; the message gives the reason and the remedy."""


class Cancelled(PhysAnimatorError):
    """The caller asked to stop; nothing went wrong."""


def require(name: str, got: object, holds: bool, expected: str) -> None:
    """Raise unless a value holds: the one wording for a bad value.

    Args:
        name: what the user calls the value.
        got: the value.
        holds: whether it is usable.
        expected: what would be, to stand after "must be".

    Raises:
        InvalidInputError: ``holds`` is false.
    """
    if not holds:
        raise InvalidInputError(f"{name} must be {expected}. Got: {got}")
