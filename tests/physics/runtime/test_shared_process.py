"""Simulations in a process in which others use Taichi, and from threads beside a working main thread."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

START = f"""\
import sys, threading
sys.path.insert(0, {str(Path(__file__).resolve().parents[2])!r})
import conftest
import numpy as np

def simulated(progress=None):
    from physanimator.physics.scene import Contact
    from physanimator.physics.mesh import mesh_from_mask
    from physanimator.physics.rig import Circle, RigPoint
    from physanimator.physics.scene import Body, Scene
    from physanimator.physics.simulation import simulate
    from physanimator.physics.forces import EnergyStroke
    y, x = np.mgrid[:120, :120] + 0.5
    mesh = mesh_from_mask((np.abs(x - 60) < 12) & (y > 15) & (y < 100), spacing=8)
    wind = EnergyStroke(path=((0, 60), (120, 60)), radius=60, speed=200, strength=4, interval=0.2)
    scene = Scene((Body(mesh),), (wind,), (RigPoint((60, 15), Circle(16)),), contact=Contact(self_contact=True))
    plain = simulate(Scene(scene.bodies, scene.strokes, scene.rig_points), frames=8, progress=progress)
    touching = simulate(scene, frames=8, progress=progress)
    assert np.ptp(plain.positions, axis=0).max() > 1
    return plain.positions.tobytes() + touching.positions.tobytes()

def foreign():
    '''What another library does: its own program, field and kernel; the program before it goes with its fields.'''
    import taichi as ti
    ti.init(ti.cpu, log_level=ti.ERROR)
    theirs.clear()
    field = ti.field(ti.f32, 64)

    @ti.kernel
    def fill(value: ti.f32):
        for i in field:
            field[i] = value + i

    fill(3.0)
    assert field.to_numpy()[10] == 13.0
    theirs.extend([field, fill])

theirs = []

def unharmed():
    '''Its field has kept its values, and its kernel still runs.'''
    field, fill = theirs
    kept = field.to_numpy()[10]
    fill(kept)
    assert field.to_numpy()[10] == kept + 10
    return kept

"""

SCRIPTS = {
    "before, between and after": """\
foreign()
results = [simulated()]
assert unharmed() == 13
foreign(); foreign()
results.append(simulated())
assert unharmed() == 13
import taichi
taichi.reset()
results.append(simulated())
foreign()
""",
    "after, and then in turn": """\
results = [simulated()]
foreign()
for number in range(2):
    results.append(simulated())
    assert unharmed() == 13 + 10 * number
""",
    "a reset alone": """\
results = [simulated()]
import taichi
taichi.reset()
results.append(simulated())
assert taichi.lang.impl.get_runtime().prog is None
""",
    "in the middle": """\
def intrude(done, total):
    if done in (2, 5):
        foreign()
results = [simulated(intrude)]
assert unharmed() == 13
results.append(simulated())
assert unharmed() == 23
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
    "nobody but us, aside": """\
from physanimator.physics import taichi_runtime
with taichi_runtime.aside():
    results = [simulated()]
assert "taichi" not in sys.modules
first = taichi_runtime._taichi_thread._worker._process
assert first.returncode is None
results.append(simulated())
assert "taichi" in sys.modules
foreign()
with taichi_runtime.aside():
    results.append(simulated())
results.append(simulated())
assert taichi_runtime._taichi_thread._worker._process is first
""",
    "nobody but us, aside where there is no interpreter": """\
from physanimator.physics import taichi_runtime
sys.executable = ""
with taichi_runtime.aside():
    results = [simulated()]
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
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=600)
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


def told(code: str, folder: Path) -> str:
    """What a script printed, where it ended well."""
    script = folder / "script.py"
    script.write_text(START + code, encoding="utf-8")
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]
    return "".join(line for line in done.stdout.splitlines(True) if not line.startswith("[Taichi]"))


WORKER = "from physanimator.physics.runtime import taichi_runtime\nworker = taichi_runtime._taichi_thread._worker\n"


def test_a_process_of_our_own_is_used_again_lets_go_and_ends_with_this_one(tmp_path: Path) -> None:
    code = """\
foreign(); simulated()
process = worker._process
simulated()
assert worker._process is process
import gc; gc.collect()
taichi_runtime.run(worker.end_idle)
assert process.returncode == 0
simulated()
print(worker._process.pid)
"""
    pid = int(told(WORKER + code, tmp_path))
    if hasattr(os, "kill") and sys.platform != "win32":
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


def test_a_process_of_our_own_that_dies_is_one_sentence_and_the_next_simulation_works(tmp_path: Path) -> None:
    code = """\
foreign()
def kill(done, total):
    if done == 4:
        worker._process.kill()
try:
    simulated(kill)
except Exception as error:
    print(type(error).__name__, error)
simulated(); unharmed()
"""
    answer = told(WORKER + code, tmp_path)
    assert answer.startswith("PhysAnimatorError The process in which PhysAnimator simulates has ended before its work")
    assert answer.count("\n") == 1


@pytest.mark.parametrize("executable", ["", "/opt/host/SomeHost"])
def test_without_an_interpreter_it_is_refused_before_anything_dies(executable: str, tmp_path: Path) -> None:
    code = f"""\
foreign()
sys.executable = {executable!r}
try:
    simulated()
except Exception as error:
    print(type(error).__name__, error)
assert unharmed() == 13
"""
    answer = told(code, tmp_path)
    assert answer.startswith(
        "PhysAnimatorError Another extension uses Taichi in this process, of which there can be only"
    )
    assert answer.count("\n") == 1


def test_a_simulation_in_a_process_of_our_own_is_cancelled_between_frames(tmp_path: Path) -> None:
    code = """\
from physanimator.physics.errors import Cancelled
foreign()
seen = []
def stop(done, total):
    seen.append(done)
    if done == 3:
        raise Cancelled("enough")
try:
    simulated(stop)
except Cancelled:
    print(seen)
simulated()
"""
    assert told(code, tmp_path) == "[1, 2, 3]\n"


def test_the_package_may_have_any_name(tmp_path: Path) -> None:
    """A host names an extension by the path of its folder."""
    code = """\
import importlib.util, pathlib
root = pathlib.Path(conftest.ROOT)
name = str(root).replace(".", "_x_")
spec = importlib.util.spec_from_file_location(name, root / "__init__.py", submodule_search_locations=[str(root)])
sys.modules[name] = module = importlib.util.module_from_spec(spec)
spec.loader.exec_module(module)
first = simulated()
for key in [key for key in sys.modules if key.startswith("physanimator")]:
    del sys.modules[key]
foreign()
solver = importlib.import_module(name + ".physics.runtime.taichi_runtime")
numbers = importlib.import_module(name + ".nodes.preview.session")
numbers.warm_up()
assert solver._taichi_thread._worker._process is not None
unharmed()
"""
    told(code, tmp_path)
