"""The layers of one frame, bent and placed, and what is seen of them over a plate, as alpha, or alone."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import PixelBox
from ...physics.motion import Motion
from ..pictures import as_dtype, is_transparent, straight
from .hidden_areas import HiddenArea
from .layer import Layer
from .laying import lay_over
from .pixel_boxes import around, bands_of, shared, within
from .still_layers import StillLayer

if TYPE_CHECKING:
    from ..artwork import Blend

__all__ = ["Drawn", "covered", "cut_out", "interleaved", "laid", "over_plate", "part_of", "placed"]

FloatImage = NDArray[np.float32]

# A frame is put together in bands of so many rows: what is laid over what then stays in the processor's cache.
_BAND = 96


class Drawn(NamedTuple):
    """One layer in one frame: its box in the picture, its channels there, its blend mode, and whether it moves."""

    box: PixelBox
    texture: FloatImage
    blend: Blend
    moving: bool


def placed(
    layer: Layer | StillLayer, body: int | None, motion: Motion, t: int, hidden: HiddenArea | None = None
) -> tuple[PixelBox, FloatImage]:
    """Where a layer is in a frame, and its channels there, which may be any where it is hidden.

    Args:
        layer: that moves with a body, or stands still.
        body: number of its body in the motion; None where it stands still.
        motion: of the bodies.
        t: number of the frame.
        hidden: where the layer is never seen; None where that is not known.
    """
    if isinstance(layer, StillLayer) or body is None:
        return layer.box, layer.texture  # type: ignore[union-attr]
    return layer.drawn(motion.of_body(body)[t], motion.width, motion.height, hidden=hidden)


def laid(
    layers: Iterable[tuple[Layer | StillLayer, int | None, HiddenArea | None]], motion: Motion, t: int
) -> list[Drawn]:
    """The layers that show in a frame, from back to front.

    Args:
        layers: each with the number of its body and where it is never seen, as :func:`placed` takes them.
        motion: of the bodies.
        t: number of the frame.
    """
    drawn = []
    for layer, body, hidden in layers:
        box, texture = placed(layer, body, motion, t, hidden)
        if box.width and box.height:
            drawn.append(Drawn(box, texture, layer.blend, isinstance(layer, Layer)))
    return drawn


def over_plate(drawn: Sequence[Drawn], plate: NDArray[Any], planes: FloatImage, region: PixelBox) -> NDArray[Any]:
    """A frame: drawn layers over a plate, of its shape and dtype.

    Args:
        drawn: the layers, from back to front.
        plate: what is seen where nothing moves, with what stands still as it is, shape [h, w, 3] or [h, w, 4].
        planes: what is behind all layers, in 0 to 1, four of them premultiplied, shape [c, region].
        region: the part of the picture that the planes show.
    """
    frame = plate.copy()
    for box in bands_of([each.box for each in drawn if each.moving], _BAND):
        behind = part_of(planes, within(box, region)).copy()
        for each, texture, part in _within_box(drawn, box, behind):
            lay_over(part, texture, each.blend)
        frame[box.slices] = interleaved(behind, frame.dtype)
    return frame


def covered(drawn: Sequence[Drawn], shape: tuple[int, ...]) -> FloatImage:
    """How much of each pixel shows drawn layers that move, 0 to 1, of a shape [h, w]."""
    shown = np.zeros(shape, dtype=np.float32)
    for each in drawn:
        part, alpha = shown[each.box.slices], np.clip(each.texture[..., -1], 0, 1)
        if each.moving:
            part += alpha * (1 - part)
        elif each.blend == "normal":
            part *= 1 - alpha
    return shown


def cut_out(drawn: Sequence[Drawn], shape: tuple[int, ...], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Drawn layers that move, alone: straight RGB and alpha of a dtype, shape [h, w, 4]."""
    alone = np.zeros((*shape, 4), dtype=dtype)
    box = around([each.box for each in drawn if each.moving])
    planes = np.zeros((4, box.height, box.width), dtype=np.float32)
    for each, texture, part in _within_box(drawn, box, planes):
        if each.moving:
            lay_over(part, texture, "normal")
        elif each.blend == "normal":
            part *= 1 - np.clip(texture[..., -1], 0, 1)
    if planes.size:
        alone[box.slices] = interleaved(planes, dtype)
    return alone


def part_of(planes: FloatImage, box: PixelBox) -> FloatImage:
    """The view of planes, shape [c, h, w], within a box."""
    rows, columns = box.slices
    return planes[:, rows, columns]


def interleaved(planes: FloatImage, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Planes in 0 to 1, four of them premultiplied, shape [c, h, w], as a straight picture, shape [h, w, c]."""
    picture = np.asarray(cv2.merge(list(planes)))
    if is_transparent(picture):
        picture = straight(picture)
    if dtype != np.uint8:
        return as_dtype(picture, dtype)
    return np.asarray(cv2.convertScaleAbs(np.clip(picture, 0, 1, out=picture), alpha=255))


def _within_box(
    drawn: Sequence[Drawn], box: PixelBox, planes: FloatImage
) -> Iterator[tuple[Drawn, FloatImage, FloatImage]]:
    """Each layer that shows in a box, its texture there, and the part of the box's planes where it is."""
    for each in drawn:
        there = shared(each.box, box)
        if there.width and there.height:
            yield each, each.texture[within(there, each.box).slices], part_of(planes, within(there, box))
