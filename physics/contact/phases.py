# mypy: ignore-errors
"""The phases of a tick of bodies that touch, in which threads share the work on all parts."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any

from ..solver import DONE, build_sharing

__all__ = ["FREE", "build_contact_phases"]

FREE = 1
"""The counter of parts that have gone through a tick on their own."""


def build_contact_phases(ti: Any, functions: SimpleNamespace, find_contacts: Any) -> SimpleNamespace:
    """The phases, by name, on the functions that ``build_functions`` and ``build_contact_search`` made.

    Each returns how many pieces it has for all threads together. ``scene`` is the kernel's.
    """
    any_value, sharing = ti.template(), build_sharing(ti, functions)
    claim, finish, do_pieces, pieces_of = sharing.claim, sharing.finish, sharing.do_pieces, sharing.pieces_of

    @ti.func
    def steps_in(interval: ti.i32, intervals: ti.i32, steps: ti.i32):
        """Steps of a part in one interval of a tick, over whose intervals they are spread evenly: 0 or 1."""
        return (interval + 1) * steps // intervals - interval * steps // intervals

    @ti.func
    def on_all_parts(work: any_value, tick: ti.i32, phase: ti.i32, scene: any_value):
        """Begin a tick of all parts, or record where they are at its end."""
        claimed, pieces = claim(phase, scene), 0
        for part in range(scene.solid.substeps.shape[0]):
            count = ti.abs(scene.steps[tick, part])
            claimed, _ = do_pieces(work, part, tick, 0, count, phase, claimed, pieces, 0, scene)
            pieces += pieces_of(work, part, scene)
        return pieces

    @ti.func
    def in_interval(
        work: any_value, tick: ti.i32, interval: ti.i32, intervals: ti.i32, phase: ti.i32, scene: any_value
    ):
        """Forces or vertices of the parts that take a step in an interval.

        Also returns how many pieces of all phases were done after the last one done here.
        """
        claimed, pieces, latest = claim(phase, scene), 0, 0
        for part in range(scene.solid.substeps.shape[0]):
            count = scene.steps[tick, part]
            if count > 0 and steps_in(interval, intervals, count) > 0:
                step = interval * count // intervals
                claimed, done = do_pieces(work, part, tick, step, count, phase, claimed, pieces, 0, scene)
                latest = ti.max(latest, done)
                pieces += pieces_of(work, part, scene)
        return pieces, latest

    @ti.func
    def free_parts(tick: ti.i32, phase: ti.i32, scene: any_value):
        """The whole tick of parts that touch nothing, each in one piece, which nobody waits for until contacts are
        searched for.
        """
        claimed, pieces = claim(phase, scene), 0
        for part in range(scene.solid.substeps.shape[0]):
            count = 0 - scene.steps[tick, part]
            if count > 0:
                if pieces == claimed:
                    for step in range(count):
                        functions.take_step(part, tick, step, count, scene.solid, scene.state, scene.drive)
                    finish(FREE, scene)
                    claimed = claim(phase, scene)
                pieces += 1
        return pieces

    @ti.func
    def search_and_plan(tick: ti.i32, ticks: ti.i32, phase: ti.i32, scene: any_value):
        """Search for contacts at the end of a tick, beside which the highest frequency of the next one is found.

        Also returns how many pieces of all phases were done after the last one done here.
        """
        claimed, pieces, latest = claim(phase, scene), 1, 0
        if claimed == 0:
            find_contacts(tick, scene)
            latest = finish(DONE, scene)
            claimed = claim(phase, scene)
        parts = scene.solid.substeps.shape[0]
        if tick + 1 < ticks:
            for part in range(parts):
                slot = (tick + 1) * parts + part
                claimed, done = do_pieces("plan", part, tick, 0, 1, phase, claimed, pieces, slot, scene)
                latest = ti.max(latest, done)
                pieces += pieces_of("plan", part, scene)
        return pieces, latest

    return SimpleNamespace(
        steps_in=steps_in,
        on_all_parts=on_all_parts,
        in_interval=in_interval,
        free_parts=free_parts,
        search_and_plan=search_and_plan,
        wait_until=sharing.wait_until,
        finish=finish,
    )
