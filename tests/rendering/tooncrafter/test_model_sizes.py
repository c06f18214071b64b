"""Weights of other sizes than the public ones bring a document that tells them; what it says is not trusted."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
import random_tooncrafter as tiny
import torch
from physanimator.rendering.networks.checkpoints import CheckpointError
from physanimator.rendering.tooncrafter.model_sizes import ModelSizes, sizes_beside, sizes_file
from physanimator.rendering.tooncrafter.models import load_models

Weights = dict[str, dict[str, torch.Tensor]]


def test_without_a_document_the_sizes_are_the_public_ones(tmp_path: Path) -> None:
    assert sizes_beside(tmp_path / "model.ckpt", tmp_path / "sketch_encoder.ckpt") == ModelSizes()


def test_weights_of_other_sizes_load_with_their_documents(
    full_file: Path, sketch_file: Path, weights: Weights, tmp_path: Path
) -> None:
    model, sketch = (Path(shutil.copy(file, tmp_path)) for file in (full_file, sketch_file))
    for file in (model, sketch):
        tiny.write_sizes(file)
    assert sizes_beside(model, sketch) == tiny.TINY
    models = load_models(model, sketch=sketch)
    for part in ("unet", "sketch", "autoencoder"):
        for name, tensor in getattr(models, part).state_dict().items():
            torch.testing.assert_close(tensor, weights[part][name], rtol=0, atol=0)


def test_each_file_s_document_tells_of_that_file(tmp_path: Path) -> None:
    model, sketch = tmp_path / "model.ckpt", tmp_path / "lines.safetensors"
    sizes_file(model).write_text(
        '{"unet": {"model_channels": 64}, "sketch": {"model_channels": 96, "num_head_channels": 32}}'
    )
    assert sizes_beside(model).unet.model_channels == 64
    assert sizes_beside(model, sketch).sketch.model_channels == 320
    sizes_file(sketch).write_text('{"sketch": {"model_channels": 128}, "unet": {"model_channels": 192}}')
    both = sizes_beside(model, sketch)
    assert (both.unet.model_channels, both.sketch.model_channels) == (64, 128)


@pytest.mark.parametrize(
    ("document", "told"),
    [
        ("[]", "values by name"),
        ("{", "sizes of ToonCrafter"),
        ('{"unet": 3}', "values by name"),
        ('{"net": {}}', "among unet"),
        ('{"unet": {"channels": 64}}', "among model_channels"),
        ('{"unet": {"model_channels": "64"}}', "whole number"),
        ('{"unet": {"model_channels": 33}}', "multiple of 32"),
        ('{"unet": {"model_channels": true}}', "whole number"),
        ('{"unet": {"num_res_blocks": 1000000000}}', "from 1 to 100"),
        ('{"unet": {"num_head_channels": 0}}', "from 1 to"),
        ('{"unet": {"channel_mult": 4}}', "a list"),
        ('{"unet": {"channel_mult": [1, 1, 1, 1, 1, 1, 1, 1, 1]}}', "at most 8"),
        ('{"autoencoder": {"double_z": false}}', "double_z"),
        ('{"autoencoder": {"ch": 30}}', "sizes of ToonCrafter"),
        ('{"image_encoder": {"heads": 7}}', "a divisor of 1280"),
        ('{"text_encoder": {"heads": 7}}', "sizes of ToonCrafter"),
        ("[" * 100_000, "sizes of ToonCrafter"),
    ],
)  # fmt: skip
def test_a_document_that_tells_no_sizes_is_refused_in_one_sentence(tmp_path: Path, document: str, told: str) -> None:
    sizes_file(tmp_path / "model.ckpt").write_text(document)
    with pytest.raises(CheckpointError, match=told) as refused:
        sizes_beside(tmp_path / "model.ckpt")
    assert "model.sizes.json" in str(refused.value)
    assert len(str(refused.value)) < 400
    assert "\n" not in str(refused.value)


def test_sizes_that_the_weights_have_not_are_refused(full_file: Path, tmp_path: Path) -> None:
    model = Path(shutil.copy(full_file, tmp_path))
    sizes: dict[str, Any] = json.loads(tiny.write_sizes(model).read_text())
    sizes["unet"]["context_dim"] = 24
    sizes_file(model).write_text(json.dumps(sizes))
    with pytest.raises(CheckpointError, match="does not fit"):
        load_models(model)
