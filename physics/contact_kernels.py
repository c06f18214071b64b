# mypy: ignore-errors
"""The Taichi kernel of bodies that touch: boundary vertices are kept out of the boundary edges of other parts.

Every part takes its own steps through a tick, those of parts that may touch side by side; after each they are put
apart. From pairs that are too near, velocities and positions are projected along the edge's normal, so that momentum
stays. Friction acts on what slides along the edge.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any

from .contact_functions import ContactOptions, build_contact_functions
from .contact_surface import ContactSurface
from .kernel_functions import build_functions
from .kernels import SMALL, array_types
from .solver_arrays import Drive, Solid, State, WindTable
from .stepping import TICK

__all__ = ["build_contact_kernel"]

_LAST_PASSES = 4  # at the end of a tick; within it one a step is enough
_LEAST_INTERVALS = 4  # for which a list of contacts has to do


def build_contact_kernel(ti: Any) -> Any:
    """The kernel, compiled for Taichi's present program when first launched."""
    types, functions, contact = array_types(ti), build_functions(ti), build_contact_functions(ti)
    add_forces, highest_frequency, substeps_at = (
        functions.add_forces,
        functions.highest_frequency,
        functions.substeps_at,
    )
    begin_tick, move_vertices, record = functions.begin_tick, functions.move_vertices, functions.record
    find_contacts, put_apart, steps_in = contact.find_contacts, contact.put_apart, contact.steps_in

    @ti.func
    def plan_tick(
        tick: ti.i32, solid: ti.template(), state: ti.template(), drive: ti.template(), surface: ti.template()
    ):
        """Choose the steps of every part and begin its tick; returns the intervals of the parts that may touch."""
        most = 1
        for part in range(solid.substeps.shape[0]):
            first, end = solid.starts[part], solid.starts[part + 1]
            squared = highest_frequency(solid, state, first[1] & SMALL, end[1] & SMALL)
            count = substeps_at(squared, solid.substeps[part])
            surface.steps[part] = count
            if surface.touching[part] > 0:
                surface.touching[part] = 2
                most = ti.max(most, count)
            begin_tick(first[0], end[0], tick, TICK / count, solid, state, drive)
        return most

    @ti.func
    def advance_interval(
        tick: ti.i32,
        interval: ti.i32,
        intervals: ti.i32,
        solid: ti.template(),
        state: ti.template(),
        drive: ti.template(),
        pairs: ti.template(),
        surface: ti.template(),
    ):
        """At most a step of each part that may touch; those that touch nothing take all of a tick's at once."""
        for part in range(solid.substeps.shape[0]):
            count = surface.steps[part]
            before, steps = interval * count // intervals, steps_in(interval, intervals, count)
            if surface.touching[part] < 2:
                before, steps = 0, ti.select(interval == 0, count, 0)
            first, end = solid.starts[part], solid.starts[part + 1]
            for step in range(before, before + steps):
                for n in range(first[1] & SMALL, end[1] & SMALL):
                    add_forces(solid, state, n)
                move_vertices(first[0], end[0], tick, step, count, solid, state, drive, pairs)

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
            surface.memory[3] = find_contacts(surface, solid, state, options, TICK)
        left = ti.max(surface.memory[3], _LEAST_INTERVALS * dt)  # time for which the list of contacts is good
        for interval in range(intervals):
            if left < 0.5 * dt:
                left = find_contacts(surface, solid, state, options, TICK - interval * dt)
                left = ti.max(left, _LEAST_INTERVALS * dt)
            advance_interval(tick, interval, intervals, solid, state, drive, pairs, surface)
            left = left - dt
            if intervals > 1:
                put_apart(surface, solid, state, options, interval, intervals, 1)
        # A frame may follow, in which nothing shall be inside anything.
        for part in range(surface.touching.shape[0]):
            surface.touching[part] = 0
        surface.memory[3] = find_contacts(surface, solid, state, options, TICK)
        put_apart(surface, solid, state, options, 0, 1, _LAST_PASSES)
        record(0, state.displacement.shape[0], tick, state, drive)

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
        points: types.integers,
        point_parts: types.integers,
        edges: types.pairs,
        edge_points: types.pairs,
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
        places: types.vectors,
        marks: types.vectors,
        contacts: types.pairs,
        contact_data: types.vectors4,
        speeds: types.scalars,
        touching: types.integers,
        steps: types.integers,
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
                ti.static(
                    ContactSurface(
                        points,
                        point_parts,
                        edges,
                        edge_points,
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
                        places,
                        marks,
                        contacts,
                        contact_data,
                        speeds,
                        touching,
                        steps,
                        memory,
                    )
                ),
                ti.static(ContactOptions(friction, thickness, within)),
            )

    return advance_touching
