"""Frames of the composite, with what the parts have uncovered painted by soft inpainting."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.progress import Progress
from ..composite import Background, LayeredRenderer, shown_frame_and_alpha
from ..inpainting import InpaintingOptions, change_map
from ..pictures import as_float
from .options import NetworkOptions

if TYPE_CHECKING:
    from ..inpainting.models import InpaintingModels
    from ..networks.placement import Placement

__all__ = ["Change", "changes_of_holes", "load_inpainting", "painted_frames"]

FloatImage = NDArray[np.float32]

Change = Callable[[int, FloatImage], FloatImage]
"""How much each pixel of a frame may change, 0..1, shape [h, w], by the frame's number and its alpha."""


def changes_of_holes(layers: LayeredRenderer, *, grow: float, soft_edge: float) -> Change:
    """Everything may change in the holes of a frame, and less and less around them; see :func:`change_map`.

    Args:
        layers: draws the motion.
        grow: how far holes reach beyond what was uncovered [px].
        soft_edge: width of the transition around them [px].
    """

    def change(_: int, alpha: FloatImage) -> FloatImage:
        covered = np.maximum(alpha, layers.in_front)
        return change_map(layers.uncovered_by(alpha), covered, grow=grow, soft_edge=soft_edge)

    return change


def painted_frames(
    models: InpaintingModels,
    layers: LayeredRenderer,
    background: Background,
    change: Change,
    *,
    options: InpaintingOptions,
    placement: Placement,
    numbers: Sequence[int],
    progress: Progress | None = None,
) -> Iterator[FloatImage]:
    """Some frames of a motion.

    Args:
        models: the networks.
        layers: draws the motion.
        background: what is there where nothing moves; opaque.
        change: how much each pixel may change.
        options: settings.
        placement: where the networks compute.
        numbers: of the frames.
        progress: see :class:`SoftInpainter`.

    Returns:
        An iterator over float32 pictures, 0..1, shape [h, w, 3]. Bad settings raise here.
    """
    from ..inpainting.inpainter import SoftInpainter

    def drawn(number: int) -> tuple[FloatImage, FloatImage]:
        frame, alpha = shown_frame_and_alpha(layers, number, background)
        return as_float(frame), change(number, alpha)

    inpainter = SoftInpainter(models, options=options, placement=placement)
    return inpainter.frames(map(drawn, numbers), len(numbers), progress=progress)


def load_inpainting(options: NetworkOptions, *, as_saved: bool = False) -> tuple[InpaintingModels, Placement]:
    """The networks, and where they compute.

    Args:
        options: which folder.
        as_saved: leave the UNet's weights in the type that their files have, in which most of them stay on disk.

    Raises:
        CheckpointError: the folder cannot be used.
        InvalidInputError: there is no such device, or the model has fewer steps than are wanted.
    """
    from ..inpainting.models import load_inpainting_models
    from .devices import device_of, dtype_of, placement_on

    gc.collect()  # networks hold themselves in circles: those of an earlier stage go before others come
    device = device_of(options.device)
    dtype = None if as_saved else dtype_of(options.dtype, device)
    models = load_inpainting_models(Path(str(options.inpainting)), dtype=dtype)
    try:
        models.check_steps(options.inpainting_options.steps)
    except InvalidInputError as error:
        raise InvalidInputError(f"inpainting_options: {error}") from error
    return models, placement_on(device)
