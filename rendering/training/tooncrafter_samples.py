"""Samples of the interpolation's training: frames at equal distances, with their sketches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import torch
from safetensors import SafetensorError, safe_open
from torch import Tensor
from torch.utils.data import Dataset

from ...physics.errors import InvalidInputError
from .data_folder import ClipRecord
from .drawing_lots import chance_of
from .encoded_clips import in_order, line_frames, read_tensors
from .encoding import shared_file
from .frame_choice import strided_window
from .hints import blurred, drawn_blur
from .settings import TrainingSettings
from .velocity_loss import drawn_timestep

__all__ = ["ToonCrafterSamples"]

_FRAMES = 16


@dataclass(frozen=True)
class ToonCrafterSamples(Dataset):  # type: ignore[type-arg]
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
        kept = read_tensors(self.data, "tooncrafter", clip.name, ("latents", "tokens", "firsts"))
        firsts = tuple(int(each) for each in kept["firsts"])
        chosen, stride = strided_window(clip.frames, settings.frames or _FRAMES, chance.choices, firsts=firsts)
        blur = drawn_blur(chance.choices, settings.least_blur, settings.most_blur)
        tokens = kept["tokens"][firsts.index(chosen[0])].float()
        shared = self.shared()
        if chance.choices.uniform() < settings.dropped_pictures:
            tokens = shared["nothing"][0].float()
        latents = in_order(kept["latents"], chosen).transpose(0, 1)
        hints = blurred(line_frames(self.data, clip.name, chosen), blur)
        return clip.name, {
            "latents": latents,
            "tokens": tokens,
            "prompt": shared["prompt"][0].float(),
            "rate": torch.tensor(max(round(clip.fps / stride), 1)),
            "hints": torch.from_numpy(hints),
            "timestep": drawn_timestep(chance.noise),
            "noise": torch.randn(latents.shape, generator=chance.noise),
        }

    def shared(self) -> dict[str, Tensor]:
        """The empty prompt and a grey picture, as the encoders see them.

        Raises:
            InvalidInputError: the data is not encoded.
        """
        place = shared_file(self.data)
        try:
            with safe_open(place, framework="pt") as opened:
                return {name: opened.get_tensor(name) for name in ("nothing", "prompt")}
        except (SafetensorError, OSError) as error:
            raise InvalidInputError(f"{place} must be what physanimator dataset encode wrote. Got: {error}") from None
