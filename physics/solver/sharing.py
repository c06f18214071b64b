# mypy: ignore-errors
"""Many connected parts on several threads, with the same result to the last bit as on one.

The work is cut into phases (the forces of a substep, then its vertices), and these into pieces. Threads claim one piece
after the other from the phase's counter until none is left, and wait in a loop until all pieces are done before the
next phase begins. A thread that the system has put aside holds up the others by one piece at most.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from .elastic_functions import BLOCK_MASK, add_forces, highest_frequency
from .external_functions import begin_vertices
from .kernel_functions import move_vertices, record
from .kernel_types import any_value
from .pace import FIRST_PHASE

__all__ = ["BLOCKS_AT_ONCE", "DONE", "VERTICES_AT_ONCE", "claim", "do_pieces", "finish", "pieces_of", "wait_until"]

DONE = 0
"""The counter of the pieces that are done."""

BLOCKS_AT_ONCE, VERTICES_AT_ONCE = 24, 192
"""Sizes of a piece: some 2 us of work, against 0.1 us for a claim that another thread waits for as well."""


@ti.func
def claim(phase: ti.i32, shared: any_value):
    """The next piece of a phase that nobody has claimed."""
    return ti.atomic_add(shared.counters[FIRST_PHASE + phase], 1)


@ti.func
def finish(counter: any_value, shared: any_value):
    """Count a piece as done; returns how many are, by all threads together."""
    return ti.atomic_add(shared.counters[counter], 1) + 1


@ti.func
def wait_until(counter: any_value, done: ti.i32, shared: any_value):
    """Wait until so many pieces are done by all threads together."""
    while ti.atomic_add(shared.counters[counter], 0) < done:
        pass


@ti.func
def pieces_of(work: any_value, part: ti.i32, shared: any_value):
    """Pieces of a part's work in a phase."""
    column = ti.static(int(work in ("plan", "forces")))
    size = ti.static(BLOCKS_AT_ONCE if column else VERTICES_AT_ONCE)
    starts = ti.static(shared.solid.starts)
    return (starts[part + 1][column] - starts[part][column] + size - 1) // size


@ti.func
def do_pieces(
    work: any_value,
    part: ti.i32,
    tick: ti.i32,
    step: ti.i32,
    count: ti.i32,
    phase: ti.i32,
    claimed: ti.i32,
    before: ti.i32,
    slot: ti.i32,
    shared: any_value,
):
    """Do the claimed piece and claim others, until one is claimed that is not of this part.

    Args:
        work: "plan", "begin", "forces", "vertices" or "record".
        before: pieces of other parts in this phase that come before those of this one.
        slot: where in ``highest`` the part's highest omega^2 belongs.

    Returns:
        The piece that is claimed at the end, and how many were done of all after the last one done here.
    """
    solid, state, drive = ti.static((shared.solid, shared.state, shared.drive))
    column = ti.static(int(work in ("plan", "forces")))
    size = ti.static(BLOCKS_AT_ONCE if column else VERTICES_AT_ONCE)
    first, end = solid.starts[part][column], solid.starts[part + 1][column]
    beyond, piece, done = before + pieces_of(work, part, shared), claimed, 0
    while piece < beyond:
        low = first + (piece - before) * size
        high = ti.min(low + size, end) & BLOCK_MASK
        if ti.static(work == "plan"):
            ti.atomic_max(shared.highest[slot], highest_frequency(low, high, solid, state))
        elif ti.static(work == "begin"):
            begin_vertices(low, high, tick, count, solid, state, drive)
        elif ti.static(work == "forces"):
            for n in range(low, high):
                add_forces(solid, state, n)
        elif ti.static(work == "vertices"):
            move_vertices(low, high, tick, step, count, solid, state, drive)
        else:
            record(low, high, tick, state, drive)
        done = finish(DONE, shared)
        piece = claim(phase, shared)
    return piece, done
