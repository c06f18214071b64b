# mypy: ignore-errors
"""The phases of a tick of bodies that touch, in which threads share the work on all parts."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from ..solver import TICK
from ..solver.kernel_functions import take_step
from ..solver.kernel_types import any_value
from ..solver.sharing import DONE, claim, do_pieces, finish, pieces_of
from .functions import steps_in
from .search import find_contacts
from .surface import CONTACTS, TOUCHING

__all__ = ["FREE", "free_parts", "in_interval", "on_all_parts", "search_and_plan"]

FREE = 1
"""The counter of parts that have gone through a tick on their own."""


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
def in_interval(work: any_value, tick: ti.i32, interval: ti.i32, intervals: ti.i32, phase: ti.i32, scene: any_value):
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
                    take_step(part, tick, step, count, scene.solid, scene.state, scene.drive)
                finish(FREE, scene)
                claimed = claim(phase, scene)
            pieces += 1
    return pieces


@ti.func
def find_at_end(tick: ti.i32, scene: any_value):
    """Find out what touches in the next tick; before the first one of a launch, if nothing is known yet."""
    if tick >= 0:
        for part in range(scene.surface.activity.shape[0]):
            scene.surface.activity[part][TOUCHING] = 0
    if tick >= 0 or scene.surface.memory[CONTACTS] < 0.0:
        find_contacts(scene.surface, scene.solid, scene.state, scene.options, TICK)


@ti.func
def search_and_plan(tick: ti.i32, ticks: ti.i32, phase: ti.i32, scene: any_value):
    """Search for contacts at the end of a tick, beside which the highest frequency of the next one is found.

    Also returns how many pieces of all phases were done after the last one done here.
    """
    claimed, pieces, latest = claim(phase, scene), 1, 0
    if claimed == 0:
        find_at_end(tick, scene)
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
