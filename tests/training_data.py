"""Small networks and a small data folder to train them on: a disc that wanders over paper, and its outline."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
import random_svd
import torch
from physanimator.rendering.pictures import write_animation
from physanimator.rendering.svd import NetworkConfiguration, svd_weights
from physanimator.rendering.svd.autoencoder import build_autoencoder
from physanimator.rendering.svd.sampler import LATENT_SCALE
from physanimator.rendering.training import ClipRecord
from physanimator.rendering.training.data_folder import clip_file, index_file, sketch_file

__all__ = ["SMALL", "small_svd", "striped_oval", "striped_shot", "write_data"]

PAPER = (240, 238, 232)

SMALL = replace(
    random_svd.TINY,
    network=NetworkConfiguration(
        model_channels=32,
        channel_mult=(1,),
        num_res_blocks=1,
        attention_at_levels=(0,),
        num_head_channels=16,
        context_dim=24,
        adm_in_channels=24,
        ids_embed_dim=8,
    ),
)


def small_svd(path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Stable Video Diffusion with one small level as a single file, which is then read with these sizes.

    The weights are random, with what all trained networks have in common: latents tell what is dark and what is light,
    and are about as strong as the sampler expects; layers beside the main path add little to it.
    """
    monkeypatch.setattr(random_svd, "TINY", SMALL)
    of_svd = svd_weights.ModelSizes
    monkeypatch.setattr(svd_weights, "ModelSizes", lambda *told: of_svd(*told) if told else SMALL)
    weights = random_svd.weights(SMALL)
    _average_pictures(weights["autoencoder"])
    for name, tensor in weights["unet"].items():
        if re.search(r"(out_layers\.3|to_out\.0|net\.2|proj_out)\.(weight|bias)$", name):
            tensor *= 0.3
    # The latents of the reference come as the autoencoder gives them, the noisy ones scaled.
    weights["unet"]["input_blocks.0.0.weight"][:, 4:] *= LATENT_SCALE
    return random_svd.write_single_file(path, weights)


@torch.no_grad()
def _average_pictures(tensors: dict[str, torch.Tensor]) -> None:
    """Let the autoencoder see the average of places instead of random patterns within them."""
    for name, tensor in tensors.items():
        if name.startswith("encoder.") and (".conv2." in name or "to_out" in name):
            tensor *= 0.1
        elif name.startswith("encoder.") and tensor.ndim == 4 and tensor.shape[2] == 3 and ".conv1." not in name:
            tensor[:] = 2 * tensor.mean((2, 3), keepdim=True)
    autoencoder = build_autoencoder(SMALL.autoencoder)
    autoencoder.load_state_dict(tensors)
    pictures = np.stack(striped_shot(0, 8)).astype(np.float32) / 127.5 - 1
    latents = autoencoder.encode(torch.from_numpy(pictures).permute(0, 3, 1, 2)).latent_dist.mode()
    gain = 0.5 / LATENT_SCALE / latents.std((0, 2, 3))
    tensors["quant_conv.weight"][:4] *= gain[:, None, None, None]
    tensors["quant_conv.bias"][:4] *= gain


def striped_shot(seed: int, frames: int, side: int = 64) -> list[np.ndarray]:
    """A striped oval that flies over paper and back from its edges; its stripes are seen in sketches."""
    chance = np.random.default_rng(seed)
    sprite, inside = striped_oval(2 * side, chance.uniform(14, 22, 2), chance.uniform(0, np.pi))
    place, angle = chance.uniform(12, side - 12, 2), chance.uniform(0, 2 * np.pi)
    step = chance.uniform(0.8, 1.6) * np.array([np.cos(angle), np.sin(angle)])
    drawn = []
    for _ in range(frames):
        shift = np.array([[1, 0, place[0] - side], [0, 1, place[1] - side]], dtype=np.float32)
        cover = cv2.warpAffine(inside.astype(np.float32), shift, (side, side))[..., None]
        moved = cv2.warpAffine(sprite, shift, (side, side), borderValue=PAPER)
        drawn.append((np.array(PAPER) * (1 - cover) + moved * cover).round().astype(np.uint8))
        place = place + step
        step = np.where((place < 8) | (place > side - 8), -np.sign(place - side / 2) * np.abs(step), step)
    return drawn


def striped_oval(side: int, radii: np.ndarray, turn: float, stripe: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """A square picture of an oval with stripes ``stripe`` px wide, and where it is."""
    y, x = np.mgrid[:side, :side] - side / 2
    along, across = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
    inside = (along / radii[0]) ** 2 + (across / radii[1]) ** 2 < 1
    picture = np.full((side, side, 3), PAPER, np.uint8)
    picture[inside] = (70, 96, 190)
    picture[inside & (along // stripe % 4 == 0)] = (16, 30, 90)
    return picture, inside


def write_data(folder: Path, *, clips: int = 6, frames: int = 24, side: int = 64) -> Path:
    """A data folder."""
    for name in ("clips", "sketches"):
        (folder / name).mkdir(parents=True)
    records = []
    for number in range(clips):
        pictures, sketches = _wandering(np.random.default_rng(number), frames, side)
        write_animation(pictures, clip_file(folder, f"disc_{number:02d}"), 24)
        write_animation(sketches, sketch_file(folder, f"disc_{number:02d}"), 24)
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
