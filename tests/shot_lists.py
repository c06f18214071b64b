"""Lists of tiny shots, and the command that does them in processes of its own."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from physanimator.rendering.pictures import save_image

__all__ = ["begin", "contents", "draw", "environment", "litter", "until", "write_list"]

ROOT = Path(__file__).resolve().parents[1]


def draw(folder: Path) -> None:
    """A picture and a mask."""
    y, x = np.mgrid[0:48, 0:64]
    strip = (np.abs(x - 30) < 6) & (y > 4) & (y < 40)
    save_image(folder / "girl.png", np.stack([80 + x, 200 - y, 160 + 0 * x], axis=-1).astype(np.uint8))
    save_image(folder / "hair.png", strip.astype(np.uint8) * 255)


def write_list(path: Path, shots: Sequence[str], *, defaults: str = "frames = 3") -> None:
    """A list of shots of the picture, each by the lines of its table."""
    text = f'[defaults]\nimage = "girl.png"\nmask = "hair.png"\n{defaults}\n'
    path.write_text(text + "".join(f"\n[[shot]]\n{shot}\n" for shot in shots), encoding="utf-8")


def environment(folder: Path) -> dict[str, str]:
    """What a process needs to find this package, whatever the folder of its sources is called."""
    packages = folder / "packages"
    packages.mkdir(exist_ok=True)
    link = packages / "physanimator"
    if not link.exists():
        link.symlink_to(ROOT, target_is_directory=True)
    return {**os.environ, "PYTHONPATH": str(packages), "OMP_NUM_THREADS": "1"}


def begin(folder: Path, *arguments: str, module: str = "physanimator", **options: Any) -> subprocess.Popen[str]:
    """Begin a module's command in a folder."""
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, **options}
    command = [*options.pop("before", []), sys.executable, "-m", module, *arguments]
    return subprocess.Popen(command, cwd=folder, env=environment(folder), text=True, **options)


def until(holds: Callable[[], Any], *, seconds: float = 60.0) -> Any:
    """Wait until something holds, and give it."""
    end = time.monotonic() + seconds
    while not (found := holds()):
        assert time.monotonic() < end, f"waited for {seconds} s"
        time.sleep(0.05)
    return found


def contents(folder: Path) -> dict[str, bytes]:
    """Every clip of a folder."""
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*.mp4"))}


def litter(folder: Path) -> list[str]:
    """What is neither a clip nor a record."""
    return [path.name for path in folder.iterdir() if not path.name.endswith((".mp4", ".shot.json"))]
