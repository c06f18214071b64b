"""Sample clips of a training: a held-out clip as the networks draw it now, on the right of how it really goes on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from ..networks.checkpoints import below, network_of, read_checkpoint
from ..pictures import write_animation
from ..svd import CLIP_FRAMES, FrameLayout
from ..svd.autoencoder import build_autoencoder
from ..svd.decoding import decode
from ..svd.frame_layout import OVERLAP
from ..svd.noise_schedule import noise_levels
from ..svd.options import DECODED_TOGETHER
from ..svd.sampler import LATENT_SCALE, sample_clip
from ..svd.svd_weights import WANTED_SVD, read_svd
from ..tooncrafter import ToonCrafterOptions
from ..tooncrafter.autoencoder import DualReferenceAutoencoder
from ..tooncrafter.clip import guided_velocity, sample_clips
from ..tooncrafter.conditioning import Tokens, contexts, encode_pair
from ..tooncrafter.decoding import decode_clip
from ..tooncrafter.model_sizes import sizes_beside
from ..tooncrafter.models import WANTED_MODEL, ToonCrafterModels
from .data_folder import ClipRecord, clip_file
from .encoded_clips import frames_of, line_frames, read_tensors
from .hints import blurred
from .lvcd_networks import LVCDNetworks
from .settings import TrainingSettings
from .tooncrafter_networks import ToonCrafterNetworks
from .tooncrafter_samples import ToonCrafterSamples

__all__ = ["draw_lvcd", "draw_tooncrafter"]

Draw = Callable[[nn.Module, Path, str], Path]


def draw_lvcd(settings: TrainingSettings, clips: Sequence[ClipRecord]) -> Draw:
    """Draws the beginning of the first clip from its first frame and its sketches.

    Args:
        settings: of the run.
        clips: to take the first of.
    """
    clip, data = clips[0], Path(settings.data)
    numbers = range(min(clip.frames, 1 + CLIP_FRAMES))

    @torch.no_grad()
    def draw(networks: nn.Module, folder: Path, name: str) -> Path:
        assert isinstance(networks, LVCDNetworks)
        device = next(networks.parameters()).device
        kept = read_tensors(data, "svd", clip.name, ("latents", "embeddings"))
        first, embedding = kept["latents"][:1].float().to(device), kept["embeddings"][:1].float().to(device)
        lines = _at_usual_blur(data, clip, numbers, settings)
        hints = torch.from_numpy(lines)[:, None].expand(-1, 3, -1, -1).to(device)
        generator = torch.Generator().manual_seed(settings.seed)
        noise = torch.randn((1 + OVERLAP + CLIP_FRAMES, *first.shape[1:]), generator=generator).to(device)

        def predict(x: Tensor, condition: Tensor, sketches: Tensor, noise_level: Tensor, layout: FrameLayout) -> Tensor:
            both = torch.cat([x, condition], dim=1)[None]
            return networks.output(both, sketches[None], noise_level[None], embedding, layout)[0].float()

        with _computing(settings, device):
            latents = sample_clip(predict, first, hints, noise, sigmas=noise_levels(settings.sample_steps))
        weights = read_svd(Path(settings.svd))
        autoencoder = network_of(
            lambda: build_autoencoder(weights.sizes.autoencoder),
            weights.autoencoder,
            dtype=torch.float32,
            file=settings.svd,
            wanted=WANTED_SVD,
        ).to(device)
        decoder = lambda part: autoencoder.decode(part, num_frames=len(part)).sample  # noqa: E731
        pictures = torch.cat([each.cpu() for each in decode(decoder, latents / LATENT_SCALE, size=DECODED_TOGETHER)])
        return _written(pictures, frames_of(clip_file(data, clip.name), numbers), folder, name, clip.fps)

    return draw


def draw_tooncrafter(settings: TrainingSettings, clips: Sequence[ClipRecord]) -> Draw:
    """Draws the first frames of the first clip between the first and the last of them.

    Args:
        settings: of the run.
        clips: to take the first of.
    """
    clip, data = clips[0], Path(settings.data)

    @torch.no_grad()
    def draw(networks: nn.Module, folder: Path, name: str) -> Path:
        assert isinstance(networks, ToonCrafterNetworks)
        device = next(networks.parameters()).device
        numbers = range(settings.frames or networks.unet.config.temporal_length)
        truth = frames_of(clip_file(data, clip.name), numbers)
        model = Path(settings.tooncrafter)
        autoencoder = network_of(
            lambda: DualReferenceAutoencoder(sizes_beside(model).autoencoder),
            below(read_checkpoint(model, wanted=WANTED_MODEL), DualReferenceAutoencoder.prefix),
            dtype=torch.float32,
            file=str(model),
            wanted=WANTED_MODEL,
        ).to(device)
        ends = np.stack([truth[0], truth[-1]])
        keyframes = torch.from_numpy(ends).permute(0, 3, 1, 2).contiguous().to(device).float() / 127.5 - 1
        generator = torch.Generator().manual_seed(settings.seed)
        shape = (4, len(truth), keyframes.shape[-2] // 8, keyframes.shape[-1] // 8)
        drawn = torch.randn((2, 4, *shape[2:]), generator=generator).to(device)
        pair = encode_pair(autoencoder, keyframes, drawn, len(truth))
        shared = {
            name: each.to(device).float() for name, each in ToonCrafterSamples(data, clips, settings).shared().items()
        }
        kept = read_tensors(data, "tooncrafter", clip.name, ("tokens",))
        tokens = Tokens(kept["tokens"][:1].to(device).float(), shared["nothing"])
        lines = torch.from_numpy(_at_usual_blur(data, clip, numbers, settings))[None, None].to(device)
        options = ToonCrafterOptions(steps=settings.sample_steps, seed=settings.seed)
        models = ToonCrafterModels(networks.unet, networks.resampler, autoencoder, networks.control_model)

        def noise(_: int = 0) -> Tensor:
            return torch.randn((1, *shape), generator=generator).to(device)

        with _computing(settings, device):
            context = contexts(networks.resampler, tokens, shared["prompt"], shared["prompt"])
            velocity = guided_velocity(models, pair.condition, context, lines, options)
            latents = sample_clips(velocity, noise(), noise, options)[0].transpose(0, 1)
        decoder = lambda part: autoencoder.decode(part, pair.references, together=1)  # noqa: E731
        pictures = decode_clip(decoder, latents / LATENT_SCALE).cpu()
        return _written(pictures, truth, folder, name, clip.fps)

    return draw


def _at_usual_blur(
    data: Path, clip: ClipRecord, numbers: Sequence[int], settings: TrainingSettings
) -> NDArray[np.float32]:
    """Sketches of a clip, lines 1 on 0, blurred halfway between the weakest and the strongest."""
    return blurred(line_frames(data, clip.name, numbers), (settings.least_blur + settings.most_blur) / 2)


def _computing(settings: TrainingSettings, device: torch.device) -> Any:
    """The precision of the training."""
    dtype = {"no": torch.float32, "fp16": torch.float16, "bf16": torch.bfloat16}[settings.precision]
    return torch.autocast(device.type, dtype=dtype, enabled=settings.precision != "no")


def _written(pictures: Tensor, truth: Sequence[NDArray[np.uint8]], folder: Path, name: str, frame_rate: float) -> Path:
    """Truth on the left, drawn pictures (-1..1, shape [t, 3, h, w]) on the right."""
    folder.mkdir(parents=True, exist_ok=True)
    drawn = ((pictures.float().clamp(-1, 1) + 1) * 127.5).round().byte().permute(0, 2, 3, 1).numpy()
    place = folder / f"{name}.mp4"
    both = [np.concatenate(pair, axis=1) for pair in zip(truth, drawn, strict=True)]
    write_animation(both, place, frame_rate)
    return place
