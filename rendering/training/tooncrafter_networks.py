"""What is trained of the interpolation: the ControlNet that reads each frame's sketch; all else is frozen."""

from __future__ import annotations

from pathlib import Path

import torch
from torch import Tensor, nn

from ..networks.checkpoints import below, network_of, read_checkpoint
from ..tooncrafter.model_sizes import sizes_beside
from ..tooncrafter.models import WANTED_MODEL, WANTED_SKETCH
from ..tooncrafter.resampler import ImageResampler
from ..tooncrafter.sketch_encoder import SketchEncoder
from ..tooncrafter.unet import InterpolationUNet
from .copied_encoder import copied_encoder
from .velocity_loss import noisy_and_velocity, velocity_loss

__all__ = ["ToonCrafterNetworks", "tooncrafter_networks"]

WANTED_ENCODER = (
    "Stable Diffusion 2.1 as one file, v2-1_512-ema-pruned.safetensors or v2-1_768-ema-pruned.safetensors, from"
    " https://huggingface.co/stabilityai/stable-diffusion-2-1"
)


class ToonCrafterNetworks(nn.Module):
    """Sketch encoder, UNet and resampler, with the loss of a batch as their output."""

    def __init__(self, sketch: SketchEncoder, unet: InterpolationUNet, resampler: ImageResampler) -> None:
        super().__init__()
        self.control_model, self.unet, self.resampler = sketch, unet, resampler
        self.requires_grad_(False)
        sketch.requires_grad_(True)

    def forward(
        self,
        latents: Tensor,
        tokens: Tensor,
        prompt: Tensor,
        rate: Tensor,
        hints: Tensor,
        timestep: Tensor,
        noise: Tensor,
    ) -> Tensor:
        """The loss of each clip.

        Args:
            latents: scaled, of each frame, shape [b, 4, t, h, w]; the first and the last are the keyframes.
            tokens: the picture encoder's, of the first frame, shape [b, n, c].
            prompt: the empty prompt, embedded, shape [b, l, c].
            rate: frames a second that the network is told, shape [b].
            hints: sketches, lines 1 on 0, shape [b, t, 8 h, 8 w].
            timestep: of each clip, 0..999, shape [b].
            noise: standard normal, shape [b, 4, t, h, w].

        Returns:
            Shape [b].
        """
        noisy, velocity = noisy_and_velocity(latents.float(), noise, timestep)
        return velocity_loss(self.predicted(noisy, latents, tokens, prompt, rate, hints, timestep), velocity)

    def predicted(
        self,
        noisy: Tensor,
        latents: Tensor,
        tokens: Tensor,
        prompt: Tensor,
        rate: Tensor,
        hints: Tensor,
        timestep: Tensor,
    ) -> Tensor:
        """The networks' output, shape [b, 4, t, h, w], for noisy latents and the conditions of :meth:`forward`."""
        condition = torch.zeros_like(noisy)
        condition[:, :, 0], condition[:, :, -1] = latents[:, :, 0], latents[:, :, -1]
        context = torch.cat([prompt.float(), self.resampler(tokens.float())], dim=1)
        frames = noisy.transpose(1, 2).flatten(0, 1)
        residuals = self.control_model(frames, hints.flatten(0, 1)[:, None], timestep, context)
        return self.unet(torch.cat([noisy, condition], dim=1), timestep, context, rate, residuals)


def tooncrafter_networks(
    model: Path,
    start: Path | None = None,
    *,
    encoder: Path | None = None,
    frozen: torch.dtype = torch.float32,
    seed: int = 0,
) -> ToonCrafterNetworks:
    """The networks at the start of a training.

    Args:
        model: ToonCrafter's file.
        start: the public sketch encoder's file, or one that a training exported.
        encoder: without ``start``: Stable Diffusion 2.1's file, whose encoder is copied; it adds nothing yet.
        frozen: precision of what is not trained; what is trained is float32.
        seed: of the layers that read the sketch, without ``start``.

    Raises:
        CheckpointError: a file is missing, damaged or another one.
    """
    sizes = sizes_beside(model, start)
    given = read_checkpoint(model, wanted=WANTED_MODEL)

    def frozen_part(build: type[InterpolationUNet] | type[ImageResampler], config: object) -> nn.Module:
        return network_of(
            lambda: build(config),  # type: ignore[arg-type]
            given,
            prefix=build.prefix,
            dtype=frozen,
            file=str(model),
            wanted=WANTED_MODEL,
        )

    unet, resampler = frozen_part(InterpolationUNet, sizes.unet), frozen_part(ImageResampler, sizes.resampler)
    assert isinstance(unet, InterpolationUNet)
    assert isinstance(resampler, ImageResampler)
    if start is not None:
        trained = read_checkpoint(start, wanted=WANTED_SKETCH)
        prefix = "control_model." if any(name.startswith("control_model.") for name in trained) else ""
        sketch = network_of(
            lambda: SketchEncoder(sizes.sketch),
            trained,
            prefix=prefix,
            dtype=torch.float32,
            file=str(start),
            wanted=WANTED_SKETCH,
        )
    else:
        source = encoder or Path("the file of Stable Diffusion 2.1")
        copied = below(read_checkpoint(source, wanted=WANTED_ENCODER), "model.diffusion_model.")
        sketch = copied_encoder(lambda: SketchEncoder(sizes.sketch), copied, file=str(source), seed=seed)
    return ToonCrafterNetworks(sketch, unet, resampler)
