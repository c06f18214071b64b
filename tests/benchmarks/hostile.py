"""Thousands of mutated scene documents and preview requests: each a scene or one sentence, in little time and memory.

Seconds are those of the computing thread, so that other work on the machine does not count. Megabytes of a document
are the most that the process held meanwhile above what it held before (on Linux; elsewhere, by how much the document
raised the most that the process has held). The peak is above what it held at the beginning, with what previews keep.

    python tests/benchmarks/hostile.py --count 10000 --json

Counts what came of them, and tells the slowest, the largest, and every error that is no sentence. What is slow or wrong
is told at once on standard error; one that does not end is given up at --limit, with its stack.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import resource
import sys
import time
import traceback
from collections import Counter
from contextlib import suppress
from pathlib import Path
from typing import Any

import source_tree
from physanimator.nodes.preview import preview_scene, read_request
from physanimator.physics.assembly import Preparations, plan
from physanimator.physics.document import read_json, scene_from_dict
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.simulation import simulate

_mutations = source_tree.helper("mutations")
_WORK = 1e8  # triangle updates of the simulation that follows, a second of them at most
_TOLD_EVERY = 500
_SLOW = 1.0  # [s]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--simulate", action="store_true", help="also simulate a frame of what is accepted")
    parser.add_argument("--limit", type=float, default=120.0, help="seconds for one of them, before all is given up")
    options = parser.parse_args()
    bodies, kept = _mutations.patches(), Preparations(most=8)
    before, report = _held()[0], _Report()
    for seed in range(options.first, options.first + options.count):
        faulthandler.dump_traceback_later(options.limit, exit=True)
        report.run(seed, bodies, kept, simulates=options.simulate)
        if (seed - options.first) % _TOLD_EVERY == _TOLD_EVERY - 1:
            _tell(f"{seed + 1 - options.first} of {options.count}: {dict(report.outcomes)}")
    faulthandler.cancel_dump_traceback_later()
    found = report.found() | {"count": options.count, "peak_mb": round(report.most - before, 1)}
    print(json.dumps(found, indent=2) if options.json else "\n".join(f"{key}: {value}" for key, value in found.items()))
    sys.exit(1 if report.faults else 0)


class _Report:
    """What came of each."""

    def __init__(self) -> None:
        self.outcomes: Counter[str] = Counter()
        self.slow: list[tuple[float, int, str]] = []
        self.large: list[tuple[float, int]] = []
        self.faults: list[str] = []
        self.most = 0.0  # [MB]

    def run(self, seed: int, bodies: list[Any], kept: Preparations, *, simulates: bool) -> None:
        body = _mutations.mutated_request(seed) if seed % 2 else _mutations.mutated_document(seed)
        _forget_peak()
        begun, before = time.thread_time(), _held()[0]
        stage = "scene"
        try:
            if isinstance(body, bytes):
                scene, _ = preview_scene(read_request(body), bodies)
                stage = "prepared"
                kept(scene)
            else:
                scene = scene_from_dict(read_json(body), meshes=[each.mesh for each in bodies])
            self._took(begun, seed, "scene")
            begun, stage = time.thread_time(), "planned"
            plan(scene, frames=5)
            if simulates:
                stage = "simulated"
                simulate(scene, frames=None if scene.loop else 2, max_work=_WORK)
            self.outcomes["a scene"] += 1
        except InvalidInputError as error:
            self.outcomes["a sentence"] += 1
            self._check_sentence(seed, str(error))
        except Exception as error:
            self.outcomes["a fault"] += 1
            where = traceback.extract_tb(error.__traceback__)[-1]
            self._fault(f"{seed} {stage}: {type(error).__name__} {error!s:.100} at {where.filename}:{where.lineno}")
        self._took(begun, seed, stage)
        peak = _held()[1]
        self.large.append((peak - before, seed))
        self.most = max(self.most, peak)

    def _took(self, begun: float, seed: int, stage: str) -> None:
        seconds = time.thread_time() - begun
        self.slow.append((seconds, seed, stage))
        if seconds > _SLOW:
            _tell(f"slow: {seed} {stage} {seconds:.2f} s")

    def _fault(self, told: str) -> None:
        self.faults.append(told)
        _tell(f"fault: {told}")

    def _check_sentence(self, seed: int, text: str) -> None:
        digits = max((len(run) for run in "".join(c if c.isdigit() else " " for c in text).split()), default=0)
        if not text.isprintable() or len(text) > 1300 or digits > 100:
            self._fault(f"{seed}: no sentence: {text[:300]!r}")

    def found(self) -> dict[str, Any]:
        return {
            "outcomes": dict(self.outcomes),
            "slowest": [[round(seconds, 3), seed, stage] for seconds, seed, stage in sorted(self.slow)[-6:]],
            "largest_mb": [[round(grown, 1), seed] for grown, seed in sorted(self.large)[-4:]],
            "faults": self.faults[:30],
            "number_of_faults": len(self.faults),
        }


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _held() -> tuple[float, float]:
    """Memory that the process holds, and the most since the last ``_forget_peak`` [MB]."""
    with suppress(OSError):
        lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
        found = {
            name: int(rest.split()[0]) / 1024
            for name, _, rest in (line.partition(":") for line in lines if "kB" in line)
        }
        return found["VmRSS"], found["VmHWM"]
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return most, most


def _forget_peak() -> None:
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="utf-8")


if __name__ == "__main__":
    main()
