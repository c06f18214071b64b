"""Stable Diffusion from a diffusers folder on disk: nothing is fetched, and nothing in the folder is run.

Each part is built as one known class, with the sizes that its JSON document tells, and gets its weights from
.safetensors files alone. What else the folder holds, such as code or the names of other classes, is not looked at.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import torch
from diffusers import AutoencoderKL, DDIMScheduler, UNet2DConditionModel
from torch import Tensor, nn

from ...physics.errors import require
from ..networks.checkpoints import CheckpointError, network_of, read_checkpoint
from ..networks.documents import read_document
from ..networks.library_bars import without_bars

__all__ = ["WANTED_INPAINTING", "InpaintingModels", "load_inpainting_models"]

WANTED_INPAINTING = (
    "the diffusers folder of a Stable Diffusion 1 or 2 model, with or without inpainting in its name: unet, vae,"
    " text_encoder, tokenizer and scheduler, weights as .safetensors"
)

Network = TypeVar("Network", bound=nn.Module)

_MOST_BYTES, _MOST_LEVELS, _MOST_LAYERS, _MOST_CHANNELS = 1_000_000, 8, 16, 16_384
_OLD_ATTENTION = {"query": "to_q", "key": "to_k", "value": "to_v", "proj_attn": "to_out.0"}


@dataclass(frozen=True, eq=False)
class InpaintingModels:
    """The networks, on the CPU.

    Attributes:
        text_encoder: embeds prompts; float32, CLIP's of the transformers library.
        tokenizer: cuts prompts into tokens; of the same library.
        autoencoder: float32; pictures to latents and back.
        unet: predicts the noise.
        schedule: the scheduler's settings by name.
    """

    text_encoder: Any
    tokenizer: Any
    autoencoder: AutoencoderKL
    unet: UNet2DConditionModel
    schedule: Mapping[str, Any]

    @property
    def dtype(self) -> torch.dtype:
        """In which the UNet computes."""
        return next(self.unet.parameters()).dtype

    @property
    def sees_holes(self) -> bool:
        """Whether the UNet is one for inpainting, which also takes the mask and the picture without what it hides."""
        return bool(self.unet.config.in_channels == 2 * self.autoencoder.config.latent_channels + 1)

    @property
    def pixels_per_latent(self) -> int:
        """Width of the square of pixels that becomes one latent [px]."""
        return int(2 ** (len(self.autoencoder.config.block_out_channels) - 1))

    def scheduler(self) -> DDIMScheduler:
        """A new one."""
        return DDIMScheduler.from_config(dict(self.schedule))

    def check_steps(self, steps: int) -> None:
        """Refuse more steps than the model was trained with.

        Raises:
            InvalidInputError: there are more.
        """
        most = self.schedule.get("num_train_timesteps", 1000)
        require("steps", steps, steps <= most, f"{most} or less with this model")

    @torch.no_grad()
    def embedded(self, prompt: str) -> Tensor:
        """A prompt as the UNet takes it, shape [1, tokens, channels]; what is too long is cut off."""
        count = self.text_encoder.config.max_position_embeddings
        tokens = self.tokenizer(
            prompt, padding="max_length", max_length=count, truncation=True, return_tensors="pt"
        ).input_ids
        embedding: Tensor = self.text_encoder(tokens)[0]
        return embedding


def load_inpainting_models(folder: Path, *, dtype: torch.dtype | None = torch.float32) -> InpaintingModels:
    """Load all networks.

    Args:
        folder: of a diffusers pipeline.
        dtype: in which the UNet computes; None for that of its file.

    Raises:
        CheckpointError: something is missing, damaged or made for something else; it tells what, and what is wanted.
    """
    if not folder.is_dir():
        raise CheckpointError(f"{folder} is no folder. Wanted: {WANTED_INPAINTING}")
    autoencoder = _part(folder / "vae", AutoencoderKL, torch.float32)
    unet = _part(folder / "unet", UNet2DConditionModel, dtype)
    text_encoder, tokenizer = _text_encoder(folder)
    _check_fit(folder, unet.config, autoencoder.config, text_encoder.config)
    models = InpaintingModels(text_encoder, tokenizer, autoencoder, unet, _schedule(folder / "scheduler"))
    _built(folder / "scheduler", models.scheduler)
    return models


def _check_fit(folder: Path, unet: Any, autoencoder: Any, text_encoder: Any) -> None:
    """Refuse parts that do not belong together, and models that want more than a prompt, such as SDXL's."""
    latents = autoencoder.latent_channels
    fits = (
        unet.in_channels in (latents, 2 * latents + 1)
        and unet.out_channels == latents
        and unet.cross_attention_dim == text_encoder.hidden_size
        and not (unet.addition_embed_type or unet.class_embed_type or unet.encoder_hid_dim)
        and unet.num_class_embeds is None
    )
    if not fits:
        raise CheckpointError(f"{folder} holds another kind of model. Wanted: {WANTED_INPAINTING}")


def _part(folder: Path, kind: Any, dtype: torch.dtype | None) -> Any:
    config = read_document(folder / "config.json", wanted=WANTED_INPAINTING, most=_MOST_BYTES)
    channels, layers = config.get("block_out_channels"), config.get("layers_per_block", 1)
    layers = layers if isinstance(layers, list) else [layers]
    # A part is built without memory, but not without time.
    plausible = (
        isinstance(channels, list)
        and 1 <= len(channels) <= _MOST_LEVELS
        and len(layers) <= _MOST_LEVELS
        and all(isinstance(each, int) and 1 <= each <= _MOST_CHANNELS for each in channels)
        and all(isinstance(each, int) and 1 <= each <= _MOST_LAYERS for each in layers)
    )
    if not plausible:
        raise CheckpointError(f"{folder / 'config.json'} tells no sizes of a network. Wanted: {WANTED_INPAINTING}")
    found = {_name(name): _shaped(name, tensor) for name, tensor in _weights(folder).items()}
    tensors = {name: tensor.to(dtype or tensor.dtype) for name, tensor in found.items()}

    def build() -> Any:
        return _built(folder, lambda: kind.from_config(config))

    return network_of(build, tensors, file=str(folder), wanted=WANTED_INPAINTING)


def _built(folder: Path, build: Callable[[], Any]) -> Any:
    try:
        return build()
    except Exception as error:  # a wrong configuration makes the library raise nearly anything
        raise CheckpointError(f"{folder} tells sizes that do not fit together. Wanted: {WANTED_INPAINTING}") from error


def _name(name: str) -> str:
    """A tensor's name; attention in the autoencoder had other ones once."""
    found = re.fullmatch(r"(.*\.attentions\.\d+\.)(query|key|value|proj_attn)(\.\w+)", name)
    return f"{found[1]}{_OLD_ATTENTION[found[2]]}{found[3]}" if found else name


def _shaped(name: str, tensor: Tensor) -> Tensor:
    """Attention under its old names may be made of 1 x 1 convolutions."""
    return tensor.flatten(1) if _name(name) != name and tensor.ndim == 4 else tensor


def _weights(folder: Path) -> dict[str, Tensor]:
    """All weights of one part: one file, or a split one; full precision where there are both."""
    for variant in ("", ".fp16"):
        stem = f"diffusion_pytorch_model{variant}"
        whole, split = folder / f"{stem}.safetensors", sorted(folder.glob(f"{stem}-*-of-*.safetensors"))
        files = [whole] if whole.is_file() else split
        if files:
            each = (read_checkpoint(file, wanted=WANTED_INPAINTING).items() for file in files)
            return {name: tensor for pairs in each for name, tensor in pairs}
    raise CheckpointError(f"{folder} holds no diffusion_pytorch_model.safetensors. Wanted: {WANTED_INPAINTING}")


def _schedule(folder: Path) -> dict[str, Any]:
    found = read_document(folder / "scheduler_config.json", wanted=WANTED_INPAINTING, most=_MOST_BYTES)
    count = found.get("num_train_timesteps", 1000)
    if not (isinstance(count, int) and 1 <= count <= 100_000):
        raise CheckpointError(f"{folder} tells sizes that do not fit together. Wanted: {WANTED_INPAINTING}")
    return {name: value for name, value in found.items() if not name.startswith("_")}


def _text_encoder(folder: Path) -> tuple[Any, Any]:
    """Text encoder and tokenizer, without a look at what their documents say of code."""
    try:
        import transformers
        from transformers import CLIPTextModel, CLIPTokenizer
    except ImportError as error:
        raise CheckpointError("The package transformers is missing: pip install 'transformers>=4.56'.") from error
    read_document(folder / "text_encoder" / "config.json", wanted=WANTED_INPAINTING, most=_MOST_BYTES)
    only = {"local_files_only": True, "trust_remote_code": False}
    try:
        with without_bars(transformers):
            network, report = CLIPTextModel.from_pretrained(
                folder / "text_encoder", use_safetensors=True, output_loading_info=True, **only
            )
        tokenizer = CLIPTokenizer.from_pretrained(folder / "tokenizer", **only)
    except Exception as error:  # damaged files and wrong configurations make the library raise nearly anything
        raise CheckpointError(
            f"{folder} holds a text_encoder or tokenizer that cannot be loaded: a file is missing, damaged, or no"
            " .safetensors."
            f" Wanted: {WANTED_INPAINTING}"
        ) from error
    if report["missing_keys"] or report["mismatched_keys"] or len(tokenizer) > network.config.vocab_size:
        raise CheckpointError(f"{folder / 'text_encoder'} does not fit its documents. Wanted: {WANTED_INPAINTING}")
    return network.float().eval().requires_grad_(False), tokenizer
