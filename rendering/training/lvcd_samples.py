"""Samples of the video model's training: a reference frame and a run of frames, with their sketches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import torch
from torch import Tensor
from torch.utils.data import Dataset

from ..svd import CLIP_FRAMES
from .data_folder import ClipRecord
from .drawing_lots import chance_of
from .edm_loss import drawn_sigma
from .encoded_clips import in_order, line_frames, read_tensors
from .frame_choice import reference_and_window
from .hints import blurred, drawn_blur
from .settings import TrainingSettings

__all__ = ["LVCDSamples"]


@dataclass(frozen=True)
class LVCDSamples(Dataset):  # type: ignore[type-arg]
    """Samples by number: the same number is the same sample, in whatever process and order they are asked for.

    Attributes:
        data: the data folder.
        clips: to draw from.
        settings: of the run.
    """

    data: Path
    clips: Sequence[ClipRecord]
    settings: TrainingSettings

    def __getitem__(self, number: int) -> tuple[str, dict[str, Tensor]]:
        """The clip's name, and what the networks take, without a batch dimension.

        Raises:
            InvalidInputError: the clip is too short, not encoded, or changed.
        """
        chance, settings = chance_of(self.settings.seed, number), self.settings
        clip = self.clips[int(chance.choices.integers(len(self.clips)))]
        frames = (settings.frames or 1 + CLIP_FRAMES) - 1
        chosen = reference_and_window(clip.frames, frames, chance.choices)
        blur = drawn_blur(chance.choices, settings.least_blur, settings.most_blur)
        kept = read_tensors(self.data, "svd", clip.name, ("latents", "embeddings"))
        latents = in_order(kept["latents"], chosen)
        hints = blurred(line_frames(self.data, clip.name, chosen), blur)
        return clip.name, {
            "latents": latents,
            "reference": latents[0],
            "embedding": kept["embeddings"][chosen[0]].float(),
            "hints": torch.from_numpy(hints),
            "sigma": drawn_sigma(chance.noise),
            "noise": torch.randn(latents.shape, generator=chance.noise),
        }
