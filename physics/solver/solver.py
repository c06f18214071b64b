"""The solver: launches of the kernels on arrays of the bodies, their state and what drives them.

The state is the displacement u = x - X rather than the position, so that F = I + grad u keeps its digits in float32.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..runtime import LANES, aligned, check_aligned, taichi_runtime
from .arguments import drive_group, solid_group, state_group
from .arrays import CALM, Drive, Solid, State, WindTable
from .pace import launch_faster, most_threads, share_counters

if TYPE_CHECKING:
    from .kernels import Kernels

__all__ = ["CALM", "Drive", "Solid", "State", "WindTable", "advance", "internal_forces"]


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


def _kernels(_taichi: Any) -> Kernels:
    from .kernels import build_kernels  # which imports Taichi

    return build_kernels()


def _advance(solid: Solid, state: State, drive: Drive) -> None:
    kernels = taichi_runtime.compiled(_kernels)
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
    """Whether a part is large enough for several threads, and all others would have to wait for it in the end."""
    return most_threads(_triangles(solid, part)) > 1 and bool(2 * work[part] > work.sum())


def _advance_largest(kernels: Kernels, part: int, solid: Solid, drive: Drive, packs: list[Any]) -> None:
    """Advance a large part on one thread or on several."""
    triangles, ticks = _triangles(solid, part), len(drive.first_particles) - 1

    def launch(threads: int) -> float:
        if threads > 1:
            _advance_shared(kernels, part, threads, solid, ticks, packs)
        else:
            kernels.advance(np.array([part], dtype=np.int32), *packs)
        return float(triangles * solid.substeps[part] * ticks)

    launch_faster(launch, threads=most_threads(triangles), kernel="one part", triangles=triangles)


def _advance_shared(kernels: Kernels, part: int, threads: int, solid: Solid, ticks: int, packs: list[Any]) -> None:
    highest = np.zeros(ticks, dtype=np.float32)
    counters = share_counters(threads, int(solid.substeps[part]), ticks)
    kernels.advance_shared(part, threads, counters, highest, *packs)


def _triangles(solid: Solid, part: int) -> int:
    """Triangles of a part, in whole blocks."""
    return LANES * int(solid.starts[part + 1, 1] - solid.starts[part, 1])


def _internal_forces(solid: Solid, arrays: tuple[NDArray[Any], ...]) -> None:
    taichi_runtime.compiled(_kernels).forces(solid.corners.ravel(), solid.elements, *arrays)
