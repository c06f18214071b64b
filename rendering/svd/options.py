"""Settings of the sketch-guided renderer."""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.checks import check_number, check_whole
from ..networks import LARGEST_AREA, SMALLEST_AREA, TRAINED_HEIGHT, TRAINED_WIDTH
from .frame_layout import CLIP_FRAMES, LEAST_OVERLAP, OVERLAP

__all__ = ["DECODED_TOGETHER", "SVDOptions"]

DECODED_TOGETHER = 10
"""Frames that LVCD decodes at once."""


@dataclass(frozen=True)
class SVDOptions:
    """Settings; the defaults are those that LVCD is used with.

    Attributes:
        steps: of the sampler, for each segment.
        motion_bucket: how much motion to expect, 1 to 255.
        frames_per_second: what the networks are told of the frame rate.
        picture_noise: standard deviation of the noise on the reference picture, which is in -1..1.
        overlap: frames that neighbouring segments share.
        area: of the pictures that the networks work on [px^2].
        decoded_together: frames that are decoded at once; fewer need less memory.
        seed: of the noise.

    Examples:
        >>> from physanimator.rendering.svd import SVDOptions
        >>> SVDOptions(steps=20, seed=7).overlap
        4
    """

    steps: int = 25
    motion_bucket: int = 160
    frames_per_second: int = 6
    picture_noise: float = 0.0
    overlap: int = OVERLAP
    area: int = TRAINED_WIDTH * TRAINED_HEIGHT
    decoded_together: int = DECODED_TOGETHER
    seed: int = 0

    def __post_init__(self) -> None:
        check_whole("steps", self.steps, 2, 1000)
        check_whole("motion_bucket", self.motion_bucket, 1, 255)
        check_whole("frames_per_second", self.frames_per_second, 1, 1000)
        check_number("picture_noise", self.picture_noise, 0, 10)
        check_whole("overlap", self.overlap, LEAST_OVERLAP, CLIP_FRAMES - 1, unit=" frames")
        check_whole("area", self.area, SMALLEST_AREA, LARGEST_AREA, unit=" px^2")
        check_whole("decoded_together", self.decoded_together, 1, 10_000, unit=" frames")
        check_whole("seed", self.seed, -(2**63), 2**64 - 1)
