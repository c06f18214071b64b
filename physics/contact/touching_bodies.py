"""Bodies that touch, and their way through time.

Every part takes its own steps through a tick as without contact, but parts that touch take as many as the stiffest of
them and are put apart after each: pushed out of each other more rarely, or while one stands still, they would gain
energy. Two that have only come near are put apart in every step of the stiffer one, and the softer one is foreseen to
move at the end of its own step.

All parts are advanced by several threads together, or by one where that is faster.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..assembly import System, drive
from ..material import RestShape
from ..runtime import LANES, taichi_runtime
from ..scene import Contact, Scene
from ..solver import Drive, Pace, Solid, State, most_threads
from .kernels import build_contact_kernel
from .surface import ContactSurface, contact_surface
from .team import Pieces, pieces_of, team_for

__all__ = ["TouchingBodies"]

_paces: dict[tuple[int, int], Pace] = {}  # by threads and work in a tick; used on the Taichi thread only


class _Touching(NamedTuple):
    """What the kernel reads, and the surface with what it notes there from one launch to the next."""

    solid: Solid
    surface: ContactSurface
    pieces: Pieces
    threads: int
    options: tuple[float, float, int]


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
        self._scene = scene
        if start is not None:
            drawn = RestShape(system.rest.positions + start, system.rest.triangles)
            system = replace(system, rest=drawn)
        surface, still = contact_surface(scene, system, contact)
        added = np.zeros((len(still), 4), np.float32)
        added[:, :2] = still
        self._solid = solid._replace(vertices=np.concatenate([solid.vertices, added]))
        pieces = pieces_of(solid, most_threads())
        threads = min(most_threads(), len(pieces.blocks))  # of one piece, no two can work at once
        thickness = contact.thickness / scene.bodies[0].mesh.longest_side
        options = (contact.friction, thickness, int(contact.self_contact))
        self._touching = _Touching(self._solid, surface, pieces, threads, options)
        self.count = len(solid.vertices)
        self.state = State.at_rest(self._solid)
        if start is not None:
            self.state.displacement[: self.count] = start

    def advance(self, first: int, end: int, *, block: int = 1) -> None:
        """Carry the state on from one tick to another, some ticks in a launch."""
        for tick in range(first, end, block):
            acting = drive(self._scene, tick, min(block, end - tick))
            taichi_runtime.launch(_advance, self._touching, self.state, acting)

    def record(self, first: int, end: int, *, count: int) -> NDArray[np.float32]:
        """Carry the state on in one launch; the displacement so many times meanwhile [side], shape [count, v, 2]."""
        recording = self.state.recording(count)
        taichi_runtime.launch(_advance, self._touching, recording, drive(self._scene, first, end - first))
        return recording.records


def _advance(touching: _Touching, state: State, acting: Drive) -> None:
    kernel = taichi_runtime.compiled(build_contact_kernel)
    solid, surface, pieces, threads, options = touching
    *arrays, gravity, wind = acting
    pairs = state.corner_forces.reshape(-1, 2)
    ticks = len(acting.first_particles) - 1
    team = team_for(pieces, solid, len(surface.points), ticks)
    work = float(LANES * (np.diff(solid.starts[:, 1]) * solid.substeps).sum())
    pace = _paces.setdefault((threads, int(work).bit_length()), Pace())
    shared, start = pace.share(), time.perf_counter()
    now = threads if shared else 1
    kernel(now, *team, *solid, *state, pairs, *arrays, *gravity, *wind, *surface, *options)
    pace.learn(shared=shared, work=work * ticks, seconds=time.perf_counter() - start)
