"""Settings of the interpolation."""

from __future__ import annotations

from dataclasses import dataclass

from ...physics.checks import check_number, check_whole
from ...physics.errors import require
from ..networks import LARGEST_AREA, SMALLEST_AREA

__all__ = ["CLIP_GAP", "SOLVERS", "TRAINED_HEIGHT", "TRAINED_WIDTH", "ToonCrafterOptions"]

TRAINED_WIDTH, TRAINED_HEIGHT = 512, 320
"""What ToonCrafter was trained with [px]."""

CLIP_GAP = 15
"""Frames from one keyframe to the next in the clips that it was trained with."""

SOLVERS = ("ddim", "dpm++ 2m")
"""How noise becomes a picture: as the original does it, and in fewer steps."""


@dataclass(frozen=True)
class ToonCrafterOptions:
    """Settings; the defaults are those that ToonCrafter is used with, and the paper's control scale.

    Attributes:
        steps: of the solver, for each pair of keyframes.
        solver: one of ``SOLVERS``.
        eta: share of the noise that DDIM draws anew in each step, 0 to 1.
        guidance: how closely frames follow prompt and picture; 1 is not at all strengthened, and twice as fast.
        guidance_rescale: share of the guided prediction whose contrast is brought back, 0 to 1.
        frame_rate: what the network is told of it: low for large motion between keyframes [1/s].
        control_scale: how closely frames follow the sketches; 0 ignores them.
        area: of the pictures that the networks work on [px^2].
        pairs_together: pairs of keyframes that are drawn at once; fewer need less memory.
        decoded_together: frames whose pictures are made at once; fewer need less memory, and give the same pictures.
        seed: of the noise.
    """

    steps: int = 50
    solver: str = SOLVERS[0]
    eta: float = 1.0
    guidance: float = 7.5
    guidance_rescale: float = 0.7
    frame_rate: int = 10
    control_scale: float = 0.1
    area: int = TRAINED_WIDTH * TRAINED_HEIGHT
    pairs_together: int = 1
    decoded_together: int = 3
    seed: int = 0

    def __post_init__(self) -> None:
        require("solver", self.solver, self.solver in SOLVERS, f"one of {', '.join(SOLVERS)}")
        check_whole("steps", self.steps, 1, 1000)
        check_number("eta", self.eta, 0, 1)
        check_number("guidance", self.guidance, 1, 1000)
        check_number("guidance_rescale", self.guidance_rescale, 0, 1)
        check_whole("frame_rate", self.frame_rate, 1, 1000)
        check_number("control_scale", self.control_scale, 0, 1000)
        check_whole("area", self.area, SMALLEST_AREA, LARGEST_AREA, unit=" px^2")
        check_whole("pairs_together", self.pairs_together, 1, 10_000)
        check_whole("decoded_together", self.decoded_together, 1, 10_000)
        check_whole("seed", self.seed, -(2**63), 2**64 - 1)
