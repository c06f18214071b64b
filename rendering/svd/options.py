"""Settings of the renderer by Stable Video Diffusion."""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.checks import check_number, check_whole, require_kind
from ...physics.errors import InvalidInputError, require
from ..networks import LARGEST_AREA, SMALLEST_AREA, TRAINED_HEIGHT, TRAINED_WIDTH
from .frame_layout import CLIP_FRAMES, LEAST_OVERLAP, OVERLAP

__all__ = ["DECODED_TOGETHER", "FOLLOWED", "STRONG", "WEAK", "SVDOptions"]

FOLLOWED = ("sketches", "animation", "both")
"""What frames can follow: warped sketches, the composite animation, or both of them."""

WEAK, STRONG = 16 / 50, 21 / 50
"""Where Time-to-Move starts and where it lets go with Stable Video Diffusion: parts of all steps."""

DECODED_TOGETHER = 10
"""Frames that LVCD decodes at once."""


@dataclass(frozen=True)
class SVDOptions:
    """Settings; the defaults are those that LVCD is used with. :meth:`following` has those of each thing to follow.

    Attributes:
        steps: of the sampler, for each segment.
        motion_bucket: how much motion to expect, 1 to 255.
        frames_per_second: what the networks are told of the frame rate.
        picture_noise: standard deviation of the noise on the reference picture, which is in -1..1.
        overlap: frames that neighbouring segments share.
        area: of the pictures that the networks work on [px^2].
        decoded_together: frames that are decoded at once; fewer need less memory.
        seed: of the noise.
        follow: what frames follow. "sketches", by LVCD; "animation", the composite's frames, by dual-clock denoising,
            for which Stable Video Diffusion is enough (see :mod:`~physanimator.rendering.svd.dual_clock`); or "both".
        weak: part of the steps that the animation stands in for, 0 to 1: less of it repaints more, everywhere.
        strong: part of the steps until which moving parts are held to the animation, ``weak`` to 1: too little lets
            them leave its path, too much leaves them as stiff as they are there.
        guidance: how strongly the last frame of a segment holds to the picture, with classifier-free guidance that
            rises from 1, none, in its first frame; 1: none in all, in half the time. Not with sketches.

    Raises:
        InvalidInputError: a value is out of its range, or would not be used.

    Examples:
        >>> from physanimator.rendering.svd import SVDOptions
        >>> SVDOptions(steps=20, seed=7).overlap
        4
        >>> SVDOptions.following("animation").motion_bucket
        17
    """

    steps: int = 25
    motion_bucket: int = 160
    frames_per_second: int = 6
    picture_noise: float = 0.0
    overlap: int = OVERLAP
    area: int = TRAINED_WIDTH * TRAINED_HEIGHT
    decoded_together: int = DECODED_TOGETHER
    seed: int = 0
    follow: str = "sketches"
    weak: float = WEAK
    strong: float = STRONG
    guidance: float = 1.0

    def __post_init__(self) -> None:
        check_whole("steps", self.steps, 2, 1000)
        check_whole("motion_bucket", self.motion_bucket, 1, 255)
        check_whole("frames_per_second", self.frames_per_second, 1, 1000)
        check_number("picture_noise", self.picture_noise, 0, 10)
        check_whole("overlap", self.overlap, LEAST_OVERLAP, CLIP_FRAMES - 1, unit=" frames")
        check_whole("area", self.area, SMALLEST_AREA, LARGEST_AREA, unit=" px^2")
        check_whole("decoded_together", self.decoded_together, 1, 10_000, unit=" frames")
        check_whole("seed", self.seed, -(2**63), 2**64 - 1)
        require_kind("follow", self.follow, str, "text")
        require("follow", repr(self.follow[:80]), self.follow in FOLLOWED, f"one of {', '.join(FOLLOWED)}")
        check_number("weak", self.weak, 0, 1)
        check_number("strong", self.strong, 0, 1)
        require("strong", self.strong, self.weak <= self.strong, f"weak, which is {self.weak}, or more")
        check_number("guidance", self.guidance, 1, 30)
        self._check_used()

    def _check_used(self) -> None:
        for name, usual, used in (
            ("weak", WEAK, self.follows_animation),
            ("strong", STRONG, self.follows_animation),
            ("guidance", 1, not self.follows_sketches),
        ):
            value = getattr(self, name)
            if value != usual and not used:
                who = "animation" if name == "guidance" else "animation or both"
                raise InvalidInputError(f"{name} must be left out unless follow is {who}. Got: {value}")

    @classmethod
    def following(cls, follow: str) -> SVDOptions:
        """The usual settings for something to follow.

        Those for the animation alone are of Time-to-Move (Singer et al., 2025, arXiv 2511.08633) and of Stable Video
        Diffusion itself.

        Args:
            follow: one of ``FOLLOWED``.
        """
        if follow == "animation":
            return cls(follow=follow, motion_bucket=17, picture_noise=0.02, guidance=3.0)
        return cls(follow=follow)

    @property
    def follows_sketches(self) -> bool:
        """Whether sketches are needed, and LVCD, which reads them."""
        return self.follow != "animation"

    @property
    def follows_animation(self) -> bool:
        """Whether frames of the composite are needed."""
        return self.follow != "sketches"
