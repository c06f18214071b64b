"""The autoencoder whose decoder sees both keyframes (ToonCrafter, "dual-reference-based 3D decoder")."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import torch
from torch import Tensor, nn

from ..networks.checkpoints import network_of
from .clip_decoder import ClipDecoder
from .configuration import AutoencoderConfiguration
from .picture_encoder import PictureEncoder

__all__ = ["PIXELS_PER_LATENT", "DualReferenceAutoencoder"]

PIXELS_PER_LATENT = 8
"""Width and height of the part of a picture that a latent stands for [px]."""


class DualReferenceAutoencoder(nn.Module):
    """Pictures to latents, and latents with both keyframes' features to pictures."""

    prefix = "first_stage_model."
    """Before its names in the public checkpoint."""

    def __init__(self, config: AutoencoderConfiguration) -> None:
        super().__init__()
        self.config = config
        self.encoder = PictureEncoder(config)
        self.decoder = ClipDecoder(config)
        self.quant_conv = nn.Conv2d(2 * config.z_channels, 2 * config.embed_dim, 1)
        # Part of the public file, without use: the decoder was trained on the latents as they are.
        self.post_quant_conv = nn.Conv2d(config.embed_dim, config.z_channels, 1)

    @classmethod
    def from_reference(
        cls, config: AutoencoderConfiguration | Mapping[str, Any], state_dict: Mapping[str, Any]
    ) -> DualReferenceAutoencoder:
        """A network with the weights of a state dict, whose names are the public checkpoint's, prefix included."""
        return network_of(
            lambda: cls(AutoencoderConfiguration.of(config)),
            state_dict,
            wanted="weights of ToonCrafter's autoencoder",
            prefix=cls.prefix,
        )

    def encode(self, frames: Tensor, *, together: int | None = None) -> tuple[Tensor, list[Tensor]]:
        """Encode pictures; the first and the last are the keyframes.

        Args:
            frames: -1..1, shape [t, 3, h, w].
            together: pictures that are encoded at once; None encodes all at once.

        Returns:
            Means and logarithms of variances, one after the other, shape [t, 8, h / 8, w / 8]; and the features of both
            keyframes on each level, then at the entrance, shapes [1, c, 2, h', w'].
        """
        moments: list[Tensor] = []
        ends: list[list[Tensor]] = []
        for part in frames.split(together or len(frames)):
            h, features = self.encoder(part)
            moments.append(self.quant_conv(h))
            ends = [*ends[:1], features]
        references = [
            torch.stack([first[0], last[-1]], dim=1)[None] for first, last in zip(ends[0], ends[-1], strict=True)
        ]
        return torch.cat(moments), references

    def decode(self, latents: Tensor, references: Sequence[Tensor], *, together: int | None = None) -> Tensor:
        """Decode one clip.

        Args:
            latents: not scaled, shape [t, 4, h, w].
            references: features of both keyframes, from ``encode``.
            together: about as many frames' results are in memory at once; None decodes all at once. The pictures are
                the same but for rounding.

        Returns:
            Pictures, about -1..1, shape [t, 3, 8 h, 8 w].
        """
        each = self.config.ch * latents[0, 0].numel() * PIXELS_PER_LATENT**2
        budget = together * each if together is not None and together < len(latents) else None
        return self.decoder(latents, references, budget)
