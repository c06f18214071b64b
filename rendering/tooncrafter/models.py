"""All networks of the interpolation, loaded from the files that users have."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import torch
from torch import Tensor, nn

from ..networks.checkpoints import CheckpointError, below, network_of, read_checkpoint
from ..networks.image_encoder import ImageEncoder, ImageEncoderConfiguration
from ..networks.image_encoder_names import from_open_clip
from .autoencoder import DualReferenceAutoencoder
from .configuration import SketchEncoderConfiguration
from .kept_prompt import keep_prompt, kept_prompt
from .model_sizes import ModelSizes, sizes_beside
from .resampler import ImageResampler
from .sketch_encoder import SketchEncoder
from .text_encoder import TextEncoder, TextEncoderConfiguration, empty_prompt, text_weights
from .unet import InterpolationUNet

__all__ = [
    "WANTED_IMAGE_ENCODER",
    "WANTED_MODEL",
    "WANTED_SKETCH",
    "WANTED_TEXT_ENCODER",
    "ModelSizes",
    "ToonCrafterModels",
    "load_models",
]

WANTED_MODEL = (
    "ToonCrafter's model.ckpt from https://huggingface.co/Doubiiu/ToonCrafter, or its pruned fp16 safetensors from"
    " https://huggingface.co/Kijai/DynamiCrafter_pruned"
)
WANTED_SKETCH = "ToonCrafter's sketch_encoder.ckpt from https://huggingface.co/Doubiiu/ToonCrafter"
WANTED_IMAGE_ENCODER = (
    "the picture encoder of OpenCLIP ViT-H/14 (CLIP-ViT-H-14-laion2B-s32B-b79K) from"
    " https://huggingface.co/laion/CLIP-ViT-H-14-laion2B-s32B-b79K"
)
WANTED_TEXT_ENCODER = (
    "the text encoder of Stable Diffusion 2.1 from https://huggingface.co/stabilityai/stable-diffusion-2-1"
)

_TEXT, _PICTURE = "cond_stage_model.model.", "embedder.model.visual."
_SKETCH_PREFIXES = ("control_model.", "")

Network = TypeVar("Network", bound=nn.Module)


@dataclass(frozen=True, eq=False)
class ToonCrafterModels:
    """The networks, on the CPU.

    Attributes:
        unet: draws the clip.
        resampler: tells it what is in the first keyframe.
        autoencoder: float32; pictures to latents and back.
        sketch: reads the sketches; None without its file.
        image_encoder: looks at the first keyframe; None where the files given hold none.
        empty_prompt: embedding of no words, shape [1, 77, c]; None where the files given hold no text encoder.
    """

    unet: InterpolationUNet
    resampler: ImageResampler
    autoencoder: DualReferenceAutoencoder
    sketch: SketchEncoder | None = None
    image_encoder: ImageEncoder | None = None
    empty_prompt: Tensor | None = None

    @property
    def dtype(self) -> torch.dtype:
        """In which all but the autoencoder compute."""
        return next(self.unet.parameters()).dtype


def load_models(
    model: Path,
    *,
    sketch: Path | None = None,
    image_encoder: Path | None = None,
    text_encoder: Path | None = None,
    dtype: torch.dtype | None = torch.float32,
    sizes: ModelSizes | None = None,
) -> ToonCrafterModels:
    """Load all networks. Tensors already in the wanted precision stay mapped from their files.

    Args:
        model: ToonCrafter's file, .ckpt or .safetensors.
        sketch: its sketch encoder, .ckpt or .safetensors.
        image_encoder: the picture encoder, where the model's file holds none.
        text_encoder: the text encoder, where the model's file holds none; only the empty prompt's embedding is kept,
            beside the model's file, so that the next time none is needed.
        dtype: in which all but the autoencoder compute; None leaves weights as their files have them.
        sizes: of the networks; by default what a document beside each file tells, else the public ones.

    Raises:
        CheckpointError: a file is missing, damaged or another one; it tells what is wrong and what is wanted.
    """
    sizes = sizes or sizes_beside(model, sketch)
    tensors = read_checkpoint(model, wanted=WANTED_MODEL)
    for network in (InterpolationUNet, ImageResampler, DualReferenceAutoencoder):
        if not any(name.startswith(network.prefix) for name in tensors):
            raise CheckpointError(
                f"{model} does not fit: nothing in it is called {network.prefix}*. Wanted: {WANTED_MODEL}"
            )

    def part(build: Callable[[], Network], prefix: str, kept: torch.dtype | None) -> Network:
        return network_of(build, tensors, prefix=prefix, dtype=kept, file=str(model), wanted=WANTED_MODEL)

    return ToonCrafterModels(
        part(lambda: InterpolationUNet(sizes.unet), InterpolationUNet.prefix, dtype),
        part(lambda: ImageResampler(sizes.resampler), ImageResampler.prefix, dtype),
        part(lambda: DualReferenceAutoencoder(sizes.autoencoder), DualReferenceAutoencoder.prefix, torch.float32),
        None if sketch is None else _sketch_encoder(sketch, sizes.sketch, dtype),
        _image_encoder(tensors, model, image_encoder, sizes.image_encoder, dtype),
        _empty_prompt(tensors, model, text_encoder, sizes.text_encoder, dtype),
    )


def _sketch_encoder(file: Path, config: SketchEncoderConfiguration, dtype: torch.dtype | None) -> SketchEncoder:
    tensors = read_checkpoint(file, wanted=WANTED_SKETCH)
    prefix = next(each for each in _SKETCH_PREFIXES if any(name.startswith(each) for name in tensors))
    return network_of(
        lambda: SketchEncoder(config), tensors, prefix=prefix, dtype=dtype, file=str(file), wanted=WANTED_SKETCH
    )


def _image_encoder(
    tensors: Mapping[str, Tensor],
    model: Path,
    file: Path | None,
    config: ImageEncoderConfiguration,
    dtype: torch.dtype | None,
) -> ImageEncoder | None:
    """From the model's own file, or else from a separate one, by OpenCLIP's names or those of transformers."""
    own = below(tensors, _PICTURE)
    if not own and file is None:
        return None
    if own or file is None:
        named = from_open_clip(own)
        return network_of(
            lambda: ImageEncoder(config), named, dtype=dtype, file=str(model), wanted=WANTED_IMAGE_ENCODER
        )
    given = read_checkpoint(file, wanted=WANTED_IMAGE_ENCODER)
    named = from_open_clip(below(given, "visual.")) or {
        name: each
        for name, each in given.items()
        if name.startswith(("vision_model.", "visual_projection.")) and not name.endswith("position_ids")
    }
    return network_of(lambda: ImageEncoder(config), named, dtype=dtype, file=str(file), wanted=WANTED_IMAGE_ENCODER)


def _empty_prompt(
    tensors: Mapping[str, Tensor],
    model: Path,
    file: Path | None,
    config: TextEncoderConfiguration,
    dtype: torch.dtype | None,
) -> Tensor | None:
    """Computed once in full precision and kept beside the model's file; the text encoder itself is not kept."""
    kept = kept_prompt(model, (1, config.tokens, config.width)) if file is None else None
    if kept is not None:
        return kept if dtype is None else kept.to(dtype)
    given, source = below(tensors, _TEXT), model
    if not given:
        if file is None:
            return None
        given, source = read_checkpoint(file, wanted=WANTED_TEXT_ENCODER), file
    weights = text_weights(given, config.layers)
    encoder = network_of(
        lambda: TextEncoder(config), weights, dtype=torch.float32, file=str(source), wanted=WANTED_TEXT_ENCODER
    )
    with torch.no_grad():
        embedding = encoder(empty_prompt(config.tokens))
    keep_prompt(model, embedding)
    return embedding if dtype is None else embedding.to(dtype)
