"""Which clips are trained on (paper, Section 4.1): long enough, and neither still nor torn."""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.checks import check_number, check_whole

__all__ = ["Bounds"]


@dataclass(frozen=True)
class Bounds:
    """What a clip must be; each bound itself is inside.

    Attributes:
        least_frames: fewest frames, counted without repeated drawings.
        least_score: lowest dynamics score.
        most_score: highest dynamics score.

    Raises:
        InvalidInputError: a bound is out of range.
    """

    least_frames: int = 24
    least_score: float = 0.05
    most_score: float = 0.7

    def __post_init__(self) -> None:
        check_whole("least_frames", self.least_frames, 2, 100_000)
        check_number("least_score", self.least_score, 0)
        check_number("most_score", self.most_score, self.least_score)

    def why_not(self, frames: int, score: float) -> str:
        """Why a clip is left out; empty where it is kept.

        Examples:
            >>> from physanimator.rendering.training.selection import Bounds
            >>> Bounds().why_not(24, 0.05), Bounds().why_not(23, 0.3)
            ('', 'shorter than 24 frames')
        """
        if frames < self.least_frames:
            return f"shorter than {self.least_frames} frames"
        if not score >= self.least_score:
            return f"moves too little (score below {self.least_score:g})"
        if score > self.most_score:
            return f"moves too much (score above {self.most_score:g})"
        return ""
