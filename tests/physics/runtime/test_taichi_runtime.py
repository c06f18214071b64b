"""Taichi in a process that it shares with others."""

# No "from __future__ import annotations": Taichi reads the annotations of a kernel as objects.

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.physics.runtime.taichi_runtime import compiled, run

PREAMBLE = f"import sys; sys.path.insert(0, {str(Path(__file__).resolve().parents[2])!r}); import conftest\n"


def build_increment(ti: Any) -> Any:
    @ti.kernel
    def increment(values: ti.types.ndarray(dtype=ti.f32, ndim=1)):
        for i in values:
            values[i] = values[i] + 1.0

    return increment


def increment(values: np.ndarray) -> np.ndarray:
    compiled(build_increment)(values)
    return values


def incremented() -> float:
    values = np.zeros(5, dtype=np.float32)
    run(increment, values)
    assert (values == values[0]).all()
    return float(values[0])


def script(code: str) -> subprocess.CompletedProcess[str]:
    """Run Python code in a process of its own, with the package at hand."""
    return subprocess.run([sys.executable, "-c", PREAMBLE + code], capture_output=True, text=True, timeout=60)


def test_arguments_go_in_and_results_come_out() -> None:
    assert run(lambda a, b: (a, b), 1, b=2) == (1, 2)
    assert incremented() == 1


def test_an_exception_reaches_the_caller_and_hurts_nobody() -> None:
    def fail() -> None:
        raise KeyError("lost")

    with pytest.raises(KeyError, match="lost"):
        run(fail)
    assert incremented() == 1


def test_every_caller_meets_the_same_thread() -> None:
    found: list[Any] = []
    callers = [
        threading.Thread(target=lambda: found.append((run(threading.get_ident), incremented()))) for _ in range(8)
    ]
    for caller in callers:
        caller.start()
    found.append((run(threading.get_ident), incremented()))
    for caller in callers:
        caller.join()
    assert len(found) == 9
    assert set(found) == {(run(threading.get_ident), 1.0)}
    assert run(threading.get_ident) != threading.get_ident()


def test_a_job_may_run_another() -> None:
    assert run(lambda: run(threading.get_ident)) == run(threading.get_ident)


def test_kernels_are_compiled_inside_a_job_only() -> None:
    with pytest.raises(RuntimeError, match="inside a job"):
        compiled(build_increment)


def test_kernels_are_built_once() -> None:
    assert run(compiled, build_increment) is run(compiled, build_increment)


def test_numbers_elsewhere_keep_their_last_digits() -> None:
    """Taichi flushes numbers below 1e-308 to zero, on its own thread alone."""
    assert incremented() == 1
    assert np.float64(1e-308) / 4 > 0
    assert run(lambda: float(np.float64(1e-308) / 4)) == 0


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Ctrl+C raises here even if the tests run in a shell's background, where it is ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_an_interrupted_wait_leaves_everything_usable() -> None:
    """Ctrl+C during one's own job lets it end; a job that is still queued when its caller gives up never runs."""
    ran: list[str] = []
    release = threading.Event()

    def long_job() -> None:
        ran.append("long")
        release.wait(10)
        ran.append("long to its end")

    def queued_job() -> None:
        ran.append("queued")

    other = threading.Thread(target=lambda: run(long_job))
    other.start()
    while not ran:
        time.sleep(0.001)
    timer = threading.Timer(0.2, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        run(queued_job)
    timer.join()
    release.set()
    other.join()
    assert incremented() == 1
    assert ran == ["long", "long to its end"]


def test_the_process_hears_nothing_of_taichi_and_ends_well() -> None:
    """No banner, no announcement, no changed environment, no warning, and a clean end with the thread still there."""
    result = script(
        "import os\n"
        "from physanimator.physics.runtime.taichi_runtime import compiled, run\n"
        "assert 'taichi' not in sys.modules\n"
        "before = dict(os.environ)\n"
        "print(run(compiled, lambda ti: ti.__name__), os.environ == before)\n"
    )
    assert result.stdout == "taichi True\n"
    assert result.stderr == ""
    assert result.returncode == 0


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system has no such signal")
def test_kernels_are_kept_although_a_signal_ends_the_process(tmp_path: Path) -> None:
    code = (
        f"import os, signal; os.environ['TI_OFFLINE_CACHE_FILE_PATH'] = {str(tmp_path)!r}\n"
        "from physanimator.physics.runtime import taichi_runtime\n"
        "from physanimator.nodes.preview.session import warm_up\n"
        "taichi_runtime._WORTH_KEEPING = 0.0\n"
        "warm_up()\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    ended = script(code)
    assert ended.returncode == -signal.SIGKILL, ended.stderr
    assert list(tmp_path.rglob("*.tic"))


@pytest.mark.parametrize("usable", [True, False])
def test_kernels_that_cannot_be_kept_are_not_given_up(usable: bool, tmp_path: Path) -> None:
    """They would have to be compiled again."""
    code = (
        f"import os; os.environ.update(TI_OFFLINE_CACHE_FILE_PATH={str(tmp_path)!r}, TI_OFFLINE_CACHE='{usable:d}')\n"
        "from physanimator.physics.runtime import taichi_runtime\n"
        "taichi_runtime._WORTH_KEEPING = 0.0\n"
        "taichi_runtime.run(taichi_runtime.compiled, lambda ti: ti.__name__)\n"
        "print(taichi_runtime.keep_compiled())\n"
    )
    assert script(code).stdout == f"{usable}\n"


def test_modules_of_the_process_are_not_looked_through_while_taichi_is_imported() -> None:
    script = (
        PREAMBLE
        + """
import types
class Counting(types.ModuleType):
    asked = 0
    @property
    def __file__(self):
        Counting.asked += 1
        return "/nowhere/counting.py"
sys.modules["counting"] = Counting("counting")
from physanimator.physics.runtime.taichi_runtime import compiled, run
run(compiled, lambda ti: None)
assert "taichi" in sys.modules
print(Counting.asked)
"""
    )
    answer = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert int(answer.stdout) < 30  # of some hundred times


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
def test_a_forked_process_is_told_what_to_do() -> None:
    result = script(
        "import os, warnings\n"
        "warnings.simplefilter('ignore')\n"
        "from physanimator.physics.runtime.taichi_runtime import run\n"
        "run(print, 'parent', flush=True)\n"
        "child = os.fork()\n"
        "if child:\n"
        "    os.waitpid(child, 0)\n"
        "else:\n"
        "    try:\n"
        "        run(print, 'never')\n"
        "    except Exception as error:\n"
        "        print(type(error).__name__, error, flush=True)\n"
        "    os._exit(0)\n"
    )
    assert result.stdout.startswith("parent\nPhysAnimatorError Taichi cannot run in a forked process")
    assert "spawn" in result.stdout
