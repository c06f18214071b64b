# mypy: ignore-errors
"""Connected parts on several threads, with the same result to the last bit as on one.

The work is cut into phases (the forces of a substep, then its vertices), and these into pieces. Threads claim one piece
after the other from the phase's counter until none is left, and wait in a loop until all pieces are done before the
next phase begins. A thread that the system has put aside holds up the others by one piece at most.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .elastic_functions import BLOCK_MASK, MOST_REFINEMENT

__all__ = ["DONE", "MOST_THREADS", "TRIANGLES_PER_THREAD", "build_advance_shared", "build_sharing", "counters"]

TRIANGLES_PER_THREAD = 1_000
"""A smaller share is not worth a thread's while: all threads wait for each other twice in every substep.

Two threads compute 2,000 triangles 1.4 times as fast as one, 10,000 1.5 times and 50,000 1.6 times, where no other
program has the processors.
"""

MOST_THREADS = 8
"""More threads wait longer for each other than they compute."""

DONE = 0
"""The counter of the pieces that are done."""

_FIRST_PHASE = 2  # counter of the pieces that are claimed in the first phase; the one before is the contact kernel's
_BLOCKS_AT_ONCE, _VERTICES_AT_ONCE = 24, 192  # of a piece: some 3 us of work, against 0.1 us for its claim


class _Shared(NamedTuple):
    """All that the kernel works on."""

    solid: Any
    state: Any
    drive: Any
    counters: Any
    highest: Any


def counters(substeps: int, ticks: int) -> NDArray[np.int32]:
    """The counters of a launch: two of pieces that are done, then for each phase one of pieces that are claimed.

    Args:
        substeps: planned in a tick, the most of all parts.
        ticks: in each of which there are at most four phases besides the two of a substep; one precedes all.
    """
    return np.zeros(_FIRST_PHASE + 1 + ticks * (4 + 2 * MOST_REFINEMENT * substeps), dtype=np.int32)


def build_sharing(ti: Any, functions: SimpleNamespace) -> SimpleNamespace:
    """What threads share work with, by name, on the functions that ``build_functions`` made.

    ``shared`` is a named tuple with the fields of ``_Shared`` at least.
    """
    any_value = ti.template()

    @ti.func
    def claim(phase: ti.i32, shared: any_value):
        """The next piece of a phase that nobody has claimed."""
        return ti.atomic_add(shared.counters[_FIRST_PHASE + phase], 1)

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
        size = ti.static(_BLOCKS_AT_ONCE if column else _VERTICES_AT_ONCE)
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
        size = ti.static(_BLOCKS_AT_ONCE if column else _VERTICES_AT_ONCE)
        first, end = solid.starts[part][column], solid.starts[part + 1][column]
        beyond, piece, done = before + pieces_of(work, part, shared), claimed, 0
        while piece < beyond:
            low = first + (piece - before) * size
            high = ti.min(low + size, end) & BLOCK_MASK
            if ti.static(work == "plan"):
                ti.atomic_max(shared.highest[slot], functions.highest_frequency(low, high, solid, state))
            elif ti.static(work == "begin"):
                functions.begin_vertices(low, high, tick, count, solid, state, drive)
            elif ti.static(work == "forces"):
                for n in range(low, high):
                    functions.add_forces(solid, state, n)
            elif ti.static(work == "vertices"):
                functions.move_vertices(low, high, tick, step, count, solid, state, drive)
            else:
                functions.record(low, high, tick, state, drive)
            done = finish(DONE, shared)
            piece = claim(phase, shared)
        return piece, done

    return SimpleNamespace(claim=claim, finish=finish, wait_until=wait_until, pieces_of=pieces_of, do_pieces=do_pieces)


def build_advance_shared(ti: Any, types: Any, packs: Any, functions: Any) -> Any:
    """The kernel for one large part, on the functions that ``build_functions`` made."""
    any_value, sharing = ti.template(), build_sharing(ti, functions)
    claim, wait_until, pieces_of, do_pieces = sharing.claim, sharing.wait_until, sharing.pieces_of, sharing.do_pieces

    @ti.func
    def do_phase(
        work: any_value, part: ti.i32, tick: ti.i32, step: ti.i32, count: ti.i32, phase: ti.i32, shared: any_value
    ):
        """Do pieces of a phase until none is left; returns how many it has for all threads together."""
        do_pieces(work, part, tick, step, count, phase, claim(phase, shared), 0, tick, shared)
        return pieces_of(work, part, shared)

    @ti.func
    def advance_with_others(part: ti.i32, shared: any_value):
        """What every thread does."""
        phase, done = 0, 0
        for tick in range(shared.drive.first_particles.shape[0] - 1):
            done += do_phase("plan", part, tick, 0, 1, phase, shared)
            wait_until(DONE, done, shared)
            count = functions.steps_for(ti.atomic_max(shared.highest[tick], 0.0), shared.solid.substeps[part])
            # External accelerations and forces write to different arrays: nobody waits between them.
            done += do_phase("begin", part, tick, 0, count, phase + 1, shared)
            phase += 2
            for step in range(count):
                done += do_phase("forces", part, tick, step, count, phase, shared)
                wait_until(DONE, done, shared)
                done += do_phase("vertices", part, tick, step, count, phase + 1, shared)
                wait_until(DONE, done, shared)
                phase += 2
            # The next tick's plan only reads what is recorded, and all wait after it.
            done += do_phase("record", part, tick, 0, count, phase, shared)
            phase += 1

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
        for _ in range(threads):
            advance_with_others(part, ti.static(_Shared(solid, state, drive, counters, highest)))

    return advance_shared
