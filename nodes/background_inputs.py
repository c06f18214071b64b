"""Inputs for what is shown where nothing moves, and for pictures with transparency and of few pixels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from .host import chosen

if TYPE_CHECKING:
    from ..rendering.composite import Background

__all__ = ["background_chosen", "background_inputs", "image_alpha_input"]

_CHOICES = ("picture", "transparent", "parts", "colour")


def background_inputs() -> list[Any]:
    """The optional inputs background, image_alpha and pixel_art."""
    colour = io.String.Input("colour", default="white", tooltip="A CSS name such as skyblue, #rgb or #rrggbb.")
    return [
        io.DynamicCombo.Input(
            "background",
            options=[io.DynamicCombo.Option(name, [colour] if name == "colour" else []) for name in _CHOICES],
            optional=True,
            tooltip="What frames show where nothing moves. picture: all of the picture, opaque; its transparent places"
            " white. colour: the same on a colour. transparent: all of the picture with its own transparency; of an"
            " opaque picture the moving parts alone. parts: the moving parts alone. With transparent and parts, frames"
            " have an alpha channel, which Save Image and Save Animated WEBP write and Create Video does not take.",
        ),
        image_alpha_input(),
        io.Boolean.Input(
            "pixel_art",
            default=False,
            optional=True,
            tooltip="Move whole pixels (or blocks, where each pixel of the art is one) and mix no colours.",
        ),
    ]


def image_alpha_input() -> Any:
    """The optional input image_alpha, for a node whose input image may have lost its transparency."""
    return io.Mask.Input(
        "image_alpha",
        optional=True,
        tooltip="White where the illustration is transparent: the mask of Load Image, whose picture has lost its"
        " alpha. Not needed for pictures of four channels.",
    )


def background_chosen(choice: dict[str, Any] | None) -> Background:
    """The background that a node was given; the picture's when nothing was said.

    Raises:
        InvalidInputError: the choice or the colour is unknown.
    """
    from ..rendering.composite import background_of

    if choice is None:
        return background_of("picture")
    name, values = chosen(choice, "background", _CHOICES)
    return background_of(str(values.get("colour") or "white") if name == "colour" else name)
