"""Bodies that touch, and their way through time.

Every part takes its own steps through a tick as without contact. Two parts that may touch are put apart in every step
of the stiffer one: bodies pushed out of each other more rarely would gain energy from the overlap of a whole interval.
The softer one, which may stand still meanwhile, is foreseen to move at the end of its own step.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from . import taichi_runtime
from .collision import Contact
from .contact_kernels import build_contact_kernel
from .contact_surface import contact_surface
from .drive import drive
from .elasticity import RestShape
from .scene import Scene
from .solver import Drive, Solid, State
from .system import System

__all__ = ["TouchingBodies"]


class TouchingBodies:
    """The bodies of a scene with contact, and their state.

    Attributes:
        count: vertices of the bodies, which come first in the state; those of colliders follow.
        state: changed by ``advance``.
    """

    def __init__(
        self,
        scene: Scene,
        system: System,
        solid: Solid,
        contact: Contact,
        start: NDArray[np.float32] | None = None,
    ) -> None:
        """Prepare bodies that are drawn displaced from rest by ``start`` [side], shape [v, 2]; None: at rest."""
        self._scene, self._contact = scene, contact
        if start is not None:
            drawn = RestShape(system.rest.positions + start, system.rest.triangles)
            system = replace(system, rest=drawn)
        self._surface, still = contact_surface(scene, system, contact)
        added = np.zeros((len(still), 4), np.float32)
        added[:, :2] = still
        self._solid = solid._replace(vertices=np.concatenate([solid.vertices, added]))
        self.count = len(solid.vertices)
        self.state = State.at_rest(self._solid)
        if start is not None:
            self.state.displacement[: self.count] = start

    def advance(self, first: int, end: int, *, block: int = 1) -> None:
        """Carry the state on from one tick to another, some ticks in a launch."""
        for tick in range(first, end, block):
            taichi_runtime.run(self._advance, self.state, drive(self._scene, tick, min(block, end - tick)))

    def record(self, first: int, end: int, *, count: int) -> NDArray[np.float32]:
        """Carry the state on in one launch; the displacement so many times meanwhile [side], shape [count, v, 2]."""
        recording = self.state.recording(count)
        taichi_runtime.run(self._advance, recording, drive(self._scene, first, end - first))
        return recording.records

    def _advance(self, state: State, acting: Drive) -> None:
        kernel = taichi_runtime.compiled(build_contact_kernel)
        *arrays, gravity, wind = acting
        thickness = self._contact.thickness / self._scene.bodies[0].mesh.longest_side
        options = (self._contact.friction, thickness, int(self._contact.self_contact))
        pairs = state.corner_forces.reshape(-1, 2)
        kernel(*self._solid, *state, pairs, *arrays, *gravity, *wind, *self._surface, *options)
