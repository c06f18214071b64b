"""Motion: where every vertex is in every frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..checks import require_kind, within
from ..errors import InvalidInputError, require
from ..scene import Body

__all__ = ["LoopReport", "Motion"]


@dataclass(frozen=True)
class LoopReport:
    """How well a motion repeats.

    Attributes:
        seconds: length of the loop [s].
        frames: frames of a cycle; frame number ``frames`` would be frame 0 again.
        cycles: cycles that were simulated until the state repeated; the last one is the motion.
        residual: how far the last cycle's last frames were from those of the cycle before [px].
        closed_residual: the same for the very last frame after the residual was blended away [px].
    """

    seconds: float
    frames: int
    cycles: int
    residual: float
    closed_residual: float


@dataclass(frozen=True, eq=False)
class Motion:
    """The result of a simulation.

    Attributes:
        bodies: the simulated bodies, in the order of their vertices in ``positions``.
        positions: vertex positions [px], float32, shape [f, v, 2]; frame 0 is the drawing (rest), except in a loop.
        frame_rate: frames a second.
        loop: how well the motion repeats; None where it is no loop.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion
        >>> from physanimator.physics.scene import Body
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> len(motion), motion.width, motion.of_body(0).shape == (2, len(mesh.vertices), 2)
        (2, 60, True)
    """

    bodies: tuple[Body, ...]
    positions: NDArray[np.float32]
    frame_rate: float
    loop: LoopReport | None = None

    def __post_init__(self) -> None:
        require_kind("bodies", self.bodies, (tuple, list), "a list of bodies")
        for number, body in enumerate(self.bodies):
            require_kind(f"bodies[{number}]", body, Body, "of type Body")
        require("frame_rate", self.frame_rate, within(self.frame_rate, 0, above=True), "above 0 frames a second")
        count = sum(len(body.mesh.vertices) for body in self.bodies)
        try:
            positions = np.ascontiguousarray(self.positions, dtype=np.float32)
        except (TypeError, ValueError, OverflowError):
            raise InvalidInputError(f"positions must be numbers of shape [f, {count}, 2]. Got: other things") from None
        if not self.bodies:
            raise InvalidInputError("a motion needs at least one body. Got: none")
        if positions.ndim != 3 or positions.shape[1:] != (count, 2) or len(positions) < 1:
            raise InvalidInputError(f"positions must have shape [f, {count}, 2] with f >= 1. Got: {positions.shape}")
        if positions is self.positions:
            positions = positions.view()
        positions.setflags(write=False)
        object.__setattr__(self, "positions", positions)

    def __len__(self) -> int:
        """Number of frames."""
        return len(self.positions)

    @property
    def width(self) -> int:
        """Width of the illustration [px]."""
        return self.bodies[0].mesh.width

    @property
    def height(self) -> int:
        """Height of the illustration [px]."""
        return self.bodies[0].mesh.height

    @property
    def duration(self) -> float:
        """Time from the first frame to the last [s]."""
        return (len(self) - 1) / self.frame_rate

    def of_body(self, index: int) -> NDArray[np.float32]:
        """Positions of one body's vertices [px], shape [f, v_body, 2] (a view)."""
        starts = np.cumsum([0] + [len(body.mesh.vertices) for body in self.bodies])
        return self.positions[:, starts[index] : starts[index + 1]]

    def __getitem__(self, frames: slice) -> Motion:
        """The motion of a range of frames; its first frame need not be the drawing."""
        return Motion(self.bodies, self.positions[frames], self.frame_rate)
