"""A small random model for inpainting and one for pictures."""

from __future__ import annotations

from pathlib import Path

import pytest
from physanimator.rendering.inpainting.models import InpaintingModels, load_inpainting_models
from random_inpainting import write_inpainting_folder


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """For pictures: its UNet sees latents alone."""
    return write_inpainting_folder(tmp_path_factory.mktemp("models") / "plain")


@pytest.fixture(scope="session")
def plain(folder: Path) -> InpaintingModels:
    return load_inpainting_models(folder)


@pytest.fixture(scope="session")
def seeing(tmp_path_factory: pytest.TempPathFactory) -> InpaintingModels:
    """For inpainting: its UNet also sees the mask and what is around it."""
    return load_inpainting_models(
        write_inpainting_folder(tmp_path_factory.mktemp("models") / "seeing", sees_holes=True)
    )
