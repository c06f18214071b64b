"""The form in which a video model wants its clip: so many frames of such a size."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.checks import check_whole
from ...physics.errors import require
from ...physics.motion import FITS, Fit, Motion, frame_at, sample_times
from ..overlays import reframed

__all__ = ["FRAME_STEP", "SIZE_STEP", "ModelFormat", "check_length"]

FRAME_STEP = 4
"""Wan makes four frames of each step of its latents, after the first one."""
SIZE_STEP = 16
"""Wan's latents are 1/8 of the size, and it reads them in squares of two [px]."""


def check_length(frames: int, *, name: str = "frames") -> None:
    """Refuse a length that Wan does not know.

    Args:
        frames: of the clip.
        name: what the user calls it.

    Raises:
        InvalidInputError: it is not 4 k + 1.
    """
    check_whole(name, frames, 1, 100_001)
    require(name, frames, frames % FRAME_STEP == 1, "4 k + 1, such as 49 or 81: Wan knows no other length")


@dataclass(frozen=True)
class ModelFormat:
    """Length and size of a clip for a video model.

    Attributes:
        frames: 4 k + 1.
        width: a multiple of 16 [px].
        height: a multiple of 16 [px].
        fit: how pictures come to that size: cut to their middle, as the host's nodes do, or stretched.

    Examples:
        >>> from physanimator.rendering.control import ModelFormat
        >>> form = ModelFormat(frames=49, width=480, height=832, fit="stretch")
        >>> form.frames, form.width
        (49, 480)
    """

    frames: int = 81
    width: int = 832
    height: int = 480
    fit: Fit = "crop"

    def __post_init__(self) -> None:
        check_length(self.frames)
        for name in ("width", "height"):
            side = getattr(self, name)
            check_whole(name, side, SIZE_STEP, 16_384, unit=" px")
            require(name, f"{side} px", side >= SIZE_STEP and side % SIZE_STEP == 0, "a multiple of 16 px")
        require("fit", self.fit, self.fit in FITS, f"one of {', '.join(FITS)}")

    def sampled(self, motion: Motion) -> Motion:
        """The whole motion, from its first frame to its last, in this many frames.

        Vertices move along smooth curves between the frames that were simulated, so pictures are drawn, not blended.
        """
        times = sample_times(len(motion), self.frames)
        positions = np.stack([frame_at(motion.positions, time, "cubic") for time in times]).astype(np.float32)
        rate = motion.frame_rate * (self.frames - 1) / max(1, len(motion) - 1)
        return Motion(motion.bodies, positions, rate if rate > 0 else motion.frame_rate)

    def resized(self, picture: NDArray[Any]) -> NDArray[Any]:
        """A picture in this size.

        Args:
            picture: uint8 or float, shape [h, w] or [h, w, 3].
        """
        return reframed(picture, self.width, self.height, self.fit)
