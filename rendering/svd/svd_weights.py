"""Stable Video Diffusion's weights, from its single file or from a diffusers folder, by the names of our networks."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from torch import Tensor

from ...physics.checks import check_whole, require_kind
from ...physics.errors import InvalidInputError, counted, require
from ..networks.checkpoints import CheckpointError, below, read_checkpoint
from ..networks.image_encoder import ImageEncoderConfiguration
from ..networks.image_encoder_names import from_open_clip
from .autoencoder import from_public_autoencoder
from .configuration import NetworkConfiguration
from .unet import SpatioTemporalUNet
from .unet_names import from_diffusers_unet

__all__ = ["WANTED_SVD", "ModelSizes", "SVDWeights", "read_svd"]

WANTED_SVD = (
    "Stable Video Diffusion image-to-video (14 frames): svd.safetensors, or the folder of its diffusers version,"
    " from https://huggingface.co/stabilityai/stable-video-diffusion-img2vid"
)

_AUTOENCODER = "first_stage_model."
_CONDITION_ENCODER = "conditioner.embedders.3.encoder."
_IMAGE_ENCODER = "conditioner.embedders.0.open_clip.model.visual."
_PARTS = ("unet", "vae", "image_encoder")

_LARGEST_DOCUMENT = 1 << 20
_MOST_CHANNELS, _MOST_LEVELS, _MOST_LAYERS = 16384, 8, 100
"""A folder's documents are read without trust: nothing larger than this is built."""


@dataclass(frozen=True)
class ModelSizes:
    """Sizes of all networks; the defaults are the public ones.

    Attributes:
        network: of UNet and ControlNet.
        autoencoder: channels of each level.
        image_encoder: of the picture encoder.
    """

    network: NetworkConfiguration = field(default_factory=NetworkConfiguration)
    autoencoder: tuple[int, ...] = (128, 256, 512, 512)
    image_encoder: ImageEncoderConfiguration = field(default_factory=ImageEncoderConfiguration)


@dataclass(frozen=True, eq=False)
class SVDWeights:
    """Tensors of each network by the names that the network uses.

    Attributes:
        unet: public names, without prefix.
        autoencoder: diffusers' names.
        image_encoder: diffusers' names.
        sizes: of the networks.
        source: the file or folder.
    """

    unet: dict[str, Tensor]
    autoencoder: dict[str, Tensor]
    image_encoder: dict[str, Tensor]
    sizes: ModelSizes
    source: Path


def read_svd(path: Path, *, sizes: ModelSizes | None = None) -> SVDWeights:
    """Read a single file, or a diffusers folder, whose documents then tell the sizes.

    Args:
        path: file or folder.
        sizes: of the networks in a single file; the public ones by default.

    Raises:
        CheckpointError: it is neither.
    """
    return _from_folder(path) if path.is_dir() else _from_file(path, sizes or ModelSizes())


def _from_file(path: Path, sizes: ModelSizes) -> SVDWeights:
    tensors = read_checkpoint(path, wanted=WANTED_SVD)
    for prefix in (SpatioTemporalUNet.prefix, _AUTOENCODER, _IMAGE_ENCODER):
        if not any(name.startswith(prefix) for name in tensors):
            raise CheckpointError(f"{path} does not fit: nothing in it is called {prefix}*. Wanted: {WANTED_SVD}")
    decoder, condition = below(tensors, _AUTOENCODER), below(tensors, _CONDITION_ENCODER)
    encoder = condition if any(name.startswith("encoder.") for name in condition) else decoder
    return SVDWeights(
        below(tensors, SpatioTemporalUNet.prefix),
        from_public_autoencoder(
            {name: tensor for name, tensor in encoder.items() if name.startswith(("encoder.", "quant_conv."))},
            {name: tensor for name, tensor in decoder.items() if name.startswith("decoder.")},
        ),
        from_open_clip(below(tensors, _IMAGE_ENCODER)),
        sizes,
        path,
    )


def _from_folder(path: Path) -> SVDWeights:
    lacking = [part for part in _PARTS if not (path / part / "config.json").is_file()]
    if lacking:
        missing = ", ".join(f"{part}/config.json" for part in lacking)
        raise CheckpointError(f"{path} does not fit: it lacks {missing}. Wanted: {WANTED_SVD}")
    sizes = _sizes_told(path)
    image_encoder = _tensors(path / "image_encoder", "model", "pytorch_model")
    return SVDWeights(
        from_diffusers_unet(_tensors(path / "unet", "diffusion_pytorch_model"), sizes.network),
        _tensors(path / "vae", "diffusion_pytorch_model"),
        {name: tensor for name, tensor in image_encoder.items() if not name.endswith("position_ids")},
        sizes,
        path,
    )


def _sizes_told(folder: Path) -> ModelSizes:
    """The sizes that a folder's documents tell; whatever else stands in them builds nothing."""
    try:
        unet, vae, encoder = (_document(folder / part / "config.json") for part in _PARTS)
        return ModelSizes(_network_sizes(unet), _channels(vae["block_out_channels"]), _encoder_sizes(encoder))
    except KeyError as error:
        raise CheckpointError(f"{folder} does not fit: a config.json lacks {error}. Wanted: {WANTED_SVD}") from error
    except (IndexError, InvalidInputError, OSError, RecursionError, TypeError, ValueError) as error:
        raise CheckpointError(
            f"{folder} does not fit: a config.json does not tell the sizes of such a network. Wanted: {WANTED_SVD}"
        ) from error


def _document(path: Path) -> Mapping[str, Any]:
    with path.open("rb") as file:
        found = json.loads(file.read(_LARGEST_DOCUMENT))
    require_kind(path.name, found, dict, "values by name")
    return dict(found)


def _whole(config: Mapping[str, Any], name: str, most: int) -> int:
    check_whole(name, config[name], 1, most)
    return int(config[name])


def _channels(given: Any) -> tuple[int, ...]:
    require("block_out_channels", counted(len(given), "level"), 1 <= len(given) <= _MOST_LEVELS, f"1 to {_MOST_LEVELS}")
    for each in given:
        check_whole("block_out_channels", each, 1, _MOST_CHANNELS)
    return tuple(given)


def _tensors(folder: Path, *stems: str) -> dict[str, Tensor]:
    """All weights of one part: one file, or a split one; full precision where there are both."""
    for stem in stems:
        for variant in ("", ".fp16"):
            for suffix in (".safetensors", ".bin"):
                whole = folder / f"{stem}{variant}{suffix}"
                split = sorted(folder.glob(f"{stem}{variant}-*-of-*{suffix}"))
                files = [whole] if whole.is_file() else split
                if files:
                    return {
                        name: tensor
                        for file in files
                        for name, tensor in read_checkpoint(file, wanted=WANTED_SVD).items()
                    }
    raise CheckpointError(f"{folder} does not fit: it lacks {stems[0]}.safetensors. Wanted: {WANTED_SVD}")


def _network_sizes(config: Mapping[str, Any]) -> NetworkConfiguration:
    channels, heads = _channels(config["block_out_channels"]), config["num_attention_heads"]
    first = heads[0] if isinstance(heads, list) else heads
    check_whole("num_attention_heads", first, 1, channels[0])
    return replace(
        NetworkConfiguration(),
        in_channels=_whole(config, "in_channels", _MOST_CHANNELS),
        out_channels=_whole(config, "out_channels", _MOST_CHANNELS),
        model_channels=channels[0],
        channel_mult=tuple(each // channels[0] for each in channels),
        num_res_blocks=_whole(config, "layers_per_block", _MOST_LAYERS),
        attention_at_levels=tuple(
            level for level, kind in enumerate(config["down_block_types"]) if str(kind).startswith("CrossAttn")
        ),
        num_head_channels=channels[0] // int(first),
        context_dim=_whole(config, "cross_attention_dim", _MOST_CHANNELS),
        adm_in_channels=_whole(config, "projection_class_embeddings_input_dim", _MOST_CHANNELS),
        ids_embed_dim=_whole(config, "addition_time_embed_dim", _MOST_CHANNELS),
    )


def _encoder_sizes(config: Mapping[str, Any]) -> ImageEncoderConfiguration:
    return ImageEncoderConfiguration(
        width=_whole(config, "hidden_size", _MOST_CHANNELS),
        layers=_whole(config, "num_hidden_layers", _MOST_LAYERS),
        heads=_whole(config, "num_attention_heads", _MOST_CHANNELS),
        hidden=_whole(config, "intermediate_size", _MOST_CHANNELS),
        patch=_whole(config, "patch_size", _MOST_CHANNELS),
        picture=_whole(config, "image_size", _MOST_CHANNELS),
        projection=_whole(config, "projection_dim", _MOST_CHANNELS),
    )
