"""What is written where nothing moves: one rule for the command line, the library and the nodes.

- ``picture``: the whole picture, opaque; where it is transparent, white shows.
- a colour (a CSS name, #rgb or #rrggbb): the whole picture, opaque; where it is transparent, that colour shows.
- ``transparent``: the whole picture with its own transparency, moving parts and all. A picture without any
  transparency shows its moving parts alone.
- ``parts``: the moving parts alone, on transparency.

Unless something is said, a picture with transparency keeps it wherever the file can hold it.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require
from ..pictures import WHITE, Colour, as_float, is_transparent, over

if TYPE_CHECKING:
    from ...physics.motion import Motion
    from .layered_renderer import LayeredRenderer
    from .pixel_art import PixelArtRenderer

__all__ = [
    "Background",
    "background_of",
    "renderer_of",
    "shown_frame",
    "shown_frame_and_alpha",
    "usual_background",
]

Image = NDArray[Any]


@dataclass(frozen=True)
class Background:
    """What is written where nothing moves.

    Attributes:
        kind: "picture", "transparent" or "parts".
        colour: what shows through a picture's transparent places when the kind is "picture", 0 to 255.
    """

    kind: Literal["picture", "transparent", "parts"] = "picture"
    colour: Colour = WHITE

    @property
    def has_alpha(self) -> bool:
        """Whether frames have an alpha channel."""
        return self.kind != "picture"


def background_of(text: str, *, others: Sequence[str] = ()) -> Background:
    """A background by its name or colour.

    Args:
        text: picture, transparent, parts, or a colour as CSS writes it: a name, #rgb or #rrggbb.
        others: what else the caller takes, for the message.

    Raises:
        InvalidInputError: it is none of these.

    Examples:
        >>> from physanimator.rendering.composite import background_of
        >>> background_of("transparent").kind, background_of("#ff0000").colour
        ('transparent', (255, 0, 0))
    """
    from PIL import ImageColor

    name = text.strip().lower()
    if name in ("picture", "transparent", "parts"):
        return Background(name)  # type: ignore[arg-type]
    colour: tuple[int, ...] = ()
    with suppress(ValueError):
        colour = ImageColor.getrgb(name)
    known = f"{', '.join(('picture', 'transparent', 'parts', *others))}, or a colour such as white, #8cf or #87ceeb"
    held = len(colour) == 3 and all(0 <= level <= 255 for level in colour)
    require("background", repr(text[:60]), held, known)
    return Background("picture", (colour[0], colour[1], colour[2]))


def usual_background(*, transparent_picture: bool, file_has_alpha: bool, parts: bool = False) -> Background:
    """The background when nothing is said.

    Args:
        transparent_picture: the illustration has transparent places.
        file_has_alpha: what is written can hold transparency.
        parts: a picture without transparency shows its moving parts alone.
    """
    if not file_has_alpha:
        return Background()
    if transparent_picture:
        return Background("transparent")
    return Background("parts" if parts else "picture")


def renderer_of(
    image: Image,
    masks: Sequence[Image],
    motion: Motion,
    *,
    plate: Image | None = None,
    pixel_art: bool = False,
    in_front: Image | None = None,
) -> LayeredRenderer | PixelArtRenderer:
    """What draws a motion of an illustration.

    Args:
        image: RGB or straight RGBA, uint8 or float32 in 0 to 1.
        masks: one for each body of the motion.
        motion: of the bodies.
        plate: what is behind all bodies, of the image's dtype; its transparency is dropped where the image has none.
        pixel_art: see :class:`pixel_art.PixelArtRenderer`.
        in_front: mask of what stands still in front of all bodies; not with ``pixel_art``.

    Raises:
        InvalidInputError: these do not fit together.
    """
    if plate is not None and not is_transparent(image):
        plate = over(plate)
    if pixel_art:
        from .pixel_art import PixelArtRenderer

        require("in_front", "a mask", in_front is None, "left out with pixel_art")
        return PixelArtRenderer(image, masks, motion, plate=plate)
    from .layered_renderer import LayeredRenderer

    return LayeredRenderer(image, masks, motion, plate=plate, in_front=in_front)


def shown_frame(renderer: LayeredRenderer | PixelArtRenderer, t: int, background: Background) -> Image:
    """Frame ``t`` over a background: RGB, or straight RGBA where it has alpha, dtype of the illustration.

    Raises:
        InvalidInputError: there is no such frame.
    """
    if background.kind == "parts" or (background.kind == "transparent" and not is_transparent(renderer.plate)):
        return renderer.cutout(t)
    frame = renderer.frame(t)
    return over(frame, background.colour) if background.kind == "picture" else frame


def shown_frame_and_alpha(
    renderer: LayeredRenderer | PixelArtRenderer, t: int, background: Background
) -> tuple[Image, NDArray[np.float32]]:
    """``shown_frame``, and its alpha in 0 to 1, shape [h, w]; of an opaque frame where moving parts are.

    Raises:
        InvalidInputError: there is no such frame.
    """
    if background.has_alpha:
        frame = shown_frame(renderer, t, background)
        return frame, as_float(frame[..., 3])
    frame, alpha = renderer.frame_and_alpha(t)
    return over(frame, background.colour), alpha
