"""Small random weights of every network that the paper's way takes, in files of every format, for whole commands."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import pytest
import random_sam
import random_svd
import random_tooncrafter
import torch
from physanimator.rendering.networks.checkpoints import build_without_storage
from physanimator.rendering.sketch.drawings import InformativeDrawingsConfiguration
from physanimator.rendering.sketch.drawings.informative_drawings import InformativeDrawings
from physanimator.rendering.svd import svd_weights
from physanimator.rendering.tooncrafter import models as tooncrafter_models
from safetensors.torch import save_file

__all__ = ["FORMATS", "small_sizes", "write"]

FORMATS = ("folder", "single", "bin")
"""Ways in which all files may come together."""


def small_sizes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let files that do not tell their sizes have those of our small networks instead of the public ones."""
    of_svd = svd_weights.ModelSizes
    monkeypatch.setattr(svd_weights, "ModelSizes", lambda *told: of_svd(*told) if told else random_svd.TINY)
    monkeypatch.setattr(tooncrafter_models, "sizes_beside", lambda *files: random_tooncrafter.TINY)


def write(folder: Path, kind: str) -> dict[str, Path]:
    """One file or folder for each option that names weights.

    Args:
        folder: where to; made.
        kind: one of ``FORMATS``.
    """
    folder.mkdir(parents=True, exist_ok=True)
    svd, tooncrafter, lines, sam = _weights()
    if kind == "single":
        save_file(lines, folder / "lines.safetensors")
        torch.save(random_sam.original_names(sam.state_dict()), folder / "sam.pth")
        return {
            "svd": random_svd.write_single_file(folder / "svd.safetensors", svd),
            "lvcd": random_svd.write_lvcd(folder / "lvcd-fp16.safetensors", svd, dtype=torch.float16),
            "tooncrafter": random_tooncrafter.write_pruned(folder / "pruned.safetensors", tooncrafter),
            "sketch_encoder": random_tooncrafter.write_sketch_encoder(folder / "sketch.safetensors", tooncrafter),
            "image_encoder": random_tooncrafter.write_image_encoder(folder / "look.safetensors", tooncrafter),
            "text_encoder": random_tooncrafter.write_text_encoder(folder / "text.safetensors", tooncrafter),
            "lines": folder / "lines.safetensors",
            "sam": folder / "sam.pth",
        }
    torch.save(lines if kind == "folder" else {"state_dict": lines}, folder / "lines.pth")
    suffix = ".safetensors" if kind == "folder" else ".bin"
    model = random_tooncrafter.write_lightning if kind == "folder" else random_tooncrafter.write_deepspeed
    return {
        "svd": random_svd.write_folder(folder / "svd", svd, suffix=suffix),
        "lvcd": random_svd.write_lvcd(folder / "lvcd.ckpt", svd),
        "tooncrafter": model(folder / "model.ckpt", tooncrafter),
        "sketch_encoder": random_tooncrafter.write_sketch_encoder(
            folder / "sketch_encoder.ckpt", tooncrafter, wrapped=kind == "bin"
        ),
        "lines": folder / "lines.pth",
        "sam": random_sam.save_network(sam, folder / "sam"),
    }


@cache
def _weights() -> tuple[Any, ...]:
    drawer = build_without_storage(lambda: InformativeDrawings(InformativeDrawingsConfiguration()))
    lines = random_svd.random_weights(drawer, 9)
    # This seed's network cuts a piece of some size out of a picture with a dark bar, where others take all or nothing.
    return random_svd.weights(), random_tooncrafter.weights(), lines, random_sam.random_network("sam", seed=28)
