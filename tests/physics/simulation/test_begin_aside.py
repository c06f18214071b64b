"""A simulation in a process of its own, begun ahead: the same motion, and other threads go on meanwhile."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import PhysAnimatorError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.runtime import taichi_runtime
from physanimator.physics.runtime.worker import TaichiWorker
from physanimator.physics.scene import Body, Scene, automatic_scene
from physanimator.physics.simulation import begin_aside, simulate, simulated_beside


@pytest.fixture
def scene() -> Scene:
    return automatic_scene([Body(mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10))])


def test_the_motion_is_the_same(scene: Scene) -> None:
    here = simulate(scene, frames=6).positions
    begin_aside()
    begin_aside()
    with simulated_beside():
        aside = simulate(scene, frames=6).positions
    np.testing.assert_array_equal(aside, here)
    assert np.ptp(aside, axis=0).max() > 0.01


def test_where_no_process_can_be_started_it_runs_here(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(self: TaichiWorker) -> None:
        raise PhysAnimatorError("no interpreter")

    before = simulate(scene, frames=4).positions
    monkeypatch.setattr(TaichiWorker, "start", fail)
    monkeypatch.setattr(taichi_runtime._taichi_thread, "_worker_fails", False)
    begin_aside()
    with simulated_beside():
        np.testing.assert_array_equal(simulate(scene, frames=4).positions, before)
