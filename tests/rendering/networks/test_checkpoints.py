"""Model files: what is read, how it is assigned, and what is said of files that do not fit."""

from __future__ import annotations

import pickle
import random
import zipfile
from pathlib import Path
from typing import Any

import pytest
import torch
from physanimator.rendering.networks.checkpoints import (
    CheckpointError,
    assign,
    below,
    build_without_storage,
    read_checkpoint,
)
from safetensors.torch import save_file
from torch import nn

WANTED = "the right file"


def weights() -> dict[str, torch.Tensor]:
    return {"weight": torch.arange(6.0).reshape(2, 3), "bias": torch.tensor([1.0, -1.0])}


@pytest.mark.parametrize("suffix", [".safetensors", ".ckpt", ".pth"])
def test_reads_every_format(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"model{suffix}"
    if suffix == ".safetensors":
        save_file(weights(), path)
    else:
        torch.save({"state_dict": weights(), "epoch": 3} if suffix == ".ckpt" else weights(), path)
    got = read_checkpoint(path, wanted=WANTED)
    assert {name: tensor.tolist() for name, tensor in got.items()} == {k: v.tolist() for k, v in weights().items()}


def test_reads_files_of_old_torch_and_of_deepspeed(tmp_path: Path) -> None:
    old, deepspeed = tmp_path / "old.pth", tmp_path / "deepspeed.ckpt"
    torch.save(weights(), old, _use_new_zipfile_serialization=False)
    torch.save({"module": {f"_forward_module.{name}": each for name, each in weights().items()}}, deepspeed)
    assert set(read_checkpoint(old, wanted=WANTED)) == set(read_checkpoint(deepspeed, wanted=WANTED)) == set(weights())


def test_assigns_without_a_copy() -> None:
    tensors = weights()
    network = build_without_storage(lambda: nn.Linear(3, 2))
    assert network.weight.is_meta
    assign(network, tensors, file="model.safetensors", wanted=WANTED)
    assert network.weight.data_ptr() == tensors["weight"].data_ptr()
    assert not network.training
    assert not network.weight.requires_grad
    torch.testing.assert_close(network(torch.tensor([1.0, 0, 0])), torch.tensor([1.0, 2.0]))


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"bias": None}, "1 missing: bias"),
        ({"extra": torch.zeros(1)}, "1 not wanted: extra"),
        ({"weight": torch.zeros(3, 2)}, r"1 of another shape: weight \[3, 2\] for \[2, 3\]"),
    ],
)
def test_names_what_does_not_fit(change: dict[str, Any], fault: str) -> None:
    tensors = {name: each for name, each in {**weights(), **change}.items() if each is not None}
    with pytest.raises(CheckpointError, match=f"model.safetensors does not fit: {fault}. Wanted: {WANTED}"):
        assign(nn.Linear(3, 2), tensors, file="model.safetensors", wanted=WANTED)


@pytest.mark.parametrize("suffix", [".safetensors", ".ckpt"])
def test_a_truncated_file_is_named(tmp_path: Path, suffix: str) -> None:
    whole, path = tmp_path / f"whole{suffix}", tmp_path / f"cut{suffix}"
    save_file(weights(), whole) if suffix == ".safetensors" else torch.save(weights(), whole)
    path.write_bytes(whole.read_bytes()[:-20])
    with pytest.raises(CheckpointError, match=rf"cut{suffix} cannot be read.*Wanted: {WANTED}"):
        read_checkpoint(path, wanted=WANTED)


class Evil:
    def __reduce__(self) -> tuple[Any, ...]:
        return (Path.touch, (Path("evil"),))


def test_code_in_a_pickle_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    torch.save({"state_dict": weights(), "callbacks": Evil()}, tmp_path / "evil.ckpt")
    (tmp_path / "bare.ckpt").write_bytes(pickle.dumps(Evil(), protocol=2))
    for name in ("evil.ckpt", "bare.ckpt"):
        with pytest.raises(CheckpointError, match="not a plain file of weights"):
            read_checkpoint(tmp_path / name, wanted=WANTED)
    assert not (tmp_path / "evil").exists()


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (b"<html>", "a web page"),
        (b"\n<!DOCTYPE html>", "a web page"),
        (b"version https://git-lfs.github.com/spec/v1\noid", "a pointer of Git LFS"),
        (b"", "it is empty"),
        (b"garbage" * 50, "damaged or was not downloaded"),
        (None, "not exist"),
    ],
)
def test_foreign_and_missing_files_are_named(tmp_path: Path, content: bytes | None, fault: str) -> None:
    path = tmp_path / "page.ckpt"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(CheckpointError, match=f"page.ckpt.*{fault}.*{WANTED}$"):
        read_checkpoint(path, wanted=WANTED)


def test_a_file_without_tensors_is_named(tmp_path: Path) -> None:
    torch.save({"epoch": 1}, tmp_path / "empty.ckpt")
    with pytest.raises(CheckpointError, match="holds no named tensors"):
        read_checkpoint(tmp_path / "empty.ckpt", wanted=WANTED)


def test_below_keeps_the_rest_of_the_name() -> None:
    assert set(below({"a.b.c": torch.zeros(1), "b.c": torch.zeros(1)}, "a.")) == {"b.c"}


@pytest.mark.parametrize("suffix", [".safetensors", ".ckpt", ".pth"])
def test_damaged_files_are_read_or_named_in_a_sentence(tmp_path: Path, suffix: str) -> None:
    whole, path = tmp_path / f"whole{suffix}", tmp_path / f"damaged{suffix}"
    if suffix == ".safetensors":
        save_file(weights(), whole)
    else:
        torch.save(weights(), whole, _use_new_zipfile_serialization=suffix == ".ckpt")
    content, dice, said = whole.read_bytes(), random.Random(0), []
    for _ in range(150):
        damaged = bytearray(content[: dice.choice((len(content), dice.randrange(len(content))))])
        for _ in range(dice.choice((0, 1, 5))):
            if damaged:
                damaged[dice.randrange(len(damaged))] = dice.randrange(256)
        path.write_bytes(bytes(damaged))
        try:
            read_checkpoint(path, wanted=WANTED)
        except CheckpointError as error:
            said.append(str(error))
    assert len(said) > 50
    assert all(each.isprintable() for each in said)
    assert not [each for each in said if "(" in each or "torch" in each or "weights_only" in each]


def test_archives_that_unpack_to_more_than_they_are_stay_packed(tmp_path: Path) -> None:
    path = tmp_path / "bomb.pth"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("archive/data.pkl", bytes(10_000_000))
    with pytest.raises(CheckpointError, match="unpacks to more than its size"):
        read_checkpoint(path, wanted=WANTED)


@pytest.mark.parametrize("length", [10**9, 2**63 - 1, 2**64 - 1])
def test_a_header_that_says_it_is_endless(tmp_path: Path, length: int) -> None:
    path = tmp_path / "long.safetensors"
    path.write_bytes(length.to_bytes(8, "little") + b"{}")
    with pytest.raises(CheckpointError, match="damaged or was not downloaded"):
        read_checkpoint(path, wanted=WANTED)
