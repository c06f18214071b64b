"""Random weights that are the same everywhere, so that what a public network gives with them can be written down."""

from __future__ import annotations

import zlib
from collections.abc import Mapping

import numpy as np
import torch

__all__ = ["drawn_weights"]


def drawn_weights(shapes: Mapping[str, tuple[int, ...]], *, seed: int = 0) -> dict[str, torch.Tensor]:
    """Tensors by name, each from its name and the seed alone, of such sizes that values pass through all layers."""
    return {name: torch.from_numpy(_drawn(name, shape, seed)) for name, shape in shapes.items()}


def _drawn(name: str, shape: tuple[int, ...], seed: int) -> np.ndarray:
    values = np.random.default_rng([zlib.crc32(name.encode()), seed]).standard_normal(shape, dtype=np.float32)
    if len(shape) > 1:
        return values * np.float32((2 / np.prod(shape[1:])) ** 0.5)
    if name.endswith("running_var"):
        return np.float32(0.5) + np.abs(values)
    return np.float32(name.endswith(("bn.weight", "norm.weight"))) + np.float32(0.1) * values
