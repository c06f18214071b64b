"""Stopping a long simulation: it ends with the frame that it is at, and the next run is as if nothing had been."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from physanimator.physics.assembly import plan
from physanimator.physics.errors import Cancelled
from physanimator.physics.forces import EnergyStroke
from physanimator.physics.material import Material
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.rig import Polygon, RigPoint
from physanimator.physics.runtime import taichi_runtime
from physanimator.physics.scene import Body, Contact, Scene
from physanimator.physics.simulation import simulate
from physanimator.physics.simulation.simulation import _LAUNCH_WORK
from physanimator.physics.solver import TICK, Drive

LONG = 3000


def scene(**acting: Any) -> Scene:
    """A strip that hangs in gusts."""
    y, x = np.mgrid[:200, :200] + 0.5
    mesh = mesh_from_mask((np.abs(x - 100) < 12) & (y > 20) & (y < 160), spacing=10)
    gusts = EnergyStroke(path=((0, 90), (200, 90)), radius=80, speed=200, strength=4, interval=0.4)
    pin = RigPoint((100, 20), Polygon(((80, 15), (120, 15), (120, 30), (80, 30))))
    return Scene((Body(mesh, Material(sway_frequency=1.5)),), (gusts,), (pin,), **acting)


SCENES: dict[str, Callable[[], Scene]] = {
    "free": scene,
    "contact": lambda: scene(contact=Contact(self_contact=True)),
    "loop": lambda: scene(loop=60.0),
    "between ticks": lambda: scene(frame_rate=23.976),
}


@pytest.fixture
def jobs(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Grows by one with each job that is handed to Taichi: the ticks that it advances."""
    done: list[int] = []
    run = taichi_runtime.run

    def counted(function: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        done.append(sum(len(each.first_particles) - 1 for each in args if isinstance(each, Drive)))
        return run(function, *args, **kwargs)

    monkeypatch.setattr(taichi_runtime, "run", counted)
    return done


@pytest.mark.parametrize("kind", SCENES)
def test_nothing_is_computed_after_the_frame_that_was_cancelled(kind: str, jobs: list[int]) -> None:
    acting = SCENES[kind]()
    frames = None if acting.loop else LONG
    seen: list[int] = []

    def progress(done: int, total: int) -> None:
        seen.append(len(jobs))
        if len(seen) == 6:
            raise Cancelled

    with pytest.raises(Cancelled):
        simulate(acting, frames=frames, progress=progress)
    assert len(jobs) == seen[-1]
    # No job holds the process up for longer than the work that one may do.
    planned = plan(acting, frames=LONG)
    ticks_in_all = (LONG - 1) / (planned.frame_rate * TICK)
    assert 0 < max(jobs) <= max(1, _LAUNCH_WORK * ticks_in_all / planned.work)
    assert np.diff(seen).max() <= 12  # a tick in each job at the most


@pytest.mark.parametrize("kind", SCENES)
def test_a_request_from_another_thread_is_met_within_a_frame(kind: str) -> None:
    acting = SCENES[kind]()
    frames = None if acting.loop else LONG
    stop, moving = threading.Event(), threading.Event()
    reached, ended = [0], []

    def progress(done: int, total: int) -> None:
        if stop.is_set():
            raise Cancelled
        reached[0] += 1
        if reached[0] == 5:
            moving.set()

    def work() -> None:
        try:
            simulate(acting, frames=frames, progress=progress)
        except Cancelled:
            ended.append(reached[0])

    worker = threading.Thread(target=work)
    worker.start()
    assert moving.wait(60)
    stop.set()
    at_request = reached[0]
    worker.join(60)
    assert len(ended) == 1
    assert 5 <= ended[0] <= at_request + 1
    assert ended[0] < LONG / 2


@pytest.mark.parametrize("kind", ["free", "contact"])
@pytest.mark.parametrize("error", [Cancelled, KeyboardInterrupt])
def test_the_next_run_is_right(kind: str, error: type[BaseException]) -> None:
    acting = SCENES[kind]()
    expected = simulate(acting, frames=9).positions

    def progress(done: int, total: int) -> None:
        if done == 4:
            raise error

    with pytest.raises(error):
        simulate(acting, frames=LONG, progress=progress)
    again = simulate(acting, frames=9).positions
    np.testing.assert_array_equal(again, expected)
    assert np.ptp(again, axis=0).max() > 1
