# mypy: ignore-errors
"""The Taichi kernels: semi-implicit Euler for fixed corotated triangles under flow particles and rig points.

The unit is a tick (``Drive.tick_length``). At its start the external acceleration of every vertex is evaluated and the
step is chosen; then follow whole substeps: forces of all triangles, then velocities and positions of all vertices.
One launch runs several ticks. Connected parts do not feel each other: each takes its own steps, on a thread of its own,
or a large one on several (``shares``).
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any, NamedTuple

import taichi as ti

from .arguments import PackedArguments, argument_packs, array_types
from .elastic_functions import add_forces, planned_steps
from .external_functions import begin_vertices
from .kernel_functions import record, take_step
from .kernel_types import any_value
from .shares import Shared, advance_share

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


@ti.func
def advance_part(part: ti.i32, solid: any_value, state: any_value, drive: any_value):
    """All ticks of a launch for one part."""
    first, end = solid.starts[part][0], solid.starts[part + 1][0]
    for tick in range(drive.first_particles.shape[0] - 1):
        count = planned_steps(part, solid, state)
        begin_vertices(first, end, tick, count, solid, state, drive)
        for step in range(count):
            take_step(part, tick, step, count, solid, state, drive)
        record(first, end, tick, state, drive)


def build_kernels() -> Kernels:
    """The kernels, compiled for Taichi's present program when first launched."""
    types, packs = array_types(ti), argument_packs(ti)

    @ti.kernel
    def advance(
        threads: ti.i32,
        claimed: types.integers,
        parts: types.integers,
        solid: packs.solid,
        state: packs.state,
        drive: packs.drive,
    ):
        ti.loop_config(block_dim=1)
        for _ in range(threads):
            n = ti.atomic_add(claimed[0], 1)
            while n < parts.shape[0]:
                advance_part(parts[n], solid, state, drive)
                n = ti.atomic_add(claimed[0], 1)

    @ti.kernel
    def advance_shared(
        part: ti.i32,
        threads: ti.i32,
        counters: types.integers,
        highest: types.scalars,
        solid: packs.solid,
        state: packs.state,
        drive: packs.drive,
    ):
        ti.loop_config(block_dim=1)
        for me in range(threads):
            advance_share(part, me, threads, ti.static(Shared(solid, state, drive, counters, highest)))

    @ti.kernel
    def forces(corners: types.integers, elements: types.blocks, u: types.vectors, corner_forces: types.pair_blocks):
        ti.loop_config(serialize=True)
        for n in range(elements.shape[0]):
            elastic = ti.static(_Elastic(corners, elements, u, corner_forces))
            add_forces(elastic, elastic, n)

    packed = PackedArguments(packs.solid, packs.state, packs.drive)
    return Kernels(advance, advance_shared, packed, forces)
