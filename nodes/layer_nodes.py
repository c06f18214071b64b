"""Layered artwork in: from files, from pictures, and from the See-through nodes; and out again as a file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from comfy_api.latest import io, ui

from ..physics.errors import InvalidInputError, counted, require
from .example_nodes import FOLDER
from .host import (
    batch_of_masks,
    batch_of_pictures,
    check_prefix,
    contents_of,
    free_place,
    layered_files,
    mask_of,
    pictures_of,
    place_of,
    refusal,
    shown_with,
    tell_user,
)
from .host.choices import OPEN
from .host.wires import LayersWire, SeeThroughWire
from .saving_inputs import place_inputs

if TYPE_CHECKING:
    from pathlib import Path

    import torch

    from ..rendering.artwork import Artwork

__all__ = ["LayersFromImageBatch", "LoadLayers", "SaveLayers", "SeeThroughLayers", "artwork_of", "layers_of"]

_EXAMPLE = "PhysAnimator example.psd"
_WHITE = ("the part", "transparent")
_FILE_TYPES = ("psd", "psb")


class LoadLayers(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_LoadLayers",
            display_name="Load Layers (PhysAnimator)",
            category="PhysAnimator/layers",
            description="Reads an illustration in layers: PSD, PSB, OpenRaster (Krita), or a folder of PNG files.",
            inputs=[
                io.Combo.Input(
                    "file",
                    options=[*layered_files(), _EXAMPLE],
                    default=_EXAMPLE,
                    extra_dict={OPEN: True},
                    tooltip="A .psd, .psb or .ora file of the input folder, or a folder in it of PNG files, from back"
                    " to front by their names. The button below uploads a file.",
                )
            ],
            outputs=_outputs("All layers with their places, hidden parts included."),
        )

    @classmethod
    def validate_inputs(cls, file: str | None = None) -> bool | str:
        return file is None or refusal(lambda: _place(file))

    @classmethod
    def fingerprint_inputs(cls, file: str | None = None, **others: Any) -> str:
        try:
            return contents_of(_place(file or ""))
        except (InvalidInputError, OSError):
            return ""  # said when it is read

    @classmethod
    def execute(cls, file: str) -> io.NodeOutput:
        from ..rendering.artwork import load_artwork

        return layers_of(cls, load_artwork(_place(file)))


class LayersFromImageBatch(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_LayersFromImageBatch",
            display_name="Layers from Image Batch",
            category="PhysAnimator/layers",
            description="Makes each picture of a batch a layer, the first at the back.",
            inputs=[
                io.Image.Input("images", tooltip="Layers of one size, from back to front."),
                io.String.Input(
                    "names",
                    multiline=True,
                    default="",
                    tooltip="A name on each line, from back to front, such as back hair, face, front hair: by them"
                    " Artwork to Bodies knows what moves. Layers without one are numbered.",
                ),
                io.Combo.Input(
                    "white_is",
                    options=list(_WHITE),
                    default=_WHITE[0],
                    tooltip="What is white in masks. the part: as segmenters and this pack's nodes draw masks."
                    " transparent: as the mask of Load Image.",
                ),
                io.Mask.Input(
                    "masks",
                    optional=True,
                    tooltip="Where each layer is, of the pictures' size: one mask for each picture, or one for all."
                    " Without them layers are opaque, or have the alpha that the pictures bring.",
                ),
            ],
            outputs=_outputs("A layer for each picture."),
        )

    @classmethod
    def execute(
        cls, images: torch.Tensor, names: str, white_is: str, masks: torch.Tensor | None = None
    ) -> io.NodeOutput:
        from ..rendering.artwork import from_layers_dictionary

        pictures = pictures_of(images, name="images", alpha=True)
        titles = [line.strip() for line in names.rstrip().splitlines()] if names.strip() else []
        most = len(pictures)
        require("names", counted(len(titles), "line"), len(titles) <= most, f"at most {most}, one for each picture")
        titles += [""] * (len(pictures) - len(titles))
        items: list[dict[str, Any]] = [
            {"image": picture[None], "name": title or f"layer {number}"}
            for number, (picture, title) in enumerate(zip(pictures, titles, strict=True), 1)
        ]
        if masks is not None:
            count = 1 if masks.ndim == 2 else len(masks)
            require("masks", count, count in (1, len(pictures)), f"one, or one for each of {len(pictures)} pictures")
            for number, item in enumerate(items):
                mask = mask_of(masks, index=number if count > 1 else 0, name="masks")
                got, size = (f"{w} x {h} px" for h, w in (mask.shape, pictures.shape[1:3]))
                require("masks", got, got == size, f"of the pictures' size, {size}")
                item["mask"] = (mask if white_is == _WHITE[1] else 1 - mask)[None]
        canvas = (pictures.shape[2], pictures.shape[1])
        return layers_of(cls, from_layers_dictionary({"version": 1, "canvas": canvas, "layers": items}))


class SeeThroughLayers(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_SeeThroughLayers",
            display_name="See-through Parts to Layers",
            category="PhysAnimator/layers",
            description="Takes over the parts into which the See-through nodes have cut an illustration.",
            inputs=[SeeThroughWire.Input("parts", tooltip="From the See-through nodes, with depth.")],
            outputs=_outputs("A layer for each part, the farthest at the back."),
        )

    @classmethod
    def execute(cls, parts: Any) -> io.NodeOutput:
        from ..rendering.artwork import from_see_through

        return layers_of(cls, from_see_through(parts))


class SaveLayers(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_SaveLayers",
            display_name="Save Layers (PhysAnimator)",
            category="PhysAnimator/layers",
            description="Writes layers as a PSD file for painting programs.",
            is_output_node=True,
            inputs=[
                LayersWire.Input("layers", tooltip="From Load Layers, Frame as Layers or any other node with layers."),
                *place_inputs(
                    "layers/PhysAnimator",
                    _FILE_TYPES,
                    "psd: for every painting program, files of up to 2 GB. psb: for larger ones.",
                ),
            ],
            outputs=[io.String.Output(display_name="path", tooltip="The file.")],
        )

    @classmethod
    def validate_inputs(cls, filename_prefix: str | None = None) -> bool | str:
        return filename_prefix is None or refusal(lambda: check_prefix(filename_prefix))

    @classmethod
    def execute(cls, layers: Any, filename_prefix: str, file_type: str) -> io.NodeOutput:
        from ..rendering.artwork import save_psd

        artwork, told = artwork_of(cls, layers)
        place = free_place(filename_prefix, file_type, artwork.width, artwork.height)
        save_psd(artwork, place.path)
        return io.NodeOutput(place.path, ui={"text": [place.path], **told})


def artwork_of(node: Any, layers: Any) -> tuple[Artwork, dict[str, list[str]]]:
    """The artwork that travels on the wire of layers, and what the user was told of it.

    Args:
        node: the node's class, as ``execute`` has it.
        layers: ComfyUI's dictionary of layers.

    Raises:
        InvalidInputError: it is none, or holds no layer.
    """
    from ..rendering.artwork import from_layers_dictionary

    artwork = from_layers_dictionary(layers)
    if not any(layer.pixels.size for layer in artwork.layers):
        raise InvalidInputError("layers must hold at least one layer with something on it. Got: none")
    return artwork, tell_user(node, artwork.warnings)


def layers_of(node: Any, artwork: Artwork) -> io.NodeOutput:
    """What the nodes give that read layers: the layers, and as they look together."""
    from ..rendering.artwork import flattened, to_layers_dictionary

    if not any(layer.pixels.size for layer in artwork.layers):
        raise InvalidInputError("there must be at least one layer with something on it. Got: none")
    told = tell_user(node, artwork.warnings)
    flat = flattened(artwork)
    shown = flat.astype(np.float32) / np.float32(np.iinfo(flat.dtype).max)
    image = batch_of_pictures([shown[..., :3]], 1)
    mask = batch_of_masks([1 - shown[..., 3]], 1)
    layers = to_layers_dictionary(artwork, most=None)
    return io.NodeOutput(layers, image, mask, ui=shown_with(ui.PreviewImage(image), told))


def _outputs(tooltip: str) -> list[io.Output]:
    return [
        LayersWire.Output(display_name="layers", tooltip=f"{tooltip} For Artwork to Bodies."),
        io.Image.Output(display_name="image", tooltip="The layers laid over one another."),
        io.Mask.Output(display_name="mask", tooltip="White where the picture is transparent, as Load Image gives it."),
    ]


def _place(file: str) -> Path:
    """Where a file is that was chosen.

    Raises:
        InvalidInputError: it is not in the input folder, or no layered file.
    """
    from ..rendering.artwork import is_artwork_file

    if file == _EXAMPLE:
        return FOLDER / "illustration.psd"
    place = place_of(file)
    if not is_artwork_file(place):
        raise InvalidInputError(f"file must be a .psd, .psb or .ora file, or a folder of PNG files. Got: {file[:60]!r}")
    return place
