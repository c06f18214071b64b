"""Clips between pairs of keyframes, from pictures to pictures; networks come to the device one after another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from ..networks.half_precision import decoded_in, is_halved
from ..networks.memory import sampling_bytes
from ..networks.placement import Placement
from .autoencoder import PIXELS_PER_LATENT
from .clip import guided_velocity, sample_clips
from .conditioning import LATENT_SCALE, Context, KeyframePair, Tokens, contexts, empty_prompt_of, encode_pair, look_at
from .decoding import decode_clip
from .memory import decoding_bytes, encoding_bytes
from .models import ToonCrafterModels
from .options import ToonCrafterOptions
from .sampler import Watch

__all__ = ["LookAt", "Pair", "PairDrawing", "Prompts"]

LookAt = Callable[[Sequence[Tensor]], Tokens]
"""Gives the picture encoder's tokens of pictures, -1..1, each of shape [3, h, w]."""

Prompts = tuple[Tensor, Tensor]
"""Embedded prompt and embedded empty prompt, each of shape [1, l, c]."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Two keyframes.

    Attributes:
        keyframes: the first and the last, -1..1, shape [2, 3, h, w].
        hints: sketch of each frame of the clip, lines 1 on 0, shape [1, t, h, w]; None without sketches.
        seed: numbers that its noise follows from, so that a pair looks the same whatever is drawn with it.
    """

    keyframes: Tensor
    hints: Tensor | None
    seed: tuple[int, ...]


class PairDrawing:
    """Draws clips."""

    def __init__(
        self,
        models: ToonCrafterModels,
        options: ToonCrafterOptions,
        placement: Placement,
        *,
        look: LookAt | None = None,
        prompts: Prompts | None = None,
    ) -> None:
        """Prepare.

        Args:
            models: the networks.
            options: settings.
            placement: where the networks compute.
            look: another picture encoder than the models' own.
            prompts: what is wanted, and no words at all, by another text encoder than that of the models' files.
        """
        self.models, self.options, self.placement = models, options, placement
        self.look = look or self._look
        self.prompts = prompts

    @torch.no_grad()
    def frames(self, pairs: Sequence[Pair], *, watch: Watch | None = None) -> list[Tensor]:
        """Draw all pairs at once.

        Args:
            pairs: of one size; all with sketches, or none.
            watch: called in each sampling step; may raise to stop.

        Returns:
            For each pair its clip, keyframes included, -1..1, on the CPU, shape [t, 3, h, w].
        """
        count = self.models.unet.config.temporal_length
        generators = [_generator(pair.seed) for pair in pairs]
        context = self._context(pairs)
        encoded = self._encoded(pairs, generators, count)
        latents = self._sampled(pairs, encoded, context, generators, watch)
        return self._decoded(latents, encoded)

    def _look(self, pictures: Sequence[Tensor]) -> Tokens:
        encoder = self.models.image_encoder
        with self.placement.at_work(*([encoder] if encoder is not None else [])):
            return look_at(self.models, [each.to(self.placement.device) for each in pictures])

    def _context(self, pairs: Sequence[Pair]) -> Context:
        device, dtype = self.placement.device, self.models.dtype
        found = self.look([pair.keyframes[0] for pair in pairs])
        tokens = Tokens(found.picture.to(device, dtype), found.nothing.to(device, dtype))
        prompts = self.prompts or (empty_prompt_of(self.models),) * 2
        prompt, without = (each.to(device, dtype) for each in prompts)
        with self.placement.at_work(self.models.resampler):
            return contexts(self.models.resampler, tokens, prompt, without)

    def _encoded(self, pairs: Sequence[Pair], generators: Sequence[torch.Generator], count: int) -> list[KeyframePair]:
        autoencoder, device = self.models.autoencoder, self.placement.device
        height, width = pairs[0].keyframes.shape[-2:]
        needed = encoding_bytes(height * width, autoencoder.config.ch)
        shape = (2, autoencoder.config.embed_dim, height // PIXELS_PER_LATENT, width // PIXELS_PER_LATENT)
        with self.placement.at_work(autoencoder, working_bytes=needed):
            return [
                encode_pair(
                    autoencoder, pair.keyframes.to(device), torch.randn(shape, generator=each).to(device), count
                )
                for pair, each in zip(pairs, generators, strict=True)
            ]

    def _sampled(
        self,
        pairs: Sequence[Pair],
        encoded: Sequence[KeyframePair],
        context: Context,
        generators: Sequence[torch.Generator],
        watch: Watch | None,
    ) -> Tensor:
        """Clean, scaled latents of all clips, on the device."""
        device, models = self.placement.device, self.models
        condition = torch.cat([each.condition for each in encoded])
        given = [pair.hints for pair in pairs if pair.hints is not None]
        hints = torch.stack(given) if given else None

        def noise(_: int = 0) -> Tensor:
            drawn = [torch.randn(condition.shape[1:], generator=each) for each in generators]
            return torch.stack(drawn).to(device)

        networks = [models.unet, *([models.sketch] if models.sketch is not None and hints is not None else [])]
        # A quarter more than in the video model, for the sketch encoder's residuals and all frames' prompt attention.
        needed = 5 * sampling_bytes(condition[:, 0].numel(), models.unet.config.model_channels, models.dtype) // 4
        with self.placement.at_work(*networks, working_bytes=needed):
            velocity = guided_velocity(models, condition, context, hints, self.options)
            return sample_clips(velocity, noise(), noise, self.options, watch=watch)

    def _decoded(self, latents: Tensor, encoded: Sequence[KeyframePair]) -> list[Tensor]:
        autoencoder, device = self.models.autoencoder, self.placement.device
        frames, pixels = latents.shape[2], latents[0, 0, 0].numel() * PIXELS_PER_LATENT**2
        together = self.options.decoded_together
        dtype = self.models.dtype if is_halved(self.models.dtype, device) else torch.float32
        needed = decoding_bytes(pixels, autoencoder.config.ch, frames, together=together, dtype=dtype)
        clips = []
        with self.placement.at_work(autoencoder, working_bytes=needed):
            for clip, pair in zip(latents, encoded, strict=True):

                def decoder(part: Tensor, references: list[Tensor] = pair.references) -> Tensor:
                    return decoded_in(dtype, device, lambda: autoencoder.decode(part, references, together=together))

                clips.append(decode_clip(decoder, clip.transpose(0, 1) / LATENT_SCALE).cpu())
        return clips


def _generator(seed: Sequence[int]) -> torch.Generator:
    mixed = int(np.random.SeedSequence(list(seed)).generate_state(1, np.uint64)[0] >> np.uint64(1))
    return torch.Generator().manual_seed(mixed)
