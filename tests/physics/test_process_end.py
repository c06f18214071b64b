"""A process ends well although a thread of it still simulates: nobody is torn out of a compiled library."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

START = f"""\
import sys, threading, time
sys.path.insert(0, {str(Path(__file__).resolve().parents[1])!r})
import conftest
from physanimator.physics import process_end
from physanimator.physics.errors import Cancelled
"""

# Whoever does some work when the process ends.
WORKING = """\
def work():
    try:
        with process_end.working():
            begun.set()
            some()
    except Cancelled as error:
        print(error, flush=True)
begun = threading.Event()
threading.Thread(target=work, daemon=True).start()
begun.wait()
"""


def ended(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", START + code], capture_output=True, text=True, timeout=60, check=False)


def test_the_end_waits_for_work_and_tells_it_to_stop() -> None:
    done = ended(
        """\
def some():
    for _ in range(1000):
        time.sleep(0.02)
        process_end.stop_at_end()
"""
        + WORKING
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "the process is ending\n", "")


def test_whoever_ends_the_process_does_not_wait_for_itself_and_nothing_begins_any_more() -> None:
    done = ended("""\
import atexit
def late():
    try:
        with process_end.working():
            pass
    except Cancelled as error:
        print(error)
atexit.register(late)
section = process_end.working()
section.__enter__()
""")
    assert (done.returncode, done.stdout, done.stderr) == (0, "the process is ending\n", "")


@pytest.mark.parametrize("seconds", [0.0, 0.15, 0.4])
def test_a_simulation_in_a_daemon_thread_stops_at_the_end(seconds: float) -> None:
    done = ended(f"""\
import numpy as np
from physanimator.physics.scene import automatic_scene
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.scene import Body
from physanimator.physics.simulation import simulate
def work():
    mask = np.zeros((96, 96), bool)
    mask[10:80, 40:50] = True
    try:
        while True:
            simulate(automatic_scene([Body(mesh_from_mask(mask))]), frames=30, progress=lambda *_: begun.set())
    except Exception as error:
        print(error, flush=True)
begun = threading.Event()
threading.Thread(target=work, daemon=True).start()
begun.wait()
time.sleep({seconds})
""")
    assert (done.returncode, done.stderr) == (0, "")
    assert "the process is ending" in done.stdout


@pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")
def test_ctrl_c_does_not_tear_the_end_apart() -> None:
    done = ended(
        """\
import os, signal
def some():
    time.sleep(0.3)
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(0.3)
    process_end.stop_at_end()
"""
        + WORKING
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "the process is ending\n", "")


@pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")
def test_ctrl_c_while_the_last_kernels_are_kept_is_not_heard() -> None:
    done = ended("""\
import os, signal
from physanimator.physics.runtime import taichi_runtime
taichi_runtime.run(int)
runtime = taichi_runtime._taichi_thread
close = runtime._close
def closing():
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(0.5)
    close()
    print("closed", flush=True)
runtime._close = closing
""")
    assert (done.returncode, done.stdout, done.stderr) == (0, "closed\n", "")
