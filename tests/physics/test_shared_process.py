"""Simulations in a process in which others use Taichi, and from threads beside a working main thread."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

START = f"""\
import sys, threading
sys.path.insert(0, {str(Path(__file__).resolve().parents[1])!r})
import conftest
import numpy as np

def simulated(progress=None):
    from physanimator.physics.collision import Contact
    from physanimator.physics.meshing import mesh_from_mask
    from physanimator.physics.rig import Circle, RigPoint
    from physanimator.physics.scene import Body, Scene
    from physanimator.physics.simulation import simulate
    from physanimator.physics.strokes import EnergyStroke
    y, x = np.mgrid[:120, :120] + 0.5
    mesh = mesh_from_mask((np.abs(x - 60) < 12) & (y > 15) & (y < 100), spacing=8)
    wind = EnergyStroke(path=((0, 60), (120, 60)), radius=60, speed=200, strength=4, interval=0.2)
    scene = Scene((Body(mesh),), (wind,), (RigPoint((60, 15), Circle(16)),), contact=Contact(self_contact=True))
    plain = simulate(Scene(scene.bodies, scene.strokes, scene.rig_points), frames=8, progress=progress)
    touching = simulate(scene, frames=8, progress=progress)
    assert np.ptp(plain.positions, axis=0).max() > 1
    return plain.positions.tobytes() + touching.positions.tobytes()

def foreign():
    '''What another library does: its own program, field and kernel.'''
    import taichi as ti
    ti.init(ti.cpu, log_level=ti.ERROR)
    field = ti.field(ti.f32, 64)

    @ti.kernel
    def fill(value: ti.f32):
        for i in field:
            field[i] = value + i

    fill(3.0)
    assert field.to_numpy()[10] == 13.0

"""

SCRIPTS = {
    "before, between and after": """\
foreign()
results = [simulated()]
foreign(); foreign()
results.append(simulated())
import taichi
taichi.reset()
results.append(simulated())
foreign()
""",
    "in the middle": """\
def intrude(done, total):
    if done in (2, 5):
        foreign()
results = [simulated(intrude), simulated()]
""",
    "a worker beside a working main thread": """\
results = []
worker = threading.Thread(target=lambda: results.extend(simulated() for _ in range(4)))
worker.start()
while worker.is_alive():
    a = np.random.default_rng(0).normal(size=(150, 150))
    assert np.isfinite(np.linalg.svd(a @ a.T, compute_uv=False)).all()
worker.join()
""",
    "a worker beside a main thread that initialises": """\
results = []
worker = threading.Thread(target=lambda: results.extend(simulated() for _ in range(3)))
worker.start()
import taichi
for _ in range(8):
    try:
        taichi.init(taichi.cpu, log_level=taichi.ERROR)
    except RuntimeError as error:  # Taichi's own answer to two initialisations at once
        assert "Only one instance at a time" in str(error)
    worker.join(0.05)
worker.join()
results.append(simulated())
""",
    "workers together, one of them still at work at the end": """\
results = []
workers = [threading.Thread(target=lambda: results.append(simulated())) for _ in range(3)]
[worker.start() for worker in workers]
results.append(simulated())
[worker.join() for worker in workers]
threading.Thread(target=lambda: [simulated() for _ in range(1000)], daemon=True).start()
results.append(simulated())
""",
}


def ended(code: str, folder: Path) -> list[str]:
    """What a script of its own process printed; it must end well."""
    script = folder / "script.py"  # a file, because Taichi reads the source of kernels
    end = "\nimport hashlib\nfor result in results:\n    print('result', hashlib.sha256(result).hexdigest())\n"
    script.write_text(START + code + end, encoding="utf-8")
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stderr[-2000:]
    return [line for line in done.stdout.splitlines() if line.startswith("result")]


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> str:
    """What the simulations give in a process of their own."""
    (found,) = ended("results = [simulated()]", tmp_path_factory.mktemp("alone"))
    return found


@pytest.mark.parametrize("others", SCRIPTS)
def test_others_change_nothing(others: str, alone: str, tmp_path: Path) -> None:
    results = ended(SCRIPTS[others], tmp_path)
    assert results
    assert set(results) == {alone}
