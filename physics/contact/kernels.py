# mypy: ignore-errors
"""The Taichi kernel of bodies that touch: boundary vertices are kept out of the boundary edges of other parts.

A tick is cut into intervals, as many as the stiffest of the parts that touch needs substeps. After each of them
contacts are resolved: positions and velocities of a vertex and an edge that are too near are projected along the edge's
normal, so that momentum stays, with Coulomb friction along the edge. Parts that touch nothing go through the tick on
their own. At its end contacts are searched for.

All of it runs on one thread. Threads that share the parts have to meet after every substep: measured on two cores, the
example's four bodies then took 1.1 times as long, and four blobs that pile up as long as on one.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any, NamedTuple

from ..solver import TICK, PackedArguments, argument_packs, array_types, build_functions
from .functions import build_contact_functions
from .search import build_contact_search
from .surface import CONTACTS, NEXT_STEPS, STEPPING, STEPS, TOUCHING, VALID_FOR, VALID_LEFT

__all__ = ["ContactKernel", "build_contact_kernel"]

_LAST_PASSES = 4  # over all contacts at the end of a tick; within it one after each step is enough
_LEAST_INTERVALS = 4  # from one search to the next within a tick
# Blocks of triangles of a part that steps in intervals even while it touches nothing, so that a search within the tick
# finds it where it is at that time; smaller ones go through the tick at once, in which they stay in the cache.
_LARGE = 93


class _Scene(NamedTuple):
    """All that the kernel works on."""

    solid: Any
    state: Any
    drive: Any
    surface: Any
    options: Any


class ContactKernel(NamedTuple):
    """What ``build_contact_kernel`` makes."""

    advance: Any
    packed: PackedArguments


def build_contact_kernel(ti: Any) -> ContactKernel:
    """The kernel, compiled for Taichi's present program when first launched."""
    packs, surface_pack = argument_packs(ti), _surface_pack(ti)
    options_pack = ti.types.argpack(friction=ti.f32, thickness=ti.f32, self_contact=ti.i32)
    functions, contact = build_functions(ti), build_contact_functions(ti)
    find_contacts = build_contact_search(ti, contact)
    resolve_contacts, steps_in = contact.resolve_contacts, contact.steps_in
    planned_steps, begin_tick = functions.planned_steps, functions.begin_tick
    take_step, record = functions.take_step, functions.record

    @ti.func
    def plan_steps(scene: ti.template()):
        """How many substeps every part needs in the next tick by itself."""
        for part in range(scene.solid.substeps.shape[0]):
            scene.surface.activity[part][NEXT_STEPS] = planned_steps(part, scene.solid, scene.state)

    @ti.func
    def settle_steps(scene: ti.template()):
        """Choose the substeps of every part in a tick; returns the intervals of the tick, 0 if nothing touches.

        Parts that touch take as many as the stiffest of them: one that stood still in many steps of a stiffer one would
        be pushed into it by each of them, and give back more than it got.
        """
        activity, memory, starts = ti.static((scene.surface.activity, scene.surface.memory, scene.solid.starts))
        intervals, most = 0, 0
        for part in range(scene.solid.substeps.shape[0]):
            activity[part][STEPS] = activity[part][NEXT_STEPS]
            activity[part][STEPPING] = activity[part][TOUCHING]
            if activity[part][TOUCHING] > 0:
                most = ti.max(most, activity[part][STEPS])
            if starts[part + 1][1] - starts[part][1] >= _LARGE:
                activity[part][STEPPING] = 1
            if activity[part][STEPPING] > 0:
                intervals = ti.max(intervals, activity[part][STEPS])
        for part in range(scene.solid.substeps.shape[0]):
            if activity[part][TOUCHING] > 0:
                activity[part][STEPS] = most
        memory[VALID_LEFT] = ti.max(memory[VALID_FOR], _LEAST_INTERVALS * TICK / ti.max(intervals, 1))
        return intervals

    @ti.func
    def advance_free(tick: ti.i32, scene: ti.template()):
        """Begin the tick of all parts, and take those that touch nothing through it."""
        solid, state, drive, activity = ti.static((scene.solid, scene.state, scene.drive, scene.surface.activity))
        for part in range(solid.substeps.shape[0]):
            count = activity[part][STEPS]
            begin_tick(part, tick, count, solid, state, drive)
            if activity[part][STEPPING] == 0:
                for step in range(count):
                    take_step(part, tick, step, count, solid, state, drive)

    @ti.func
    def advance_interval(tick: ti.i32, interval: ti.i32, intervals: ti.i32, scene: ti.template()):
        """At most one step of every part that steps, after which contacts are resolved, and searched for if due."""
        solid, state, surface, options = ti.static((scene.solid, scene.state, scene.surface, scene.options))
        for part in range(solid.substeps.shape[0]):
            count = surface.activity[part][STEPS]
            if surface.activity[part][STEPPING] > 0 and steps_in(interval, intervals, count) > 0:
                step = interval * count // intervals
                take_step(part, tick, step, count, solid, state, scene.drive)
        dt = TICK / intervals
        if intervals > 1:
            resolve_contacts(surface, solid, state, options, interval, intervals, 1)
        surface.memory[VALID_LEFT] = surface.memory[VALID_LEFT] - dt
        # The search at the end of the tick is soon enough for a list that is good until the last interval.
        if interval + 2 < intervals and surface.memory[VALID_LEFT] < 0.5 * dt:
            find_contacts(surface, solid, state, options, TICK - (interval + 1) * dt)
            surface.memory[VALID_LEFT] = ti.max(surface.memory[VALID_FOR], _LEAST_INTERVALS * dt)

    @ti.func
    def end_tick(scene: ti.template()):
        """Find out which parts touch in the next tick, and leave nothing inside anything: a frame may follow."""
        surface, solid, state, options = ti.static((scene.surface, scene.solid, scene.state, scene.options))
        for part in range(surface.activity.shape[0]):
            surface.activity[part][TOUCHING] = 0
        find_contacts(surface, solid, state, options, TICK)
        resolve_contacts(surface, solid, state, options, 0, 1, _LAST_PASSES)

    @ti.func
    def advance(scene: ti.template()):
        """All ticks of a launch."""
        ticks, parts = scene.drive.first_particles.shape[0] - 1, scene.solid.substeps.shape[0]
        plan_steps(scene)
        if scene.surface.memory[CONTACTS] < 0.0:
            find_contacts(scene.surface, scene.solid, scene.state, scene.options, TICK)
        for tick in range(ticks):
            intervals = settle_steps(scene)
            advance_free(tick, scene)
            for interval in range(intervals):
                advance_interval(tick, interval, intervals, scene)
            plan_steps(scene)
            end_tick(scene)
            record(0, scene.solid.starts[parts][0], tick, scene.state, scene.drive)

    @ti.kernel
    def advance_touching(
        solid: packs.solid, state: packs.state, drive: packs.drive, surface: surface_pack, options: options_pack
    ):
        ti.loop_config(block_dim=1)
        for _ in range(1):  # the outermost loop would be spread over threads
            advance(ti.static(_Scene(solid, state, drive, surface, options)))

    return ContactKernel(
        advance_touching, PackedArguments(packs.solid, packs.state, packs.drive, surface_pack, options_pack)
    )


def _surface_pack(ti: Any) -> Any:
    """The type of the pack of ``ContactSurface``."""
    types = array_types(ti)
    return ti.types.argpack(
        points=types.integers,
        point_parts=types.integers,
        edges=types.pairs,
        neighbours=types.pairs,
        edge_parts=types.integers,
        bodies=types.integers,
        measures=types.vectors,
        boxes=types.vectors4,
        first_overlaps=types.integers,
        overlap_parts=types.integers,
        overlaps=types.scalars,
        heads=types.integers,
        order=types.pairs,
        middles=types.vectors4,
        candidate_ranges=types.pairs,
        candidates=types.integers,
        positions=types.vectors,
        listed=types.vectors4,
        contact_counts=types.integers,
        contacts=types.pairs,
        contact_data=types.vectors4,
        activity=types.integers4,
        memory=types.scalars,
    )
