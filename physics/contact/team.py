"""How the threads that advance touching bodies together share the work: in pieces, of which each takes the next one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..runtime import LANES
from ..solver import BLOCKS_AT_ONCE, TRIANGLES_PER_THREAD, VERTICES_AT_ONCE, Solid
from .surface import POINTS_AT_ONCE

__all__ = ["FLAGS", "FREE", "LARGE", "LINE", "Pieces", "Team", "pieces_of", "team_for"]

Float32Array = NDArray[np.float32]
Int32Array = NDArray[np.int32]

LARGE = 2 * TRIANGLES_PER_THREAD // LANES
"""Blocks of triangles of a part that threads share even while it touches nothing."""

LINE = 16
"""Numbers of ``Team.claims`` in a cache line, of which each piece has one to itself."""

FREE, FLAGS = 2 * LINE, 4 * LINE
"""Where in ``Team.claims`` the second counter stands, and where the pieces begin."""


class Pieces(NamedTuple):
    """The work on a solid, cut into pieces that a thread does at once; a part that is not large is one piece.

    Attributes:
        blocks: part and first block of triangles of each piece, int32, shape [n, 2].
        vertices: part and first vertex of each piece, int32, shape [m, 2].
        large: those of large parts, int32, shape [k, 2].
        order: the parts, of each thread's share the most work first, int32, shape [p].
    """

    blocks: Int32Array
    vertices: Int32Array
    large: Int32Array
    order: Int32Array


class Team(NamedTuple):
    """What the threads of a launch know of each other.

    Attributes:
        blocks, vertices, large, order: the pieces.
        claims: how many pieces are done by all threads, at ``FREE`` how many parts that touch nothing have ended their
            ticks, and from ``FLAGS`` on, in a cache line for each piece, the latest phase in which it was taken, int32.
        highest: omega^2 of the parts in each tick [1/s^2], float32, shape [n, p].
        steps: substeps of the parts in each tick, negative for those that touch nothing, then the intervals of the tick
            and how many pieces of blocks have steps in them, int32, shape [n, p + 2].
    """

    blocks: Int32Array
    vertices: Int32Array
    large: Int32Array
    order: Int32Array
    claims: Int32Array
    highest: Float32Array
    steps: Int32Array


def pieces_of(solid: Solid, threads: int) -> Pieces:
    """Cut the work on a solid's connected parts into pieces, and deal them out so that every thread has its share.

    A part that is one piece has the same place in all phases, so that it stays in the cache of one thread.
    """
    sizes = np.diff(solid.starts[:, 1])
    order = np.argsort(-sizes * solid.substeps, kind="stable").astype(np.int32)
    large, small = [part for part in order if sizes[part] >= LARGE], [part for part in order if sizes[part] < LARGE]
    tables = []
    for column, size in ((1, BLOCKS_AT_ONCE), (0, VERTICES_AT_ONCE)):
        starts = solid.starts[:, column]
        cut = [(part, first) for part in large for first in range(starts[part], starts[part + 1], size)]
        whole = [(part, starts[part]) for part in small]
        hands = [
            cut[hand * len(cut) // threads : (hand + 1) * len(cut) // threads] + whole[hand::threads]
            for hand in range(threads)
        ]
        dealt = [piece for hand in hands for piece in hand]
        tables += [np.array(table, np.int32).reshape(-1, 2) for table in (dealt, cut)]
    dealt_parts = [part for hand in range(threads) for part in large[hand::threads] + small[hand::threads]]
    return Pieces(blocks=tables[0], vertices=tables[2], large=tables[3], order=np.array(dealt_parts, np.int32))


def team_for(pieces: Pieces, solid: Solid, points: int, ticks: int) -> Team:
    """A team that has done nothing yet of so many ticks.

    Args:
        pieces: the work.
        solid: what it is done on.
        points: boundary vertices of a search for contacts.
        ticks: of the launch.
    """
    parts = len(solid.substeps)
    most = max(len(pieces.blocks), len(pieces.vertices), parts, -(-points // POINTS_AT_ONCE))
    return Team(
        *pieces,
        claims=np.zeros(FLAGS + LINE * most, np.int32),
        highest=np.zeros((ticks, parts), np.float32),
        steps=np.zeros((ticks, parts + 2), np.int32),
    )
