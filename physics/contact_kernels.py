# mypy: ignore-errors
"""The Taichi kernel of bodies that touch: boundary vertices are kept out of the boundary edges of other parts.

Parts that may touch go through a tick in the same intervals, at whose ends they are put apart; the others take their
own steps. From pairs that are too near, velocities and positions are projected along the edge's normal, so that
momentum stays. Friction acts on what slides along the edge.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any

from .contact_functions import ContactOptions, build_contact_functions
from .contact_surface import ContactSurface
from .kernel_functions import build_functions
from .kernels import array_types
from .solver_arrays import Drive, Solid, State, WindTable
from .stepping import TICK

__all__ = ["build_contact_kernel"]

_LAST_PASSES = 4  # at the end of a tick; within it one a step is enough
_LIST_INTERVALS = 4  # for which a list of contacts is good
_STEPS_BETWEEN = 1  # most substeps of the stiffest part from one interval to the next


def build_contact_kernel(ti: Any) -> Any:
    """The kernel, compiled for Taichi's present program when first launched."""
    types, functions, contact = array_types(ti), build_functions(ti), build_contact_functions(ti)
    add_forces, highest_frequency, substeps_at = (
        functions.add_forces,
        functions.highest_frequency,
        functions.substeps_at,
    )
    begin_tick, move = functions.begin_tick, functions.move
    find_contacts, put_apart = contact.find_contacts, contact.put_apart
    pairs4 = ti.types.ndarray(dtype=ti.types.vector(4, ti.i32), ndim=1)

    @ti.func
    def plan_tick(
        tick: ti.i32, solid: ti.template(), state: ti.template(), drive: ti.template(), surface: ti.template()
    ):
        """Choose the steps of every part and begin its tick; returns the intervals of the parts that may touch."""
        most = 1
        for part in range(solid.substeps.shape[0]):
            squared = highest_frequency(solid, state, solid.starts[part][1], solid.starts[part + 1][1])
            count = substeps_at(squared, solid.substeps[part])
            surface.steps[part, 0], surface.steps[part, 1] = count, count
            if surface.touching[part] == 1:
                most = ti.max(most, count)
        intervals = (most + _STEPS_BETWEEN - 1) // _STEPS_BETWEEN
        for part in range(solid.substeps.shape[0]):
            if surface.touching[part] == 1:
                surface.steps[part, 0] = (surface.steps[part, 0] + intervals - 1) // intervals
                surface.steps[part, 1] = surface.steps[part, 0] * intervals
            for i in range(solid.starts[part][0], solid.starts[part + 1][0]):
                begin_tick(i, tick, TICK / surface.steps[part, 1], solid, state, drive)
        return intervals

    @ti.func
    def advance_interval(
        tick: ti.i32,
        interval: ti.i32,
        solid: ti.template(),
        state: ti.template(),
        drive: ti.template(),
        pairs: ti.template(),
        surface: ti.template(),
    ):
        """The substeps of all parts in an interval; those that touch nothing take all of a tick's in the first."""
        for part in range(solid.substeps.shape[0]):
            steps, count = surface.steps[part, 0], surface.steps[part, 1]
            taken = interval * steps
            if taken < count:
                for step in range(taken, taken + steps):
                    for n in range(solid.starts[part][1], solid.starts[part + 1][1]):
                        add_forces(solid, state, n)
                    for i in range(solid.starts[part][0], solid.starts[part + 1][0]):
                        move(i, tick, step, count, solid, state, drive, pairs)

    @ti.func
    def advance_tick(
        tick: ti.i32,
        solid: ti.template(),
        state: ti.template(),
        drive: ti.template(),
        pairs: ti.template(),
        surface: ti.template(),
        options: ti.template(),
    ):
        intervals = plan_tick(tick, solid, state, drive, surface)
        dt = TICK / intervals
        if surface.memory[1] < 0.0:
            find_contacts(surface, solid, state, options, TICK)
        for interval in range(intervals):
            # A list holds for some intervals; the last tick's own is good for the first ones.
            if interval > 0 and interval % _LIST_INTERVALS == 0:
                find_contacts(surface, solid, state, options, dt * ti.min(_LIST_INTERVALS, intervals - interval))
            advance_interval(tick, interval, solid, state, drive, pairs, surface)
            if intervals > 1:
                put_apart(surface, solid, state, options, dt, 1)
        # A frame may follow, in which nothing shall be inside anything.
        for part in range(surface.touching.shape[0]):
            surface.touching[part] = 0
        find_contacts(surface, solid, state, options, TICK)
        put_apart(surface, solid, state, options, dt, _LAST_PASSES)

    @ti.kernel
    def advance_touching(
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
        u: types.vectors,
        v: types.vectors,
        push: types.vectors,
        decay: types.scalars,
        corner_forces: types.pair_blocks,
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
        points: types.integers,
        point_parts: types.integers,
        edges: types.pairs,
        neighbours: types.pairs,
        edge_parts: types.integers,
        bodies: types.integers,
        spacing: types.scalars,
        first_overlaps: types.integers,
        overlap_parts: types.integers,
        overlaps: types.scalars,
        heads: types.integers,
        order: types.integers,
        first_candidates: types.integers,
        candidates: types.integers,
        contacts: pairs4,
        contact_data: types.vectors4,
        touching: types.integers,
        steps: types.integers2,
        memory: types.scalars,
        friction: ti.f32,
        thickness: ti.f32,
        within: ti.i32,
    ):
        ti.loop_config(serialize=True)
        for tick in range(first_particles.shape[0] - 1):
            advance_tick(
                tick,
                ti.static(
                    Solid(starts, planned, vertices, reach, leaders, grips, corners, elements, first_slots, slots)
                ),
                ti.static(State(u, v, push, decay, corner_forces)),
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
                ti.static(
                    ContactSurface(
                        points,
                        point_parts,
                        edges,
                        neighbours,
                        edge_parts,
                        bodies,
                        spacing,
                        first_overlaps,
                        overlap_parts,
                        overlaps,
                        heads,
                        order,
                        first_candidates,
                        candidates,
                        contacts,
                        contact_data,
                        touching,
                        steps,
                        memory,
                    )
                ),
                ti.static(ContactOptions(friction, thickness, within)),
            )

    return advance_touching
