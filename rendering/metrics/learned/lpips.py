"""LPIPS 0.1 (Zhang et al., "The unreasonable effectiveness of deep features as a perceptual metric", CVPR 2018).

How differently two pictures look: the squared difference of a classifier's features, each of length 1, weighted by
learned numbers a channel, averaged over the picture and summed over five layers.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import torch
from torch import Tensor, nn
from torch.nn import functional

from ....physics.errors import InvalidInputError, require
from ...networks.checkpoints import below, network_of, read_checkpoint
from .files import LPIPS_FOLDER, require_file

__all__ = ["LEAST_SIDE", "Lpips", "load_lpips"]

LEAST_SIDE = 32
"""Shortest side of a picture that reaches the last layer [px]."""

_WANTED = f"the backbone and the linear layers from {LPIPS_FOLDER.page}"
_SUFFIXES = (".pth", ".pt", ".safetensors")
_MOST_FILES = 20

# Of the public networks' ``features``: their convolutions (number, channels in and out, kernel, stride, padding), the
# maximum pools by number, and the numbers of the layers whose output is compared.
_Layer = tuple[int, int, int, int, int, int]
_ALEX: tuple[_Layer, ...] = (
    (0, 3, 64, 11, 4, 2),
    (3, 64, 192, 5, 1, 2),
    (6, 192, 384, 3, 1, 1),
    (8, 384, 256, 3, 1, 1),
    (10, 256, 256, 3, 1, 1),
)
_VGG_WIDTHS = {
    0: 64,
    2: 64,
    5: 128,
    7: 128,
    10: 256,
    12: 256,
    14: 256,
    17: 512,
    19: 512,
    21: 512,
    24: 512,
    26: 512,
    28: 512,
}
_VGG: tuple[_Layer, ...] = tuple(
    (number, given, made, 3, 1, 1)
    for (number, made), given in zip(_VGG_WIDTHS.items(), (3, *_VGG_WIDTHS.values()), strict=False)
)
_NETWORKS: Mapping[str, tuple[tuple[_Layer, ...], dict[int, int], tuple[int, ...]]] = {
    "alex": (_ALEX, {2: 3, 5: 3}, (0, 3, 6, 8, 10)),
    "vgg": (_VGG, {4: 2, 9: 2, 16: 2, 23: 2}, (2, 7, 14, 21, 28)),
}


class Lpips(nn.Module):
    """Distance of pictures, under the public names of the backbone (``features.N``) and linear layers (``linN``)."""

    def __init__(self, name: str) -> None:
        super().__init__()
        convolutions, self._pools, self._compared = _NETWORKS[name]
        self.features = nn.ModuleDict(
            {
                str(number): nn.Conv2d(given, made, kernel, stride=stride, padding=padding)
                for number, given, made, kernel, stride, padding in convolutions
            }
        )
        widths = {number: made for number, _, made, *_ in convolutions}
        self.lin = nn.ModuleList(nn.Conv2d(widths[number], 1, 1, bias=False) for number in self._compared)

    def forward(self, first: Tensor, second: Tensor) -> Tensor:
        """Distances.

        Args:
            first, second: RGB 0..1, shape [b, 3, h, w], sides of at least 32 px.

        Returns:
            Shape [b]; 0 for equal pictures.
        """
        return self.distance(self.layers(first), self.layers(second))

    def layers(self, pictures: Tensor) -> list[Tensor]:
        """What is compared of pictures: five layers, each place of length 1."""
        shift = pictures.new_tensor([-0.030, -0.088, -0.188])[:, None, None]
        scale = pictures.new_tensor([0.458, 0.448, 0.450])[:, None, None]
        x, found = (2 * pictures - 1 - shift) / scale, []
        for key, convolution in self.features.items():
            number = int(key)
            if number - 1 in self._pools:
                x = functional.max_pool2d(x, self._pools[number - 1], stride=2)
            x = functional.relu(convolution(x))
            if number in self._compared:
                found.append(x / (x.square().sum(dim=1, keepdim=True).sqrt() + 1e-10))
        return found

    def distance(self, first: list[Tensor], second: list[Tensor]) -> Tensor:
        """Distances of what :meth:`layers` gives, shape [b]."""
        layers = zip(self.lin, first, second, strict=True)
        return sum((lin((one - other).square()).mean(dim=(1, 2, 3)) for lin, one, other in layers), torch.zeros(()))


def load_lpips(folder: Path) -> Lpips:
    """The network of a folder with the backbone's and the linear layers' files, known by their tensors.

    Raises:
        InvalidInputError: a file is missing, damaged, or of another network than the other.
    """
    require_file(folder, LPIPS_FOLDER)
    files = sorted(each for each in folder.iterdir() if each.suffix.lower() in _SUFFIXES)
    require("lpips", f"{len(files)} in {folder}", len(files) <= _MOST_FILES, f"a folder of at most {_MOST_FILES} files")
    backbones: dict[str, dict[str, Tensor]] = {}
    linears: dict[str, dict[str, Tensor]] = {}
    for file in files:
        tensors = read_checkpoint(file, wanted=_WANTED)
        found = linears if any(name.startswith("lin") for name in tensors) else backbones
        found[_network_of(tensors, file)] = tensors
    both = sorted(set(backbones) & set(linears))
    if not both:
        there = [f"backbone of {name}" for name in backbones] + [f"linear layers of {name}" for name in linears]
        raise InvalidInputError(f"{folder} must hold {_WANTED}. Got: {', '.join(there) or 'no such file'}")
    return _assembled(both[0], backbones[both[0]], linears[both[0]], folder)


def _network_of(tensors: Mapping[str, Tensor], file: Path) -> str:
    """Which network a file is for, by its first layers' shapes."""
    first = tensors.get("features.0.weight", tensors.get("lin1.model.1.weight"))
    shape = () if first is None else tuple(first.shape)
    known = {(64, 3, 11, 11): "alex", (1, 192, 1, 1): "alex", (64, 3, 3, 3): "vgg", (1, 128, 1, 1): "vgg"}
    if shape not in known:
        raise InvalidInputError(f"{file} does not fit: it is neither AlexNet's nor VGG-16's. Wanted: {_WANTED}")
    return known[shape]


def _assembled(name: str, backbone: Mapping[str, Tensor], linear: Mapping[str, Tensor], folder: Path) -> Lpips:
    tensors = {f"features.{rest}": tensor for rest, tensor in below(backbone, "features.").items()}
    tensors |= {f"lin.{rest.replace('.model.1', '')}": tensor for rest, tensor in below(linear, "lin").items()}
    return network_of(lambda: Lpips(name), tensors, file=str(folder), wanted=_WANTED)
