"""The solver: launches of the kernels on arrays of the bodies, their state and what drives them.

The state is the displacement u = x - X rather than the position, so that F = I + grad u keeps its digits in float32.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..runtime import LANES, aligned, check_aligned, taichi_runtime
from .arrays import CALM, Drive, Solid, State, WindTable
from .kernel_functions import MOST_REFINEMENT
from .kernels import build_kernels
from .pace import Pace
from .scheduling import Schedule, schedule

__all__ = ["CALM", "Drive", "Solid", "State", "WindTable", "advance", "internal_forces"]

_paces: dict[tuple[int, int], Pace] = {}  # by threads and size of the part; used on the Taichi thread only


def advance(solid: Solid, state: State, drive: Drive, *, threads: int | None = None) -> None:
    """Carry a state on through the ticks of a drive, on the Taichi thread.

    Args:
        solid: the bodies.
        state: changed in place.
        drive: what acts on them.
        threads: most threads that compute a part, as for ``schedule``; the result is the same with any.

    Raises:
        ValueError: an array lies where the kernels cannot read it.
    """
    check_aligned(solid.corners, solid.elements, state.corner_forces)
    chosen = schedule(LANES * np.diff(solid.starts[:, 1]), solid.substeps, threads=threads)
    taichi_runtime.launch(_advance, solid, state, drive, chosen)


def internal_forces(solid: Solid, displacement: NDArray[np.float32]) -> NDArray[np.float32]:
    """Internal force on each vertex at a displacement, shape [v, 2]: what ``advance`` computes in a substep."""
    corner_forces = aligned((len(solid.corners), 3, 2 * LANES))
    arrays = np.ascontiguousarray(displacement, dtype=np.float32), corner_forces
    taichi_runtime.launch(_internal_forces, solid, arrays)
    pairs = corner_forces.reshape(-1, 2)[solid.slots]
    vertices = np.repeat(np.arange(len(solid.vertices)), np.diff(solid.first_slots))
    force = np.zeros_like(displacement)
    np.add.at(force, vertices, pairs)
    return force


def _advance(solid: Solid, state: State, drive: Drive, chosen: Schedule) -> None:
    kernels = taichi_runtime.compiled(build_kernels)
    *arrays, gravity, wind = drive
    arguments = (*solid, *state, state.corner_forces.reshape(-1, 2), *arrays, *gravity, *wind)
    if len(chosen.alone):
        kernels.advance(chosen.alone, *arguments)
    ticks = len(drive.first_particles) - 1
    for part, threads in chosen.shared:
        triangles = LANES * int(solid.starts[part + 1, 1] - solid.starts[part, 1])
        pace = _paces.setdefault((threads, triangles.bit_length()), Pace())
        shared, start = pace.share(), time.perf_counter()
        if shared:
            phases = ticks * (3 + 2 * MOST_REFINEMENT * int(solid.substeps[part]))
            claims, highest = np.zeros(1 + phases, dtype=np.int32), np.zeros(ticks, dtype=np.float32)
            kernels.advance_together(part, threads, claims, highest, *arguments)
        else:
            kernels.advance(np.array([part], dtype=np.int32), *arguments)
        work = float(triangles * solid.substeps[part] * ticks)
        pace.learn(shared=shared, work=work, seconds=time.perf_counter() - start)


def _internal_forces(solid: Solid, arrays: tuple[NDArray[Any], ...]) -> None:
    taichi_runtime.compiled(build_kernels).forces(solid.corners, solid.elements, *arrays)
