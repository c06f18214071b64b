"""Seconds and memory of clips by Stable Video Diffusion: ours in every mode, and diffusers' own pipeline; for svd.py.

Ours: "sketches" and "both" have LVCD; "animation" begins at a later step; "plain" is held to nothing and does what
diffusers does. That draws one segment of 14 frames, so longer clips are ours alone; "in turns" its networks come to the
GPU only for their work, as ours do.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import source_tree
import torch
from physanimator.rendering.networks.memory import peak_memory
from physanimator.rendering.networks.placement import Placement
from physanimator.rendering.svd import CLIP_FRAMES, CrudeAnimation, SVDOptions
from physanimator.rendering.svd.models import load_models
from physanimator.rendering.svd.renderer import SVDRenderer
from physanimator.rendering.svd.svd_weights import ModelSizes

random_svd = source_tree.helper("random_svd")

__all__ = ["AREAS", "GIB", "MODES", "SMALL", "OwnMemory", "clips"]

GIB = 2**30
AREAS = {"448x256": (448, 256), "576x320": (576, 320), "768x448": (768, 448), "1024x576": (1024, 576)}
MODES = ("sketches", "animation", "both", "plain", "diffusers", "diffusers in turns")
SMALL = replace(random_svd.TINY, image_encoder=replace(random_svd.TINY.image_encoder, picture=224))
"""Networks that a CPU can run; diffusers knows no other size of the encoder's picture than 224."""

# A noisy picture would have other noise in each of two programs.
_SAME = {"picture_noise": 0.0, "motion_bucket": 127, "guidance": 3.0}


class OwnMemory:
    """Most memory of this process beyond mapped files, while active [bytes]; 0 where the system does not tell."""

    def __enter__(self) -> OwnMemory:
        self.peak, self._start, self._done = 0, _own_bytes(), threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._done.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._done.wait(0.005):
            self.peak = max(self.peak, _own_bytes() - self._start)


def _own_bytes() -> int:
    status = Path("/proc/self/status")
    lines = status.read_text().splitlines() if status.exists() else []
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith("RssAnon:")), 0)


def clips(
    folder: Path, mode: str, compiled: bool, full: bool, dtype: torch.dtype, device: torch.device, options: Any
) -> dict[str, dict[str, float]]:
    """Figures of every size and length in one mode; in a process of its own, whose memory is its alone.

    Args:
        folder: with the files of :func:`svd.written`.
        mode: one of ``MODES``.
        compiled: whether networks are; the first clip, which compiles them, then does not count.
        full: sizes of the networks are the public ones.
        dtype: of the networks.
        device: where they compute.
        options: of the command line: areas, frames, steps.
    """
    torch.set_grad_enabled(False)
    theirs = mode.startswith("diffusers")
    begun = _diffusers if theirs else _ours
    draw = begun(folder, mode, compiled, ModelSizes() if full else SMALL, dtype, device)
    lengths = [count for count in options.frames if not theirs or count <= CLIP_FRAMES]
    found = {}
    for area in options.areas:
        if compiled:
            for count in lengths:
                draw(AREAS[area], count, 2)
        for count in lengths:
            found[f"{count} frames, {area}"] = _measured(draw, AREAS[area], count, options.steps, device)
    return found


Draw = Callable[[tuple[int, int], int, int], list[float]]
"""Draws a clip of a size [px], a number of frames and of steps; the times at which steps were done."""


def _measured(draw: Draw, size: tuple[int, int], frames: int, steps: int, device: torch.device) -> dict[str, float]:
    on_gpu = device.type == "cuda"
    if on_gpu:
        torch.cuda.reset_peak_memory_stats(device)
    began = time.perf_counter()
    with OwnMemory() as memory:
        marks = draw(size, frames, steps)
    seconds = time.perf_counter() - began
    between = np.diff(marks)
    return {
        "seconds": seconds,
        "seconds_a_step": float(np.median(between)) if len(between) else 0.0,
        "steps": len(marks),
        "peak_gib": (peak_memory(device) if on_gpu else memory.peak) / GIB,
    }


def _picture(size: tuple[int, int]) -> Any:
    return np.random.default_rng(0).integers(0, 256, (size[1], size[0], 3), dtype=np.uint8)


def _settings(mode: str, size: tuple[int, int], steps: int) -> SVDOptions:
    more = {"steps": steps, "area": size[0] * size[1]}
    if mode == "plain":
        return replace(SVDOptions.following("animation"), weak=0.0, strong=0.0, **_SAME, **more)
    return replace(SVDOptions.following(mode), **more)


def _ours(folder: Path, mode: str, compiled: bool, sizes: ModelSizes, dtype: torch.dtype, device: torch.device) -> Draw:
    lvcd = folder / "lvcd.ckpt" if mode in ("sketches", "both") else None
    models = load_models(folder / "svd.safetensors", lvcd, dtype=dtype, sizes=sizes)
    if compiled:
        for network in (models.unet, models.control):
            if network is not None:
                network.compile()

    def draw(size: tuple[int, int], frames: int, steps: int) -> list[float]:
        image, options = _picture(size), _settings(mode, size, steps)
        lines, covered = np.ones(image.shape[:2], np.float32), np.zeros(image.shape[:2], np.float32)
        covered[: size[1] // 2] = 1
        given = {"sketches": [lines] * frames} if options.follows_sketches else {}
        animation = CrudeAnimation(frames, lambda _: (image, covered)) if options.follows_animation else None
        marks: list[float] = []
        renderer = SVDRenderer(models, options=options, placement=Placement(device))
        drawn = renderer.frames(image, **given, animation=animation, watch=lambda _: marks.append(time.perf_counter()))
        assert len(list(drawn)) == frames
        return marks

    return draw


def _diffusers(
    folder: Path, mode: str, compiled: bool, sizes: ModelSizes, dtype: torch.dtype, device: torch.device
) -> Draw:
    diffusers_svd = source_tree.helper("diffusers_svd")
    pipeline = diffusers_svd.loaded(folder / "svd", dtype, device, in_turns=mode == "diffusers in turns")
    if compiled:
        pipeline.unet.compile()

    def draw(size: tuple[int, int], frames: int, steps: int) -> list[float]:
        marks: list[float] = []

        def watch(_: Any, __: int, ___: Any, given: dict[str, Any]) -> dict[str, Any]:
            marks.append(time.perf_counter())
            return given

        same = {"num_inference_steps": steps, "noise_aug_strength": 0.0, "decode_chunk_size": 10}
        clip = diffusers_svd.draw(pipeline, _picture(size), frames, callback_on_step_end=watch, **same)
        assert len(clip) == frames
        return marks

    return draw
