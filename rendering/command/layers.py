"""What the command ``layers`` tells of a layered file."""

from __future__ import annotations

import argparse
import json
import unicodedata
from typing import TYPE_CHECKING, Any

from .files import check_apart
from .messages import say, show, warn
from .names import named_as

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..artwork import Artwork, LayerPlan

__all__ = ["list_layers"]

_HEADINGS = ("", "layer", "size", "at", "drawn", "moves", "preset", "why")


def list_layers(options: argparse.Namespace) -> None:
    """List the layers of a file from front to back, and write them where asked.

    Raises:
        InvalidInputError: the file cannot be read, there is no layer of a name, or a result cannot be written.
    """
    from ..artwork import check_layer_folder, check_psd_output, load_artwork, moving_layers, save_layer_pngs, save_psd

    check_apart(options)
    if options.save_psd is not None:
        with named_as("--save-psd", "output", "the name"):
            check_psd_output(options.save_psd)
    if options.save_png is not None:
        with named_as("--save-png", "output", "folder"):
            check_layer_folder(options.save_png)
    artwork = load_artwork(options.file, groups=options.groups)
    for sentence in artwork.warnings:
        warn(f"physanimator: warning: {sentence}")
    plans = moving_layers(artwork, options.move, options.still)
    show(_as_json(artwork, plans) if options.json else _table(artwork, plans))
    if options.save_psd is not None:
        save_psd(artwork, options.save_psd)
        say(f"{options.save_psd}: {len(artwork.layers)} layers")
    if options.save_png is not None:
        say(f"{options.save_png}: {len(save_layer_pngs(artwork, options.save_png))} files")


def _table(artwork: Artwork, plans: Sequence[LayerPlan]) -> str:
    rows = [_HEADINGS, *(_row(artwork, plan) for plan in reversed(plans))]
    widths = [max(_width(row[column]) for row in rows) for column in range(len(_HEADINGS))]
    lines = ["  ".join(_padded(text, width) for text, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    moving = sum(plan.moves for plan in plans)
    sized = f"{artwork.width} x {artwork.height} px, {8 * artwork.dtype.itemsize} bits"
    return "\n".join([f"{sized}, {len(plans)} layers from front to back, {moving} of them would move", *lines])


def _row(artwork: Artwork, plan: LayerPlan) -> tuple[str, ...]:
    from ...physics.errors import printable

    layer = artwork.layers[plan.index]
    left, top, right, bottom = layer.box
    drawn = f"{layer.blend} {layer.opacity:.0%}" if plan.shown else "no"
    held = f"{plan.preset}, held at its {_HELD[plan.held]}" if plan.held else plan.preset or ""
    return (
        str(plan.index + 1),
        printable(plan.name),
        f"{right - left} x {bottom - top}",
        f"{left}, {top}",
        drawn,
        "yes" if plan.moves else "-",
        held,
        plan.why,
    )


_HELD = {
    "top": "top",
    "covered": "covered part",
    "waist": "waist",
    "end": "end at the body",
    "bottom": "bottom",
}


def _as_json(artwork: Artwork, plans: Sequence[LayerPlan]) -> str:
    def entry(plan: LayerPlan) -> dict[str, Any]:
        layer = artwork.layers[plan.index]
        left, top, right, bottom = layer.box
        return {
            "name": plan.name,
            "left": left,
            "top": top,
            "width": right - left,
            "height": bottom - top,
            "opacity": round(layer.opacity, 6),
            "blend": layer.blend,
            "visible": layer.visible,
            "depth": layer.depth,
            "shown": plan.shown,
            "moves": plan.moves,
            "preset": plan.preset,
            "held": plan.held,
            "why": plan.why,
        }

    document = {"width": artwork.width, "height": artwork.height, "bits": 8 * artwork.dtype.itemsize}
    listed = {"layers_from_back_to_front": [entry(plan) for plan in plans], "warnings": list(artwork.warnings)}
    return json.dumps({**document, **listed}, indent=2, ensure_ascii=False)


def _width(text: str) -> int:
    """Columns that a text takes in a terminal: two for each letter of Japanese and Chinese."""
    return sum(1 + (unicodedata.east_asian_width(each) in "WF") for each in text)


def _padded(text: str, width: int) -> str:
    return text + " " * (width - _width(text))
