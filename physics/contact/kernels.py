# mypy: ignore-errors
"""The Taichi kernel of bodies that touch: boundary vertices are kept out of the boundary edges of other parts.

A tick is cut into intervals, as many as the stiffest of the parts that touch needs substeps. After each of them
contacts are resolved: positions and velocities of a vertex and an edge that are too near are projected along the edge's
normal, so that momentum stays, with Coulomb friction along the edge. Parts that touch nothing go through the tick on
their own. At its end contacts are searched for.

Threads share the steps of all parts in pieces and wait for each other, as in ``solver.sharing``; one of them searches
and resolves. The result is the same to the last bit with any number of threads.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any, NamedTuple

import taichi as ti

from ..solver import TICK, PackedArguments, argument_packs, array_types
from ..solver.elastic_functions import steps_for
from ..solver.kernel_types import any_value
from ..solver.sharing import DONE, finish, wait_until
from .functions import resolve_contacts
from .phases import FREE, free_parts, in_interval, on_all_parts, search_and_plan
from .search import find_contacts
from .surface import STEPS, TOUCHING, VALID_FOR, VALID_LEFT

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
    counters: Any
    highest: Any
    steps: Any


class ContactKernel(NamedTuple):
    """What ``build_contact_kernel`` makes."""

    advance: Any
    packed: PackedArguments


@ti.func
def settle_steps(tick: ti.i32, scene: any_value):
    """Choose the substeps of every part in a tick, and its intervals, of which there are none if nothing touches.

    Parts that touch take as many as the stiffest of them: one that stood still in many steps of a stiffer one would
    be pushed into it by each of them, and give back more than it got.
    """
    solid, steps = ti.static((scene.solid, scene.steps))
    activity, memory = ti.static((scene.surface.activity, scene.surface.memory))
    intervals, most, parts = 0, 0, solid.substeps.shape[0]
    for part in range(parts):
        count = steps_for(ti.atomic_max(scene.highest[tick * parts + part], 0.0), solid.substeps[part])
        activity[part][STEPS], steps[tick, part] = count, 0 - count
        if activity[part][TOUCHING] > 0:
            most = ti.max(most, count)
        if activity[part][TOUCHING] > 0 or solid.starts[part + 1][1] - solid.starts[part][1] >= _LARGE:
            steps[tick, part] = count
            intervals = ti.max(intervals, count)
    for part in range(parts):
        if activity[part][TOUCHING] > 0:
            activity[part][STEPS], steps[tick, part] = most, most
    steps[tick, parts] = intervals
    memory[VALID_LEFT] = ti.max(memory[VALID_FOR], _LEAST_INTERVALS * TICK / ti.max(intervals, 1))


@ti.func
def end_interval(interval: ti.i32, intervals: ti.i32, free: ti.i32, scene: any_value):
    """Resolve contacts after the steps of an interval, and search for them if due."""
    solid, state, surface, options = ti.static((scene.solid, scene.state, scene.surface, scene.options))
    dt = TICK / intervals
    if intervals > 1:
        resolve_contacts(surface, solid, state, options, interval, intervals, 1)
    surface.memory[VALID_LEFT] = surface.memory[VALID_LEFT] - dt
    # The search at the end of the tick is soon enough for a list that is good until the last interval.
    if interval + 2 < intervals and surface.memory[VALID_LEFT] < 0.5 * dt:
        wait_until(FREE, free, scene)
        find_contacts(surface, solid, state, options, TICK - (interval + 1) * dt)
        surface.memory[VALID_LEFT] = ti.max(surface.memory[VALID_FOR], _LEAST_INTERVALS * dt)


@ti.func
def end_tick(tick: ti.i32, ticks: ti.i32, scene: any_value):
    """Leave nothing inside anything, since a frame may follow, and settle the next tick."""
    if tick >= 0:
        resolve_contacts(scene.surface, scene.solid, scene.state, scene.options, 0, 1, _LAST_PASSES)
    if tick + 1 < ticks:
        settle_steps(tick + 1, scene)


@ti.func
def advance_with_others(scene: any_value):
    """What every thread does. What only one may do is left to the one that has done the last piece before it."""
    ticks, parts = scene.drive.first_particles.shape[0] - 1, scene.solid.substeps.shape[0]
    phase, due, free = 0, 0, 0
    for tick in range(-1, ticks):  # tick -1 only plans the first one
        if tick >= 0:
            due += on_all_parts("begin", tick, phase, scene)
            wait_until(DONE, due, scene)
            free += free_parts(tick, phase + 1, scene)
            phase += 2
            intervals = scene.steps[tick, parts]
            for interval in range(intervals):
                forces, _ = in_interval("forces", tick, interval, intervals, phase, scene)
                due += forces
                wait_until(DONE, due, scene)
                vertices, done = in_interval("vertices", tick, interval, intervals, phase + 1, scene)
                due += vertices
                if done == due:
                    end_interval(interval, intervals, free, scene)
                    finish(DONE, scene)
                due += 1
                wait_until(DONE, due, scene)
                phase += 2
            wait_until(FREE, free, scene)
        pieces, done = search_and_plan(tick, ticks, phase, scene)
        due += pieces
        if done == due:
            end_tick(tick, ticks, scene)
            finish(DONE, scene)
        due += 1
        wait_until(DONE, due, scene)
        phase += 1
        if tick >= 0:  # the next tick begins with accelerations: nothing moves until all have recorded
            due += on_all_parts("record", tick, phase, scene)
            phase += 1


def build_contact_kernel() -> ContactKernel:
    """The kernel, compiled for Taichi's present program when first launched."""
    types, packs, surface_pack = array_types(ti), argument_packs(ti), _surface_pack()
    options_pack = ti.types.argpack(friction=ti.f32, thickness=ti.f32, self_contact=ti.i32)

    @ti.kernel
    def advance_touching(
        threads: ti.i32,
        counters: types.integers,
        highest: types.scalars,
        steps: types.integers2,
        solid: packs.solid,
        state: packs.state,
        drive: packs.drive,
        surface: surface_pack,
        options: options_pack,
    ):
        ti.loop_config(block_dim=1)
        for _ in range(threads):
            advance_with_others(ti.static(_Scene(solid, state, drive, surface, options, counters, highest, steps)))

    return ContactKernel(
        advance_touching, PackedArguments(packs.solid, packs.state, packs.drive, surface_pack, options_pack)
    )


def _surface_pack() -> Any:
    """The type of the pack of ``ContactSurface``."""
    types = array_types(ti)
    return ti.types.argpack(
        points=types.integers,
        point_parts=types.integers,
        edges=types.quads,
        edge_parts=types.pairs,
        drawn=types.vectors4,
        own_sides=types.vectors,
        bodies=types.integers,
        measures=types.vectors,
        boxes=types.vectors4,
        first_overlaps=types.integers,
        overlaps=types.vectors,
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
        activity=types.pairs,
        memory=types.scalars,
    )
