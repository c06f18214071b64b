"""Memory and time of a training step at full size, with random weights: ``python training.py --json``.

Without a GPU the memory is counted on the meta device, where tensors have shapes and no storage: weights, gradients and
moments exactly; intermediate results as far as autograd keeps them when every stage is computed twice, and attention
keeps no matrix of weights, as its fused kernels on a GPU do. With a GPU, seconds a step and peak memory are measured.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import source_tree  # noqa: F401
import torch
from physanimator.rendering.networks.checkpoints import build_without_storage
from physanimator.rendering.svd import NetworkConfiguration
from physanimator.rendering.svd.controlnet import SketchControlNet
from physanimator.rendering.svd.encoder import Stage
from physanimator.rendering.svd.unet import SpatioTemporalUNet
from physanimator.rendering.training.lvcd_networks import LVCDNetworks
from physanimator.rendering.training.recomputing import recompute_stages
from physanimator.rendering.training.settings import PRESETS
from torch import Tensor, nn
from torch.nn import functional

SIZES = {"256x448x14": (256, 448, 14), "320x576x15": (320, 576, 15)}
GIGABYTE = 2**30


def networks() -> LVCDNetworks:
    """LVCD's, in the precision of the preset, without storage."""
    size = NetworkConfiguration()
    made = build_without_storage(lambda: LVCDNetworks(SketchControlNet(size), SpatioTemporalUNet(size)))
    for parameter in made.parameters():
        if not parameter.requires_grad:
            parameter.data = parameter.data.to(torch.bfloat16)
    return made


def batch(height: int, width: int, frames: int, device: str) -> dict[str, Tensor]:
    """One clip."""
    latents = torch.zeros((1, frames, 4, height // 8, width // 8), device=device)
    return {
        "latents": latents,
        "reference": latents[:, 0],
        "embedding": torch.zeros((1, 1024), device=device),
        "hints": torch.zeros((1, frames, height, width), device=device),
        "sigma": torch.ones((1,), device=device),
        "noise": torch.zeros_like(latents),
    }


class Kept:
    """Bytes that autograd keeps, each tensor once."""

    def __init__(self, weights: set[int]) -> None:
        self.weights, self.seen, self.total = weights, dict[int, Tensor](), 0

    def __call__(self, tensor: Tensor) -> Tensor:
        storage = tensor.untyped_storage()
        if storage._cdata not in self.weights and storage._cdata not in self.seen:
            self.seen[storage._cdata] = tensor
            self.total += storage.nbytes()
        return tensor


@contextmanager
def attention_without_matrix() -> Iterator[None]:
    """Let attention keep queries, keys, values and its result, as fused kernels do."""

    def fused(q: Tensor, k: Tensor, v: Tensor, attn_mask: Tensor | None = None) -> Tensor:
        return q * k.sum() * v.sum() if q.shape != v.shape else q * (k * v).sum()

    real = functional.scaled_dot_product_attention
    functional.scaled_dot_product_attention = fused  # type: ignore[assignment]
    try:
        yield
    finally:
        functional.scaled_dot_product_attention = real


def counted(height: int, width: int, frames: int) -> dict[str, float]:
    """Gigabytes of one step, by what they are for."""
    made = networks().float()  # there is no autocast on the meta device; results are counted as half of this
    trained = sum(each.numel() for each in made.parameters() if each.requires_grad)
    frozen = sum(each.numel() for each in made.parameters() if not each.requires_grad)
    weights = {each.untyped_storage()._cdata for each in made.parameters()}
    outside, largest, inputs = Kept(weights), 0, 0

    def watched(stage: nn.Module) -> None:
        forward = stage.forward

        def counting(x: Tensor, conditions: Any) -> Tensor:
            nonlocal largest, inputs
            inside = Kept(weights)
            with torch.autograd.graph.saved_tensors_hooks(inside, lambda each: each):
                result = forward(x, conditions)
            largest, inputs = max(largest, inside.total), inputs + x.nbytes
            return result

        stage.forward = counting  # type: ignore[method-assign]

    for module in made.modules():
        if isinstance(module, Stage):
            watched(module)
    with (
        attention_without_matrix(),
        torch.device("meta"),
        torch.autograd.graph.saved_tensors_hooks(outside, lambda each: each),
    ):
        made(**batch(height, width, frames, "meta"))
    bytes_of = {
        "frozen weights, bf16": 2 * frozen,
        "trained weights, float32": 4 * trained,
        "their bf16 copies": 2 * trained,
        "gradients, float32": 4 * trained,
        "moments, 8 bits": 2 * trained,
        "inputs of stages": inputs / 2,
        "largest stage": largest / 2,
        "beside the stages": outside.total / 2,
    }
    found = {name: round(value / GIGABYTE, 2) for name, value in bytes_of.items()}
    return found | {"together": round(sum(bytes_of.values()) / GIGABYTE, 2)}


def measured(height: int, width: int, frames: int, steps: int = 3) -> dict[str, float]:
    """Seconds of a batch and gigabytes at most, on the GPU, by the preset ``24gb``."""
    from physanimator.rendering.training.optimizer import made_optimizer

    settings, device = replace(PRESETS["24gb"]["lvcd"], frames=frames), torch.device("cuda")
    made = networks().to_empty(device=device)
    for parameter in made.parameters():
        nn.init.normal_(parameter, std=0.02)
    recompute_stages(made)
    optimizer = made_optimizer([each for each in made.parameters() if each.requires_grad], settings, device)
    given, seconds = batch(height, width, frames, "cuda"), []
    for _ in range(steps):
        torch.cuda.synchronize()
        start = time.perf_counter()
        with torch.autocast("cuda", torch.bfloat16):
            loss = made(**given).mean()
        loss.backward()
        torch.cuda.synchronize()
        seconds.append(time.perf_counter() - start)
        optimizer.step()
        optimizer.zero_grad()
    most = torch.cuda.max_memory_allocated() / GIGABYTE
    return {"seconds_a_batch": min(seconds), "seconds_a_step_of_32": 32 * min(seconds), "gigabytes": round(most, 2)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print JSON")
    options = parser.parse_args()
    found: dict[str, Any] = {"counted_gigabytes": {name: counted(*size) for name, size in SIZES.items()}}
    if torch.cuda.is_available():
        found["device"] = torch.cuda.get_device_name()
        found["measured"] = {name: measured(*size) for name, size in SIZES.items()}
    print(json.dumps(found, indent=None if options.json else 2))


if __name__ == "__main__":
    main()
