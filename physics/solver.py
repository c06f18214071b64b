"""The solver: arrays of the bodies, their state and what drives them, and the launches of the kernels on these.

The state is the displacement u = x - X rather than the position, so that F = I + grad u keeps its digits in float32.
Units are the solver's: sides and seconds.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import taichi_runtime
from .kernels import build_kernels

__all__ = ["Drive", "Solid", "State", "advance", "internal_forces"]

Float32Array = NDArray[np.float32]
Int32Array = NDArray[np.int32]


class Solid(NamedTuple):
    """The bodies, which do not change, one connected part after the other.

    Attributes:
        starts: first vertex and first triangle of each part, and where the last one ends, int32, shape [p + 1, 2].
        substeps: planned substeps of each part in a tick, int32, shape [p].
        vertices: rest position X [side], inverse mass (0: led or held), damping [1/s], float32, shape [v, 4].
        reach: largest displacement in a substep [side], float32, shape [v].
        leaders: index of the rig point that leads each vertex, -1 for none, int32, shape [v].
        triangles: vertex indices, int32, shape [t, 3].
        inverse_edges: row-major inverse of the rest edge columns [1/side], float32, shape [t, 4].
        stiffness: 2 mu V, lambda V, and the omega^2 at rest to plan with [1/s^2], float32, shape [t, 3].
    """

    starts: Int32Array
    substeps: Int32Array
    vertices: Float32Array
    reach: Float32Array
    leaders: Int32Array
    triangles: Int32Array
    inverse_edges: Float32Array
    stiffness: Float32Array


class State(NamedTuple):
    """What the kernels change in place.

    Attributes:
        displacement: u = x - X [side], float32, shape [v, 2].
        velocity: [side/s], float32, shape [v, 2].
        force: internal force [density side^3 / s^2], 0 between substeps, float32, shape [v, 2].
        push: external acceleration [side/s^2] in this tick, float32, shape [v, 2].
        decay: what damping leaves of a velocity in a substep of this tick, float32, shape [v].
    """

    displacement: Float32Array
    velocity: Float32Array
    force: Float32Array
    push: Float32Array
    decay: Float32Array

    @staticmethod
    def at_rest(count: int) -> State:
        """The undeformed, unmoving state of a number of vertices."""
        u, v, force, push = (np.zeros((count, 2), dtype=np.float32) for _ in range(4))
        return State(u, v, force, push, np.zeros(count, dtype=np.float32))


class Drive(NamedTuple):
    """What acts on the bodies in each of n ticks.

    Attributes:
        rig_displacements: of each rig point at the ticks' ends [side], float32, shape [n + 1, g, 2].
        rig_velocities: [side/s], float32, shape [n + 1, g, 2].
        first_particles: particles of tick i are those from entry i to before entry i + 1, int32, shape [n + 1].
        particles: position and direction of travel of each particle in the middle of its tick [side],
            radius [side], strength [side/s^2], float32, shape [p, 6].
        kinds: index into ``strokes.STROKE_KINDS``, int32, shape [p].
        gravity: acceleration of every vertex [side/s^2].
    """

    rig_displacements: Float32Array
    rig_velocities: Float32Array
    first_particles: Int32Array
    particles: Float32Array
    kinds: Int32Array
    gravity: tuple[float, float]


def advance(solid: Solid, state: State, drive: Drive) -> None:
    """Carry a state on through the ticks of a drive, on the Taichi thread.

    Args:
        solid: the bodies.
        state: changed in place.
        drive: what acts on them.
    """
    taichi_runtime.run(_advance, solid, state, drive)


def internal_forces(solid: Solid, displacement: Float32Array) -> Float32Array:
    """Internal force on each vertex at a displacement, shape [v, 2]: what ``advance`` computes in a substep."""
    force = np.zeros_like(displacement)
    taichi_runtime.run(_internal_forces, solid, np.ascontiguousarray(displacement, dtype=np.float32), force)
    return force


def _advance(solid: Solid, state: State, drive: Drive) -> None:
    advance_kernel, _ = taichi_runtime.compiled(build_kernels)
    *arrays, gravity = drive
    advance_kernel(*solid, *state, *arrays, *gravity)


def _internal_forces(solid: Solid, displacement: Float32Array, force: Float32Array) -> None:
    _, force_kernel = taichi_runtime.compiled(build_kernels)
    force_kernel(solid.triangles, solid.inverse_edges, solid.stiffness, displacement, force)
