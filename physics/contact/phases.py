# mypy: ignore-errors
"""The phases of a tick that the contact kernel's threads share: in each they take pieces until none is left."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any

from ..solver import BLOCKS_AT_ONCE, SMALL, TICK, VERTICES_AT_ONCE
from .team import FLAGS, FREE, LARGE, LINE

__all__ = ["build_contact_phases"]


def build_contact_phases(
    ti: Any, functions: SimpleNamespace, contact: SimpleNamespace, searching: SimpleNamespace
) -> SimpleNamespace:
    """The phases, by name, made of the functions of bodies, of contacts and of the search for these.

    Each works on the kernel's whole ``scene``, which also says which of how many threads this is.
    """
    add_forces, highest_frequency = functions.add_forces, functions.highest_frequency
    begin_tick, move_vertices, record = functions.begin_tick, functions.move_vertices, functions.record
    steps_in = contact.steps_in

    @ti.func
    def in_turn(n: ti.i32, pieces: ti.i32, scene: ti.template()):
        """The n-th piece that a thread tries to take: first its own ones, which stay in its cache, then others'.

        Of those it begins with what their owners come to last.
        """
        first, end = scene.thread * pieces // scene.threads, (scene.thread + 1) * pieces // scene.threads
        piece = first + n
        if piece >= end:
            piece = end - 1 - n
            if piece < 0:
                piece = piece + pieces
        return piece

    @ti.func
    def take(piece: ti.i32, phase: ti.i32, scene: ti.template()):
        """Whether nobody else has taken a piece in a phase; phases are counted from 1 and never fall."""
        flag, free = FLAGS + LINE * piece, False
        if scene.team.claims[flag] < phase:  # reading leaves the flag's cache line with those who look on
            free = ti.atomic_max(scene.team.claims[flag], phase) < phase
        return free

    @ti.func
    def give(team: ti.template()):
        """A piece is done; returns how many are done by all threads together."""
        return ti.atomic_add(team.claims[0], 1) + 1

    @ti.func
    def wait_for(claims: ti.template(), counter: ti.template(), due: ti.i32):
        """Wait until so many pieces are done by all threads together."""
        while ti.atomic_add(claims[counter], 0) < due:
            pass

    @ti.func
    def is_large(part: ti.i32, solid: ti.template()):
        """Whether threads share a part; others go through a step in one piece, which keeps them in the cache."""
        return solid.starts[part + 1][1] - solid.starts[part][1] >= LARGE

    @ti.func
    def end_of_piece(column: ti.template(), part: ti.i32, first: ti.i32, solid: ti.template()):
        """Where the blocks (column 1) or vertices (column 0) of a piece end that begins with the first."""
        end = solid.starts[part + 1][column]
        if is_large(part, solid):
            end = ti.min(end, first + ti.static(BLOCKS_AT_ONCE if column == 1 else VERTICES_AT_ONCE))
        return end

    @ti.func
    def move_piece(low: ti.i32, part: ti.i32, tick: ti.i32, interval: ti.i32, intervals: ti.i32, scene: ti.template()):
        """What an interval brings to a piece of a part's vertices: a step at most, and before the first their tick.

        Before that, where they are is written down, if the tick before was the last one of a frame.
        """
        solid, state, drive = ti.static(scene.solid, scene.state, scene.drive)
        count, high = scene.team.steps[tick, part], end_of_piece(0, part, low, solid)
        if interval == 0 and count > 0:
            if tick > 0:
                record(low, high, tick - 1, state, drive)
            begin_tick(low, high, tick, TICK / count, solid, state, drive)
        if steps_in(interval, intervals, count) > 0:
            step = interval * count // intervals
            move_vertices(low, high, tick, step, count, solid, state, drive, scene.pairs)

    @ti.func
    def plan_piece(piece: ti.i32, tick: ti.i32, scene: ti.template()):
        """Find the highest frequency of a piece of triangles for a tick's steps."""
        part, low = scene.team.blocks[piece][0], scene.team.blocks[piece][1]
        high = end_of_piece(1, part, low, scene.solid) & SMALL
        ti.atomic_max(scene.team.highest[tick, part], highest_frequency(scene.solid, scene.state, low, high))

    @ti.func
    def step_together(
        phase: ti.i32, due: ti.i32, tick: ti.i32, interval: ti.i32, intervals: ti.i32, scene: ti.template()
    ):
        """Take pieces of an interval, of large parts only the forces, until none is left; whether it did the last."""
        solid, team = ti.static(scene.solid, scene.team)
        last = False
        for turn in range(team.blocks.shape[0]):
            piece = in_turn(turn, team.blocks.shape[0], scene)
            part, low = team.blocks[piece][0], team.blocks[piece][1]
            if team.steps[tick, part] > 0 and take(piece, phase, scene):
                high = end_of_piece(1, part, low, solid) & SMALL
                if steps_in(interval, intervals, team.steps[tick, part]) > 0:
                    for n in range(low, high):
                        add_forces(solid, scene.state, n)
                if not is_large(part, solid):
                    move_piece(solid.starts[part][0], part, tick, interval, intervals, scene)
                last = give(team) == due
        return last

    @ti.func
    def move_large(phase: ti.i32, due: ti.i32, tick: ti.i32, interval: ti.i32, intervals: ti.i32, scene: ti.template()):
        """Take pieces of the large parts' vertices until none is left; whether this thread did the last one."""
        team = ti.static(scene.team)
        last = False
        for n in range(team.large.shape[0]):
            piece = in_turn(n, team.large.shape[0], scene)
            if take(piece, phase, scene):
                move_piece(team.large[piece][1], team.large[piece][0], tick, interval, intervals, scene)
                last = give(team) == due
        return last

    @ti.func
    def search_together(phase: ti.i32, due: ti.i32, tick: ti.i32, scene: ti.template()):
        """Take pieces of the search at the end of a tick, and of the plan of the next one, until none is left.

        Returns whether this thread did the last one.
        """
        last, blocks, pieces = False, scene.team.blocks.shape[0], searching.pieces(scene.surface)
        searched, planned = (
            ti.select(tick >= 0, pieces, 0),
            ti.select(tick + 1 < scene.team.highest.shape[0], blocks, 0),
        )
        pieces = ti.max(pieces, blocks)
        for n in range(pieces):
            piece = in_turn(n, pieces, scene)
            if take(piece, phase, scene):
                if piece < searched:
                    searching.search(scene.surface, scene.solid, scene.options, piece)
                if piece < planned:
                    plan_piece(piece, tick + 1, scene)
                last = give(scene.team) == due
        return last

    @ti.func
    def advance_free(phase: ti.i32, tick: ti.i32, scene: ti.template()):
        """Take parts that touch nothing through all of their tick, which others need not wait for.

        Returns whether this thread did the last one.
        """
        solid, state, drive, team = ti.static(scene.solid, scene.state, scene.drive, scene.team)
        last, parts = False, team.order.shape[0]
        for turn in range(parts):
            piece = in_turn(turn, parts, scene)
            if take(piece, phase, scene):
                part = team.order[piece]
                count = 0 - team.steps[tick, part]
                if count > 0:
                    first, end = solid.starts[part], solid.starts[part + 1]
                    if tick > 0:
                        record(first[0], end[0], tick - 1, state, drive)
                    begin_tick(first[0], end[0], tick, TICK / count, solid, state, drive)
                    for step in range(count):
                        for n in range(first[1] & SMALL, end[1] & SMALL):
                            add_forces(solid, state, n)
                        move_vertices(first[0], end[0], tick, step, count, solid, state, drive, scene.pairs)
                last = ti.atomic_add(team.claims[FREE], 1) + 1 == (tick + 1) * parts
        return last

    @ti.func
    def record_together(phase: ti.i32, tick: ti.i32, scene: ti.template()):
        """Take pieces of the record of a launch's last tick until none is left."""
        pieces = scene.team.vertices.shape[0]
        for n in range(pieces):
            piece = in_turn(n, pieces, scene)
            if take(piece, phase, scene):
                part, low = scene.team.vertices[piece][0], scene.team.vertices[piece][1]
                record(low, end_of_piece(0, part, low, scene.solid), tick, scene.state, scene.drive)

    return SimpleNamespace(
        give=give,
        wait_for=wait_for,
        is_large=is_large,
        step_together=step_together,
        move_large=move_large,
        search_together=search_together,
        advance_free=advance_free,
        record_together=record_together,
    )
