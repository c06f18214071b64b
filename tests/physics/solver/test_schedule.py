"""Which parts are shared among threads."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.solver import TRIANGLES_PER_THREAD, schedule
from physanimator.physics.solver.scheduling import Schedule

ENOUGH = 2 * TRIANGLES_PER_THREAD


def chosen(*parts: tuple[int, int], threads: int = 2) -> tuple[list[int], tuple[tuple[int, int], ...]]:
    """The schedule of parts of (triangles, substeps)."""
    triangles, substeps = np.array(parts).T
    found: Schedule = schedule(triangles, substeps, threads=threads)
    return found.alone.tolist(), found.shared


@pytest.mark.parametrize(("triangles", "threads", "sharing"), [(ENOUGH, 2, 2), (ENOUGH, 4, 2), (100_000, 4, 4)])
def test_a_large_part_is_shared_by_as_many_as_it_feeds(triangles: int, threads: int, sharing: int) -> None:
    assert chosen((triangles, 5), threads=threads) == ([], ((0, sharing),))


def test_small_parts_and_single_threads_share_nothing() -> None:
    assert chosen((ENOUGH - 1, 5)) == ([0], ())
    assert chosen((100_000, 5), threads=1) == ([0], ())


def test_large_parts_that_keep_all_threads_busy_are_not_shared() -> None:
    assert chosen((ENOUGH, 5), (ENOUGH, 5)) == ([0, 1], ())
    assert chosen((ENOUGH, 5), (ENOUGH, 2), (10, 1)) == ([1, 2], ((0, 2),))


def test_the_most_work_comes_first() -> None:
    assert chosen((100, 1), (300, 2), (200, 4)) == ([2, 1, 0], ())


def test_threads_that_meet_are_not_too_many() -> None:
    assert chosen((1_000_000, 5), threads=64) == ([], ((0, 8),))
