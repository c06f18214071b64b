"""Scene: everything that a simulation needs."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from ..checks import is_whole, numbers_of, require_kind, within
from ..errors import InvalidInputError, require
from ..forces import EnergyStroke, Wind
from ..limits import (
    LARGEST,
    MAX_BODIES,
    MAX_COLLIDERS,
    MAX_LOOP,
    MAX_PAINT,
    MAX_PARTICLES,
    MAX_QUERY_POINTS,
    MAX_RIG_POINTS,
    MAX_STROKES,
)
from ..material import SCALES, Material
from ..mesh import TriangleMesh
from ..rig import RigPoint
from .collision import Collider, Contact
from .paint import Paint
from .query_points import QueryPoint

__all__ = ["Body", "Scene", "check_scene_rate"]


def check_scene_rate(frame_rate: float) -> None:
    """Refuse a frame rate that no scene can have, before any long work.

    Raises:
        InvalidInputError: it is not 1 to 240 frames a second.
    """
    require("frame_rate", frame_rate, within(frame_rate, 1, 240), "1 to 240 frames a second")


@dataclass(frozen=True, eq=False)
class Body:
    """One deformable thing.

    Attributes:
        mesh: its shape.
        material: what it is made of.
        layer: occlusion order; a higher layer covers a lower one, and of equal layers the later body.
        name: for people; may be empty.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.material import preset
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> Body(mesh, preset("cloth"), layer=1, name="skirt").layer
        1
    """

    mesh: TriangleMesh
    material: Material = field(default_factory=Material)
    layer: int = 0
    name: str = ""

    def __post_init__(self) -> None:
        require_kind("mesh", self.mesh, TriangleMesh, "a TriangleMesh")
        require_kind("material", self.material, Material, "a Material")
        whole = is_whole(self.layer, -LARGEST, LARGEST)
        require("layer", self.layer, whole, f"a whole number, -{LARGEST} to {LARGEST}")
        object.__setattr__(self, "layer", int(self.layer))
        require("name", self.name, isinstance(self.name, str), "a text")
        for name in SCALES:
            scale = getattr(self.material, name)
            if scale is not None and len(scale) != len(self.mesh.triangles):
                raise InvalidInputError(
                    f"{name} must have one factor for each of the {len(self.mesh.triangles)} triangles."
                    f" Got: {len(scale)}"
                )


@dataclass(frozen=True, eq=False)
class Scene:
    """Bodies and what acts on them.

    Attributes:
        bodies: at least one; all over an illustration of one size.
        strokes: energy strokes.
        rig_points: pins and leads.
        gravity: acceleration of every vertex [side/s^2], x right, y down. The drawing is how it hangs: held bodies
            stay as drawn until something else acts, and swing more stiffly (hanging) or softly (standing).
        frame_rate: frames a second.
        loop: length of a seamless loop [s]; then frame 0 is not the drawing but a state that comes again after the
            loop, and all that acts is fitted to it (see ``loop.periodic``). None: no loop.
        wind: blows everywhere beside the strokes; None for calm.
        sag: gravity instead acts on the drawing as on an undeformed shape, which sags from the first frame on.
        contact: how bodies keep out of each other and of colliders; None: they pass through.
        colliders: still shapes that bodies keep out of where there is contact.
        paint: where bodies are stiffer, heavier or more damped than their materials say.
        query_points: where somebody clicked to say which part of the picture is meant; they move nothing.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.forces import EnergyStroke, Wind
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body, Scene
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> scene = Scene((Body(mesh),), strokes=(EnergyStroke(path=((0, 30), (60, 30))),), wind=Wind())
        >>> scene.width, scene.height, scene.frame_rate
        (60, 60, 24.0)
    """

    bodies: tuple[Body, ...]
    strokes: tuple[EnergyStroke, ...] = ()
    rig_points: tuple[RigPoint, ...] = ()
    gravity: tuple[float, float] = (0.0, 0.0)
    frame_rate: float = 24.0
    loop: float | None = None
    wind: Wind | None = None
    sag: bool = False
    contact: Contact | None = None
    colliders: tuple[Collider, ...] = ()
    paint: tuple[Paint, ...] = ()
    query_points: tuple[QueryPoint, ...] = ()

    def __post_init__(self) -> None:
        for name, kind, most in (
            ("bodies", Body, MAX_BODIES),
            ("strokes", EnergyStroke, MAX_STROKES),
            ("rig_points", RigPoint, MAX_RIG_POINTS),
            ("colliders", Collider, MAX_COLLIDERS),
            ("paint", Paint, MAX_PAINT),
            ("query_points", QueryPoint, MAX_QUERY_POINTS),
        ):
            given = getattr(self, name)
            require_kind(name, given, (tuple, list), f"a list of {kind.__name__} objects")
            entries = tuple(given)
            for number, entry in enumerate(entries):
                require_kind(f"{name}[{number}]", entry, kind, f"of type {kind.__name__}")
            require(name, f"{len(entries)} entries", len(entries) <= most, f"at most {most} entries")
            object.__setattr__(self, name, entries)
        if not self.bodies:
            raise InvalidInputError("a scene needs at least one body. Got: none")
        sizes = {(body.mesh.width, body.mesh.height) for body in self.bodies}
        if len(sizes) > 1:
            raise InvalidInputError(f"all bodies must belong to a picture of one size. Got: {sorted(sizes)}")
        expected = f"two numbers from -{LARGEST} to {LARGEST} side/s^2"
        gravity = numbers_of("gravity", self.gravity, expected)
        bounded = len(gravity) == 2 and all(within(value, -LARGEST, LARGEST) for value in gravity)
        require("gravity", gravity[:3], bounded, expected)
        object.__setattr__(self, "gravity", gravity)
        check_scene_rate(self.frame_rate)
        if self.loop is not None:
            long = within(self.loop, 2 / self.frame_rate, MAX_LOOP)
            require("loop", self.loop, long, f"2 frames to {MAX_LOOP} s long")
        if self.wind is not None:
            require_kind("wind", self.wind, Wind, "a Wind or None")
        if self.contact is not None:
            require_kind("contact", self.contact, Contact, "a Contact or None")
        require("sag", self.sag, isinstance(self.sag, bool), "True or False")
        count = len(self.bodies)
        for number, rig_point in enumerate(self.rig_points):
            known = rig_point.body is None or rig_point.body < count
            require(f"rig_points[{number}].body", rig_point.body, known, f"below the number of bodies ({count})")
        for number, entry in enumerate(self.paint):
            known = entry.body is None or entry.body < count
            require(f"paint[{number}].body", entry.body, known, f"below the number of bodies ({count})")
        self._require_few_particles()

    @property
    def width(self) -> int:
        """Width of the illustration [px]."""
        return self.bodies[0].mesh.width

    @property
    def height(self) -> int:
        """Height of the illustration [px]."""
        return self.bodies[0].mesh.height

    def rescaled(self, width: int, height: int) -> Scene:
        """The same scene over the illustration at another size.

        Positions scale in x and y, radii and speeds with the longest side; what is measured in sides stays.
        """
        scale = (width / self.width, height / self.height, max(width, height) / max(self.width, self.height))
        return replace(
            self,
            bodies=tuple(replace(body, mesh=body.mesh.rescaled(width, height)) for body in self.bodies),
            strokes=tuple(stroke.rescaled(scale) for stroke in self.strokes),
            rig_points=tuple(rig_point.rescaled(scale) for rig_point in self.rig_points),
            wind=self.wind and self.wind.rescaled(scale),
            contact=self.contact and self.contact.rescaled(scale),
            colliders=tuple(collider.rescaled(scale) for collider in self.colliders),
            paint=tuple(entry.rescaled(scale) for entry in self.paint),
            query_points=tuple(point.rescaled(scale) for point in self.query_points),
        )

    def _require_few_particles(self) -> None:
        most = sum(stroke.most_particles for stroke in self.strokes)
        require(
            "strokes",
            f"{most:.0f}",
            most <= MAX_PARTICLES,
            f"few enough, or their intervals so long, that at most {MAX_PARTICLES} particles are under way at once",
        )
