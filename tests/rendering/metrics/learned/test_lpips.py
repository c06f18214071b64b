"""LPIPS: the networks are the public ones, and files are checked."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import torch
from drawn_weights import drawn_weights
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.metrics.learned.lpips import Lpips, load_lpips
from physanimator.rendering.networks.checkpoints import CheckpointError, build_without_storage

WIDTHS = {"alex": (64, 192, 384, 256, 256), "vgg": (64, 128, 256, 512, 512)}
KNOWN = {"alex": [0.19141726, 0.19021873], "vgg": [0.19504978, 0.19796537]}
"""What the package lpips 0.1.4 gives for these weights and pictures."""


def backbone(name: str) -> dict[str, torch.Tensor]:
    states = build_without_storage(lambda: Lpips(name)).features.state_dict()
    drawn = drawn_weights({key: tuple(each.shape) for key, each in states.items()})
    return {f"features.{key}": tensor for key, tensor in drawn.items()}


def linear(name: str) -> dict[str, torch.Tensor]:
    shapes = {f"lin{k}.model.1.weight": (1, width, 1, 1) for k, width in enumerate(WIDTHS[name])}
    return {key: tensor.abs() for key, tensor in drawn_weights(shapes).items()}


def folder_of(path: Path, name: str) -> Path:
    """As it is after the public files have been downloaded."""
    torch.save({**backbone(name), "classifier.6.bias": torch.zeros(1000)}, path / f"{name}-0123.pth")
    torch.save(linear(name), path / f"{name}.pth", _use_new_zipfile_serialization=False)
    return path


def pictures() -> torch.Tensor:
    drawn = np.random.default_rng(3).integers(0, 256, (5, 70, 90, 3), dtype=np.uint8)
    return torch.from_numpy(drawn).permute(0, 3, 1, 2).float() / 255


@pytest.mark.parametrize("name", WIDTHS)
def test_the_networks_are_those_of_the_package_lpips(name: str, tmp_path: Path) -> None:
    network, seen = load_lpips(folder_of(tmp_path, name)), pictures()
    assert network(seen[:2], seen[2:4]).tolist() == pytest.approx(KNOWN[name], rel=1e-4)
    assert network(seen[:1], seen[:1]).item() == 0


def without_linear(folder: Path) -> None:
    (folder / "alex.pth").unlink()


def of_another(folder: Path) -> None:
    torch.save(linear("vgg"), folder / "alex.pth")


def unknown(folder: Path) -> None:
    torch.save({"features.0.weight": torch.zeros(3, 3)}, folder / "other.pth")


def shortened(folder: Path) -> None:
    (folder / "alex-0123.pth").write_bytes((folder / "alex-0123.pth").read_bytes()[:-1000])


def lacking(folder: Path) -> None:
    tensors = backbone("alex")
    del tensors["features.10.bias"]
    torch.save(tensors, folder / "alex-0123.pth")


def running_code(folder: Path) -> None:
    (folder / "alex-0123.pth").write_bytes(b"cos\nsystem\n(S'echo'\ntR.")


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (without_linear, r"must hold the backbone and the linear layers from .*\. Got: backbone of alex"),
        (of_another, r"Got: backbone of alex, linear layers of vgg"),
        (unknown, r"other\.pth does not fit: it is neither AlexNet's nor VGG-16's"),
        (shortened, r"alex-0123\.pth cannot be read; it is damaged or was not downloaded to its end"),
        (lacking, r"does not fit: 1 missing: features\.10\.bias"),
        (running_code, r"alex-0123\.pth (cannot be read|is not a plain file of weights)"),
    ],
)
def test_a_folder_with_a_fault_names_it(spoil: Callable[[Path], None], sentence: str, tmp_path: Path) -> None:
    spoil(folder_of(tmp_path, "alex"))
    with pytest.raises((InvalidInputError, CheckpointError), match=sentence):
        load_lpips(tmp_path)


def test_a_missing_folder_says_what_where_and_whence(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"none is missing.*the folder lpips from .*PerceptualSimilarity.*BSD"):
        load_lpips(tmp_path / "none")
