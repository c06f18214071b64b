"""Artwork as a PSD file, for painting programs."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require
from ..files import check_file_place, replacing, suffix_of
from .artwork import ArtLayer, Artwork, Blend
from .flattening import as_whole_numbers, flattened

if TYPE_CHECKING:
    from psd_tools.psd import PSD
    from psd_tools.psd.header import FileHeader
    from psd_tools.psd.layer_and_mask import ChannelDataList, LayerRecord

__all__ = ["check_psd_output", "save_psd"]

StrPath = str | os.PathLike[str]

_MODES: dict[Blend, str] = {
    "normal": "NORMAL",
    "multiply": "MULTIPLY",
    "screen": "SCREEN",
    "overlay": "OVERLAY",
    "add": "LINEAR_DODGE",
}
_ALPHA = -1


def save_psd(artwork: Artwork, path: StrPath, *, small: bool = False) -> None:
    """Write artwork as a PSD file, or as a PSB file, which holds more. An earlier file is replaced by a complete one.

    Args:
        artwork: 8 or 16 bits a channel; all layers are written, hidden and empty ones as well.
        path: where to; the folder must exist.
        small: pack tighter than all programs read, and leave out the picture for programs that read no layers.

    Raises:
        InvalidInputError: see :func:`check_psd_output`.

    Examples:
        >>> import tempfile
        >>> from pathlib import Path
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import ArtLayer, Artwork, load_artwork, save_psd
        >>> hair = ArtLayer("hair", np.full((2, 3, 4), 255, np.uint8), left=1)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     save_psd(Artwork(8, 6, (hair,)), Path(folder, "girl.psd"))
        ...     load_artwork(Path(folder, "girl.psd")).layers[0].box
        (1, 0, 4, 2)
    """
    check_psd_output(path)
    document = _document(artwork, version=2 if suffix_of(path) == ".psb" else 1, small=small)
    with replacing(path) as temporary, temporary.open("wb") as file:
        document.write(file)


def check_psd_output(path: StrPath) -> None:
    """Refuse a place that :func:`save_psd` could not write to, before any work.

    Raises:
        InvalidInputError: it has another suffix, or nothing can be written there.
    """
    suffix = suffix_of(path)
    require("the name", path, suffix in (".psd", ".psb"), "that of a .psd or .psb file")
    check_file_place(path)


def _document(artwork: Artwork, *, version: int, small: bool) -> PSD:
    from psd_tools.constants import ColorMode, Resource
    from psd_tools.psd import PSD
    from psd_tools.psd.header import FileHeader
    from psd_tools.psd.image_resources import ImageResources
    from psd_tools.psd.layer_and_mask import ChannelImageData, LayerAndMaskInformation, LayerInfo, LayerRecords

    picture = flattened(artwork)
    if small:
        picture[...] = np.iinfo(picture.dtype).max
    opaque = bool((picture[..., 3] == np.iinfo(picture.dtype).max).all())
    header = FileHeader(
        version=version,
        channels=3 if opaque else 4,
        height=artwork.height,
        width=artwork.width,
        depth=8 * artwork.dtype.itemsize,
        color_mode=ColorMode.RGB,
    )
    layers = [_layer(layer, header, small=small) for layer in artwork.layers]
    information = LayerInfo(
        layer_count=len(layers) if opaque else -len(layers),  # negative: the picture's fourth plane is its alpha
        layer_records=LayerRecords([record for record, _ in layers]),
        channel_image_data=ChannelImageData([channels for _, channels in layers]),
    )
    resources = ImageResources.new()
    about = resources.get_data(Resource.VERSION_INFO)
    about.has_composite, about.writer = not small, "PhysAnimator"
    return PSD(
        header=header,
        image_resources=resources,
        layer_and_mask_information=LayerAndMaskInformation(layer_info=information),
        image_data=_merged(picture, header),
    )


def _layer(layer: ArtLayer, header: FileHeader, *, small: bool) -> tuple[LayerRecord, ChannelDataList]:
    from psd_tools.constants import BlendMode, Compression, Tag
    from psd_tools.psd.layer_and_mask import ChannelData, ChannelDataList, ChannelInfo, LayerFlags, LayerRecord
    from psd_tools.psd.tagged_blocks import TaggedBlocks

    left, top, right, bottom = layer.box if layer.pixels.size else (0, 0, 0, 0)
    channels = []
    for plane in (3, 0, 1, 2):
        packed = Compression.ZIP_WITH_PREDICTION if small else Compression.RLE
        channel = ChannelData(compression=packed if layer.pixels.size else Compression.RAW, data=b"")
        if layer.pixels.size:
            channel.set_data(_bytes(layer.pixels[..., plane]), right - left, bottom - top, header.depth, header.version)
        channels.append(channel)
    names = TaggedBlocks()
    names.set_data(Tag.UNICODE_LAYER_NAME, layer.name)
    record = LayerRecord(
        top=top,
        left=left,
        bottom=bottom,
        right=right,
        channel_info=[
            ChannelInfo(id=number, length=2 + len(channel.data))
            for number, channel in zip((_ALPHA, 0, 1, 2), channels, strict=True)
        ],
        blend_mode=BlendMode[_MODES[layer.blend]],
        opacity=round(layer.opacity * 255),
        flags=LayerFlags(visible=layer.visible),
        name=layer.name.encode("ascii", "replace").decode()[:63],  # the whole name is in Unicode
        tagged_blocks=names,
    )
    return record, ChannelDataList(channels)


def _merged(picture: NDArray[Any], header: FileHeader) -> Any:
    """The picture for programs that do not read layers: its colours over white, as Photoshop writes them."""
    from psd_tools.constants import Compression
    from psd_tools.psd.image_data import ImageData

    most = np.iinfo(picture.dtype).max
    planes = []
    alpha = picture[..., 3].astype(np.float32) / np.float32(most)
    for index in range(header.channels):
        plane = picture[..., index]
        if index < 3 and header.channels == 4:
            over = plane.astype(np.float32) / np.float32(most) * alpha + (1 - alpha)
            plane = as_whole_numbers(over, picture.dtype)
        planes.append(_bytes(plane))
    data = ImageData(compression=Compression.RLE)
    data.set_data(planes, header)
    return data


def _bytes(plane: NDArray[Any]) -> bytes:
    return np.ascontiguousarray(plane, dtype=plane.dtype.newbyteorder(">")).tobytes()
