# mypy: ignore-errors
"""The Taichi kernel of bodies that touch: boundary vertices are kept out of the boundary edges of other parts.

Every part takes its own steps through a tick, parts that touch the same number of them side by side; after each they
are put apart. From pairs that are too near, velocities and positions are projected along the edge's normal, so that
momentum stays. Friction acts on what slides along the edge.

Several threads share the work of each phase in pieces and meet after it, as in ``kernels.advance_together``; contacts
are found and put apart by one of them. The result is the same to the last bit with any number of threads.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any, NamedTuple

from ..solver import TICK, Drive, Solid, State, WindTable, array_types, build_functions
from .functions import ContactOptions, build_contact_functions
from .phases import build_contact_phases
from .search import build_contact_search
from .surface import CONTACTS, GOOD_FOR, LEFT, STEPS, TOUCHING, ContactSurface
from .team import FREE, Team

__all__ = ["build_contact_kernel"]

_LAST_PASSES = 4  # at the end of a tick; within it one a step is enough
_LEAST_INTERVALS = 4  # for which a list of contacts has to do


class _Scene(NamedTuple):
    """All that the kernel works on."""

    solid: Any
    state: Any
    drive: Any
    pairs: Any
    surface: Any
    options: Any
    team: Any
    thread: Any
    threads: Any


def build_contact_kernel(ti: Any) -> Any:
    """The kernel, compiled for Taichi's present program when first launched."""
    types, functions, contact = array_types(ti), build_functions(ti), build_contact_functions(ti)
    searching = build_contact_search(ti, contact)
    phases_of_tick = build_contact_phases(ti, functions, contact, searching)
    put_apart, substeps_at = contact.put_apart, functions.substeps_at
    give, wait_for, is_large = phases_of_tick.give, phases_of_tick.wait_for, phases_of_tick.is_large
    advance_free = phases_of_tick.advance_free
    step_together, move_large = phases_of_tick.step_together, phases_of_tick.move_large
    search_together, record_together = phases_of_tick.search_together, phases_of_tick.record_together

    @ti.func
    def settle_tick(tick: ti.i32, scene: ti.template()):
        """Choose the steps of every part in a tick, and into how many intervals it is cut: none if nothing touches.

        Parts that touch take as many as the stiffest of them.
        """
        solid, surface, team = ti.static(scene.solid, scene.surface, scene.team)
        intervals, most = 0, 0
        for part in range(solid.substeps.shape[0]):
            count = substeps_at(ti.atomic_max(team.highest[tick, part], 0.0), solid.substeps[part])
            surface.activity[part][STEPS] = count
            if surface.activity[part][TOUCHING] > 0:
                most = ti.max(most, count)
            if is_large(part, solid) or surface.activity[part][TOUCHING] > 0:
                intervals = ti.max(intervals, count)
                team.steps[tick, part] = count
            else:
                team.steps[tick, part] = 0 - count
        # A part that stood still in many steps of a stiffer one would be pushed into it by each of them, and give back
        # more than it got.
        for part in range(solid.substeps.shape[0]):
            if surface.activity[part][TOUCHING] > 0:
                surface.activity[part][STEPS] = most
                team.steps[tick, part] = most
        busy = 0
        for piece in range(team.blocks.shape[0]):
            busy = busy + ti.cast(team.steps[tick, team.blocks[piece][0]] > 0, ti.i32)
        team.steps[tick, solid.substeps.shape[0]] = intervals
        team.steps[tick, solid.substeps.shape[0] + 1] = busy
        surface.memory[LEFT] = ti.max(surface.memory[GOOD_FOR], _LEAST_INTERVALS * TICK / ti.max(intervals, 1))

    @ti.func
    def wait_for_free(tick: ti.i32, scene: ti.template()):
        """Wait for the parts that touch nothing."""
        wait_for(scene.team.claims, FREE, (tick + 1) * scene.team.order.shape[0])

    @ti.func
    def see_to_contacts(tick: ti.i32, interval: ti.i32, intervals: ti.i32, scene: ti.template()):
        """Put apart what an interval's steps brought too near, and look for contacts where it is due."""
        solid, state, surface, options = ti.static(scene.solid, scene.state, scene.surface, scene.options)
        dt = TICK / intervals
        if intervals > 1:
            put_apart(surface, solid, state, options, interval, intervals, 1)
        surface.memory[LEFT] = surface.memory[LEFT] - dt
        # The search at the end of the tick is soon enough for a list that is good until the last interval.
        if interval + 2 < intervals and surface.memory[LEFT] < 0.5 * dt:
            wait_for_free(tick, scene)
            searching.find_contacts(surface, solid, state, options, TICK - (interval + 1) * dt)
            surface.memory[LEFT] = ti.max(surface.memory[GOOD_FOR], _LEAST_INTERVALS * dt)

    @ti.func
    def begin_end(tick: ti.i32, scene: ti.template()):
        """Begin the search at the end of a tick."""
        wait_for_free(tick, scene)
        for part in range(scene.surface.activity.shape[0]):
            scene.surface.activity[part][TOUCHING] = 0
        searching.begin_search(scene.surface, scene.solid, scene.state, scene.options, TICK)

    @ti.func
    def end_tick(tick: ti.i32, scene: ti.template()):
        """Put apart what is too near at the end of a tick, and settle the next one, if there is one.

        At the end of tick -1, before the first one of all, contacts are found.
        """
        surface, solid, state, options = ti.static(scene.surface, scene.solid, scene.state, scene.options)
        if tick >= 0:
            searching.end_search(surface, options)
            # A frame may follow, in which nothing shall be inside anything.
            put_apart(surface, solid, state, options, 0, 1, _LAST_PASSES)
        elif surface.memory[CONTACTS] < 0.0:
            searching.find_contacts(surface, solid, state, options, TICK)
        if tick + 1 < scene.team.highest.shape[0]:
            settle_tick(tick + 1, scene)

    @ti.func
    def work_together(scene: ti.template()):
        """What every thread does: whoever is awake works, and all meet where one phase builds on another.

        What is one thread's business is that of the one that did the last piece before it.
        """
        team = ti.static(scene.team)
        blocks, large = team.blocks.shape[0], team.large.shape[0]
        phase, due, parts = 1, 0, team.order.shape[0]
        for tick in range(-1, team.highest.shape[0]):  # at first only the plan of tick 0
            if tick >= 0:
                intervals, busy = team.steps[tick, parts], team.steps[tick, parts + 1]
                if advance_free(phase, tick, scene) and intervals == 0:
                    begin_end(tick, scene)
                    give(team)
                phase += 1
                for interval in range(intervals):
                    due += busy
                    last = step_together(phase, due, tick, interval, intervals, scene)
                    if large > 0:
                        wait_for(team.claims, 0, due)
                        due += large
                        last = move_large(phase + 1, due, tick, interval, intervals, scene)
                    if last:
                        see_to_contacts(tick, interval, intervals, scene)
                        if interval + 1 == intervals:
                            begin_end(tick, scene)
                        give(team)
                    due += 1
                    wait_for(team.claims, 0, due)
                    phase += 2
                if intervals == 0:
                    due += 1
                    wait_for(team.claims, 0, due)
            due += ti.max(blocks, searching.pieces(scene.surface))
            if search_together(phase, due, tick, scene):
                end_tick(tick, scene)
                give(team)
            due += 1
            wait_for(team.claims, 0, due)
            phase += 1
        record_together(phase, team.highest.shape[0] - 1, scene)

    @ti.kernel
    def advance_touching(
        threads: ti.i32,
        blocks: types.pairs,
        vertex_pieces: types.pairs,
        large_pieces: types.pairs,
        part_order: types.integers,
        claims: types.integers,
        highest: types.scalars2,
        tick_steps: types.integers2,
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
        neighbours: types.pairs,
        edge_parts: types.integers,
        bodies: types.integers,
        measures: types.vectors,
        boxes: types.vectors4,
        first_overlaps: types.integers,
        overlap_parts: types.integers,
        overlaps: types.scalars,
        heads: types.integers,
        order: types.pairs,
        middles: types.vectors4,
        candidate_ranges: types.pairs,
        candidates: types.integers,
        places: types.vectors,
        marks: types.vectors4,
        found: types.integers,
        contacts: types.pairs,
        contact_data: types.vectors4,
        activity: types.pairs,
        memory: types.scalars,
        friction: ti.f32,
        thickness: ti.f32,
        within: ti.i32,
    ):
        ti.loop_config(block_dim=1)
        for thread in range(threads):
            work_together(
                ti.static(
                    _Scene(
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
                        ),
                        State(u, v, push, decay, corner_forces, records),
                        Drive(
                            rig_leads,
                            rig_rates,
                            first_particles,
                            particles,
                            kinds,
                            (gravity_x, gravity_y),
                            WindTable(wind, waves, phases),
                        ),
                        pairs,
                        ContactSurface(
                            points,
                            point_parts,
                            edges,
                            neighbours,
                            edge_parts,
                            bodies,
                            measures,
                            boxes,
                            first_overlaps,
                            overlap_parts,
                            overlaps,
                            heads,
                            order,
                            middles,
                            candidate_ranges,
                            candidates,
                            places,
                            marks,
                            found,
                            contacts,
                            contact_data,
                            activity,
                            memory,
                        ),
                        ContactOptions(friction, thickness, within),
                        Team(blocks, vertex_pieces, large_pieces, part_order, claims, highest, tick_steps),
                        thread,
                        threads,
                    )
                )
            )

    return advance_touching
