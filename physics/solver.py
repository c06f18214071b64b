"""The solver: launches of the kernels on arrays of the bodies, their state and what drives them.

The state is the displacement u = x - X rather than the position, so that F = I + grad u keeps its digits in float32.
"""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import taichi_runtime
from .kernel_functions import MOST_REFINEMENT
from .kernels import build_kernels
from .solver_arrays import CALM, LANES, Drive, Solid, State, WindTable, aligned, check_aligned

__all__ = ["CALM", "Drive", "Solid", "State", "WindTable", "advance", "internal_forces", "schedule"]

TRIANGLES_TO_SHARE = 8_000
"""A connected part of at least so many triangles is computed by several threads together."""


class Schedule(NamedTuple):
    """Which parts of a solid are computed how.

    Attributes:
        alone: parts that a thread computes by itself, int32.
        shared: parts that several threads compute together.
        threads: how many these are.
    """

    alone: NDArray[np.int32]
    shared: tuple[int, ...]
    threads: int


def schedule(solid: Solid, *, threads: int | None = None) -> Schedule:
    """How ``advance`` goes about a solid.

    Args:
        solid: the bodies.
        threads: threads for large parts; those of the processors that this process may use when None.
    """
    threads = _processors() if threads is None else threads
    large = np.diff(solid.starts[:, 1]) * LANES >= TRIANGLES_TO_SHARE
    large &= threads > 1
    return Schedule(np.flatnonzero(~large).astype(np.int32), tuple(np.flatnonzero(large).tolist()), threads)


def advance(solid: Solid, state: State, drive: Drive, *, threads: int | None = None) -> None:
    """Carry a state on through the ticks of a drive, on the Taichi thread.

    Args:
        solid: the bodies.
        state: changed in place.
        drive: what acts on them.
        threads: as for ``schedule``; the result is the same with any.

    Raises:
        ValueError: an array lies where the kernels cannot read it.
    """
    check_aligned(solid.corners, solid.elements, state.corner_forces)
    taichi_runtime.run(_advance, solid, state, drive, schedule(solid, threads=threads))


def internal_forces(solid: Solid, displacement: NDArray[np.float32]) -> NDArray[np.float32]:
    """Internal force on each vertex at a displacement, shape [v, 2]: what ``advance`` computes in a substep."""
    corner_forces = aligned((len(solid.corners), 3, 2 * LANES))
    arrays = solid.corners, solid.elements, np.ascontiguousarray(displacement, dtype=np.float32), corner_forces
    taichi_runtime.run(_internal_forces, *arrays)
    pairs = corner_forces.reshape(-1, 2)[solid.slots]
    vertices = np.repeat(np.arange(len(solid.vertices)), np.diff(solid.first_slots))
    force = np.zeros_like(displacement)
    np.add.at(force, vertices, pairs)
    return force


def _advance(solid: Solid, state: State, drive: Drive, plan: Schedule) -> None:
    kernels = taichi_runtime.compiled(build_kernels)
    *arrays, gravity, wind = drive
    arguments = (*solid, *state, state.corner_forces.reshape(-1, 2), *arrays, *gravity, *wind)
    if len(plan.alone):
        kernels.advance(plan.alone, *arguments)
    ticks = len(drive.first_particles) - 1
    for part in plan.shared:
        phases = 2 * ticks * (1 + MOST_REFINEMENT * int(solid.substeps[part]))
        claims, highest = np.zeros(1 + phases, dtype=np.int32), np.zeros(ticks, dtype=np.float32)
        kernels.advance_together(part, plan.threads, claims, highest, *arguments)


def _internal_forces(*arrays: NDArray[Any]) -> None:
    taichi_runtime.compiled(build_kernels).forces(*arrays)


def _processors() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
