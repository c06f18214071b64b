"""The frames of a method, drawn as they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ..animation import Animation
from ..neural import NetworkOptions
from ..neural.options import FILES
from ..pictures import as_uint8, over, read_clip
from ..stages import StageProgress
from .evaluation_set import EvaluationSet, PictureOfSet
from .foreign_clips import foreign_clip
from .loaded_pictures import LoadedPicture, loaded
from .methods import WARP, Method
from .motions import animation_of
from .names import suggestion
from .warping import warped_and_filled

__all__ = ["drawn_frames", "network_options", "unusable_for"]

Picture = NDArray[np.uint8]

_LARGEST_SEED = 2**31


def drawn_frames(
    which: EvaluationSet,
    picture: PictureOfSet,
    sample: int,
    method: Method,
    *,
    progress: StageProgress | None = None,
) -> Iterator[Picture]:
    """The frames of a method for a sample of a picture: RGB, uint8, shape [h, w, 3].

    Raises:
        InvalidInputError: something is unusable.
    """
    if method.clips:
        yield from read_clip(foreign_clip(method, picture, sample))
        return
    animation = animation_of(which, picture, sample, method, progress=progress)
    if method.draws == WARP:
        frames = warped_and_filled(loaded(picture, which.size).flat, animation.shown_motion, weight=method.weight)
        total = len(animation)
        for done, frame in enumerate(frames, start=1):
            if progress is not None:
                progress("render", done, total)
            yield frame
        return
    animation = replace(animation, networks=network_options(which, method, sample))
    for each in _frames(animation, method, progress):
        yield as_uint8(over(each))


def _frames(animation: Animation, method: Method, progress: StageProgress | None) -> Iterator[Any]:
    if method.interpolate == 1:
        return animation.frames(background="picture", progress=progress)
    return animation.frames(background="picture", every=method.interpolate, progress=progress)


def network_options(which: EvaluationSet, method: Method, sample: int) -> NetworkOptions:
    """The networks of a method; models begin with another noise in each sample.

    Raises:
        InvalidInputError: settings are none of its renderer's, or out of their range.
    """
    chosen: dict[str, Any] = {"renderer": method.renderer}
    if method.interpolate > 1:
        chosen["interpolate_with"] = method.interpolate_with
    by_svd = method.renderer == "svd"
    if which.weights.lines and by_svd and method.follow != "animation":
        chosen["extractor"] = "informative"
    used = {name for name, (which_choice, network, _) in FILES.items() if chosen.get(which_choice) == network}
    if by_svd and method.follow == "animation":
        used -= {"lvcd"}
    files: dict[str, Any] = {name: which.weights.of(name) for name in used}
    usual = NetworkOptions()
    seed = (which.seed + sample) % _LARGEST_SEED
    told: dict[str, Any] = {}
    filled = [(method.interpolate_with, method.interpolate_settings)] if method.interpolate > 1 else []
    settings_of_svd: dict[str, float | int | bool | str] = {"follow": method.follow} if by_svd else {}
    for network, settings in [(method.renderer, settings_of_svd | method.settings), *filled]:
        name = f"{network}_options"
        if hasattr(usual, name):
            told[name] = _settings(getattr(usual, name), {"seed": seed, **settings})
        elif settings:
            raise InvalidInputError(f"method {method.name!r} must have no settings, as {network} has none. Got: some")
    return NetworkOptions(
        **chosen,
        **files,
        **told,
        device=which.device,
        dtype=which.dtype,
        sketch_blur=method.sketch_blur,
        sketch_warp=method.sketch_warp,
    )


def _settings(usual: Any, told: dict[str, Any]) -> Any:
    known = [each.name for each in fields(usual)]
    for name in told:
        if name not in known:
            raise InvalidInputError(
                f"settings must be among {', '.join(known)}{suggestion(name, known)}. Got: {name!r}"
            )
    if "follow" in told:
        usual = usual.following(told["follow"])
    return replace(usual, **told)


_FLAT: dict[str, Callable[[Method], bool]] = {
    "painted by a model behind its parts": lambda method: method.renderer == "inpainting",
    "cut out by masks that can be wrong": lambda method: bool(method.mask_error),
}


def unusable_for(method: Method, picture: PictureOfSet, shown: LoadedPicture) -> str:
    """Why a method has no clip of a picture, in words; empty where it has one."""
    if method.clips:
        return ""
    if not method.contact and (shown.scene or {}).get("contact") is None:
        return "its scene has no contact that could be left out"
    if shown.layered:
        return next((f"layered artwork is not {why}" for why, holds in _FLAT.items() if holds(method)), "")
    if method.renderer == "inpainting" and picture.plate:
        return "with a plate nothing is missing that a model could paint"
    return ""
