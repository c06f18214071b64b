"""Every format that users have loads into the same networks; every other file is refused by name."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
import random_svd
import torch
from physanimator.rendering.networks.checkpoints import CheckpointError
from physanimator.rendering.svd.models import SVDModels, load_models
from safetensors.torch import load_file, save_file

Weights = dict[str, dict[str, torch.Tensor]]


def assert_holds(models: SVDModels, weights: Weights, *, dtype: torch.dtype = torch.float32) -> None:
    """The networks have exactly these weights; LVCD's attention replaces the UNet's own."""
    expected = {**weights, "unet": {**weights["unet"], **weights["attention"]}}
    for part in ("unet", "control", "autoencoder", "image_encoder"):
        got = getattr(models, part).state_dict()
        assert set(got) == set(expected[part])
        kept = torch.float32 if part == "autoencoder" else dtype
        for name, tensor in got.items():
            torch.testing.assert_close(tensor, expected[part][name].to(kept), rtol=0, atol=0)


def test_single_file_and_training_checkpoint(models: SVDModels, weights: Weights) -> None:
    assert_holds(models, weights)
    assert not any(network.training for network in (models.unet, models.control, models.image_encoder))


@pytest.mark.parametrize("suffix", [".safetensors", ".bin", ".fp16.safetensors"])
def test_diffusers_folder(weights: Weights, lvcd: Path, tmp_path: Path, suffix: str) -> None:
    assert_holds(load_models(random_svd.write_folder(tmp_path / "svd", weights, suffix=suffix), lvcd), weights)


def test_split_diffusers_files(weights: Weights, folder: Path, lvcd: Path, tmp_path: Path) -> None:
    copy = tmp_path / "svd"
    shutil.copytree(folder, copy)
    whole = copy / "unet" / "diffusion_pytorch_model.safetensors"
    tensors = load_file(whole)
    whole.unlink()
    for part, names in enumerate((list(tensors)[::2], list(tensors)[1::2]), start=1):
        save_file(
            {name: tensors[name] for name in names},
            copy / "unet" / f"diffusion_pytorch_model-0000{part}-of-00002.safetensors",
        )
    assert_holds(load_models(copy, lvcd), weights)


@pytest.mark.parametrize("dtype", [torch.float16, torch.bfloat16, torch.float32])
def test_pruned_lvcd_in_every_precision(weights: Weights, folder: Path, tmp_path: Path, dtype: torch.dtype) -> None:
    half = {part: {name: each.half().float() for name, each in found.items()} for part, found in weights.items()}
    pruned = random_svd.write_lvcd(tmp_path / "lvcd-fp16.safetensors", weights, dtype=torch.float16)
    expected = {**weights, "control": half["control"], "attention": half["attention"]}
    assert_holds(load_models(folder, pruned, dtype=dtype), expected, dtype=dtype)


def test_an_encoder_with_the_quantisation_folded_in(weights: Weights, tmp_path: Path, lvcd: Path) -> None:
    """Files without the condition's own encoder have an encoder that needs no further convolution."""
    path = random_svd.write_single_file(tmp_path / "svd.safetensors", weights)
    tensors = {name: each for name, each in load_file(path).items() if ".embedders.3." not in name}
    save_file(tensors, path)
    loaded = load_models(path, lvcd, sizes=random_svd.TINY).autoencoder
    moments = torch.randn(1, 8, 2, 2)
    torch.testing.assert_close(loaded.quant_conv(moments), moments)


@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="tells of mapped files on Linux only")
def test_weights_in_the_right_precision_stay_in_the_file(models: SVDModels, lvcd: Path) -> None:
    lines = [line for line in Path("/proc/self/maps").read_text().splitlines() if line.endswith(str(lvcd))]
    ranges = [[int(end, 16) for end in line.split()[0].split("-")] for line in lines]
    for tensor in models.control.parameters():
        assert any(start <= tensor.data_ptr() < end for start, end in ranges)


def test_swapped_files_are_named(single_file: Path, lvcd: Path) -> None:
    with pytest.raises(CheckpointError, match=r"lvcd\.ckpt does not fit.*Wanted: Stable Video Diffusion"):
        load_models(lvcd, lvcd, sizes=random_svd.TINY)
    with pytest.raises(CheckpointError, match=r"svd\.safetensors does not fit.*control_model.*Wanted: LVCD"):
        load_models(single_file, single_file, sizes=random_svd.TINY)


def test_files_of_another_size_are_named(single_file: Path, lvcd: Path) -> None:
    with pytest.raises(CheckpointError, match=r"does not fit: .* of another shape"):
        load_models(single_file, lvcd)


@pytest.mark.parametrize(
    ("part", "lost", "fault"),
    [
        ("control", "zero_convs.3.0.weight", "1 missing: zero_convs.3.0.weight"),
        ("attention", "input_blocks.1.1.time_stack.0.attn1.to_k.weight", "1 missing: input_blocks.1.1.time_stack"),
    ],
)
def test_missing_names_of_lvcd_are_named(
    weights: Weights, folder: Path, tmp_path: Path, part: str, lost: str, fault: str
) -> None:
    left = {name: each for name, each in weights[part].items() if name != lost}
    path = random_svd.write_lvcd(tmp_path / "lvcd.ckpt", {**weights, part: left})
    with pytest.raises(CheckpointError, match=rf"lvcd\.ckpt does not fit: {fault}.*lvcd\.ckpt"):
        load_models(folder, path)


@pytest.mark.parametrize("part", ["unet", "vae", "image_encoder"])
def test_parts_that_a_folder_lacks_are_named(folder: Path, lvcd: Path, tmp_path: Path, part: str) -> None:
    copy = tmp_path / "svd"
    shutil.copytree(folder, copy)
    (next((copy / part).glob("*.safetensors"))).unlink()
    with pytest.raises(CheckpointError, match=rf"{part} does not fit: it lacks"):
        load_models(copy, lvcd)
    shutil.rmtree(copy / part)
    with pytest.raises(CheckpointError, match=rf"it lacks {part}/config.json"):
        load_models(copy, lvcd)


def test_a_config_of_something_else_is_named(folder: Path, lvcd: Path, tmp_path: Path) -> None:
    copy = tmp_path / "svd"
    shutil.copytree(folder, copy)
    (copy / "unet" / "config.json").write_text(json.dumps({"_class_name": "Other"}))
    with pytest.raises(CheckpointError, match=r"a config\.json lacks 'block_out_channels'"):
        load_models(copy, lvcd)


def test_a_missing_file_is_named(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(CheckpointError, match=r"nowhere\.ckpt does not exist"):
        load_models(folder, tmp_path / "nowhere.ckpt")


@pytest.mark.parametrize("value", [0, -1, 1.5, 10**9, "32", None, [], [0], ["a"], {}, [32] * 99, float("nan")])
@pytest.mark.parametrize("part", ["unet", "vae", "image_encoder"])
def test_sizes_are_not_trusted(folder: Path, lvcd: Path, tmp_path: Path, part: str, value: object) -> None:
    """Whatever a document says, a sentence comes of it, and no network of that size."""
    copy = tmp_path / "svd"
    shutil.copytree(folder, copy)
    file = copy / part / "config.json"
    config = json.loads(file.read_text())
    for name, usual in config.items():
        fits = name == "num_attention_heads" and value == [32] * 99  # heads of one channel each
        if name == "down_block_types" or fits or value == usual:
            continue
        file.write_text(json.dumps({**config, name: value}))
        with pytest.raises(CheckpointError, match=r"svd.* does not fit"):
            load_models(copy, lvcd)


@pytest.mark.parametrize("text", ["", "[1]", "{", "null", "[" * 100_000, "\x00", '{"a": 1}'])
def test_documents_that_tell_nothing_are_named(folder: Path, lvcd: Path, tmp_path: Path, text: str) -> None:
    copy = tmp_path / "svd"
    shutil.copytree(folder, copy)
    (copy / "vae" / "config.json").write_text(text)
    with pytest.raises(CheckpointError, match=r"svd does not fit: a config.json"):
        load_models(copy, lvcd)
