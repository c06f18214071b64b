"""The paper's renderer as a choice of the node Render: its options, and what it draws."""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from comfy_api.latest import io
from numpy.typing import NDArray

from ..rendering.still_parts import keep_still_parts, moving_region
from ..rendering.svd.frame_layout import CLIP_FRAMES
from ..rendering.svd.options import SketchVideoOptions
from .computing import PRECISIONS, dtype_of, host_placement
from .model_files import SKETCH_VIDEO, lvcd_choices, lvcd_file, svd_choices, svd_file
from .progress import host_preview, host_progress
from .tensors import pictures_of

if TYPE_CHECKING:
    import torch

    from ..rendering.composite import LayeredRenderer
    from ..rendering.svd.models import SketchVideoModels
    from ..rendering.svd.sampler import SampledStep

__all__ = ["sketch_video_frames", "sketch_video_inputs"]

_AREAS = {"448 x 256": 448 * 256, "576 x 320": 576 * 320, "768 x 448": 768 * 448, "1024 x 576": 1024 * 576}
_USUAL = SketchVideoOptions()

FloatImage = NDArray[np.float32]


def sketch_video_inputs() -> list[Any]:
    """The inputs that this choice brings."""
    return [
        io.Image.Input("sketches", tooltip="From Warp Sketch: dark lines on white, one for each frame of the motion."),
        io.Combo.Input(
            "svd_model",
            options=svd_choices(),
            tooltip="Stable Video Diffusion, image to video, 14 frames: svd.safetensors in models/checkpoints, or its"
            " diffusers folder in models/diffusers.",
        ),
        io.Combo.Input(
            "lvcd_model",
            options=lvcd_choices(),
            tooltip="LVCD: lvcd.ckpt or lvcd-fp16.safetensors in models/controlnet, models/checkpoints or models/lvcd.",
        ),
        io.Int.Input(
            "noise_from",
            default=_USUAL.seed,
            min=0,
            max=2**32 - 1,
            tooltip="Seed of the noise: another number gives another clip, the same one the same clip.",
        ),
        io.Int.Input(
            "steps",
            default=_USUAL.steps,
            min=2,
            max=100,
            tooltip="Sampling steps of each segment; time grows with them. 25 is usual, 12 makes drafts.",
        ),
        io.Int.Input(
            "motion_bucket",
            default=_USUAL.motion_bucket,
            min=1,
            max=255,
            tooltip="How much motion the model expects [1 to 255]. Lower keeps the picture calmer.",
        ),
        io.Int.Input(
            "overlap",
            default=_USUAL.overlap,
            min=3,
            max=CLIP_FRAMES // 2,
            tooltip="Frames that neighbouring segments of a long clip share; more hides seams and takes longer.",
        ),
        io.Combo.Input(
            "working_size",
            options=list(_AREAS),
            default="576 x 320",
            tooltip="Area that the model works on [px], in the illustration's proportions; trained at 576 x 320.",
        ),
        io.Int.Input(
            "frames_per_second",
            default=_USUAL.frames_per_second,
            min=1,
            max=60,
            tooltip="What the model is told of the frame rate; 6 is what it was trained with. The video's own stays.",
        ),
        io.Float.Input(
            "picture_noise",
            default=_USUAL.picture_noise,
            min=0.0,
            max=1.0,
            step=0.01,
            tooltip="Noise on the illustration [0 to 1]: more lets frames leave it further.",
        ),
        io.Int.Input(
            "decoded_together",
            default=_USUAL.decoded_together,
            min=5,
            max=64,
            tooltip="Frames that are decoded at once; fewer need less memory.",
        ),
        io.Combo.Input(
            "precision",
            options=list(PRECISIONS),
            default=PRECISIONS[0],
            tooltip="auto: 16 bits where the device computes faster with them.",
        ),
        io.Boolean.Input(
            "keep_still_parts",
            default=True,
            tooltip="Takes all pixels that no body ever covers from the illustration.",
        ),
        io.Float.Input(
            "soft_edge",
            default=24.0,
            min=0.0,
            max=1000.0,
            step=1.0,
            tooltip="Width of the transition to the kept pixels [px].",
        ),
    ]


def sketch_video_frames(image: FloatImage, layers: LayeredRenderer, choice: dict[str, Any]) -> Iterator[FloatImage]:
    """The frames.

    Args:
        image: the illustration, shape [h, w, 3].
        layers: knows where the moving bodies are.
        choice: values of the inputs.
    """
    import torch
    from comfy import model_management

    from ..physics.errors import require
    from ..rendering.svd.memory import peak_memory
    from ..rendering.svd.renderer import SketchVideoRenderer

    files = _files(choice)
    sketches = pictures_of(choice["sketches"], name="sketches")
    require(
        "sketches", len(sketches), len(sketches) == len(layers), f"one for each of the motion's {len(layers)} frames"
    )
    device = model_management.get_torch_device()
    if device.type == "cuda":
        torch.cuda.reset_peak_memory_stats(device)
    began = time.perf_counter()
    renderer = SketchVideoRenderer(
        _models(*files, dtype_of(choice["precision"], device)),
        options=_options(choice),
        placement=host_placement(device),
    )
    region = None
    if choice["keep_still_parts"]:
        alphas = (layers.alpha(number) for number in range(len(layers)))
        region = moving_region(alphas, soft_edge=choice["soft_edge"])
    for frame in renderer.frames(image, list(sketches), **_watched(device)):
        yield frame if region is None else keep_still_parts(frame, image, region)
    seconds, peak = time.perf_counter() - began, peak_memory(device) / 2**30
    logging.info("Render: %d frames in %.0f s, at most %.1f GiB of memory", len(sketches), seconds, peak)


def _options(choice: dict[str, Any]) -> SketchVideoOptions:
    same = ("steps", "motion_bucket", "overlap", "frames_per_second", "picture_noise", "decoded_together")
    chosen = {name: choice[name] for name in same}
    return SketchVideoOptions(area=_AREAS[choice["working_size"]], seed=choice["noise_from"], **chosen)


def _files(choice: dict[str, Any]) -> tuple[Path, Path]:
    """The chosen model files."""
    from ..physics.errors import InvalidInputError

    svd, lvcd = svd_file(choice["svd_model"]), lvcd_file(choice["lvcd_model"])
    if svd is None or lvcd is None:
        missing = [name for name, path in {"svd_model": svd, "lvcd_model": lvcd}.items() if path is None]
        told = " ".join(f"{choice[name]} is missing: {SKETCH_VIDEO[name]}" for name in missing)
        raise InvalidInputError(f"{told} Or set renderer to composite, which needs no model.")
    return svd, lvcd


def _models(svd: Path, lvcd: Path, dtype: torch.dtype) -> SketchVideoModels:
    return _loaded(svd, svd.stat().st_mtime, lvcd, lvcd.stat().st_mtime, dtype)


@lru_cache(maxsize=1)
def _loaded(svd: Path, _: float, lvcd: Path, __: float, dtype: torch.dtype) -> SketchVideoModels:
    """The networks that were used last, as long as their files stay as they are."""
    from ..rendering.svd.models import load_models

    return load_models(svd, lvcd, dtype=dtype)


def _watched(device: torch.device) -> dict[str, Any]:
    """Progress, and a look at the clip's middle after each step."""
    report, preview = host_progress(), host_preview(device)
    latest: list[Any] = []

    def watch(now: SampledStep) -> None:
        middle = len(now.clean) - CLIP_FRAMES // 2
        latest[:] = [preview(now.clean[middle : middle + 1])]

    return {"watch": watch, "progress": lambda done, total: report(done, total, latest.pop() if latest else None)}
