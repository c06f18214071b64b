# mypy: ignore-errors
"""The Taichi kernels: semi-implicit Euler for fixed corotated triangles under flow particles and rig points.

The unit is a tick (``stepping.TICK``). At its start the external acceleration of every vertex is evaluated and the
step is chosen; then follow whole substeps: forces of all triangles, then velocities and positions of all vertices.
One launch runs several ticks. Connected parts do not feel each other: each takes its own steps, on a thread of its own.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any, NamedTuple

from ..runtime import LANES
from .arrays import Drive, Solid, State, WindTable
from .kernel_functions import build_functions

__all__ = ["Kernels", "array_types", "build_kernels"]


class Kernels(NamedTuple):
    """What ``build_kernels`` makes."""

    advance: Any
    forces: Any


class _Elastic(NamedTuple):
    """The arrays that forces depend on, as if of a solid and its state."""

    corners: Any
    elements: Any
    displacement: Any
    corner_forces: Any


class ArrayTypes(NamedTuple):
    """Types of the kernels' arguments."""

    scalars: Any
    scalars2: Any
    scalars3: Any
    integers: Any
    integers4: Any
    vectors: Any
    vectors2: Any
    vectors4: Any
    pairs: Any
    index_blocks: Any
    blocks: Any
    pair_blocks: Any


def array_types(ti: Any) -> ArrayTypes:
    """Arrays as the kernels see them.

    Elements are vectors of 2, 4 or 16 only: those of 3 or 6 numbers do not lie one behind the other in the compiler's
    eyes.
    """
    array, vector = ti.types.ndarray, ti.types.vector
    return ArrayTypes(
        scalars=array(dtype=ti.f32, ndim=1),
        scalars2=array(dtype=ti.f32, ndim=2),
        scalars3=array(dtype=ti.f32, ndim=3),
        integers=array(dtype=ti.i32, ndim=1),
        integers4=array(dtype=vector(4, ti.i32), ndim=1),
        vectors=array(dtype=vector(2, ti.f32), ndim=1),
        vectors2=array(dtype=vector(2, ti.f32), ndim=2),
        vectors4=array(dtype=vector(4, ti.f32), ndim=1),
        pairs=array(dtype=vector(2, ti.i32), ndim=1),
        index_blocks=array(dtype=vector(LANES, ti.i32), ndim=2),
        blocks=array(dtype=vector(LANES, ti.f32), ndim=2),
        pair_blocks=array(dtype=vector(2 * LANES, ti.f32), ndim=2),
    )


def build_kernels(ti: Any) -> Kernels:
    """The kernels, compiled for Taichi's present program when first launched."""
    types, functions = array_types(ti), build_functions(ti)
    planned_steps, begin_tick, take_step = functions.planned_steps, functions.begin_tick, functions.take_step
    add_forces, record = functions.add_forces, functions.record

    @ti.func
    def advance_part(
        part: ti.i32, solid: ti.template(), state: ti.template(), drive: ti.template(), pairs: ti.template()
    ):
        for tick in range(drive.first_particles.shape[0] - 1):
            count = planned_steps(part, solid, state)
            begin_tick(part, tick, count, solid, state, drive)
            for step in range(count):
                take_step(part, tick, step, count, solid, state, drive, pairs)
            record(solid.starts[part][0], solid.starts[part + 1][0], tick, state, drive)

    @ti.kernel
    def advance(
        parts: types.integers,
        starts: types.pairs,
        planned: types.integers,
        vertices: types.vectors4,
        reach: types.scalars,
        leaders: types.integers,
        grips: types.scalars,
        corners: types.index_blocks,
        elements: types.blocks,
        first_slots: types.integers,
        slots: types.integers,
        anchors: types.integers,
        tethers: types.scalars,
        wind_response: types.scalars,
        u: types.vectors,
        v: types.vectors,
        push: types.vectors,
        decay: types.scalars,
        corner_forces: types.pair_blocks,
        records: types.vectors2,
        pairs: types.vectors,
        rig_leads: types.scalars3,
        rig_rates: types.scalars3,
        first_particles: types.integers,
        particles: types.scalars2,
        kinds: types.integers,
        gravity_x: ti.f32,
        gravity_y: ti.f32,
        wind: types.vectors,
        waves: types.vectors4,
        phases: types.scalars2,
    ):
        ti.loop_config(block_dim=1)
        for n in range(parts.shape[0]):
            advance_part(
                parts[n],
                ti.static(
                    Solid(
                        starts,
                        planned,
                        vertices,
                        reach,
                        leaders,
                        grips,
                        corners,
                        elements,
                        first_slots,
                        slots,
                        anchors,
                        tethers,
                        wind_response,
                    )
                ),
                ti.static(State(u, v, push, decay, corner_forces, records)),
                ti.static(
                    Drive(
                        rig_leads,
                        rig_rates,
                        first_particles,
                        particles,
                        kinds,
                        (gravity_x, gravity_y),
                        WindTable(wind, waves, phases),
                    )
                ),
                pairs,
            )

    @ti.kernel
    def forces(corners: types.index_blocks, elements: types.blocks, u: types.vectors, corner_forces: types.pair_blocks):
        ti.loop_config(serialize=True)
        for n in range(corners.shape[0]):
            elastic = ti.static(_Elastic(corners, elements, u, corner_forces))
            add_forces(elastic, elastic, n)

    return Kernels(advance, forces)
