# mypy: ignore-errors
"""A large connected part on several threads, with the same result to the last bit as on one.

A substep has two phases: the forces of all triangles, then the motion of all vertices. Each thread has a share of both,
the same in every substep, which stays in its processor's cache. When it is through, it waits in a loop until all are;
if that takes long, it looks for pieces of the others' shares that nobody has begun. So a thread that the system has put
aside holds up the others by one piece at most.

Counters that different threads write to are on different lines of the cache, and a thread that waits only reads: a
processor that takes a line from another costs as much time as 30 triangles.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any, NamedTuple

import taichi as ti

from .elastic_functions import BLOCK_MASK, add_forces, highest_frequency, steps_for
from .external_functions import begin_vertices
from .kernel_functions import move_vertices, record
from .kernel_types import any_value
from .pace import CACHE_LINE
from .sharing import BLOCKS_AT_ONCE, VERTICES_AT_ONCE

__all__ = ["Shared", "advance_share"]

_TOGETHER = 16  # vertices, by whose multiples shares begin: what they write is on lines of its own
_PATIENCE = 200  # looks at the others' counters, some 3 us, before one helps them


class Shared(NamedTuple):
    """All that the kernel works on."""

    solid: Any
    state: Any
    drive: Any
    counters: Any
    highest: Any


@ti.func
def bounds(work: any_value, part: ti.i32, owner: ti.i32, threads: ti.i32, solid: any_value):
    """First block or vertex of a thread's share of a part, and the one after its last."""
    column, unit = ti.static((1, 1) if work == "forces" else (0, _TOGETHER))
    first, end = solid.starts[part][column], solid.starts[part + 1][column]
    units = (end - first + unit - 1) // unit
    return first + units * owner // threads * unit, ti.min(first + units * (owner + 1) // threads * unit, end)


@ti.func
def all_done(due: ti.i32, threads: ti.i32, counters: any_value):
    """Whether all threads together have done so many pieces."""
    done = 0
    for thread in range(threads):
        done += counters[thread * CACHE_LINE]
    return done >= due


@ti.func
def pieces_of(work: any_value, part: ti.i32, owner: ti.i32, threads: ti.i32, solid: any_value):
    """Pieces of a thread's share."""
    size = ti.static(BLOCKS_AT_ONCE if work == "forces" else VERTICES_AT_ONCE)
    first, end = bounds(work, part, owner, threads, solid)
    return (end - first + size - 1) // size


@ti.func
def do_piece(
    work: any_value,
    part: ti.i32,
    low: ti.i32,
    high: ti.i32,
    tick: ti.i32,
    step: ti.i32,
    count: ti.i32,
    shared: any_value,
):
    """Do what a phase asks of some blocks or vertices.

    What a tick begins with, and what ends it, only reads what this phase does not change, or does so for one vertex.
    """
    solid, state, drive = ti.static((shared.solid, shared.state, shared.drive))
    if ti.static(work == "forces"):
        if step == 0:
            ti.atomic_max(shared.highest[tick], highest_frequency(low, high, solid, state))
        for n in range(low & BLOCK_MASK, high & BLOCK_MASK):
            add_forces(solid, state, n)
    else:
        if step == 0:
            begin_vertices(low, high, tick, count, solid, state, drive)
        move_vertices(low, high, tick, step, count, solid, state, drive)
        if step + 1 == count:
            record(low, high, tick, state, drive)


@ti.func
def do_share(
    work: any_value,
    part: ti.i32,
    owner: ti.i32,
    threads: ti.i32,
    tick: ti.i32,
    step: ti.i32,
    count: ti.i32,
    claims: ti.i32,
    shared: any_value,
):
    """Do those pieces of a share that nobody else claims; returns how many."""
    size = ti.static(BLOCKS_AT_ONCE if work == "forces" else VERTICES_AT_ONCE)
    first, end = bounds(work, part, owner, threads, shared.solid)
    pieces, done = pieces_of(work, part, owner, threads, shared.solid), 0
    while shared.counters[claims] < pieces:
        piece = ti.atomic_add(shared.counters[claims], 1)
        if piece < pieces:
            low = first + piece * size
            do_piece(work, part, low, ti.min(low + size, end), tick, step, count, shared)
            done += 1
    return done


@ti.func
def do_phase(
    work: any_value,
    part: ti.i32,
    me: ti.i32,
    threads: ti.i32,
    tick: ti.i32,
    step: ti.i32,
    count: ti.i32,
    phase: ti.i32,
    due: ti.i32,
    patience: ti.i32,
    shared: any_value,
):
    """Do one's share of a phase, wait for the others, and help those that do not come.

    Returns the pieces that are due when the phase is over, and how long to wait in the next one: not at all for threads
    that had to be helped in this one.
    """
    counters = ti.static(shared.counters)
    for owner in range(threads):
        due += pieces_of(work, part, owner, threads, shared.solid)
    stride = (counters.shape[0] - 2 * CACHE_LINE * threads) // threads
    owner, over, helped, left = me, False, 0, patience
    while not over:
        claims = 2 * CACHE_LINE * threads + owner * stride + phase
        done = do_share(work, part, owner, threads, tick, step, count, claims, shared)
        if done > 0:
            ti.atomic_add(counters[me * CACHE_LINE], done)
            if owner != me:
                helped = 1
        over = all_done(due, threads, counters)
        while not over and left > 0:
            # On a line that no other thread reads, which keeps the compiler from reading the others' but once.
            ti.atomic_add(counters[(threads + me) * CACHE_LINE], 1)
            left -= 1
            over = all_done(due, threads, counters)
        owner = (owner + 1) % threads
    return due, ti.select(helped > 0, 0, _PATIENCE)


@ti.func
def advance_share(part: ti.i32, me: ti.i32, threads: ti.i32, shared: any_value):
    """What every thread does."""
    phase, due, patience = 0, 0, _PATIENCE
    for tick in range(shared.drive.first_particles.shape[0] - 1):
        step, count = 0, 1
        while step < count:
            due, patience = do_phase("forces", part, me, threads, tick, step, count, phase, due, patience, shared)
            if step == 0:
                count = steps_for(ti.atomic_max(shared.highest[tick], 0.0), shared.solid.substeps[part])
            due, patience = do_phase("vertices", part, me, threads, tick, step, count, phase + 1, due, patience, shared)
            phase += 2
            step += 1
