"""How fast a list of shots is done: by workers of so many threads, and by GNU parallel or xargs running ``animate``."""

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
from contextlib import suppress
from pathlib import Path
from typing import Any

import source_tree  # noqa: F401 (loads this source tree as the package physanimator)
from physanimator.rendering.options import DEFAULT_FRAMES
from PIL import Image

__all__ = ["measured", "memory_measured"]

_ROOT = Path(__file__).resolve().parents[2]
_THREADS = "PHYSANIMATOR_THREADS"
_ONE_THREAD = "lines of one thread"
_WAYS = ("1x1", "1x2", "2x1", "2x2", "lines", _ONE_THREAD)
_EXAMPLE = _ROOT / "workflows" / "example"


def _environment(folder: Path) -> dict[str, str]:
    packages = folder / "packages"
    packages.mkdir(exist_ok=True)
    if not (packages / "physanimator").exists():
        (packages / "physanimator").symlink_to(_ROOT, target_is_directory=True)
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    compiled = str(folder / "compiled")  # as an installed package has it, which is compiled once
    return {**kept, "PYTHONPATH": str(packages), "PYTHONPYCACHEPREFIX": compiled, "OMP_NUM_THREADS": "1"}


def _sample_files(samples: Sequence[Path]) -> list[tuple[Path, Path]]:
    """Pictures with a mask each: of sample folders, or the bundled example with each of its masks."""
    if samples:
        return [(each / "composite.png", each / "mask.png") for each in samples]
    masks = sorted(_EXAMPLE.glob("mask_*.png"))
    return [(_EXAMPLE / "illustration.png", mask) for mask in masks]


def _prepared(
    folder: Path, files: Sequence[tuple[Path, Path]], count: int, frames: int, width: int | None
) -> list[list[str]]:
    """Write a list of shots and their pictures; the words of ``animate`` for each, with a clip's name as the last."""
    lines, words = [f"[defaults]\nframes = {frames}\n"], []
    for number, pair in enumerate(files):
        for path, name in zip(pair, ("picture", "mask"), strict=True):
            with Image.open(path) as picture:
                if width is not None:
                    height = round(picture.height * width / picture.width)
                    picture = picture.resize((width, height), Image.Resampling.BOX)
                picture.save(folder / f"{name}{number}.png")
    for number in range(count):
        picture, mask = (f"{name}{number % len(files)}.png" for name in ("picture", "mask"))
        wind = 1 + number / 10
        lines.append(f'[[shot]]\nname = "s{number:04d}"\nimage = "{picture}"\nmask = "{mask}"\nwind = {wind}\n')
        given = ["animate", picture, "--mask", mask, "--frames", str(frames), "--wind", str(wind), "--quiet"]
        words.append([*given, f"s{number:04d}.mp4"])
    (folder / "list.toml").write_text("\n".join(lines), encoding="utf-8")
    return words


def _timed(command: Sequence[str], folder: Path, threads: int | None, text: str | None = None) -> dict[str, float]:
    """Seconds of a whole command, its start included: on the clock, of processors, and what others had of those.

    Args:
        command: the command's words.
        folder: in which it runs.
        threads: that each of its processes may use; as many as they like when None.
        text: for its standard input.
    """
    import psutil

    environment = _environment(folder)
    environment.pop(_THREADS, None)
    if threads is not None:
        environment[_THREADS] = str(threads)
    before, busy, start = resource.getrusage(resource.RUSAGE_CHILDREN), psutil.cpu_times(), time.perf_counter()
    subprocess.run(command, input=text, text=True, cwd=folder, env=environment, check=True)
    seconds = time.perf_counter() - start
    _end_orphans()
    used, end = resource.getrusage(resource.RUSAGE_CHILDREN), psutil.cpu_times()
    processors = used.ru_utime - before.ru_utime + used.ru_stime - before.ru_stime
    others = sum(getattr(end, name) - getattr(busy, name) for name in ("user", "nice", "system")) - processors
    return {"seconds": seconds, "processor_seconds": processors, "others_processor_seconds": max(0.0, others)}


def _adopt_orphans() -> None:
    """Let processes whose parents have ended be ours, so that what they have used of processors is counted."""
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER


def _end_orphans() -> None:
    """Wait for the processes that a command has left, such as that from which its workers were forked."""
    with suppress(ChildProcessError, AttributeError):  # none are left; Windows
        while True:
            os.waitpid(-1, 0)


def _shots(folder: Path, out: str, workers: int, threads: int) -> dict[str, float]:
    command = [sys.executable, "-m", "physanimator", "shots", "list.toml", "-o", out, "--workers", str(workers), "-q"]
    return _timed(command, folder, threads)


def _by_lines(
    folder: Path, out: str, words: Sequence[Sequence[str]], jobs: int, threads: int | None
) -> dict[str, float]:
    """GNU parallel, or xargs where there is none, running one ``animate`` after the other."""
    (folder / out).mkdir()
    program = [sys.executable, "-m", "physanimator"]
    lines = (shlex.join([*program, *each[:-1], "--output", f"{out}/{each[-1]}"]) for each in words)
    text = "".join(f"{line}\n" for line in lines)
    parallel = shutil.which("parallel")
    command = (
        [parallel, "-j", str(jobs)] if parallel else ["xargs", "-P", str(jobs), "-d", "\n", "-I{}", "sh", "-c", "{}"]
    )
    return _timed(command, folder, threads, text)


def _done(way: str, folder: Path, out: str, words: Sequence[Sequence[str]]) -> dict[str, float]:
    """All shots, in one of the ways."""
    if way.startswith("lines"):
        return _by_lines(folder, out, words, 2, 1 if way == "lines of one thread" else None)
    workers, threads = map(int, way.split("x"))
    return _shots(folder, out, workers, threads)


def measured(
    count: int,
    frames: int,
    width: int | None,
    samples: Sequence[Path] = (),
    *,
    ways: Sequence[str] = _WAYS,
    rounds: int = 1,
) -> dict[str, Any]:
    """The same shots in several ways, in turns; each result is compared with the first.

    Args:
        count: shots.
        frames: of each.
        width: to which pictures are scaled [px]; none are when None.
        samples: folders of pictures; the bundled example without any.
        ways: see ``--ways``.
        rounds: how often each; of its runs the fastest counts, which others have disturbed least.
    """
    _adopt_orphans()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        words = _prepared(folder, _sample_files(samples), count, frames, width)
        warm = [sys.executable, "-m", "physanimator", *words[0][:-1], "--output", "warm.mp4"]
        subprocess.run(warm, cwd=folder, env=_environment(folder), check=True)  # kernels are compiled once
        runs: dict[str, list[dict[str, float]]] = {way: [] for way in ways}
        clips, same = dict[str, bytes](), True
        for turn in range(rounds):
            for way in ways:
                runs[way].append(_done(way, folder, f"{way} {turn}", words))
                made = {path.name: path.read_bytes() for path in (folder / f"{way} {turn}").glob("*.mp4")}
                clips = clips or made
                same = same and made == clips and len(made) == count
        best = {way: min(each, key=lambda run: run["seconds"]) for way, each in runs.items()}
        return {
            "shots": count,
            "frames": frames,
            "width": width,
            "cores": os.cpu_count(),
            "lines_by": "GNU parallel -j 2" if shutil.which("parallel") else "xargs -P 2",
            "same_bytes": same,
            "workers_x_threads": best,
            "all_seconds": {way: [round(run["seconds"], 2) for run in each] for way, each in runs.items()},
            **_ratios({way: run["seconds"] for way, run in best.items()}),
        }


def _ratios(seconds: dict[str, float]) -> dict[str, float]:
    """How much faster two workers are than one, and than the lines, as far as these were measured."""
    found = {}
    for name, slow in (("scaling", "1x1"), ("lines_to_2x1", "lines"), ("lines_of_one_thread_to_2x1", _ONE_THREAD)):
        if {slow, "2x1"} <= seconds.keys():
            found[name] = seconds[slow] / seconds["2x1"]
    return found


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
    parser.add_argument("--frames", type=int, default=DEFAULT_FRAMES, help="of each (default: %(default)s, as animate)")
    parser.add_argument(
        "--width", type=int, help="scale the pictures to this [px]; small ones show what starting takes"
    )
    parser.add_argument("--samples", type=Path, nargs="+", default=[], help="folders with composite.png and mask.png")
    parser.add_argument(
        "--ways", nargs="+", choices=_WAYS, default=_WAYS, help="2x1: two workers of one thread each (default: all)"
    )
    parser.add_argument("--rounds", type=int, default=1, help="how often each way, in turns; the fastest run counts")
    parser.add_argument("--many", type=int, metavar="N", help="only do N tiny shots, and measure memory")
    parser.add_argument("--json", action="store_true", help="print JSON, as always")
    given = parser.parse_args()
    figures = (
        memory_measured(given.many, 64)
        if given.many
        else measured(
            given.shots, given.frames, given.width, given.samples, ways=tuple(given.ways), rounds=given.rounds
        )
    )
    print(json.dumps(figures, indent=2))


if __name__ == "__main__":
    main()
