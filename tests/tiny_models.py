"""Small random networks in a host's model folders, for every choice of the strict paper's graph."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import random_sam
import random_svd
import random_tooncrafter
import reference_nets
import torch

__all__ = ["with_tiny_models", "write_tiny_models"]

_CHOICES: dict[str, dict[str, Any]] = {
    "SegmentByPoints": {"backend.sam_model": "tiny/", "backend.precision": "fp32"},
    "ExtractSketch": {"extractor.model": "sk_model.pth", "extractor.working_size": 160, "extractor.precision": "fp32"},
    "Render": {
        "renderer.svd_model": "diffusers/svd-tiny",
        "renderer.lvcd_model": "lvcd-tiny.safetensors",
        "renderer.steps": 2,
        "renderer.working_size": "448 x 256",
        "renderer.precision": "fp32",
    },
    "Interpolate": {
        "backend.tooncrafter_model": "tooncrafter-tiny.ckpt",
        "backend.sketch_model": "sketch_encoder.ckpt",
        "backend.steps": 2,
        "backend.precision": "fp32",
    },
}


def write_tiny_models(models: Path) -> None:
    """Write them into the folders that the node's help names.

    Args:
        models: the host's folder of models.
    """
    for kind in ("diffusers", "controlnet", "checkpoints", "sams"):
        (models / kind).mkdir(parents=True, exist_ok=True)
    random_sam.save_network(random_sam.random_network("sam2"), models / "sams" / "tiny")
    generator = torch.Generator().manual_seed(0)
    shapes = reference_nets.full_shapes("informative_drawings_sk_model")
    lines = {name: torch.randn(shape, generator=generator) * 0.05 for name, shape in shapes.items()}
    torch.save(lines, models / "controlnet" / "sk_model.pth")
    svd = random_svd.weights()
    random_svd.write_folder(models / "diffusers" / "svd-tiny", svd)
    random_svd.write_lvcd(models / "controlnet" / "lvcd-tiny.safetensors", svd, dtype=torch.float16)
    drawn = random_tooncrafter.weights()
    model = random_tooncrafter.write_lightning(models / "checkpoints" / "tooncrafter-tiny.ckpt", drawn)
    sketch = random_tooncrafter.write_sketch_encoder(models / "controlnet" / "sketch_encoder.ckpt", drawn)
    for file in (model, sketch):
        random_tooncrafter.write_sizes(file)


def with_tiny_models(api: dict[str, Any], *, frames: int) -> dict[str, Any]:
    """A graph in API format with these files chosen, as few steps as there can be, and a short clip."""
    changed = copy.deepcopy(api)
    for node in changed.values():
        kind = node["class_type"].removeprefix("PhysAnimator_")
        node["inputs"] |= _CHOICES.get(kind, {})
        if kind == "Simulate":
            # What a random network cuts out is ragged: its small triangles want a shorter step than the paper's.
            node["inputs"] |= {"frames": frames, "time_step": 0.0005}
    return changed
