"""How the solver learns whether to share a part among threads."""

from __future__ import annotations

import pytest
from physanimator.physics.solver.pace import Pace


def shared_launches(speeds: dict[bool, float], launches: int, pace: Pace) -> int:
    """How many of so many launches are shared when both ways have these speeds."""
    count = 0
    for _ in range(launches):
        shared = pace.share()
        pace.learn(shared=shared, work=1e6, seconds=1e6 / speeds[shared])
        count += shared
    return count


@pytest.mark.parametrize("faster", [True, False])
def test_the_faster_way_is_taken_and_the_other_tried_now_and_then(faster: bool) -> None:
    shared = shared_launches({faster: 2e8, not faster: 1e8}, 160, Pace())
    other = 160 - shared if faster else shared
    assert 2 <= other <= 20


def test_a_machine_that_becomes_busy_is_noticed() -> None:
    pace = Pace()
    assert shared_launches({True: 2e8, False: 1e8}, 64, pace) > 55
    shared_launches({True: 3e7, False: 1e8}, 16, pace)
    assert shared_launches({True: 3e7, False: 1e8}, 64, pace) < 9


def test_short_launches_in_which_threads_wake_up_do_not_decide() -> None:
    pace = Pace()
    for _ in range(4):
        shared = pace.share()
        pace.learn(shared=shared, work=1e4, seconds=1e-3 if shared else 1e-4)
    assert shared_launches({True: 2e8, False: 1e8}, 64, pace) > 50


def test_many_short_launches_decide_together() -> None:
    pace, slow = Pace(), {True: 3e7, False: 1e8}
    count = 0
    for _ in range(2000):
        shared = pace.share()
        pace.learn(shared=shared, work=1e4, seconds=1e4 / slow[shared])
        count += shared
    assert count < 300
