"""The solver: launches of the kernels on arrays of the bodies, their state and what drives them.

The state is the displacement u = x - X rather than the position, so that F = I + grad u keeps its digits in float32.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..runtime import LANES, aligned, check_aligned, taichi_runtime
from ..threads import allowed_threads
from .arguments import drive_group, solid_group, state_group
from .arrays import CALM, Drive, Solid, State, WindTable
from .pace import TRIANGLES_PER_THREAD, launch_faster, most_threads, share_counters

if TYPE_CHECKING:
    from .kernels import Kernels

__all__ = ["CALM", "Drive", "Solid", "State", "WindTable", "advance", "internal_forces", "read_kernels"]

_SPARED = 2  # processors for threads that work beside: one that draws, and one that writes


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
    taichi_runtime.launch(_advance, solid, state, drive, _SPARED if taichi_runtime.is_beside() else 0)


def read_kernels(_constant: None = None, _state: None = None) -> None:
    """Bring the kernels of bodies that do not touch into this process: read from disk, or compiled."""
    one = np.ones(3, dtype=np.float32)
    solid = Solid.of_triangles(
        starts=np.array([[0, 0], [3, 1]], dtype=np.int32),
        substeps=np.ones(1, dtype=np.int32),
        vertices=np.ones((3, 4), dtype=np.float32),
        step_limits=one,
        handles=np.full(3, -1, dtype=np.int32),
        grips=0 * one,
        triangles=np.arange(3, dtype=np.int32)[None],
        inverse_edges=np.eye(2, dtype=np.float32).reshape(1, 4),
        stiffness=one[None],
    )
    rig, nothing = np.zeros((2, 1, 6), dtype=np.float32), np.zeros((0, 6), dtype=np.float32)
    counts = np.zeros(2, dtype=np.int32)
    advance(solid, State.at_rest(solid), Drive(rig, rig, counts, nothing, np.zeros(0, dtype=np.int32), (0.0, 0.0)))


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


def _kernels(_taichi: Any) -> Kernels:
    from .kernels import build_kernels  # which imports Taichi

    return build_kernels()


def _advance(solid: Solid, state: State, drive: Drive, spared: int) -> None:
    kernels = taichi_runtime.compiled(_kernels)
    packs = kernels.packed(solid_group(solid), state_group(state), drive_group(drive))
    work = np.diff(solid.starts[:, 1]) * solid.substeps
    parts = np.argsort(-work, kind="stable").astype(np.int32)  # the most work first, so that threads end together
    largest = int(parts[0])
    threads = most_threads(_triangles(solid, largest), TRIANGLES_PER_THREAD, spared)
    if threads > 1 and 2 * work[largest] > work.sum():  # all others would have to wait for it in the end
        _advance_largest(kernels, largest, threads, solid, drive, packs)
        parts = parts[1:]
    if len(parts):
        _advance_each(kernels, parts, packs)


def _advance_each(kernels: Kernels, parts: NDArray[np.int32], packs: list[Any]) -> None:
    """Advance parts, each on one thread: which takes the next one when it is done with one."""
    kernels.advance(min(allowed_threads(), len(parts)), np.zeros(1, dtype=np.int32), parts, *packs)


def _advance_largest(kernels: Kernels, part: int, most: int, solid: Solid, drive: Drive, packs: list[Any]) -> None:
    """Advance a large part on one thread or on as many as it may have at most."""
    triangles, ticks = _triangles(solid, part), len(drive.first_particles) - 1

    def launch(threads: int) -> float:
        if threads > 1:
            _advance_shared(kernels, part, threads, solid, ticks, packs)
        else:
            _advance_each(kernels, np.array([part], dtype=np.int32), packs)
        return float(triangles * solid.substeps[part] * ticks)

    launch_faster(launch, threads=most, kernel="one part", triangles=triangles)


def _advance_shared(kernels: Kernels, part: int, threads: int, solid: Solid, ticks: int, packs: list[Any]) -> None:
    highest = np.zeros(ticks, dtype=np.float32)
    counters = share_counters(threads, int(solid.substeps[part]), ticks)
    kernels.advance_shared(part, threads, counters, highest, *packs)


def _triangles(solid: Solid, part: int) -> int:
    """Triangles of a part, in whole blocks."""
    return LANES * int(solid.starts[part + 1, 1] - solid.starts[part, 1])


def _internal_forces(solid: Solid, arrays: tuple[NDArray[Any], ...]) -> None:
    taichi_runtime.compiled(_kernels).forces(solid.corners.ravel(), solid.elements, *arrays)
