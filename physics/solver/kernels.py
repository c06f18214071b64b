# mypy: ignore-errors
"""The Taichi kernels: semi-implicit Euler for fixed corotated triangles under flow particles and rig points.

The unit is a tick (``stepping.TICK``). At its start the external acceleration of every vertex is evaluated and the
step is chosen; then follow whole substeps: forces of all triangles, then velocities and positions of all vertices.
One launch runs several ticks. Connected parts do not feel each other: each takes its own steps.

``advance`` has a thread for a part, and several parts side by side. ``advance_together`` shares one large part among
several threads, with the same result to the last bit.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any, NamedTuple

from ..runtime import LANES
from .arrays import Drive, Solid, State, WindTable
from .kernel_functions import build_functions
from .stepping import TICK

__all__ = ["BLOCKS_AT_ONCE", "SMALL", "VERTICES_AT_ONCE", "Kernels", "array_types", "build_kernels"]

BLOCKS_AT_ONCE = 24
"""Blocks of triangles that a thread takes from the common work."""

VERTICES_AT_ONCE = 192
"""Vertices that a thread takes from the common work."""

SMALL = 0x7FFFFFF
"""Masks the ends of loops over blocks, which changes nothing but tells the compiler that 48 n fits into 32 bits."""


class Kernels(NamedTuple):
    """What ``build_kernels`` makes."""

    advance: Any
    advance_together: Any
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
    integers2: Any
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
        integers2=array(dtype=ti.i32, ndim=2),
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
    add_forces, highest_frequency, substeps_at = (
        functions.add_forces,
        functions.highest_frequency,
        functions.substeps_at,
    )
    begin_tick, move_vertices, record = functions.begin_tick, functions.move_vertices, functions.record

    @ti.func
    def advance_part(
        part: ti.i32, solid: ti.template(), state: ti.template(), drive: ti.template(), pairs: ti.template()
    ):
        first, end = solid.starts[part], solid.starts[part + 1]
        for tick in range(drive.first_particles.shape[0] - 1):
            squared = highest_frequency(solid, state, first[1] & SMALL, end[1] & SMALL)
            count = substeps_at(squared, solid.substeps[part])
            begin_tick(first[0], end[0], tick, TICK / count, solid, state, drive)
            for step in range(count):
                for n in range(first[1] & SMALL, end[1] & SMALL):
                    add_forces(solid, state, n)
                move_vertices(first[0], end[0], tick, step, count, solid, state, drive, pairs)
            record(first[0], end[0], tick, state, drive)

    @ti.func
    def share(
        work: ti.template(),
        part: ti.i32,
        tick: ti.i32,
        step: ti.i32,
        count: ti.i32,
        phase: ti.i32,
        solid: ti.template(),
        state: ti.template(),
        drive: ti.template(),
        pairs: ti.template(),
        claims: ti.template(),
        highest: ti.template(),
    ):
        """Take pieces of a phase's work until none is left; returns how many pieces the phase has for all threads.

        Whoever is awake works: a thread that the system has put aside holds up the others by one piece at most.
        """
        on_blocks = ti.static(work in ("plan", "forces"))
        at_once = ti.static(BLOCKS_AT_ONCE if on_blocks else VERTICES_AT_ONCE)
        first, end = solid.starts[part][ti.static(int(on_blocks))], solid.starts[part + 1][ti.static(int(on_blocks))]
        pieces = (end - first + at_once - 1) // at_once
        piece = ti.atomic_add(claims[1 + phase], 1)
        while piece < pieces:
            low = first + piece * at_once
            high = ti.min(low + at_once, end) & SMALL
            if ti.static(work == "plan"):
                ti.atomic_max(highest[tick], highest_frequency(solid, state, low, high))
            elif ti.static(work == "forces"):
                for n in range(low, high):
                    add_forces(solid, state, n)
            elif ti.static(work == "begin"):
                begin_tick(low, high, tick, TICK / count, solid, state, drive)
            elif ti.static(work == "record"):
                record(low, high, tick, state, drive)
            else:
                move_vertices(low, high, tick, step, count, solid, state, drive, pairs)
            ti.atomic_add(claims[0], 1)
            piece = ti.atomic_add(claims[1 + phase], 1)
        return pieces

    @ti.func
    def meet(claims: ti.template(), due: ti.i32):
        """Wait until so many pieces are done by all threads together."""
        while ti.atomic_add(claims[0], 0) < due:
            pass

    @ti.func
    def work_together(
        part: ti.i32,
        solid: ti.template(),
        state: ti.template(),
        drive: ti.template(),
        pairs: ti.template(),
        claims: ti.template(),
        highest: ti.template(),
    ):
        """What every thread does to advance a part."""
        arrays = ti.static((solid, state, drive, pairs, claims, highest))
        phase, due = 0, 0
        for tick in range(drive.first_particles.shape[0] - 1):
            due += share("plan", part, tick, 0, 1, phase, *arrays)
            meet(claims, due)
            count = substeps_at(ti.atomic_max(highest[tick], 0.0), solid.substeps[part])
            due += share("begin", part, tick, 0, count, phase + 1, *arrays)  # does not meddle with forces
            phase += 2
            for step in range(count):
                due += share("forces", part, tick, step, count, phase, *arrays)
                meet(claims, due)
                due += share("move", part, tick, step, count, phase + 1, *arrays)
                meet(claims, due)
                phase += 2
            due += share("record", part, tick, 0, count, phase, *arrays)  # all meet after the next plan
            phase += 1

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
    def advance_together(
        part: ti.i32,
        threads: ti.i32,
        claims: types.integers,
        highest: types.scalars,
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
        for _ in range(threads):
            work_together(
                part,
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
                claims,
                highest,
            )

    @ti.kernel
    def forces(corners: types.index_blocks, elements: types.blocks, u: types.vectors, corner_forces: types.pair_blocks):
        ti.loop_config(serialize=True)
        for n in range(corners.shape[0]):
            elastic = ti.static(_Elastic(corners, elements, u, corner_forces))
            add_forces(elastic, elastic, n)

    return Kernels(advance, advance_together, forces)
