"""Scene: everything that a simulation needs."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .errors import InvalidInputError
from .material import Material
from .mesh import TriangleMesh
from .rig import RigPoint
from .strokes import EnergyStroke

__all__ = ["Body", "Scene"]


@dataclass(frozen=True, eq=False)
class Body:
    """One deformable thing.

    Attributes:
        mesh: its shape.
        material: what it is made of.
        layer: occlusion order; a higher layer covers a lower one, and of equal layers the later body.
        name: for people; may be empty.
    """

    mesh: TriangleMesh
    material: Material = field(default_factory=Material)
    layer: int = 0
    name: str = ""

    def __post_init__(self) -> None:
        scale = self.material.stiffness_scale
        if scale is not None and len(scale) != len(self.mesh.triangles):
            raise InvalidInputError(
                f"stiffness_scale must have one factor for each of the {len(self.mesh.triangles)} triangles."
                f" Got: {len(scale)}"
            )


@dataclass(frozen=True, eq=False)
class Scene:
    """Bodies and what acts on them.

    Attributes:
        bodies: at least one; all over an illustration of one size.
        strokes: energy strokes.
        rig_points: pins and leads.
        gravity: acceleration of every vertex [side/s^2], x right, y down.
        frame_rate: frames a second.
    """

    bodies: tuple[Body, ...]
    strokes: tuple[EnergyStroke, ...] = ()
    rig_points: tuple[RigPoint, ...] = ()
    gravity: tuple[float, float] = (0.0, 0.0)
    frame_rate: float = 24.0

    def __post_init__(self) -> None:
        for name in ("bodies", "strokes", "rig_points"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        if not self.bodies:
            raise InvalidInputError("a scene needs at least one body. Got: none")
        sizes = {(body.mesh.width, body.mesh.height) for body in self.bodies}
        if len(sizes) > 1:
            raise InvalidInputError(f"all bodies must belong to a picture of one size. Got: {sorted(sizes)}")
        if len(self.gravity) != 2 or not np.isfinite(self.gravity).all():
            raise InvalidInputError(f"gravity must be two finite numbers. Got: {self.gravity}")
        if not 1 <= self.frame_rate <= 240:
            raise InvalidInputError(f"frame_rate must be 1 to 240 frames a second. Got: {self.frame_rate}")
        for number, rig_point in enumerate(self.rig_points):
            if rig_point.body is not None and rig_point.body >= len(self.bodies):
                raise InvalidInputError(
                    f"rig_points[{number}].body must be below the number of bodies ({len(self.bodies)})."
                    f" Got: {rig_point.body}"
                )

    @property
    def width(self) -> int:
        """Width of the illustration [px]."""
        return self.bodies[0].mesh.width

    @property
    def height(self) -> int:
        """Height of the illustration [px]."""
        return self.bodies[0].mesh.height
