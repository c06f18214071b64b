"""Model files of small random networks, made once."""

from __future__ import annotations

from pathlib import Path

import pytest
import random_tooncrafter
import torch
from physanimator.rendering.tooncrafter.models import ToonCrafterModels, load_models

Weights = dict[str, dict[str, torch.Tensor]]


@pytest.fixture(scope="session")
def weights() -> Weights:
    return random_tooncrafter.weights()


@pytest.fixture(scope="session")
def full_file(weights: Weights, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return random_tooncrafter.write_lightning(tmp_path_factory.mktemp("full") / "model.ckpt", weights)


@pytest.fixture
def pruned_file(weights: Weights, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """For each test its own: the empty prompt is kept beside it."""
    return random_tooncrafter.write_pruned(tmp_path_factory.mktemp("pruned") / "pruned-fp16.safetensors", weights)


@pytest.fixture(scope="session")
def sketch_file(weights: Weights, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return random_tooncrafter.write_sketch_encoder(tmp_path_factory.mktemp("sketch") / "sketch_encoder.ckpt", weights)


@pytest.fixture(scope="session")
def models(full_file: Path, sketch_file: Path) -> ToonCrafterModels:
    return load_models(full_file, sketch=sketch_file, sizes=random_tooncrafter.TINY)
