"""The solver: launches of the kernels on arrays of the bodies, their state and what drives them.

The state is the displacement u = x - X rather than the position, so that F = I + grad u keeps its digits in float32.
"""

from __future__ import annotations

import os
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..runtime import LANES, aligned, check_aligned, taichi_runtime
from .arguments import drive_group, solid_group, state_group
from .arrays import CALM, Drive, Solid, State, WindTable
from .elastic_functions import MOST_REFINEMENT
from .kernels import Kernels, build_kernels
from .pace import Pace
from .sharing import LARGE, MOST_THREADS, TRIANGLES_PER_THREAD, phases_of

__all__ = ["CALM", "Drive", "Solid", "State", "WindTable", "advance", "internal_forces"]

_paces: dict[int, Pace] = {}  # by the size of the part; used on the Taichi thread only


def advance(solid: Solid, state: State, drive: Drive) -> None:
    """Carry a state on through the ticks of a drive, on the Taichi thread.

    Args:
        solid: the bodies.
        state: changed in place.
        drive: what acts on them.

    Raises:
        ValueError: an array lies where the kernels cannot read it.
    """
    check_aligned(solid.corners, solid.elements, state.corner_forces)
    taichi_runtime.launch(_advance, solid, state, drive)


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


def _advance(solid: Solid, state: State, drive: Drive) -> None:
    kernels = taichi_runtime.compiled(build_kernels)
    packs = kernels.packed(solid_group(solid), state_group(state), drive_group(drive))
    work = np.diff(solid.starts[:, 1]) * solid.substeps
    parts = np.argsort(-work, kind="stable").astype(np.int32)  # the most work first, so that threads end together
    largest = int(parts[0])
    if _may_be_shared(solid, largest, work):
        _advance_largest(kernels, largest, solid, drive, packs)
        parts = parts[1:]
    if len(parts):
        kernels.advance(parts, *packs)


def _may_be_shared(solid: Solid, part: int, work: NDArray[Any]) -> bool:
    """Whether a part is large enough, and all others would have to wait for it in the end."""
    triangles = LANES * int(solid.starts[part + 1, 1] - solid.starts[part, 1])
    return triangles >= LARGE and 2 * work[part] > work.sum() and _processors() > 1


def _advance_largest(kernels: Kernels, part: int, solid: Solid, drive: Drive, packs: list[Any]) -> None:
    """Advance a large part on one thread or on several, whichever was faster lately."""
    work, ticks = int(solid.starts[part + 1, 1] - solid.starts[part, 1]), len(drive.first_particles) - 1
    pace = _paces.setdefault(work.bit_length(), Pace())
    shared, start = pace.share(), time.perf_counter()
    if shared:
        threads = min(_processors(), LANES * work // TRIANGLES_PER_THREAD)
        _advance_shared(kernels, part, max(threads, 2), solid, ticks, packs)
    else:
        kernels.advance(np.array([part], dtype=np.int32), *packs)
    done = float(work * solid.substeps[part] * ticks)
    pace.learn(shared=shared, work=done, seconds=time.perf_counter() - start)


def _advance_shared(kernels: Kernels, part: int, threads: int, solid: Solid, ticks: int, packs: list[Any]) -> None:
    phases = phases_of(ticks, int(solid.substeps[part]), MOST_REFINEMENT)
    counters, highest = np.zeros(1 + phases, dtype=np.int32), np.zeros(ticks, dtype=np.float32)
    kernels.advance_shared(part, threads, counters, highest, *packs)


def _processors() -> int:
    """Most threads that share a part: one for each processor that this process may use, but not too many."""
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(available, MOST_THREADS)


def _internal_forces(solid: Solid, arrays: tuple[NDArray[Any], ...]) -> None:
    taichi_runtime.compiled(build_kernels).forces(solid.corners, solid.elements, *arrays)
