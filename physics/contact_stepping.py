"""Steps of bodies that touch: a tick is cut into intervals, and after each one the bodies are put apart.

The solver knows ticks only; an interval is a tick to it in a unit of time that is shorter by the number of intervals.
That number is a power of two, so that changing the unit rounds nothing.
"""

from __future__ import annotations

import math

import numpy as np

from . import taichi_runtime
from .collision import Contact
from .contact_kernels import build_contact_kernel
from .contact_surface import contact_surface
from .drive import drive
from .scene import Scene
from .solver import Drive, Solid, State, advance_here
from .stepping import TICK
from .system import System

__all__ = ["TouchingBodies"]

_MOST_INTERVALS = 64
_SUBSTEPS = 1  # of the stiffest part in an interval, at most, while anything touches
_TRAVEL = 0.5  # of a boundary edge that vertices move in an interval, at most, while anything is near


class TouchingBodies:
    """The bodies of a scene, their state, and how finely time is cut for them."""

    def __init__(self, scene: Scene, system: System, solid: Solid, contact: Contact) -> None:
        self._scene, self._contact = scene, contact
        self._side = scene.bodies[0].mesh.longest_side
        self._surface, still = contact_surface(scene, system, contact)
        added = np.zeros((len(still), 4), np.float32)
        added[:, :2] = still
        self._solids = {1: solid._replace(vertices=np.concatenate([solid.vertices, added]))}
        self._most = max(int(solid.substeps.max()), 1)
        self._finest = float(self._surface.spacing[self._surface.spacing > 0].min())
        self.count = len(solid.vertices)
        self.state = State.at_rest(self.count + len(still))

    def advance(self, first: int, end: int) -> None:
        """Carry the state on from one tick to another."""
        for tick in range(first, end):
            intervals = self._intervals()
            rig = drive(self._scene, tick, 1, intervals=intervals)
            taichi_runtime.run(self._advance, rig, intervals)

    def _intervals(self) -> int:
        """How many intervals the next tick takes, from what the last one met."""
        closest, fastest, _ = self._surface.report.tolist()
        if closest > 2 * fastest * TICK:
            return 1
        needed = max(self._most / _SUBSTEPS, fastest * TICK / (_TRAVEL * self._finest))
        return min(1 << max(0, math.ceil(math.log2(max(needed, 1.0)))), _MOST_INTERVALS)

    def _advance(self, whole: Drive, intervals: int) -> None:
        solid, state = self._solid(intervals), self.state
        resolve = taichi_runtime.compiled(build_contact_kernel)
        thickness = self._contact.thickness / self._side
        for number in range(intervals):
            state.velocity[:] /= np.float32(intervals)
            advance_here(solid, state, _part_of(whole, number, intervals))
            state.velocity[:] *= np.float32(intervals)
            resolve(
                solid.vertices,
                state.displacement,
                state.velocity,
                *self._surface,
                self._contact.friction,
                thickness,
                int(self._contact.self_contact),
                TICK / intervals,
                TICK,
            )

    def _solid(self, intervals: int) -> Solid:
        """The bodies in the unit of time in which an interval is a tick."""
        if intervals not in self._solids:
            whole = self._solids[1]
            scale = np.float32(intervals)
            vertices = whole.vertices.copy()
            vertices[:, 3] /= scale
            self._solids[intervals] = whole._replace(
                substeps=-(-whole.substeps // np.int32(intervals)),
                vertices=vertices,
                stiffness=whole.stiffness / (scale * scale),
            )
        return self._solids[intervals]


def _part_of(whole: Drive, number: int, intervals: int) -> Drive:
    """What acts in one interval of a tick, in the interval's unit of time."""
    scale = np.float32(intervals)
    particles = whole.particles.copy()
    particles[:, 5] /= scale * scale
    gravity = whole.gravity
    return whole._replace(
        rig_displacements=whole.rig_displacements[number : number + 2],
        rig_velocities=whole.rig_velocities[number : number + 2] / scale,
        particles=particles,
        gravity=(gravity[0] / intervals**2, gravity[1] / intervals**2),
    )

