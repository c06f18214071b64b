"""Stable Video Diffusion as choices of the node Render: what it draws, on the host's device."""

from __future__ import annotations

import itertools
import logging
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, require
from ...rendering.neural.drawing import sketch_guided_frames
from ...rendering.svd import CLIP_FRAMES, CrudeAnimation, SVDOptions
from ..host import dtype_of, watched_sampling
from .clip_inputs import colour_match_of, is_loop
from .model_files import SVD_FILES, lvcd_file, svd_file
from .networks import Networks, kept_networks
from .svd_inputs import AREAS, NO_LVCD

if TYPE_CHECKING:
    import torch

    from ...rendering.composite import Background, LayeredRenderer
    from ...rendering.neural.colour_drift import Reference
    from ...rendering.svd.models import SVDModels

__all__ = ["check_followed", "missing_svd_files", "svd_frames"]

FloatImage = NDArray[np.float32]


def svd_frames(
    image: FloatImage,
    sketches: Sequence[FloatImage],
    layers: LayeredRenderer | None,
    choice: dict[str, Any],
    background: Background | None = None,
) -> Iterator[FloatImage]:
    """The frames.

    Args:
        image: the illustration, shape [h, w, 3].
        sketches: one for each frame, shape [h, w, 3] each; none where only the animation is followed.
        layers: knows where the moving bodies are; None where nothing does, and nothing is kept still.
        choice: values of the inputs.
        background: of the animation that frames follow, opaque; None where they follow sketches alone.
    """
    import torch
    from comfy import model_management

    from ...rendering.networks.memory import peak_memory

    files = _files(choice)
    if layers is not None and sketches:
        frames = f"one for each of the motion's {len(layers)} frames"
        require("sketches", len(sketches), len(sketches) == len(layers), frames)
    device = model_management.get_torch_device()
    if device.type == "cuda":
        torch.cuda.reset_peak_memory_stats(device)
    began = time.perf_counter()
    networks = _networks(*files, dtype_of(choice["precision"], device))
    kept = choice["keep_still_parts"] and layers is not None
    loops = is_loop(choice.get("loop"), None if layers is None else layers.motion, len(sketches) or len(layers or ()))
    # In a loop no frame is the illustration, which the model begins with.
    animation, before = None, 1 if loops else 0
    if layers is not None and background is not None:
        before = 1 if loops or (layers.motion.loop is not None and not sketches) else 0
        animation = _followed(image, layers, background, before)
    frames = sketch_guided_frames(
        networks.held,
        image,
        [*[_lines_of(image)] * before, *sketches] if sketches else [],
        options=_options(choice, _follow_of(choice) if animation else "sketches"),
        placement=networks.placement(device),
        animation=animation,
        alphas=map(layers.alpha, range(len(layers))) if kept else None,
        soft_edge=choice["soft_edge"],
        loops=loops,
        colour_match=colour_match_of(choice),
        references=None if layers is None else _colours(image, layers, before),
        **watched_sampling(device, lambda clean: clean[len(clean) - CLIP_FRAMES // 2 :][:1]),
    )
    yield from itertools.islice(frames, before, None)
    seconds, peak = time.perf_counter() - began, peak_memory(device) / 2**30
    count = len(sketches) or len(layers or ())
    logging.info("Render: %d frames in %.0f s, at most %.1f GiB of memory", count, seconds, peak)


def _lines_of(image: FloatImage) -> FloatImage:
    """The illustration's own sketch, shape [h, w, 3]."""
    from ...rendering.sketch import extract_sketch

    return np.repeat(extract_sketch(image)[..., None], 3, axis=2)


def _colours(image: FloatImage, layers: LayeredRenderer, before: int) -> Iterator[Reference]:
    """The colours that frames should have: composite's outside its holes, and first those of the illustration."""
    from ...rendering.composite import Background, shown_frame_and_alpha
    from ...rendering.neural.colour_drift import own_colours
    from ...rendering.pictures import as_float

    yield from [own_colours(as_float(image))] * before
    for number in range(len(layers)):
        frame, alpha = shown_frame_and_alpha(layers, number, Background())
        yield as_float(frame), 1 - layers.uncovered_by(alpha)


def _followed(image: FloatImage, layers: LayeredRenderer, background: Background, before: int) -> CrudeAnimation:
    """Composite's frames; where ``before`` is 1, one more before them that shows the illustration."""
    from ...rendering.composite import shown_frame_and_alpha

    def at(number: int) -> tuple[NDArray[Any], FloatImage]:
        if number < before:
            return image, layers.alpha_at_rest
        return shown_frame_and_alpha(layers, number - before, background)

    return CrudeAnimation(before + len(layers), at)


def check_followed(choice: dict[str, Any], *, sketches: bool) -> None:
    """Refuse what does not go together in the choice that follows the animation, before the work.

    Args:
        choice: values of the inputs.
        sketches: some are connected.

    Raises:
        InvalidInputError: there is something.
    """
    lvcd, weak, strong = choice.get("lvcd_model", NO_LVCD), choice.get("weak"), choice.get("strong")
    require("lvcd_model", lvcd, lvcd != NO_LVCD or not sketches, "a file where sketches are connected, which it reads")
    require("lvcd_model", lvcd, lvcd == NO_LVCD or sketches, f"{NO_LVCD} where no sketches are connected")
    if isinstance(weak, float | int) and isinstance(strong, float | int):
        require("strong", strong, weak <= strong, f"weak, which is {weak}, or more")


def _follow_of(choice: dict[str, Any]) -> str:
    """What frames follow, of the choice that follows the animation."""
    return "animation" if choice["lvcd_model"] == NO_LVCD else "both"


def _options(choice: dict[str, Any], follow: str) -> SVDOptions:
    same = ("steps", "motion_bucket", "overlap", "frames_per_second", "picture_noise", "decoded_together")
    chosen = {name: choice[name] for name in same}
    clock = ("weak", "strong", "guidance")
    chosen |= {name: choice[name] for name in clock if name in choice and (name != "guidance" or follow == "animation")}
    return SVDOptions(area=AREAS[choice["working_size"]], seed=choice["noise_from"], follow=follow, **chosen)


def missing_svd_files(choice: dict[str, Any]) -> str:
    """What to tell about the chosen model files that are not there, with where to get them; empty if none."""
    find = {"svd_model": svd_file, "lvcd_model": lvcd_file}
    named = {name: choice[name] for name in find if choice.get(name, NO_LVCD) != NO_LVCD}
    missing = [name for name, file in named.items() if find[name](file) is None]
    told = " ".join(f"{choice[name]} is missing: {SVD_FILES[name]}" for name in missing)
    return f"{told} Or set renderer to composite, which needs no model." if told else ""


def _files(choice: dict[str, Any]) -> tuple[Path, Path | None]:
    """The chosen model files."""
    if missing := missing_svd_files(choice):
        raise InvalidInputError(missing)
    svd, lvcd = svd_file(choice["svd_model"]), None
    if choice["lvcd_model"] != NO_LVCD:
        lvcd = lvcd_file(choice["lvcd_model"])
    assert svd is not None
    return svd, lvcd


def _networks(svd: Path, lvcd: Path | None, dtype: torch.dtype) -> Networks[SVDModels]:
    from ...rendering.svd.models import load_models

    key = svd, svd.stat().st_mtime, lvcd, lvcd and lvcd.stat().st_mtime, dtype
    return kept_networks("svd", key, lambda: load_models(svd, lvcd, dtype=dtype))
