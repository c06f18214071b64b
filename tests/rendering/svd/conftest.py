"""Model files of small random networks, made once."""

from __future__ import annotations

from pathlib import Path

import pytest
import random_svd
import torch
from physanimator.rendering.svd.models import SVDModels, load_models


@pytest.fixture(scope="session")
def weights() -> dict[str, dict[str, torch.Tensor]]:
    return random_svd.weights()


@pytest.fixture(scope="session")
def single_file(weights: dict[str, dict[str, torch.Tensor]], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return random_svd.write_single_file(tmp_path_factory.mktemp("checkpoints") / "svd.safetensors", weights)


@pytest.fixture(scope="session")
def folder(weights: dict[str, dict[str, torch.Tensor]], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return random_svd.write_folder(tmp_path_factory.mktemp("diffusers") / "svd", weights)


@pytest.fixture(scope="session")
def lvcd(weights: dict[str, dict[str, torch.Tensor]], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return random_svd.write_lvcd(tmp_path_factory.mktemp("lvcd") / "lvcd.ckpt", weights)


@pytest.fixture(scope="session")
def models(single_file: Path, lvcd: Path) -> SVDModels:
    return load_models(single_file, lvcd, sizes=random_svd.TINY)
