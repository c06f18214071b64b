"""What can be said of the wanted frames before anything is simulated: one place for library, command line and nodes."""

from __future__ import annotations

import numbers
from typing import Any

from numpy.typing import NDArray

from ..physics.errors import InvalidInputError, require

__all__ = ["check_count", "check_drawing", "height_at"]


def check_count(name: str, value: object, *, least: int = 1, unit: str = "frame") -> None:
    """Refuse what is no whole number, or too small.

    Args:
        name: what the caller calls the value.
        value: the number.
        least: the smallest that makes sense.
        unit: what is counted.

    Raises:
        InvalidInputError: the message names the value.
    """
    whole = isinstance(value, numbers.Integral) and type(value) is not bool
    expected = f"at least {least} {unit}" if whole else "a whole number"
    require(name, value, whole and int(value) >= least, expected)  # type: ignore[call-overload]


def check_drawing(
    *,
    transparent: bool = False,
    every: int = 1,
    pixel_art: bool = False,
    in_betweens: bool = False,
    by_model: bool = False,
) -> None:
    """Refuse ways to draw frames that do not go together.

    Args:
        transparent: frames have an alpha channel.
        every: draw each so many-th frame anew and fill in the others.
        pixel_art: pixels are moved whole, and no colours mixed.
        in_betweens: frames are filled in, whatever ``every`` is.
        by_model: a model draws the frames, or paints in them.

    Raises:
        InvalidInputError: ``every`` is no number of frames, or in-betweens or a model are asked for together with
            transparency or with pixel art.
    """
    check_count("every", every)
    if by_model and (pixel_art or transparent):
        got = "pixel art" if pixel_art else "transparency"
        raise InvalidInputError(f"frames that a model draws must be opaque, and no pixel art. Got: {got}")
    if every == 1 and not in_betweens:
        return
    if pixel_art:
        raise InvalidInputError("frames of pixel art must be drawn one by one. Got: in-betweens as well")
    if transparent:
        raise InvalidInputError(
            "transparent frames must be drawn one by one; leave in-betweens out or choose an opaque background."
            " Got: in-betweens as well"
        )


def height_at(picture: NDArray[Any], width: int) -> int:
    """Height of a picture that is brought to a width [px].

    Args:
        picture: shape [h, w] or [h, w, c].
        width: of the result [px].

    Raises:
        InvalidInputError: ``width`` is no number of pixels.
    """
    check_count("width", width, unit="px")
    return max(1, round(picture.shape[0] * width / picture.shape[1]))
