"""What is trained of the video model: LVCD's ControlNet, and its two kinds of self-attention in the UNet."""

from __future__ import annotations

from pathlib import Path

import torch
from torch import Tensor, nn

from ..networks.checkpoints import below, network_of, read_checkpoint
from ..svd import FrameLayout, SVDOptions
from ..svd.controlnet import SketchControlNet
from ..svd.models import WANTED_LVCD
from ..svd.noise_schedule import Preconditioning
from ..svd.sampler import LATENT_SCALE
from ..svd.svd_weights import WANTED_SVD, SVDWeights, read_svd
from ..svd.unet import SpatioTemporalUNet
from .copied_encoder import copied_encoder
from .edm_loss import edm_loss, noisy_at

__all__ = ["LVCDNetworks", "lvcd_networks"]

_TRAINED = ".attn1."


class LVCDNetworks(nn.Module):
    """ControlNet and UNet, with the loss of a batch as their output.

    Names are those of the public checkpoint, so what is trained is written under them.
    """

    def __init__(self, control: SketchControlNet, unet: SpatioTemporalUNet) -> None:
        super().__init__()
        self.control_model = control
        self.model = nn.ModuleDict({"diffusion_model": unet})
        self.requires_grad_(False)
        control.requires_grad_(True)
        for name, parameter in unet.named_parameters():
            parameter.requires_grad_(_TRAINED in name)

    @property
    def unet(self) -> SpatioTemporalUNet:
        """The video model."""
        network = self.model["diffusion_model"]
        assert isinstance(network, SpatioTemporalUNet)
        return network

    def forward(
        self, latents: Tensor, reference: Tensor, embedding: Tensor, hints: Tensor, sigma: Tensor, noise: Tensor
    ) -> Tensor:
        """The loss of each clip.

        Args:
            latents: the autoencoder's own, of the reference frame and the run's, shape [b, t, 4, h, w].
            reference: those of the reference picture, shape [b, 4, h, w].
            embedding: of the reference picture, shape [b, c].
            hints: sketches, lines 1 on 0, shape [b, t, 8 h, 8 w].
            sigma: noise level of each clip, shape [b].
            noise: standard normal, shape [b, t, 4, h, w].

        Returns:
            Shape [b].
        """
        clean = LATENT_SCALE * latents.float()
        noisy = noisy_at(clean, noise, sigma)
        return edm_loss(self.predicted(noisy, reference, embedding, hints, sigma), noisy, clean, sigma)

    def predicted(self, noisy: Tensor, reference: Tensor, embedding: Tensor, hints: Tensor, sigma: Tensor) -> Tensor:
        """The networks' output, shape [b, t, 4, h, w], for noisy latents and the conditions of :meth:`forward`."""
        frames = noisy.shape[1]
        use = Preconditioning.at(sigma)
        condition = reference[:, None].expand(-1, frames, -1, -1, -1)
        both = torch.cat([use.into.reshape(-1, 1, 1, 1, 1) * noisy, condition.float()], dim=2)
        lines = hints[:, :, None].expand(-1, -1, 3, -1, -1)
        return self.output(both, lines, use.level, embedding, FrameLayout.single_reference(frames))

    def output(
        self, both: Tensor, lines: Tensor, noise_level: Tensor, embedding: Tensor, layout: FrameLayout
    ) -> Tensor:
        """The networks' output, shape [b, t, 4, h, w].

        Args:
            both: scaled noisy latents, then condition latents, shape [b, t, 8, h, w].
            lines: sketches, lines 1 on 0, shape [b, t, 3, 8 h, 8 w].
            noise_level: ln(sigma) / 4 of each clip, shape [b].
            embedding: of the reference picture, shape [b, c].
            layout: which frames are references.
        """
        usual = SVDOptions()
        numbers = (usual.frames_per_second, usual.motion_bucket, usual.picture_noise)
        ids = torch.tensor([numbers], dtype=torch.float32, device=both.device).expand(len(both), -1)
        told = (noise_level, embedding[:, None].float(), ids, layout)
        return self.unet(both, *told, self.control_model(both, lines, *told))


def lvcd_networks(
    svd: Path, start: Path | None = None, *, frozen: torch.dtype = torch.float32, seed: int = 0
) -> LVCDNetworks:
    """The networks at the start of a training.

    Args:
        svd: Stable Video Diffusion: its single file or its diffusers folder.
        start: LVCD's file, or one that a training exported; without it the ControlNet begins as a copy of the UNet's
            encoder that adds nothing yet (Zhang et al. 2023, "zero convolution").
        frozen: precision of what is not trained; what is trained is float32.
        seed: of the layers that read the sketch, without ``start``.

    Raises:
        CheckpointError: a file is missing, damaged or another one.
    """
    weights = read_svd(svd)
    network = weights.sizes.network
    if start is None:
        unet = _unet(weights, {})
        control = copied_encoder(lambda: SketchControlNet(network), unet, file=str(svd), seed=seed)
    else:
        given = read_checkpoint(start, wanted=WANTED_LVCD)
        unet = _unet(weights, below(given, SpatioTemporalUNet.prefix))
        trained = below(given, SketchControlNet.prefix)
        control = network_of(
            lambda: SketchControlNet(network), trained, dtype=torch.float32, file=str(start), wanted=WANTED_LVCD
        )
    made = LVCDNetworks(control, unet)
    for parameter in made.parameters():
        if not parameter.requires_grad:
            parameter.data = parameter.data.to(frozen)
    return made


def _unet(weights: SVDWeights, attention: dict[str, Tensor]) -> SpatioTemporalUNet:
    return network_of(
        lambda: SpatioTemporalUNet(weights.sizes.network),
        {**weights.unet, **attention},
        dtype=torch.float32,
        file=str(weights.source),
        wanted=WANTED_SVD,
    )
