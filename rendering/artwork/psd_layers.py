"""The tree of layers of a PSD file as a list: groups, masks and clipping layers carried to what they act on."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...physics.errors import InvalidInputError
from .artwork import ArtLayer, Blend
from .groups import carried_down, clipped, merged, shut_in
from .psd_masks import with_masks
from .psd_pixels import pixels_of

if TYPE_CHECKING:
    from psd_tools import PSDImage
    from psd_tools.api.layers import Layer

__all__ = ["all_layers", "layers_of", "name_of"]

_DEEPEST = 64
"""Groups in groups."""

_BLENDS: dict[str, Blend] = {
    "NORMAL": "normal",
    "PASS_THROUGH": "normal",
    "MULTIPLY": "multiply",
    "SCREEN": "screen",
    "OVERLAY": "overlay",
    "LINEAR_DODGE": "add",
}


def layers_of(document: PSDImage, *, groups: bool = False) -> tuple[list[ArtLayer], list[str]]:
    """The layers of a document from back to front, and a sentence for each thing that is shown otherwise than there.

    Args:
        document: the document.
        groups: make one layer of each outermost group.

    Raises:
        InvalidInputError: a layer cannot be read.
    """
    remarks: list[str] = []
    return _flattened_tree(document, remarks, whole=groups), remarks


def all_layers(group: Iterable[Any], depth: int = 0) -> Iterator[Layer]:
    """Layers and groups of a document, inner ones as well.

    Raises:
        InvalidInputError: there are too many groups in groups.
    """
    if depth > _DEEPEST:
        raise InvalidInputError(f"groups of layers must be at most {_DEEPEST} deep. Got: more")
    for layer in group:
        yield layer
        if layer.is_group():
            yield from all_layers(layer, depth + 1)


def _flattened_tree(group: Iterable[Any], remarks: list[str], *, whole: bool = False) -> list[ArtLayer]:
    result: list[ArtLayer] = []
    run: list[Any] = []  # a layer, and what is clipped to it
    for layer in group:
        if run and layer.clipping:
            run.append(layer)
            continue
        result += _read_run(run, remarks, whole=whole)
        run = [layer]
    return result + _read_run(run, remarks, whole=whole)


def _read_run(run: list[Any], remarks: list[str], *, whole: bool) -> list[ArtLayer]:
    """A layer or group with what is clipped to it."""
    if not run:
        return []
    base = _read(run[0], remarks, whole=whole)
    above = [each for layer in run[1:] for each in _read(layer, remarks)]
    if not base:
        remarks += [f"layer {each.name} is left out with {name_of(run[0])}, which it is clipped to" for each in above]
    if not any(layer.visible for layer in above) or not base:
        return base
    if len(base) == 1:
        return [clipped(base[0], above)]
    drawn = [layer for layer in base if layer.visible]
    if not drawn:
        return base
    remarks.append(f"layers are clipped to group {name_of(run[0])}: it is read as one layer")
    one = clipped(merged(drawn, name=name_of(run[0])), above)
    return [*[layer for layer in base if not layer.visible], one]


def _read(layer: Layer, remarks: list[str], *, whole: bool = False) -> list[ArtLayer]:
    if layer.has_effects():
        remarks.append(f"layer {name_of(layer)}: its layer styles, such as shadows and strokes, are not drawn")
    if layer.is_group():
        return _read_group(layer, remarks, whole=whole)
    pixels = pixels_of(layer)
    if pixels is None:
        if layer.visible:
            remarks.append(f"layer {name_of(layer)} ({_kind(layer)}) is left out: only layers with pixels are read")
        return []
    read = ArtLayer(
        name=name_of(layer),
        pixels=pixels,
        left=layer.left,
        top=layer.top,
        opacity=layer.opacity / 255 * _fill(layer),
        blend=_blend(layer, remarks),
        visible=layer.visible,
    )
    return [with_masks(read, layer, remarks)]


def _read_group(group: Any, remarks: list[str], *, whole: bool) -> list[ArtLayer]:
    if group.kind == "artboard":
        remarks.append(f"artboard {name_of(group)}: its own background and border are not drawn")
    inner = [with_masks(layer, group, remarks) for layer in _flattened_tree(group, remarks)]
    blend, opacity = _blend(group, remarks), group.opacity / 255 * _fill(group)
    drawn = [layer for layer in inner if layer.visible]
    if whole and drawn:
        return [replace(merged(drawn, name=name_of(group), opacity=opacity, blend=blend), visible=group.visible)]
    if group.blend_mode.name != "PASS_THROUGH":
        remarks += shut_in(drawn, name_of(group))
    layers, lost = carried_down(inner, name=name_of(group), opacity=opacity, blend=blend, visible=group.visible)
    remarks += lost
    return layers


def name_of(layer: Layer) -> str:
    """What the artist called a layer.

    Files without the name in Unicode say it in an encoding of their own, which psd-tools takes for that of old Macs.
    """
    from psd_tools.constants import Tag

    name = layer.name
    if Tag.UNICODE_LAYER_NAME not in layer.tagged_blocks:
        with suppress(UnicodeError):
            name = name.encode("mac_roman").decode("utf-8")
    return name.replace("\0", "")


def _fill(layer: Layer) -> float:
    """The opacity of the pixels without layer styles, which multiplies the layer's own."""
    from psd_tools.constants import Tag

    fill = layer.tagged_blocks.get_data(Tag.BLEND_FILL_OPACITY)
    return 1.0 if fill is None else fill / 255


def _blend(layer: Layer, remarks: list[str]) -> Blend:
    mode = layer.blend_mode.name
    if mode not in _BLENDS:
        remarks.append(f"layer {name_of(layer)}: blend mode {mode.lower().replace('_', ' ')} is drawn as normal")
    return _BLENDS.get(mode, "normal")


def _kind(layer: Layer) -> str:
    """What a layer without pixels is, in words."""
    from psd_tools.api.adjustments import AdjustmentLayer, FillLayer

    if isinstance(layer, AdjustmentLayer):
        return "adjustment layer"
    if isinstance(layer, FillLayer):
        return "fill layer"
    return "shape" if layer.kind == "shape" else "no pixels"
