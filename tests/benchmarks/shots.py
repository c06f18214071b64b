"""How fast a list of shots is done: by one and by two workers, and by GNU parallel (or xargs) running ``animate``."""

from __future__ import annotations

import argparse
import json
import os
import re
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from PIL import Image

__all__ = ["measured", "memory_measured"]

_ROOT = Path(__file__).resolve().parents[2]
_EXAMPLE = _ROOT / "workflows" / "example"


def _environment(folder: Path) -> dict[str, str]:
    packages = folder / "packages"
    packages.mkdir(exist_ok=True)
    if not (packages / "physanimator").exists():
        (packages / "physanimator").symlink_to(_ROOT, target_is_directory=True)
    return {**os.environ, "PYTHONPATH": str(packages), "OMP_NUM_THREADS": "1"}


def _sample_files(samples: Sequence[Path]) -> list[tuple[Path, Path]]:
    """Pictures with a mask each: of sample folders, or the bundled example with each of its masks."""
    if samples:
        return [(each / "composite.png", each / "mask.png") for each in samples]
    masks = sorted(_EXAMPLE.glob("mask_*.png"))
    return [(_EXAMPLE / "illustration.png", mask) for mask in masks]


def _prepared(folder: Path, files: Sequence[tuple[Path, Path]], count: int, frames: int, width: int) -> list[list[str]]:
    """Write a list of shots and smaller pictures; and the words of ``animate`` for each of its shots."""
    lines, words = [f"[defaults]\nframes = {frames}\n"], []
    for number, pair in enumerate(files):
        for path, name in zip(pair, ("picture", "mask"), strict=True):
            with Image.open(path) as picture:
                height = round(picture.height * width / picture.width)
                picture.resize((width, height), Image.Resampling.BOX).save(folder / f"{name}{number}.png")
    for number in range(count):
        picture, mask = (f"{name}{number % len(files)}.png" for name in ("picture", "mask"))
        wind = 1 + number / 10
        lines.append(f'[[shot]]\nname = "s{number:04d}"\nimage = "{picture}"\nmask = "{mask}"\nwind = {wind}\n')
        given = ["animate", picture, "--mask", mask, "--frames", str(frames), "--wind", str(wind), "--quiet"]
        words.append([*given, "--output", f"by_lines/s{number:04d}.mp4"])
    (folder / "list.toml").write_text("\n".join(lines), encoding="utf-8")
    return words


def _timed(command: Sequence[str], folder: Path, text: str | None = None) -> dict[str, float]:
    """Seconds of a whole command, its start included: on the clock, and of processors, which others do not disturb."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(command, input=text, text=True, cwd=folder, env=_environment(folder), check=True)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    processors = used.ru_utime - before.ru_utime + used.ru_stime - before.ru_stime
    return {"seconds": time.perf_counter() - start, "processor_seconds": processors}


def _shots(folder: Path, out: str, workers: int) -> dict[str, float]:
    command = [sys.executable, "-m", "physanimator", "shots", "list.toml", "-o", out, "--workers", str(workers), "-q"]
    return _timed(command, folder)


def _by_lines(folder: Path, words: Sequence[Sequence[str]], jobs: int) -> dict[str, Any]:
    """GNU parallel, or xargs where there is none, running one ``animate`` after the other."""
    (folder / "by_lines").mkdir()
    text = "".join(f"{shlex.join([sys.executable, '-m', 'physanimator', *each])}\n" for each in words)
    parallel = shutil.which("parallel")
    command = (
        [parallel, "-j", str(jobs)] if parallel else ["xargs", "-P", str(jobs), "-d", "\n", "-I{}", "sh", "-c", "{}"]
    )
    return {"program": "GNU parallel" if parallel else "xargs -P", **_timed(command, folder, text)}


def measured(count: int, frames: int, width: int, samples: Sequence[Path] = ()) -> dict[str, Any]:
    """The same shots by one worker, by two, and by two jobs of ``animate``; each result is compared."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        words = _prepared(folder, _sample_files(samples), count, frames, width)
        warm = [*words[0][:-1], "warm.mp4"]  # kernels are compiled, and files read, once
        subprocess.run([sys.executable, "-m", "physanimator", *warm], cwd=folder, env=_environment(folder), check=True)
        one, two = _shots(folder, "one", 1), _shots(folder, "two", 2)
        lines = _by_lines(folder, words, 2)
        clips = [path.name for path in sorted((folder / "one").glob("*.mp4"))]
        same = [len({(folder / out / clip).read_bytes() for out in ("one", "two", "by_lines")}) == 1 for clip in clips]
        return {
            "shots": count,
            "frames": frames,
            "width": width,
            "same_bytes": len(clips) == count and all(same),
            "one_worker": one,
            "two_workers": two,
            "lines": lines,
            "scaling": one["seconds"] / two["seconds"],
            "lines_to_two_workers": lines["seconds"] / two["seconds"],
        }


def memory_measured(count: int, width: int) -> dict[str, Any]:
    """Many tiny shots by two workers: that each was done once, and the most memory of the client with its scheduler."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _prepared(folder, _sample_files(()), count, 2, width)
        command = [sys.executable, "-m", "physanimator", "shots", "list.toml", "-o", "out", "--workers", "2"]
        start = time.perf_counter()
        client = subprocess.Popen(command, cwd=folder, env=_environment(folder), stdout=subprocess.PIPE, text=True)
        assert client.stdout is not None
        ended, memory = [], []
        for line in client.stdout:
            if found := re.match(r"\[(\d+)/\d+\] (\S+): done", line):
                ended.append(found[2])
                memory.append(_resident(client.pid))
        client.wait()
        return {
            "shots": count,
            "each_once": sorted(ended) == sorted(set(ended)) and len(ended) == count,
            "seconds": time.perf_counter() - start,
            "client_and_scheduler_MB_after_a_tenth": memory[count // 10],
            "client_and_scheduler_MB_at_the_end": memory[-1],
        }


def _resident(process: int) -> float:
    """Memory of a process [MB]."""
    import psutil

    return float(psutil.Process(process).memory_info().rss) / 1e6


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--shots", type=int, default=24)
    parser.add_argument("--frames", type=int, default=48)
    parser.add_argument("--width", type=int, default=640, help="of the pictures [px]")
    parser.add_argument("--samples", type=Path, nargs="+", default=[], help="folders with composite.png and mask.png")
    parser.add_argument("--many", type=int, metavar="N", help="only do N tiny shots, and measure memory")
    parser.add_argument("--json", action="store_true", help="print JSON, as always")
    given = parser.parse_args()
    figures = (
        memory_measured(given.many, 64)
        if given.many
        else measured(given.shots, given.frames, given.width, given.samples)
    )
    print(json.dumps(figures, indent=2))


if __name__ == "__main__":
    main()
