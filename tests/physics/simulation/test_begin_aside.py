"""A simulation in a process of its own, begun ahead: the same motion, and other threads go on meanwhile."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.errors import PhysAnimatorError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.runtime import taichi_runtime
from physanimator.physics.runtime.worker import TaichiWorker
from physanimator.physics.scene import Body, Scene, automatic_scene
from physanimator.physics.simulation import begin_aside, simulate, simulated_beside
from physanimator.physics.threads import THREADS


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


def test_of_one_thread_no_process_is_begun(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(self: TaichiWorker) -> None:
        pytest.fail("a process was begun")

    monkeypatch.setenv(THREADS, "1")
    monkeypatch.setattr(TaichiWorker, "start", fail)
    begin_aside()
    with simulated_beside():
        assert np.ptp(simulate(scene, frames=6).positions, axis=0).max() > 0.01


def test_parts_move_alike_on_any_number_of_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether there are fewer threads than parts or more."""
    masks = [np.zeros((160, 60)) for _ in range(5)]
    for number, mask in enumerate(masks):
        mask[10 : 40 + 25 * number, 10:50] = 1
    scene, found = automatic_scene([Body(mesh_from_mask(mask, spacing=10)) for mask in masks]), []
    for threads in ("1", "2", "8"):
        monkeypatch.setenv(THREADS, threads)
        found.append(simulate(scene, frames=6).positions)
    assert np.ptp(found[0], axis=0).max() > 0.01
    for each in found[1:]:
        np.testing.assert_array_equal(each, found[0])


def test_where_no_process_can_be_started_it_runs_here(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(self: TaichiWorker) -> None:
        raise PhysAnimatorError("no interpreter")

    before = simulate(scene, frames=4).positions
    monkeypatch.setattr(TaichiWorker, "start", fail)
    monkeypatch.setattr(taichi_runtime._taichi_thread, "_worker_fails", False)
    begin_aside()
    with simulated_beside():
        np.testing.assert_array_equal(simulate(scene, frames=4).positions, before)


@pytest.mark.skipif(os.name == "nt", reason="symbolic links need rights on Windows")
def test_a_process_that_ends_at_once_does_not_wait_for_kernels(tmp_path: Path) -> None:
    """As after bad input; on an empty disk cache they would take seconds."""
    program = """
import time
from physanimator.physics.runtime import taichi_runtime
from physanimator.physics.simulation import begin_aside
begin_aside()
while taichi_runtime._taichi_thread._worker._process is None:
    time.sleep(0.001)
"""
    package, kernels = tmp_path / "package", tmp_path / "kernels"
    for folder in (package, kernels):
        folder.mkdir()
    (package / "physanimator").symlink_to(Path(__file__).resolve().parents[3], target_is_directory=True)
    variables = {"PYTHONPATH": str(package), "TI_OFFLINE_CACHE_FILE_PATH": str(kernels), THREADS: "2"}
    environment = os.environ | variables
    subprocess.run([sys.executable, "-c", program], env=environment, check=True, capture_output=True, timeout=60)
    assert not list(kernels.rglob("*.tic"))
