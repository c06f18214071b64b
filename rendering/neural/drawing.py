"""Frames and in-betweens by the paper's video models, as they are chosen."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.progress import Progress
from ..composite import keep_still_parts, moving_region
from ..pictures import as_float
from ..svd import CrudeAnimation, SVDOptions
from .colour_drift import Reference, own_colours, without_drift
from .options import NetworkOptions, StrPath

if TYPE_CHECKING:
    from ..networks.placement import Placement
    from ..svd.models import SVDModels
    from ..svd.sampler import SampledStep
    from ..tooncrafter.interpolator import ToonCrafterInterpolator
    from ..tooncrafter.models import ToonCrafterModels

__all__ = ["in_between_backend", "load_svd", "load_tooncrafter", "sketch_guided_frames"]

FloatImage = NDArray[np.float32]


def sketch_guided_frames(
    models: SVDModels,
    image: NDArray[Any],
    sketches: Sequence[NDArray[Any]],
    *,
    options: SVDOptions,
    placement: Placement,
    animation: CrudeAnimation | None = None,
    alphas: Iterable[FloatImage] | None = None,
    soft_edge: float = 24.0,
    progress: Progress | None = None,
    watch: Callable[[SampledStep], None] | None = None,
    loops: bool = False,
    colour_match: float = 1.0,
    references: Iterable[Reference] | None = None,
) -> Iterator[FloatImage]:
    """The frames of a clip that follow sketches, an animation, or both.

    Args:
        models: the networks.
        image: the illustration, RGB, shape [h, w, 3].
        sketches: dark lines on white, one for each frame, the illustration's own first; none where only
            an animation is followed.
        options: settings.
        placement: where the networks compute.
        animation: see :class:`SVDRenderer`.
        alphas: how much moving parts cover of each pixel in each frame, 0..1, shape [h, w]: what none ever covers is
            taken from the illustration. None: everything is as the networks draw it.
        soft_edge: width of the transition to it [px].
        progress: see :class:`SVDRenderer`.
        watch: see :class:`SVDRenderer`.
        loops: the last frame leads to frame 1; see :class:`SVDRenderer`.
        colour_match: share of the colour drift that is taken out, 0..1.
        references: for each frame what its colours should be; those of the illustration when None.

    Returns:
        An iterator over float32 pictures, 0..1, shape [h, w, 3]. Bad input raises here.
    """
    from ..svd.renderer import SVDRenderer

    renderer = SVDRenderer(models, options=options, placement=placement)
    frames = renderer.frames(image, sketches, animation=animation, progress=progress, watch=watch, loops=loops)
    picture = as_float(image)
    if colour_match > 0:
        count = len(sketches) if animation is None else animation.count
        wanted = [own_colours(picture)] * count if references is None else references
        frames = without_drift(frames, wanted, colour_match)
    if alphas is None:
        return frames
    region = moving_region(alphas, soft_edge=soft_edge)
    return (keep_still_parts(frame, picture, region) for frame in frames)


def load_svd(options: NetworkOptions, *, as_saved: bool = False) -> tuple[SVDModels, Placement]:
    """The renderer's networks, and where they compute.

    Args:
        options: which files.
        as_saved: leave weights in the type that their files have, in which most of them stay on disk.

    Raises:
        CheckpointError: a file cannot be used.
        InvalidInputError: there is no such device.
    """
    from ..svd.models import load_models
    from .devices import device_of, dtype_of, placement_on

    gc.collect()  # networks hold themselves in circles: those of an earlier stage go before others come
    device = device_of(options.device)
    dtype = None if as_saved else dtype_of(options.dtype, device)
    return load_models(Path(str(options.svd)), _path(options.lvcd), dtype=dtype), placement_on(device)


def load_tooncrafter(options: NetworkOptions, *, as_saved: bool = False) -> tuple[ToonCrafterModels, Placement]:
    """The interpolation's networks, and where they compute; arguments and errors as those of :func:`load_svd`."""
    from ..networks.checkpoints import CheckpointError
    from ..tooncrafter.models import WANTED_IMAGE_ENCODER, WANTED_TEXT_ENCODER, load_models
    from .devices import device_of, dtype_of, placement_on

    gc.collect()
    device = device_of(options.device)
    models = load_models(
        Path(str(options.tooncrafter)),
        sketch=_path(options.sketch_encoder),
        image_encoder=_path(options.image_encoder),
        text_encoder=_path(options.text_encoder),
        dtype=None if as_saved else dtype_of(options.dtype, device),
    )
    for name, held, wanted in (
        ("image_encoder", models.image_encoder, WANTED_IMAGE_ENCODER),
        ("text_encoder", models.empty_prompt, WANTED_TEXT_ENCODER),
    ):
        if held is None:
            raise CheckpointError(f"{name} must be a file where tooncrafter is pruned. Got: none. Wanted: {wanted}")
    return models, placement_on(device)


def _path(given: StrPath | None) -> Path | None:
    return None if given is None else Path(given)


def in_between_backend(options: NetworkOptions, progress: Progress | None = None) -> str | ToonCrafterInterpolator:
    """What ``interpolate`` takes as its backend.

    Args:
        options: who draws in-betweens.
        progress: called after each sampling step of a video model.
    """
    if options.interpolate_with != "tooncrafter":
        return options.interpolate_with
    from ..tooncrafter.interpolator import ToonCrafterInterpolator

    models, placement = load_tooncrafter(options)
    return ToonCrafterInterpolator(
        models,
        options=options.tooncrafter_options,
        placement=placement,
        progress=progress,
        colour_match=options.colour_match,
    )
