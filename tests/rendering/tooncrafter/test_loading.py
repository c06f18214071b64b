"""Every format that users have loads into the same networks; every other file is refused by name."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest
import random_tooncrafter as tiny
import torch
from physanimator.rendering.networks.checkpoints import CheckpointError
from physanimator.rendering.tooncrafter.kept_prompt import keep_prompt, kept_prompt_file
from physanimator.rendering.tooncrafter.models import ToonCrafterModels, load_models
from physanimator.rendering.tooncrafter.text_encoder import TextEncoder, empty_prompt

Weights = dict[str, dict[str, torch.Tensor]]


def assert_holds(models: ToonCrafterModels, weights: Weights, *, through: torch.dtype = torch.float32) -> None:
    for part in ("unet", "resampler", "autoencoder", "sketch", "image_encoder"):
        network = getattr(models, part)
        if network is None:
            continue
        kept = through if part in ("unet", "resampler", "autoencoder") else torch.float32
        for name, tensor in network.state_dict().items():
            torch.testing.assert_close(tensor, weights[part][name].to(kept).to(tensor.dtype), rtol=0, atol=0)


def empty_prompt_by(weights: Weights) -> torch.Tensor:
    encoder = TextEncoder(tiny.TINY.text_encoder).eval()
    encoder.load_state_dict(weights["text_encoder"])
    with torch.no_grad():
        return encoder(empty_prompt(tiny.TINY.text_encoder.tokens))


def test_the_full_file_holds_everything_but_the_sketch_encoder(models: ToonCrafterModels, weights: Weights) -> None:
    assert_holds(models, weights)
    assert models.sketch is not None
    assert models.image_encoder is not None
    torch.testing.assert_close(models.empty_prompt, empty_prompt_by(weights))


def test_deepspeeds_file(weights: Weights, tmp_path: Path) -> None:
    path = tiny.write_deepspeed(tmp_path / "model.ckpt", weights)
    assert_holds(load_models(path, sizes=tiny.TINY), weights)


@pytest.mark.parametrize("dtype", [torch.float16, torch.bfloat16, torch.float32])
def test_the_pruned_file_in_every_precision(weights: Weights, tmp_path: Path, dtype: torch.dtype) -> None:
    path = tiny.write_pruned(tmp_path / "pruned.safetensors", weights)
    models = load_models(path, dtype=dtype, sizes=tiny.TINY)
    assert_holds(models, weights, through=torch.float16)
    assert models.dtype == dtype
    assert next(models.autoencoder.parameters()).dtype == torch.float32
    assert models.image_encoder is None
    assert models.empty_prompt is None


@pytest.mark.parametrize(("name", "wrapped"), [("s.ckpt", False), ("s.ckpt", True), ("s.safetensors", False)])
def test_the_sketch_encoders_file(
    weights: Weights, pruned_file: Path, tmp_path: Path, name: str, wrapped: bool
) -> None:
    path = tiny.write_sketch_encoder(tmp_path / name, weights, wrapped=wrapped)
    sketch = load_models(pruned_file, sketch=path, sizes=tiny.TINY).sketch
    assert sketch is not None
    for key, tensor in sketch.state_dict().items():
        torch.testing.assert_close(tensor, weights["sketch"][key], rtol=0, atol=0)


@pytest.mark.parametrize("by_open_clip", [False, True])
def test_encoders_in_files_of_their_own(
    weights: Weights, pruned_file: Path, tmp_path: Path, by_open_clip: bool
) -> None:
    picture = tiny.write_image_encoder(tmp_path / "vision.safetensors", weights, by_open_clip=by_open_clip)
    text = tiny.write_text_encoder(tmp_path / "text.safetensors", weights)
    models = load_models(pruned_file, image_encoder=picture, text_encoder=text, sizes=tiny.TINY)
    assert_holds(models, weights, through=torch.float16)
    assert models.image_encoder is not None
    torch.testing.assert_close(models.empty_prompt, empty_prompt_by(weights))


def test_the_empty_prompt_is_kept_for_runs_without_a_text_encoder(
    weights: Weights, pruned_file: Path, tmp_path: Path
) -> None:
    model = tmp_path / "pruned.safetensors"
    shutil.copy(pruned_file, model)
    assert load_models(model, sizes=tiny.TINY).empty_prompt is None
    text = tiny.write_text_encoder(tmp_path / "text.safetensors", weights)
    load_models(model, text_encoder=text, sizes=tiny.TINY)
    text.unlink()
    torch.testing.assert_close(load_models(model, sizes=tiny.TINY).empty_prompt, empty_prompt_by(weights))


@pytest.mark.parametrize("spoil", ["older", "damaged", "of another shape"])
def test_a_kept_prompt_that_does_not_fit_is_left_alone(pruned_file: Path, tmp_path: Path, spoil: str) -> None:
    model = tmp_path / "pruned.safetensors"
    shutil.copy(pruned_file, model)
    sizes = tiny.TINY.text_encoder
    keep_prompt(model, torch.ones(1, sizes.tokens, sizes.width))
    assert load_models(model, sizes=tiny.TINY).empty_prompt is not None
    if spoil == "older":
        os.utime(kept_prompt_file(model), (0, 0))
    elif spoil == "damaged":
        kept_prompt_file(model).write_bytes(b"no weights")
    else:
        keep_prompt(model, torch.ones(1, sizes.tokens, sizes.width + 1))
    assert load_models(model, sizes=tiny.TINY).empty_prompt is None


def test_nothing_is_kept_where_nothing_can_be_written(tmp_path: Path) -> None:
    keep_prompt(tmp_path / "no folder" / "model.ckpt", torch.ones(1, 2, 3))
    assert not list(tmp_path.iterdir())


def test_swapped_files_are_named(full_file: Path, sketch_file: Path) -> None:
    with pytest.raises(CheckpointError, match=r"sketch_encoder\.ckpt does not fit.*Wanted: ToonCrafter's model"):
        load_models(sketch_file, sizes=tiny.TINY)
    with pytest.raises(CheckpointError, match=r"model\.ckpt does not fit.*Wanted: ToonCrafter's sketch"):
        load_models(full_file, sketch=full_file, sizes=tiny.TINY)


def test_files_of_another_size_are_named(full_file: Path) -> None:
    with pytest.raises(CheckpointError, match=r"does not fit: .* of another shape"):
        load_models(full_file)


@pytest.mark.parametrize("part", ["unet", "resampler", "autoencoder"])
def test_missing_names_are_named(weights: Weights, tmp_path: Path, part: str) -> None:
    lost = next(iter(weights[part]))
    left = {name: each for name, each in weights[part].items() if name != lost}
    path = tiny.write_pruned(tmp_path / "pruned.safetensors", {**weights, part: left})
    with pytest.raises(CheckpointError, match=rf"does not fit: 1 missing: {lost}"):
        load_models(path, sizes=tiny.TINY)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(CheckpointError, match=r"nowhere\.ckpt does not exist. Wanted: ToonCrafter"):
        load_models(tmp_path / "nowhere.ckpt")
