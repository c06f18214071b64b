"""Scene: everything that a simulation needs."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..checks import numbers_of, require_kind, within
from ..errors import InvalidInputError, counted, require
from ..fields import Field, Input, check_field, check_fields, described
from ..forces import EnergyStroke, Wind
from ..limits import (
    LARGEST,
    MAX_BODIES,
    MAX_COLLIDERS,
    MAX_LAYERS,
    MAX_LOOP,
    MAX_PAINT,
    MAX_PARTICLES,
    MAX_QUERY_POINTS,
    MAX_RIG_POINTS,
    MAX_STROKES,
    TICK,
)
from ..material import SCALES, Material
from ..mesh import TriangleMesh
from ..rig import RigPoint
from .collision import Collider, Contact
from .paint import Paint
from .query_points import QueryPoint
from .sides import Held

__all__ = ["Body", "Scene", "StrokesAs", "check_scene_rate"]

StrokesAs = Literal["acceleration", "force", "vertex_force"]
"""What the strengths of strokes and wind are."""

_DRAWN = ("strokes", "rig_points", "colliders", "paint", "query_points")  # lists of what scales with the picture


def check_scene_rate(frame_rate: float) -> None:
    """Refuse a frame rate that no scene can have, before any long work.

    Raises:
        InvalidInputError: it is not 1 to 240 frames a second.
    """
    check_field(Scene, "frame_rate", frame_rate)


def _one_of(kind: type, title: str, about: str, expected: str) -> Field:
    def check(name: str, value: Any) -> Any:
        require_kind(name, value, kind, expected)
        return value

    return Field(title, about, check=check)


def _several(kind: type, title: str, about: str, entry: str, most: int) -> Field:
    def check(name: str, given: Any) -> tuple[Any, ...]:
        require_kind(name, given, (tuple, list), f"a list of {kind.__name__} objects")
        for number, each in enumerate(given):
            require_kind(f"{name}[{number}]", each, kind, f"of type {kind.__name__}")
        require(name, counted(len(given), "entry"), len(given) <= most, f"at most {most} entries")
        return tuple(given)

    return Field(title, about, entry=entry, most=most, check=check)


def _checked_gravity(name: str, value: object) -> tuple[float, ...]:
    expected = f"two numbers from -{LARGEST} to {LARGEST} side/s^2"
    gravity = numbers_of(name, value, expected)
    bounded = len(gravity) == 2 and all(within(each, -LARGEST, LARGEST) for each in gravity)
    require(name, gravity[:3], bounded, expected)
    return gravity


@described
@dataclass(frozen=True, eq=False)
class Body:
    """One deformable thing.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.material import preset
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> Body(mesh, preset("cloth"), layer=1, name="skirt").layer
        1
    """

    mesh: Annotated[TriangleMesh, _one_of(TriangleMesh, "Mesh", "Its shape.", "a TriangleMesh")]
    material: Annotated[Material, _one_of(Material, "Material", "What it is made of.", "a Material")] = field(
        default_factory=Material
    )
    layer: Annotated[
        int,
        Field("Layer", "Who covers whom: a higher layer is in front; of equal layers the later body."),
        Input("A higher layer covers a lower one; of equal layers, the later one in the chain does.", -99, 99),
    ] = 0
    name: Annotated[str, Field("Name", 'For people, such as "left sleeve".')] = ""
    strands: Annotated[
        bool,
        Field(
            "Strands",
            "Whether a mesh that is made of the illustration is slit along the lines that are drawn between its"
            " strands, so that they swing apart. Meshes that are given stay as they are.",
        ),
    ] = False
    cover: NDArray[np.bool_] | None = None
    """Where something that stands still is in front of it, shape [h, w] of the picture; None for nowhere."""
    rests_on: NDArray[np.bool_] | None = None
    """Where something that stands still is behind it, the backdrop apart, shape [h, w]; None where nothing says so."""
    attach: Annotated[
        Held,
        Field(
            "Attach",
            "Where it is held as long as no rig point is for it alone: at a side; auto, where each of its parts reaches"
            " out of the picture, or else at its top; head, hair on a head; crown, hair that hangs over a forehead;"
            " covered, what hangs behind a head; end, where it touches what stands still. none: nowhere.",
        ),
    ] = "none"

    def __post_init__(self) -> None:
        check_fields(self)
        size = self.mesh.height, self.mesh.width
        for name in ("cover", "rests_on"):
            mask = getattr(self, name)
            if mask is not None:
                known = isinstance(mask, np.ndarray)
                got = f"{mask.dtype} of shape {mask.shape}" if known else mask
                require(name, got, known and mask.dtype == bool and mask.shape == size, f"bool of shape {size}")
        for name in SCALES:
            scale = getattr(self.material, name)
            if scale is not None and len(scale) != len(self.mesh.triangles):
                raise InvalidInputError(
                    f"{name} must have one factor for each of the {len(self.mesh.triangles)} triangles."
                    f" Got: {len(scale)}"
                )


@described
@dataclass(frozen=True, eq=False)
class Scene:
    """Bodies and what acts on them.

    All bodies lie over an illustration of one size. Under gravity held bodies stay as drawn until something else acts,
    and swing more stiffly (hanging) or softly (standing); where they sag, it acts on the drawing as on an undeformed
    shape. In a loop frame 0 is not the drawing but a state that comes again after it (see ``loop.periodic``).

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

    bodies: Annotated[
        tuple[Body, ...],
        _several(
            Body,
            "Bodies",
            "What can move, in the order of the masks. Bodies left out are of default material.",
            "body",
            MAX_BODIES,
        ),
    ]
    strokes: Annotated[
        tuple[EnergyStroke, ...],
        _several(EnergyStroke, "Energy strokes", "What blows, pushes and pulls.", "stroke", MAX_STROKES),
    ] = ()
    rig_points: Annotated[
        tuple[RigPoint, ...],
        _several(
            RigPoint,
            "Rig points",
            "Where bodies are held or led. Where several reach the same part, the last one in this list leads it.",
            "rig_point",
            MAX_RIG_POINTS,
        ),
    ] = ()
    gravity: Annotated[
        tuple[float, float],
        Field(
            "Gravity",
            "A steady pull on everything, x and y. [0, 0.5] pulls down gently. Held bodies hang as they are drawn.",
            "side/s^2",
            check=_checked_gravity,
        ),
    ] = (0.0, 0.0)
    frame_rate: Annotated[
        float,
        Field(
            "Frame rate",
            "How many frames a second has. The motion stays the same.",
            "frames/s",
            minimum=1,
            maximum=240,
        ),
        Input("Frames a second [1/s]. Simulate hands it on to Create Video.", step=1.0),
    ] = 24.0
    loop: Annotated[
        float | None,
        Field(
            "Loop",
            "Length of a seamless loop: all that acts is fitted to it, and the first frame is not the drawing but one"
            " that comes again after the last. null: no loop.",
            "s",
            above=0,
            maximum=MAX_LOOP,
        ),
    ] = None
    wind: Annotated[
        Wind | None, _one_of(Wind, "Wind", "Blows everywhere beside the strokes; none for calm.", "a Wind or None")
    ] = None
    sag: Annotated[
        bool,
        Field(
            "Sag",
            "Whether bodies are drawn without their weight, so that gravity makes them sag from the first frame on.",
        ),
    ] = False
    contact: Annotated[
        Contact | None,
        _one_of(
            Contact,
            "Contact",
            "How bodies keep out of each other and of colliders. null: they pass through.",
            "a Contact or None",
        ),
    ] = None
    colliders: Annotated[
        tuple[Collider, ...],
        _several(
            Collider,
            "Colliders",
            "Still shapes that bodies keep out of where there is contact, such as a shoulder under hair.",
            "collider",
            MAX_COLLIDERS,
        ),
    ] = ()
    paint: Annotated[
        tuple[Paint, ...],
        _several(
            Paint,
            "Paint",
            "Where bodies are stiffer, heavier or more damped than their materials say; entries that overlap multiply.",
            "paint",
            MAX_PAINT,
        ),
    ] = ()
    query_points: Annotated[
        tuple[QueryPoint, ...],
        _several(
            QueryPoint,
            "Query points",
            "Where somebody clicked to say which part of the illustration is meant: for segmentation, not for motion.",
            "query_point",
            MAX_QUERY_POINTS,
        ),
    ] = ()
    still: Annotated[
        tuple[str, ...],
        _several(
            str,
            "Still layers",
            "Names of layers of an artwork that stand still although their names say that they move.",
            "layer_name",
            MAX_BODIES,
        ),
    ] = ()
    order: Annotated[
        tuple[str, ...],
        _several(
            str,
            "Order of layers",
            "Names of layers of an artwork from back to front: where they are in another order in the file, they change"
            " places among themselves. Layers that are not named stay where they are.",
            "layer_name",
            MAX_LAYERS,
        ),
    ] = ()
    absent: tuple[str, ...] = ()
    """Names of bodies that the scene's document has and that none of the parts is."""
    time_step: Annotated[
        float | None,
        Field(
            "Time step",
            "The step of plain semi-implicit Euler, in each of which all forces are evaluated, such as the paper's"
            " 0.001. null: steps follow from the mesh, and forces from outside are evaluated every 1/240 s.",
            "s",
            minimum=1e-5,
            maximum=TICK,
        ),
    ] = None
    strokes_as: Annotated[
        StrokesAs,
        Field(
            "Strokes as",
            "What the strengths of strokes and wind are: an acceleration, the same for light and heavy; a force on the"
            " area, which moves a body of density 4 a quarter as far; or, as the paper's formulas read to the letter, a"
            " vertex_force on each vertex, which moves a finer mesh farther.",
        ),
        Input(
            "What the strengths of strokes and wind are: an acceleration, the same for light and heavy; a force on the"
            " area, which moves density 4 a quarter as far; a force on each vertex, as the paper writes, which moves a"
            " finer mesh farther and takes strengths of some 0.0001.",
        ),
    ] = "acceleration"

    def __post_init__(self) -> None:
        check_fields(self)
        if not self.bodies:
            raise InvalidInputError("a scene needs at least one body. Got: none")
        sizes = {(body.mesh.width, body.mesh.height) for body in self.bodies}
        if len(sizes) > 1:
            raise InvalidInputError(f"all bodies must belong to a picture of one size. Got: {sorted(sizes)}")
        if self.loop is not None:
            require("loop", self.loop, self.loop >= 2 / self.frame_rate, f"2 frames to {MAX_LOOP} s long")
        count = len(self.bodies)
        placed: dict[str, tuple[RigPoint | Paint, ...]] = {"rig_points": self.rig_points, "paint": self.paint}
        for name, entries in placed.items():
            for number, entry in enumerate(entries):
                known = entry.body is None or entry.body < count
                require(f"{name}[{number}].body", entry.body, known, f"below the number of bodies ({count})")
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
        drawn: dict[str, Any] = {name: tuple(each.rescaled(scale) for each in getattr(self, name)) for name in _DRAWN}
        return replace(
            self,
            bodies=tuple(replace(body, mesh=body.mesh.rescaled(width, height)) for body in self.bodies),
            wind=self.wind and self.wind.rescaled(scale),
            contact=self.contact and self.contact.rescaled(scale),
            **drawn,
        )

    def _require_few_particles(self) -> None:
        most = sum(stroke.most_particles for stroke in self.strokes)
        require(
            "strokes",
            f"{most:.0f}",
            most <= MAX_PARTICLES,
            f"few enough, or their intervals so long, that at most {MAX_PARTICLES} particles are under way at once",
        )
