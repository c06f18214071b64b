"""The sizes of all networks: the public ones, or what a document beside the weights tells of others.

ToonCrafter's files hold weights alone, and heads of attention cannot be seen in them. So networks of other sizes bring
a document, as those of diffusers bring their config.json: beside ``name.ckpt`` lies ``name.sizes.json``, with the sizes
that differ, by network and by the names in configuration.py: ``{"unet": {"model_channels": 64}}``.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from torch import nn

from ...physics.checks import check_whole, require_kind
from ...physics.errors import InvalidInputError, counted, require
from ..networks.checkpoints import CheckpointError, build_without_storage
from ..networks.image_encoder import ImageEncoder, ImageEncoderConfiguration
from .autoencoder import DualReferenceAutoencoder
from .configuration import (
    AutoencoderConfiguration,
    ResamplerConfiguration,
    SketchEncoderConfiguration,
    UNetConfiguration,
)
from .resampler import ImageResampler
from .sketch_encoder import SketchEncoder
from .text_encoder import TextEncoder, TextEncoderConfiguration
from .unet import InterpolationUNet

__all__ = ["ModelSizes", "sizes_beside", "sizes_file"]

_LARGEST_DOCUMENT = 1 << 16
_MOST, _MOST_LAYERS, _MOST_LEVELS = 1 << 16, 100, 8
_LAYERS = ("depth", "layers", "num_res_blocks")


@dataclass(frozen=True)
class ModelSizes:
    """Sizes of all networks; the defaults are the public ones."""

    unet: UNetConfiguration = field(default_factory=UNetConfiguration)
    resampler: ResamplerConfiguration = field(default_factory=ResamplerConfiguration)
    autoencoder: AutoencoderConfiguration = field(default_factory=AutoencoderConfiguration)
    sketch: SketchEncoderConfiguration = field(default_factory=SketchEncoderConfiguration)
    image_encoder: ImageEncoderConfiguration = field(default_factory=ImageEncoderConfiguration)
    text_encoder: TextEncoderConfiguration = field(default_factory=TextEncoderConfiguration)


def sizes_file(weights: Path) -> Path:
    """Where the sizes of the networks in a file are told, if they are not the public ones."""
    return weights.with_name(f"{weights.stem}.sizes.json")


def sizes_beside(model: Path, sketch: Path | None = None) -> ModelSizes:
    """The sizes for a model's file and its sketch encoder's, each told beside its own file.

    Args:
        model: ToonCrafter's file.
        sketch: its sketch encoder, whose document counts for the sketch encoder alone.

    Raises:
        CheckpointError: a document is there and does not tell sizes.
    """
    sizes = _told(sizes_file(model), ModelSizes())
    return sizes if sketch is None else replace(sizes, sketch=_told(sizes_file(sketch), ModelSizes()).sketch)


def _told(file: Path, usual: ModelSizes) -> ModelSizes:
    if not file.is_file():
        return usual
    try:
        with file.open("rb") as opened:
            told = json.loads(opened.read(_LARGEST_DOCUMENT))
        changes = {name: _changed(name, getattr(usual, name), values) for name, values in _known(told, usual).items()}
        sizes = replace(usual, **changes)
        for name in changes:
            _build(name, getattr(sizes, name))
        return sizes
    except (AssertionError, InvalidInputError, OSError, RecursionError, RuntimeError, ValueError) as error:
        raise CheckpointError(f"{file} must tell the sizes of ToonCrafter's networks. Got: {error}") from error


def _build(network: str, sizes: Any) -> None:
    """Try whether there can be such a network; without storage, so that nothing takes memory."""
    if isinstance(sizes, ImageEncoderConfiguration):
        require("image_encoder.heads", sizes.heads, sizes.width % sizes.heads == 0, f"a divisor of {sizes.width}")
    kinds: dict[str, Callable[[Any], nn.Module]] = {
        "unet": InterpolationUNet,
        "resampler": ImageResampler,
        "autoencoder": DualReferenceAutoencoder,
        "sketch": SketchEncoder,
        "image_encoder": ImageEncoder,
        "text_encoder": TextEncoder,
    }
    build_without_storage(lambda: kinds[network](sizes))


def _changed(network: str, usual: Any, values: Any) -> Any:
    """One network's sizes with the given ones among them."""
    known = _known(values, usual)
    return replace(usual, **{name: _checked(f"{network}.{name}", getattr(usual, name), known[name]) for name in known})


def _known(told: Any, usual: Any) -> Mapping[str, Any]:
    """Values by names that there are."""
    require_kind("the document", told, dict, "values by name")
    names = [each.name for each in fields(usual)]
    unknown = ", ".join(sorted(set(told) - set(names)))[:60]
    require("names", unknown, not unknown, f"among {', '.join(names)}")
    return dict(told)


def _checked(name: str, usual: Any, value: Any) -> Any:
    """A value of the usual one's kind, within what can be built."""
    most = _MOST_LAYERS if name.rpartition(".")[2] in _LAYERS else _MOST
    if isinstance(usual, bool):
        require(name, value, isinstance(value, bool), "true or false")
    elif isinstance(usual, tuple):
        require_kind(name, value, list, "a list")
        require(name, counted(len(value), "value"), len(value) <= _MOST_LEVELS, f"at most {_MOST_LEVELS} values")
        for each in value:
            check_whole(name, each, 0, most)
        return tuple(value)
    else:
        check_whole(name, value, 1, most)
    return value
