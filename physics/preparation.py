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

from .elasticity import RestShape
from .falloff import grips_of
from .paint import Paint
from .prestress import unsagged
from .rig import MaskRegion
from .rigging import leaders_of
from .scene import Body, Scene
from .system import System, assemble

__all__ = ["AtRest", "Preparations", "Prepare", "Prepared"]


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
    """

    scene: Scene

    @cached_property
    def system(self) -> System:
        """The assembled bodies, their rest shape being the drawing."""
        return assemble(self.scene)

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


Prepare = Callable[[Scene], Prepared]
"""Makes or finds what a scene needs before its first step."""


class Preparations:
    """Keeps the last preparations by their content; safe to use from any thread."""

    def __init__(self, *, most: int) -> None:
        """
        Args:
            most: how many to keep.
        """
        self._most = most
        self._made: OrderedDict[str, Prepared] = OrderedDict()
        self._lock = threading.Lock()

    def __call__(self, scene: Scene) -> Prepared:
        """The preparation of a scene, or of an earlier one from which it does not differ in what matters here."""
        key = _key(scene)
        with self._lock:
            prepared = self._made.setdefault(key, Prepared(scene))
            self._made.move_to_end(key)
            while len(self._made) > self._most:
                self._made.popitem(last=False)
        return prepared


def _key(scene: Scene) -> str:
    """A digest of everything that ``Prepared`` reads of a scene."""
    digest = hashlib.sha256(repr((scene.gravity, scene.sag, len(scene.paint))).encode())
    for number, body in enumerate(scene.bodies):
        digest.update(repr(body.name).encode() + body.mesh.content_hash.encode())
        _add_fields(digest, body)
        digest.update(leaders_of(scene.rig_points, body.mesh, body=number).tobytes())
        for values in grips_of(scene.rig_points, body.mesh, body=number):
            digest.update(values.tobytes())
    for entry in scene.paint:
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
            digest.update(value.tobytes())
