"""The solver: launches of the kernels on arrays of the bodies, their state and what drives them.

The state is the displacement u = x - X rather than the position, so that F = I + grad u keeps its digits in float32.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..runtime import LANES, aligned, check_aligned, taichi_runtime
from .arguments import drive_group, solid_group, state_group
from .arrays import CALM, Drive, Solid, State, WindTable
from .kernels import build_kernels

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


def _advance(solid: Solid, state: State, drive: Drive) -> None:
    kernels = taichi_runtime.compiled(build_kernels)
    work = np.diff(solid.starts[:, 1]) * solid.substeps
    parts = np.argsort(-work, kind="stable").astype(np.int32)  # the most work first, so that threads end together
    kernels.advance(parts, *kernels.packed(solid_group(solid), state_group(state), drive_group(drive)))


def _internal_forces(solid: Solid, arrays: tuple[NDArray[Any], ...]) -> None:
    taichi_runtime.compiled(build_kernels).forces(solid.corners, solid.elements, *arrays)
