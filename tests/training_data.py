"""Small networks and a small data folder to train them on: a disc that wanders over paper, and its outline."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
import random_svd
from physanimator.rendering.pictures import write_animation
from physanimator.rendering.svd import NetworkConfiguration, svd_weights
from physanimator.rendering.training import ClipRecord
from physanimator.rendering.training.data_folder import clip_file, index_file, sketch_file

__all__ = ["SMALL", "small_svd", "write_data"]

SMALL = replace(
    random_svd.TINY,
    network=NetworkConfiguration(
        model_channels=32,
        channel_mult=(1, 2),
        num_res_blocks=1,
        attention_at_levels=(0, 1),
        num_head_channels=16,
        context_dim=24,
        adm_in_channels=24,
        ids_embed_dim=8,
    ),
)


def small_svd(path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Stable Video Diffusion with two small levels as a single file, which is then read with these sizes."""
    of_svd = svd_weights.ModelSizes
    monkeypatch.setattr(svd_weights, "ModelSizes", lambda *told: of_svd(*told) if told else SMALL)
    return random_svd.write_single_file(path, random_svd.weights(SMALL))


def write_data(folder: Path, *, clips: int = 6, frames: int = 24, shuffled: bool = False, side: int = 64) -> Path:
    """A data folder; with ``shuffled`` each clip has the sketches of another."""
    for name in ("clips", "sketches"):
        (folder / name).mkdir(parents=True)
    records = []
    for number in range(clips):
        pictures, sketches = _wandering(np.random.default_rng(number), frames, side)
        write_animation(pictures, clip_file(folder, f"disc_{number:02d}"), 24)
        other = (number + 1) % clips if shuffled else number
        write_animation(sketches, sketch_file(folder, f"disc_{other:02d}"), 24)
        seconds = frames / 24
        record = ClipRecord(f"disc_{number:02d}", "drawn", 0.0, seconds, frames, 24.0, side, side, 0.3, True)
        records.append(record.as_line())
    index_file(folder).write_text("\n".join(records) + "\n", encoding="utf-8")
    return folder


def _wandering(chance: np.random.Generator, frames: int, side: int) -> tuple[list[np.ndarray], list[np.ndarray]]:
    turns = chance.uniform(0.2 * side, 0.8 * side, (frames, 2))
    pictures, sketches = [], []
    for frame in range(frames):
        at, share = divmod(frame / 3, 1)
        x, y = turns[int(at)] * (1 - share) + turns[int(at) + 1] * share
        picture, sketch = np.full((side, side, 3), 245, np.uint8), np.full((side, side, 3), 255, np.uint8)
        cv2.circle(picture, (round(x), round(y)), side // 5, (10, 20, 160), -1)
        cv2.circle(sketch, (round(x), round(y)), side // 5, (0, 0, 0), max(side // 24, 1))
        pictures.append(picture)
        sketches.append(sketch)
    return pictures, sketches
