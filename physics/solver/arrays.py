"""The arrays that the kernels read and write. Units are the solver's: sides and seconds."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..limits import TICK
from ..runtime import LANES, aligned

__all__ = ["CALM", "Drive", "Solid", "State", "WindTable"]

Float32Array = NDArray[np.float32]
Int32Array = NDArray[np.int32]


class Solid(NamedTuple):
    """The bodies, which do not change, one connected part after the other.

    Attributes:
        starts: first vertex and first block of triangles of each part, and where the last one ends, int32,
            shape [p + 1, 2].
        substeps: planned substeps of each part in a tick, int32, shape [p].
        vertices: rest position X [side], inverse mass (0: kinematic or pinned), damping [1/s], float32, shape [v, 4].
        step_limits: largest displacement in a substep [side], float32, shape [v].
        handles: index of the moving rig point whose motion each vertex follows, -1 for none, int32, shape [v].
        grips: firmness of the spring by which it follows, 0..1; 0 for kinematic vertices, which are where the motion
            has them, float32, shape [v].
        corners: vertices at the corners of the triangles of each block, int32, shape [n, 3, 16]; a part's last block
            is filled up with triangles that have no stiffness.
        elements: of each of these triangles the row-major inverse of its rest edge columns [1/side], 2 mu V,
            lambda V, and the omega^2 at rest to plan with [1/s^2], float32, shape [n, 7, 16].
        first_slots: where each vertex's slots begin, int32, shape [v + 1].
        slots: where the forces on a vertex are among ``State.corner_forces`` seen as pairs, one slot for each of its
            triangles, int32, shape [3 t].
        anchors: vertex that holds each vertex by a tether, itself pinned or kinematic, -1 for none, int32, shape
            [v]; of no length where nothing is tethered.
        tethers: length of the tether [side], float32, shape as ``anchors``.
        wind_response: factor on what wind and strokes do to each vertex, float32, shape [v]; of no length for 1
            everywhere.
    """

    starts: Int32Array
    substeps: Int32Array
    vertices: Float32Array
    step_limits: Float32Array
    handles: Int32Array
    grips: Float32Array
    corners: Int32Array
    elements: Float32Array
    first_slots: Int32Array
    slots: Int32Array
    anchors: Int32Array = np.zeros(0, dtype=np.int32)
    tethers: Float32Array = np.zeros(0, dtype=np.float32)
    wind_response: Float32Array = np.zeros(0, dtype=np.float32)

    @staticmethod
    def of_triangles(
        *,
        starts: Int32Array,
        triangles: Int32Array,
        inverse_edges: Float32Array,
        stiffness: Float32Array,
        vertices: Float32Array,
        **others: Any,
    ) -> Solid:
        """Put triangles into blocks.

        Args:
            starts: first vertex and first triangle of each part, and where the last one ends, shape [p + 1, 2].
            triangles: vertex indices, shape [t, 3].
            inverse_edges: row-major inverse of the rest edge columns [1/side], shape [t, 4].
            stiffness: 2 mu V, lambda V, and the omega^2 at rest to plan with [1/s^2], shape [t, 3].
            vertices: as in the result.
            others: the result's other fields.
        """
        counts = np.diff(starts[:, 1])
        first_blocks = np.concatenate([[0], np.cumsum(-(-counts // LANES))])
        lanes = np.arange(len(triangles)) - np.repeat(starts[:-1, 1] - LANES * first_blocks[:-1], counts)
        filled = LANES * int(first_blocks[-1])
        corners = np.zeros((filled, 3), dtype=np.int32)
        corners[:] = np.repeat(starts[:-1, 0], LANES * np.diff(first_blocks))[:, None]
        elements = np.zeros((filled, 7), dtype=np.float32)
        elements[:, 4] = 1.0  # divides in the estimate of the step, where all else is 0
        corners[lanes], elements[lanes] = triangles, np.column_stack([inverse_edges, stiffness])
        pairs = (lanes // LANES * 3)[:, None] * LANES + LANES * np.arange(3) + (lanes % LANES)[:, None]
        order = np.argsort(triangles.ravel(), kind="stable")
        per_vertex = np.bincount(triangles.ravel(), minlength=len(vertices))
        return Solid(
            starts=np.column_stack([starts[:, 0], first_blocks]).astype(np.int32),
            vertices=vertices,
            corners=_in_blocks(corners),
            elements=_in_blocks(elements),
            first_slots=np.concatenate([[0], np.cumsum(per_vertex)]).astype(np.int32),
            slots=pairs.ravel()[order].astype(np.int32),
            **others,
        )


class State(NamedTuple):
    """The state of the bodies, and arrays that the kernels work in.

    Attributes:
        displacement: u = x - X [side], float32, shape [v, 2].
        velocity: [side/s], float32, shape [v, 2].
        push: external acceleration [side/s^2] in this tick, float32, shape [v, 2].
        decay: factor exp(-damping dt) on the velocity in a substep of this tick, float32, shape [v].
        corner_forces: internal force of each triangle on its corners [density side^3 / s^2], the pairs of a block one
            after the other, float32, shape [n, 3, 32].
        records: receives the displacement f times in a launch, at equal distances of time, last at its end [side],
            float32, shape [f, v, 2]; f may be 0.
    """

    displacement: Float32Array
    velocity: Float32Array
    push: Float32Array
    decay: Float32Array
    corner_forces: Float32Array
    records: Float32Array

    @staticmethod
    def at_rest(solid: Solid) -> State:
        """The undeformed, unmoving state of bodies."""
        count = len(solid.vertices)
        u, v, push = (np.zeros((count, 2), dtype=np.float32) for _ in range(3))
        decay, corner_forces = np.zeros(count, dtype=np.float32), aligned((len(solid.corners), 3, 2 * LANES))
        return State(u, v, push, decay, corner_forces, np.zeros((0, count, 2), dtype=np.float32))

    def recording(self, count: int) -> State:
        """The same state, which a launch records so many times."""
        return self._replace(records=np.empty((count, *self.displacement.shape), dtype=np.float32))


class WindTable(NamedTuple):
    """A wind field in each of n ticks: uniform plus the sum of amplitude sin(wave . x + phase).

    Attributes:
        uniform: [side/s^2], float32, shape [n, 2]; of no length for calm.
        waves: wave vector [rad/side] and amplitude [side/s^2] of each of m waves, float32, shape [m, 4].
        phases: [rad], float32, shape [n, max(m, 1)].
    """

    uniform: Float32Array
    waves: Float32Array
    phases: Float32Array


CALM = WindTable(*(np.zeros(shape, dtype=np.float32) for shape in ((0, 2), (0, 4), (1, 1))))
"""No wind."""


class Drive(NamedTuple):
    """What acts on the bodies in each of n ticks.

    Attributes:
        rig_leads: M row by row and d [side] of the displacement M X + d that each rig point gives its region at the
            ticks' ends, float32, shape [n + 1, g, 6].
        rig_rates: their time derivatives [1/s], float32, shape [n + 1, g, 6].
        first_particles: particles of tick i are those from entry i to before entry i + 1, int32, shape [n + 1].
        particles: position and direction of travel of each particle in the middle of its tick [side],
            radius [side], strength [side/s^2], float32, shape [p, 6].
        kinds: kind and falloff as in ``EnergyStroke.effect_number``, int32, shape [p].
        gravity: acceleration of every vertex [side/s^2].
        wind: beside it.
        tick_length: of each tick [s].
    """

    rig_leads: Float32Array
    rig_rates: Float32Array
    first_particles: Int32Array
    particles: Float32Array
    kinds: Int32Array
    gravity: tuple[float, float]
    wind: WindTable = CALM
    tick_length: float = TICK


def _in_blocks(rows: NDArray[Any]) -> NDArray[Any]:
    """Rows of numbers with the same number of several rows side by side, shape [n, columns, 16]."""
    blocks = aligned((len(rows) // LANES, rows.shape[1], LANES), rows.dtype)
    blocks[:] = rows.reshape(-1, LANES, rows.shape[1]).swapaxes(1, 2)
    return blocks
