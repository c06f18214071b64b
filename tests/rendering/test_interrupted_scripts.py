"""A script of the user's own that a signal ends: as it would without the library, with nothing left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = """
import os, runpy, signal, sys
runpy.run_path(sys.argv[1])
import numpy as np
from physanimator.rendering.options import Saving, Timing, Watch
from physanimator.rendering.pipeline import animate

output, number, way = sys.argv[2], int(sys.argv[3]), sys.argv[4]

def advance(stage, done, total):
    if stage == "render" and done == 3:
        print("sent", flush=True)
        os.kill(os.getpid(), number)

picture = np.full((60, 60, 3), 230, np.uint8)
picture[10:50, 20:40] = (200, 60, 40)
mask = np.zeros((60, 60))
mask[10:50, 20:40] = 1
watch, timing = Watch(progress=advance), Timing(frames=400)
if way == "meanwhile":
    animate(picture, [mask], timing=timing, watch=watch, save=Saving(output))
else:
    animate(picture, [mask], timing=timing).save(output, progress=advance)
print("went on")
"""


@pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
@pytest.mark.parametrize(("output", "way"), [("a.mp4", "after"), ("f/", "after"), ("a.webp", "meanwhile")])
def test_nothing_is_left_behind(tmp_path: Path, name: str, output: str, way: str) -> None:
    number = getattr(signal, name)
    arguments = [str(ROOT / "tests" / "conftest.py"), f"{tmp_path}/{output}", str(int(number)), way]
    environment = {**os.environ, "PHYSANIMATOR_THREADS": "2"}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, *arguments], capture_output=True, text=True, env=environment, check=False
    )
    assert "sent" in done.stdout, done.stderr
    assert "went on" not in done.stdout
    assert done.returncode == -number
    assert list(tmp_path.iterdir()) == []
    assert done.stderr.endswith("KeyboardInterrupt\n") if name == "SIGINT" else not done.stderr
