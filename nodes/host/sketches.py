"""Line drawings that come into a node, from ours or from other packs' detectors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .messages import tell_user
from .tensors import picture_of, pictures_of

if TYPE_CHECKING:
    import torch
    from numpy.typing import NDArray

    from ...rendering.sketch import LineTones

__all__ = ["drawn_lines", "lines_of_frames", "sketch_lines_input", "told_of_light_lines"]

_TURNED = "{name}: light lines on dark were taken as dark lines on light."


def sketch_lines_input() -> Any:
    """The optional input sketch_lines."""
    from comfy_api.latest import io

    from ...rendering.sketch import LINE_TONES

    return io.Combo.Input(
        "sketch_lines",
        options=list(LINE_TONES),
        default=LINE_TONES[0],
        optional=True,
        tooltip="What the sketch is. dark on light: as Extract Sketch gives it, and as drawn by hand. light on dark: as"
        " edge and line detectors for ControlNet give it. automatic: light on dark where most of it is nearly black.",
    )


def drawn_lines(
    sketch: torch.Tensor, width: int, height: int, tones: LineTones, *, name: str = "sketch"
) -> NDArray[Any]:
    """A line drawing of the illustration's size, lines 0 and paper 1, shape [h, w].

    Raises:
        InvalidInputError: it is no single picture, or has other proportions than the illustration.
    """
    from ...rendering.sketch import dark_lines, sized_sketch

    drawing = picture_of(sketch, name=name).mean(axis=2)
    return sized_sketch(dark_lines(drawing, tones), width, height, name=name)


def lines_of_frames(sketches: torch.Tensor) -> list[NDArray[Any]]:
    """The line drawings of a clip's frames as dark lines on light, shape [h, w, 3] each; the first tells for all."""
    from ...rendering.sketch import dark_lines, has_light_lines

    pictures = pictures_of(sketches, name="sketches")
    tones: LineTones = "light on dark" if has_light_lines(pictures[0]) else "dark on light"
    return [dark_lines(each, tones) for each in pictures]


def told_of_light_lines(
    node: Any, sketch: torch.Tensor | None, tones: LineTones = "automatic", *, name: str = "sketch"
) -> dict[str, list[str]]:
    """Say that a drawing was turned around without anybody having asked for it; see ``tell_user``."""
    from ...rendering.sketch import has_light_lines

    turned = sketch is not None and tones == "automatic" and has_light_lines(pictures_of(sketch[:1], name=name))
    return tell_user(node, [_TURNED.format(name=name)] if turned else [])
