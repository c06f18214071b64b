"""Loading Stable Diffusion from folders that are good, others, or made to do harm."""

from __future__ import annotations

import json
import pickle
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import torch
from physanimator.rendering.inpainting.models import InpaintingModels, load_inpainting_models
from physanimator.rendering.networks.checkpoints import CheckpointError
from random_inpainting import write_inpainting_folder
from safetensors.torch import load_file, save_file


@pytest.fixture
def copied(folder: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(folder, tmp_path / "copy"))


def changed(file: Path, **values: Any) -> None:
    file.write_text(json.dumps(json.loads(file.read_text()) | values))


def same_weights(one: InpaintingModels, other: InpaintingModels) -> bool:
    pairs = [(one.unet, other.unet), (one.autoencoder, other.autoencoder), (one.text_encoder, other.text_encoder)]
    return all(
        torch.equal(tensor, second.state_dict()[name])
        for first, second in pairs
        for name, tensor in first.state_dict().items()
    )


def test_sizes_come_from_the_folder(plain: InpaintingModels, seeing: InpaintingModels, tmp_path: Path) -> None:
    assert not plain.sees_holes
    assert seeing.sees_holes
    wider = load_inpainting_models(write_inpainting_folder(tmp_path / "wider", block_out_channels=(64, 64)))
    assert wider.unet.conv_in.weight.shape[0] == 64
    assert plain.pixels_per_latent == 8


def test_half_precision_is_the_unet_s_alone(folder: Path) -> None:
    models = load_inpainting_models(folder, dtype=torch.bfloat16)
    kinds = [next(each.parameters()).dtype for each in (models.unet, models.autoencoder, models.text_encoder)]
    assert kinds == [torch.bfloat16, torch.float32, torch.float32]


def test_files_in_half_precision_and_in_pieces(copied: Path, plain: InpaintingModels) -> None:
    file = copied / "unet" / "diffusion_pytorch_model.safetensors"
    tensors = load_file(file)
    file.unlink()
    for part in (0, 1):
        piece = {name: tensor for number, (name, tensor) in enumerate(tensors.items()) if number % 2 == part}
        save_file(piece, copied / "unet" / f"diffusion_pytorch_model-0000{part + 1}-of-00002.safetensors")
    vae = copied / "vae" / "diffusion_pytorch_model.safetensors"
    vae.rename(vae.with_name("diffusion_pytorch_model.fp16.safetensors"))
    assert same_weights(load_inpainting_models(copied), plain)


def test_old_names_of_attention(copied: Path, plain: InpaintingModels) -> None:
    """As in the first folders of Stable Diffusion 1.5."""
    file = copied / "vae" / "diffusion_pytorch_model.safetensors"
    old = {"to_q": "query", "to_k": "key", "to_v": "value", "to_out.0": "proj_attn"}
    named = {}
    for name, tensor in load_file(file).items():
        for new, former in old.items():
            name = name.replace(f"attentions.0.{new}.", f"attentions.0.{former}.")
        named[name] = tensor[:, :, None, None].clone() if "query.weight" in name else tensor
    assert sum("proj_attn" in name for name in named) == 4
    save_file(named, file)
    assert same_weights(load_inpainting_models(copied), plain)


class Harmful:
    """Pickled, it writes a file when it is read."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def __reduce__(self) -> Any:
        return Path.touch, (self.file,)


def test_nothing_in_the_folder_is_run(copied: Path, plain: InpaintingModels, tmp_path: Path) -> None:
    sign = tmp_path / "was_run"
    code = f"from pathlib import Path\nPath({str(sign)!r}).touch()\n"
    for name in ("pipeline.py", "unet/custom.py", "text_encoder/custom.py", "tokenizer/custom.py", "unet/unet.py"):
        (copied / name).write_text(code)
    (copied / "model_index.json").write_text(json.dumps({"_class_name": ["pipeline", "Custom"], "unet": ["unet", "X"]}))
    changed(copied / "text_encoder" / "config.json", auto_map={"AutoModel": "custom.Model"})
    changed(copied / "tokenizer" / "tokenizer_config.json", auto_map={"AutoTokenizer": ["custom.Tokenizer", None]})
    changed(copied / "unet" / "config.json", _class_name="custom.Model", auto_map={"AutoModel": "custom.Model"})
    changed(copied / "scheduler" / "scheduler_config.json", _class_name="custom.Scheduler")
    with (copied / "unet" / "diffusion_pytorch_model.bin").open("wb") as file:
        pickle.dump(Harmful(sign), file)
    assert same_weights(load_inpainting_models(copied), plain)
    for part, stem in (("unet", "diffusion_pytorch_model"), ("text_encoder", "pytorch_model")):
        for weights in (copied / part).glob("*.safetensors"):
            weights.rename(weights.with_suffix(".kept"))
        with (copied / part / f"{stem}.bin").open("wb") as file:
            pickle.dump(Harmful(sign), file)
        with pytest.raises(CheckpointError, match="safetensors"):
            load_inpainting_models(copied)
        for weights in (copied / part).glob("*.kept"):
            weights.rename(weights.with_suffix(".safetensors"))
    assert not sign.exists()


def _without(name: str) -> Callable[[Path], None]:
    return lambda folder: shutil.rmtree(folder / name)


def _config(part: str, name: str = "config.json", **values: Any) -> Callable[[Path], None]:
    return lambda folder: changed(folder / part / name, **values)


def _text(name: str, text: str) -> Callable[[Path], None]:
    return lambda folder: (folder / name).write_text(text) and None


_WEIGHTS = "unet/diffusion_pytorch_model.safetensors"


@pytest.mark.parametrize(
    "spoil",
    [
        *map(_without, ("unet", "vae", "text_encoder", "tokenizer", "scheduler")),
        _config("unet", block_out_channels=[10**9, 10**9]),
        _config("unet", layers_per_block=10**9),
        _config("unet", block_out_channels="many"),
        _config("unet", block_out_channels=[32, 48]),
        _config("unet", addition_embed_type="text_time"),
        _config("unet", in_channels=5),
        _config("unet", down_block_types=["Unknown", "DownBlock2D"]),
        _config("vae", latent_channels=16),
        _config("text_encoder", hidden_size=64),
        _config("text_encoder", num_hidden_layers=3),
        _config("scheduler", "scheduler_config.json", num_train_timesteps=10**12),
        _config("scheduler", "scheduler_config.json", beta_schedule="unknown"),
        _text("unet/config.json", "[" * 100_000),
        _text("vae/config.json", "[]"),
        _text(_WEIGHTS, "version https://git-lfs.github.com/spec/v1"),
        _text("text_encoder/model.safetensors", "<!doctype html>"),
        _text("tokenizer/vocab.json", "{"),
    ],
)
def test_what_is_no_such_model_is_refused(copied: Path, spoil: Callable[[Path], None]) -> None:
    spoil(copied)
    with pytest.raises(CheckpointError, match="Wanted: the diffusers folder of a Stable Diffusion 1 or 2") as refused:
        load_inpainting_models(copied)
    assert len(str(refused.value)) < 800


def test_a_file_is_no_folder(folder: Path) -> None:
    with pytest.raises(CheckpointError, match="is no folder"):
        load_inpainting_models(folder / _WEIGHTS)
