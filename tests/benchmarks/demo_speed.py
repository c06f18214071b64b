"""How long one waits for the bundled example: from nothing to its first frame, to its video, and for a clean plate."""

from __future__ import annotations

import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from physanimator.physics.document import read_json
from physanimator.rendering.pictures import load_image, load_mask
from physanimator.rendering.plate import clean_plate

__all__ = ["demo_measured", "plate_measured"]

_ROOT = Path(__file__).resolve().parents[2]
_EXAMPLE = _ROOT / "workflows" / "example"

# Seconds since the process was asked for, at the first sign of work and at the first frame.
_FIRST_FRAME = """
import sys, time
asked = float(sys.argv[1])
from physanimator.rendering.command.example import read_example
from physanimator.rendering.options import Timing, Watch
from physanimator.rendering.pipeline import animate
heard = []
image, masks, scene = read_example()
watch = Watch(progress=lambda stage, done, total: heard.append(time.time() - asked))
animation = animate(image, masks, scene=scene, timing=Timing(frames=72), watch=watch)
next(iter(animation.frames()))
print(heard[0], time.time() - asked)
"""


def plate_measured(rounds: int = 3) -> dict[str, float]:
    """Clean plates of the example's parts, each alone, against cv2.remap of the same RGB frame."""
    image = load_image(_EXAMPLE / "illustration.png")
    height, width = image.shape[:2]
    rows, columns = np.mgrid[0:height, 0:width].astype(np.float32)
    map_x, map_y = columns + 3.3 * np.sin(rows / 40), rows + 2.7 * np.cos(columns / 50)
    scene, ratios = read_json((_EXAMPLE / "scene.json").read_text(encoding="utf-8")), {}
    for body in scene["bodies"]:
        mask = load_mask(_EXAMPLE / f"mask_{body['name']}.png", width=width, height=height)
        found = []
        for number in range(rounds):
            other = cv2.add(image, number)  # nothing is known of it from an earlier round
            remaps = [_seconds(lambda: cv2.remap(image, map_x, map_y, cv2.INTER_LINEAR)) for _ in range(21)]
            found.append(_seconds(lambda mask=mask, other=other: clean_plate(other, mask)) / statistics.median(remaps))
        ratios[body["name"]] = statistics.median(found)
    return ratios


def demo_measured(rounds: int = 3) -> dict[str, Any]:
    """``physanimator demo`` in new processes: medians of ``rounds``, and where the time of the last one went.

    The first frame is timed without any kernels on disk; the whole demo with them. Python's modules are compiled in
    both, as they are once a package has been installed.
    """
    with tempfile.TemporaryDirectory() as folder:
        output, whole, modules = Path(folder, "demo.mp4"), [], Path(folder, "modules")
        _demo(output, modules)
        first = [_first_frame(Path(folder, f"kernels{number}"), modules) for number in range(rounds)]
        for _ in range(rounds):
            start = time.perf_counter()
            report = _demo(output, modules)
            whole.append(time.perf_counter() - start)
    stages = {name: float(took) for name, took in re.findall(r"^(\w+) +([\d.]+) s$", report, re.MULTILINE)}
    stages["start"] = whole[-1] - sum(stages.values())
    return {
        "first_progress_cold_s": statistics.median(heard for heard, _ in first),
        "first_frame_cold_s": statistics.median(drawn for _, drawn in first),
        "demo_warm_s": statistics.median(whole),
        "demo_stages_s": stages,
    }


def _first_frame(kernels: Path, modules: Path) -> tuple[float, float]:
    kernels.mkdir()
    more = {"TI_OFFLINE_CACHE_FILE_PATH": str(kernels)}
    heard, drawn = _run(["-c", _FIRST_FRAME, str(time.time())], modules, **more).stdout.split()
    return float(heard), float(drawn)


def _demo(output: Path, modules: Path) -> str:
    return _run(["-m", "physanimator", "demo", "--verbose", "--output", str(output)], modules).stderr


def _run(arguments: list[str], modules: Path, **more: str) -> subprocess.CompletedProcess[str]:
    """A new process that takes this source tree for the package, and keeps compiled modules in a folder."""
    path = os.pathsep.join(filter(None, [str(_ROOT.parent), os.environ.get("PYTHONPATH")]))
    environment = os.environ | more | {"PYTHONPATH": path, "PYTHONPYCACHEPREFIX": str(modules)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    return subprocess.run([sys.executable, *arguments], env=environment, check=True, capture_output=True, text=True)


def _seconds(function: Any) -> float:
    start = time.perf_counter()
    function()
    return time.perf_counter() - start
