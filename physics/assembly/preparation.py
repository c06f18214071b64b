"""What a simulation needs before its first step, and what of it can be used again when only a stroke has changed."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..interruption import checkpoint
from ..material import RestShape
from ..rig import MaskRegion, RigRegion
from ..scene import Body, Holds, Paint, Scene, holds_of
from .prestress import unsagged
from .system import System, assemble

__all__ = ["AtRest", "Preparations", "Prepare", "Prepared"]

MAX_PREPARED_BYTES = 256 * 2**20
"""Memory for what simulations need before their first step; beyond, what was not used for longest is forgotten."""


_BYTES_OF_A_TRIANGLE = 700  # what is kept of one in an assembled system
_BYTES_OF_A_VERTEX = 300


@dataclass(frozen=True, eq=False)
class AtRest:
    """The bodies without their weight.

    Attributes:
        rest: rest positions [px], shape [v, 2].
        system: the assembled bodies with these.
        start: displacement of the drawing from them [side], shape [v, 2].
    """

    rest: NDArray[np.float64]
    system: System
    start: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scene's bodies ready to be simulated; neither its strokes nor how its rig points move matter.

    Attributes:
        scene: the scene.
        holds: what its rig points hold, where that is known already: they themselves are then not read.
    """

    scene: Scene
    holds: Holds | None = None

    @cached_property
    def system(self) -> System:
        """The assembled bodies, their rest shape being the drawing."""
        return assemble(self.scene, self.holds)

    @cached_property
    def at_rest(self) -> AtRest:
        """The rest shape of each body, for which gravity is solved.

        Raises:
            SimulationError: a part is too soft to carry itself as it was drawn.
        """
        scene, system, side = self.scene, self.system, self.scene.bodies[0].mesh.longest_side
        drawn = np.concatenate([body.mesh.vertices for body in scene.bodies])[system.order]
        if scene.sag or not any(scene.gravity):
            return AtRest(drawn, system, np.zeros(drawn.shape, dtype=np.float32))
        start = unsagged(scene, system)
        offset = start.astype(np.float64)
        rest = RestShape(system.rest.positions - offset, system.rest.triangles)
        return AtRest(drawn - offset * side, replace(system, rest=rest), start)

    @property
    def size(self) -> int:
        """Bytes of memory that it comes to hold on to, about."""
        meshes = [body.mesh for body in self.scene.bodies]
        triangles, vertices = sum(len(mesh.triangles) for mesh in meshes), sum(len(mesh.vertices) for mesh in meshes)
        masks = sum(region.mask.nbytes for region in _regions(self.scene) if isinstance(region, MaskRegion))
        return _BYTES_OF_A_TRIANGLE * triangles + _BYTES_OF_A_VERTEX * vertices + masks


Prepare = Callable[[Scene], Prepared]
"""Makes or finds what a scene needs before its first step."""


class Preparations:
    """Keeps the last preparations by their content; safe to use from any thread."""

    def __init__(self, *, most: int, max_bytes: int = MAX_PREPARED_BYTES) -> None:
        """
        Args:
            most: how many to keep.
            max_bytes: memory that they may take together; the last one is kept however large it is.
        """
        self._most, self._max_bytes = most, max_bytes
        self._made: OrderedDict[str, Prepared] = OrderedDict()
        self._lock = threading.Lock()

    def __call__(self, scene: Scene) -> Prepared:
        """The preparation of a scene, or of an earlier one from which it does not differ in what matters here."""
        holds = holds_of(scene)
        key, kept = _key(scene, holds), _without_what_acts(scene)
        with self._lock:
            prepared = self._made.setdefault(key, Prepared(kept, holds))
            self._made.move_to_end(key)
            while len(self._made) > self._most or (len(self._made) > 1 and self._bytes() > self._max_bytes):
                self._made.popitem(last=False)
        return prepared

    @property
    def size(self) -> int:
        """Bytes that all of them come to hold on to, about."""
        with self._lock:
            return self._bytes()

    def _bytes(self) -> int:
        return sum(prepared.size for prepared in self._made.values())


def _without_what_acts(scene: Scene) -> Scene:
    """The scene without large masks that are not read any more once it is known what rig points hold."""
    if not any(isinstance(region, MaskRegion) for region in _regions(replace(scene, paint=()))):
        return scene
    return replace(scene, strokes=(), rig_points=(), colliders=(), query_points=(), wind=None, contact=None, loop=None)


def _regions(scene: Scene) -> list[RigRegion]:
    """The regions of everything that has one."""
    entries = (scene.rig_points, scene.colliders, scene.paint)
    return [entry.region for group in entries for entry in group]  # type: ignore[attr-defined]


def _key(scene: Scene, holds: Holds) -> str:
    """A digest of everything that ``Prepared`` reads of a scene."""
    digest = hashlib.sha256(
        repr((scene.gravity, scene.sag, scene.time_step, scene.strokes_as, len(scene.paint))).encode()
    )
    for number, body in enumerate(scene.bodies):
        digest.update(repr(body.name).encode() + body.mesh.content_hash.encode())
        _add_fields(digest, body)
        for values in (holds.leaders[number], holds.grips[number], holds.grippers[number]):
            digest.update(values.tobytes())
    for entry in scene.paint:
        checkpoint()
        _add_fields(digest, entry)
    return digest.hexdigest()


def _add_fields(digest: hashlib._Hash, part: Body | Paint) -> None:
    """Every field of a body's material or of paint, arrays by their bytes."""
    values = part.material if isinstance(part, Body) else part
    for field in fields(values):
        value = getattr(values, field.name)
        value = value.mask if isinstance(value, MaskRegion) else value
        shown = value.shape if isinstance(value, np.ndarray) else value
        digest.update(f"{field.name}={shown!r};".encode())
        if isinstance(value, np.ndarray):
            digest.update(np.ascontiguousarray(value).data)
