"""Settings of soft inpainting."""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.checks import check_number, check_whole, require_kind
from ...physics.errors import require
from ..networks import LARGEST_AREA, SMALLEST_AREA

__all__ = ["InpaintingOptions"]


@dataclass(frozen=True)
class InpaintingOptions:
    """Settings; the defaults are those that Stable Diffusion is used with.

    Attributes:
        prompt: what is to be seen in the picture.
        negative_prompt: what is not.
        steps: of the sampler, for the strength 1.
        strength: how far what changes most may leave the frame, up to 1, where nothing of it is kept. Only this share
            of the steps is done.
        guidance: how closely the prompt is followed; 1 leaves the negative prompt out and takes half the time.
        seed: of the noise.
        shared_noise: whether all frames of a clip start from the same noise, so that what is painted flickers less.
        area: of the pictures that the networks work on [px^2], in the frames' proportions; None for the frames' size.

    Examples:
        >>> from physanimator.rendering.inpainting import InpaintingOptions
        >>> InpaintingOptions(prompt="girl under a blue sky", steps=20, strength=0.8).steps_done
        16
    """

    prompt: str = ""
    negative_prompt: str = ""
    steps: int = 25
    strength: float = 1.0
    guidance: float = 7.5
    seed: int = 0
    shared_noise: bool = True
    area: int | None = None

    def __post_init__(self) -> None:
        require_kind("prompt", self.prompt, str, "a text")
        require_kind("negative_prompt", self.negative_prompt, str, "a text")
        check_whole("steps", self.steps, 1, 1000)
        check_number("strength", self.strength, 0, 1)
        expected = f"{1 / self.steps:.3g} to 1, so that at least one of {self.steps} steps is done"
        require("strength", self.strength, self.steps_done >= 1, expected)
        check_number("guidance", self.guidance, 0, 100)
        check_whole("seed", self.seed, 0, 2**64 - 1)
        require_kind("shared_noise", self.shared_noise, bool, "yes or no")
        if self.area is not None:
            check_whole("area", self.area, SMALLEST_AREA, LARGEST_AREA, unit=" px^2")

    @property
    def steps_done(self) -> int:
        """Steps of the sampler that the strength leaves, rounded down as diffusers does."""
        return int(self.steps * self.strength)
