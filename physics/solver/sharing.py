# mypy: ignore-errors
"""One large connected part on several threads, with the same result to the last bit as on one.

Each phase of a substep (forces, then vertices) is cut into pieces. Threads claim one piece after the other from a
common counter until none is left, and wait in a loop until all pieces are done before the next phase begins. A thread
that the system has put aside holds up the others by one piece at most.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any

from .elastic_functions import BLOCK_MASK

__all__ = ["LARGE", "MOST_THREADS", "TRIANGLES_PER_THREAD", "build_advance_shared", "phases_of"]

LARGE = 2_000
"""Triangles of a part from which on it is shared: two threads compute these 1.4 times as fast as one, 10,000 1.5 times
and 50,000 1.6 times, where no other program has the processors."""

TRIANGLES_PER_THREAD = 1_000
"""A smaller share is not worth a thread's while: all threads wait for each other twice in every substep."""

MOST_THREADS = 8
"""More threads wait longer for each other than they compute."""

_BLOCKS_AT_ONCE, _VERTICES_AT_ONCE = 24, 192  # of a piece: some 3 us of work, against 0.1 us for its claim


def phases_of(ticks: int, substeps: int, most_refinement: int) -> int:
    """Most phases of so many ticks, for each of which there is a counter: plan, begin, record, and two a substep."""
    return ticks * (3 + 2 * most_refinement * substeps)


def build_advance_shared(ti: Any, types: Any, packs: Any, functions: Any) -> Any:
    """The kernel, on the functions that ``build_functions`` made."""
    any_value = ti.template()

    @ti.func
    def do_phase(
        work: any_value,
        part: ti.i32,
        tick: ti.i32,
        step: ti.i32,
        count: ti.i32,
        phase: ti.i32,
        solid: any_value,
        state: any_value,
        drive: any_value,
        counters: any_value,
        highest: any_value,
    ):
        """Claim pieces of a phase until none is left; returns how many pieces it has for all threads together."""
        on_blocks = ti.static(work in ("plan", "forces"))
        size, column = ti.static(_BLOCKS_AT_ONCE if on_blocks else _VERTICES_AT_ONCE), ti.static(int(on_blocks))
        first, end = solid.starts[part][column], solid.starts[part + 1][column]
        pieces = (end - first + size - 1) // size
        piece = ti.atomic_add(counters[1 + phase], 1)
        while piece < pieces:
            low = first + piece * size
            high = ti.min(low + size, end) & BLOCK_MASK
            if ti.static(work == "plan"):
                ti.atomic_max(highest[tick], functions.highest_frequency(low, high, solid, state))
            elif ti.static(work == "begin"):
                functions.begin_vertices(low, high, tick, count, solid, state, drive)
            elif ti.static(work == "forces"):
                for n in range(low, high):
                    functions.add_forces(solid, state, n)
            elif ti.static(work == "vertices"):
                functions.move_vertices(low, high, tick, step, count, solid, state, drive)
            else:
                functions.record(low, high, tick, state, drive)
            ti.atomic_add(counters[0], 1)
            piece = ti.atomic_add(counters[1 + phase], 1)
        return pieces

    @ti.func
    def wait_until(done: ti.i32, counters: any_value):
        """Wait until so many pieces are done by all threads together."""
        while ti.atomic_add(counters[0], 0) < done:
            pass

    @ti.func
    def advance_with_others(
        part: ti.i32,
        solid: any_value,
        state: any_value,
        drive: any_value,
        counters: any_value,
        highest: any_value,
    ):
        """What every thread does."""
        phase, done = 0, 0
        for tick in range(drive.first_particles.shape[0] - 1):
            done += do_phase("plan", part, tick, 0, 1, phase, solid, state, drive, counters, highest)
            wait_until(done, counters)
            count = functions.steps_for(ti.atomic_max(highest[tick], 0.0), solid.substeps[part])
            # External accelerations and forces write to different arrays: nobody waits between them.
            done += do_phase("begin", part, tick, 0, count, phase + 1, solid, state, drive, counters, highest)
            phase += 2
            for step in range(count):
                done += do_phase("forces", part, tick, step, count, phase, solid, state, drive, counters, highest)
                wait_until(done, counters)
                done += do_phase("vertices", part, tick, step, count, phase + 1, solid, state, drive, counters, highest)
                wait_until(done, counters)
                phase += 2
            # The next tick's plan only reads what is recorded, and all wait after it.
            done += do_phase("record", part, tick, 0, count, phase, solid, state, drive, counters, highest)
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
            advance_with_others(part, solid, state, drive, counters, highest)

    return advance_shared
