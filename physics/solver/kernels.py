# mypy: ignore-errors
"""The Taichi kernels: semi-implicit Euler for fixed corotated triangles under flow particles and rig points.

The unit is a tick (``stepping.TICK``). At its start the external acceleration of every vertex is evaluated and the
step is chosen; then follow whole substeps: forces of all triangles, then velocities and positions of all vertices.
One launch runs several ticks. Connected parts do not feel each other: each takes its own steps, on a thread of its own,
or a large one on several (``sharing``).
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any, NamedTuple

from .arguments import PackedArguments, argument_packs, array_types
from .kernel_functions import build_functions
from .sharing import build_advance_shared

__all__ = ["Kernels", "build_kernels"]


class Kernels(NamedTuple):
    """What ``build_kernels`` makes."""

    advance: Any
    advance_shared: Any
    packed: PackedArguments
    forces: Any


class _Elastic(NamedTuple):
    """The arrays that forces depend on, as if of a solid and its state."""

    corners: Any
    elements: Any
    displacement: Any
    corner_forces: Any


def build_kernels(ti: Any) -> Kernels:
    """The kernels, compiled for Taichi's present program when first launched."""
    types, packs, functions = array_types(ti), argument_packs(ti), build_functions(ti)
    planned_steps, begin_tick, take_step = functions.planned_steps, functions.begin_tick, functions.take_step
    add_forces, record = functions.add_forces, functions.record

    @ti.func
    def advance_part(part: ti.i32, solid: ti.template(), state: ti.template(), drive: ti.template()):
        for tick in range(drive.first_particles.shape[0] - 1):
            count = planned_steps(part, solid, state)
            begin_tick(part, tick, count, solid, state, drive)
            for step in range(count):
                take_step(part, tick, step, count, solid, state, drive)
            record(solid.starts[part][0], solid.starts[part + 1][0], tick, state, drive)

    @ti.kernel
    def advance(parts: types.integers, solid: packs.solid, state: packs.state, drive: packs.drive):
        ti.loop_config(block_dim=1)
        for n in range(parts.shape[0]):
            advance_part(parts[n], solid, state, drive)

    @ti.kernel
    def forces(corners: types.index_blocks, elements: types.blocks, u: types.vectors, corner_forces: types.pair_blocks):
        ti.loop_config(serialize=True)
        for n in range(corners.shape[0]):
            elastic = ti.static(_Elastic(corners, elements, u, corner_forces))
            add_forces(elastic, elastic, n)

    shared = build_advance_shared(ti, types, packs, functions)
    return Kernels(advance, shared, PackedArguments(packs.solid, packs.state, packs.drive), forces)
