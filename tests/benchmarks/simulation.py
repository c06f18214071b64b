"""Times the solver against other ways to integrate the same substeps, on the same meshes in the same run.

    python tests/benchmarks/simulation.py --json

Prints ``{"mtri_per_s": {name: {"1k": _, ...}}, "ratios": {peer: {"1k": ours over it, ...}}, ...}``: million triangle
updates (one triangle in one substep) a second, the best of several rounds in which all take turns, so that a slow
moment hits all alike. Before that, all must agree to 1e-5 of the largest displacement. Peers are installed with
``pip install 'physanimator[bench]'``; one that is missing, or has no compiler, is null.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import meshes
import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from contact_cost import contact_costs
from peers.problem import Advance, Problem
from physanimator.physics.assembly import assemble, plan
from physanimator.physics.material import Material, preset
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import Circle, Pinned, RigPoint
from physanimator.physics.scene import Body, Scene, automatic_scene
from physanimator.physics.simulation import simulate
from physanimator.physics.simulation.simulation import _solid
from physanimator.physics.solver import TICK, Drive, Solid, State
from physanimator.physics.solver import advance as advance_solid

# Threads of one contestant that wait for more work would hold a processor in the next one's turn.
os.environ.setdefault("KMP_BLOCKTIME", "0")
_PAUSE_SECONDS = 0.03

SIZES = {"1k": 1_000, "5k": 5_000, "50k": 50_000}
AGREEMENT = 1e-5
PEERS = {
    "warp": ("warp_kernel", "one_core"),
    "numba_one_core": ("numba_loops", "one_core"),
    "numba_two_cores": ("numba_loops", "two_cores"),
    "torch": ("torch_arrays", "all_cores"),
    "scipy_sparse": ("scipy_sparse", "one_core"),
    "c_one_core": ("c", "one_core"),
    "c_two_cores": ("c", "two_cores"),
}
_PIECE_SECONDS = 0.08  # long enough for the clock, short enough for many rounds

_START_UP = """
import time
start = time.perf_counter()
import sys
sys.path.insert(0, sys.argv[1])
import source_tree
import numpy as np
from physanimator.physics.solver import Drive, Solid, State, advance
i, f = (lambda *v: np.array(v, np.int32)), (lambda *v: np.array(v, np.float32))
solid = Solid.of_triangles(
    starts=i([0, 0], [3, 1]), substeps=i(2), vertices=np.ones((3, 4), np.float32), step_limits=np.ones(3, np.float32),
    handles=i(-1, -1, -1), grips=np.zeros(3, np.float32), triangles=i([0, 1, 2]), inverse_edges=f([1, 0, 0, 1]),
    stiffness=f([1, 1, 1]))
rig = np.zeros((2, 1, 6), np.float32)
advance(solid, State.at_rest(solid), Drive(rig, rig, i(0, 0), np.zeros((0, 6), np.float32), i(), (0.0, 0.0)))
print(time.perf_counter() - start)
"""
"""What a new process does before its first result: import, initialisation, first kernel."""

_TAICHI_START_UP = """
import os, time
os.environ["TI_SKIP_VERSION_CHECK"] = "ON"
start = time.perf_counter()
import numpy as np
import taichi as ti
ti.init(ti.cpu, log_level=ti.ERROR)
print(time.perf_counter() - start)
"""
"""What Taichi takes of it before any kernel."""


def mesh_of_about(triangles: int) -> TriangleMesh:
    """A leaf-shaped body, one connected part, of about so many triangles."""
    y, x = np.mgrid[0:720, 0:1280].astype(np.float32)
    mask = ((x - 640) / (240 + 60 * np.sin(y / 90))) ** 2 + ((y - 360) / 320) ** 2 < 1
    return meshes.mesh_of_about(mask, triangles)


def solid_and_problem(mesh: TriangleMesh) -> tuple[Solid, Problem]:
    """The same held body for the solver and for its peers, bent by 1 % of the picture."""
    top = mesh.vertices[:, 1].argmin()
    x, y = (float(value) for value in mesh.vertices[top])
    scene = Scene((Body(mesh, Material()),), (), (RigPoint((x, y), Circle(60.0), Pinned()),))
    system = assemble(scene)
    solid = _solid(scene, system)
    depth = system.rest.positions[:, 1] - system.rest.positions[~system.free, 1].max()
    u = np.zeros_like(solid.vertices[:, :2])
    u[:, 0] = np.where(system.free, 0.01 * (np.maximum(depth, 0) / depth.max()) ** 2, 0)
    step = TICK / int(solid.substeps[0])
    decay = float(np.exp(-solid.vertices[0, 3] * step))
    rest, active = system.rest, system.active
    mu, lam = system.lame
    constants = (
        np.ascontiguousarray(rest.triangles[active]),
        rest.inverse_edges[active].reshape(-1, 4).astype(np.float32),
        (np.column_stack([2 * mu, lam]) * rest.areas[:, None])[active].astype(np.float32),
    )
    return solid, Problem(*constants, np.ascontiguousarray(solid.vertices[:, 2]), u, step, decay)


def ours(solid: Solid) -> Advance:
    """The solver itself, launched as ``simulate`` launches it: a connected part on one thread."""
    substeps, state = int(solid.substeps[0]), State.at_rest(solid)

    def advance(u: np.ndarray, v: np.ndarray, steps: int) -> None:
        ticks = steps // substeps
        zeros = np.zeros((ticks + 1, 1, 6), dtype=np.float32)
        nothing = np.zeros((0, 6), dtype=np.float32), np.zeros(0, dtype=np.int32)
        drive = Drive(zeros, zeros, np.zeros(ticks + 1, dtype=np.int32), *nothing, (0.0, 0.0))
        advance_solid(solid, state._replace(displacement=u, velocity=v), drive)

    return advance


def peer(name: str, problem: Problem) -> Advance | None:
    """A peer that is ready to run, or None where it is not installed."""
    module, function = PEERS[name]
    try:
        advance: Advance = getattr(importlib.import_module(f"peers.{module}"), function)(problem)
    except (ImportError, FileNotFoundError):
        return None
    return advance


def displacement_after(advance: Advance, problem: Problem, steps: int) -> np.ndarray:
    """Displacement [side] after some steps from the start."""
    u, v = problem.displacement.copy(), np.zeros_like(problem.displacement)
    advance(u, v, steps)
    return u


def checked(contestants: dict[str, Advance], problem: Problem, steps: int) -> dict[str, float]:
    """Largest difference of each from ours, as a part of the largest displacement.

    Raises:
        SystemExit: one of them is off by more than ``AGREEMENT``.
    """
    found = {name: displacement_after(advance, problem, steps) for name, advance in contestants.items()}
    size = np.abs(found["ours"]).max()
    differences = {name: float(np.abs(u - found["ours"]).max() / size) for name, u in found.items()}
    for name, difference in differences.items():
        if not difference <= AGREEMENT:
            raise SystemExit(f"{name} differs by {difference:.1e} of the largest displacement after {steps} steps")
    return differences


def speeds(contestants: dict[str, Advance], problem: Problem, substeps: int, rounds: int) -> dict[str, float]:
    """Million triangle updates a second of each, the best of the rounds."""
    pieces: dict[str, int] = {}
    for name, advance in contestants.items():
        seconds = timed(lambda advance=advance: displacement_after(advance, problem, 20 * substeps)) / 20
        pieces[name] = substeps * max(1, min(2000, round(_PIECE_SECONDS / seconds)))
    best = dict.fromkeys(contestants, np.inf)
    order = list(contestants)
    for _ in range(rounds):
        order = order[1:] + order[:1]  # nobody always comes after the same one
        for name in order:
            advance = contestants[name]
            u, v = problem.displacement.copy(), np.zeros_like(problem.displacement)
            time.sleep(_PAUSE_SECONDS)
            seconds = timed(partial(advance, u, v, pieces[name]))
            best[name] = min(best[name], seconds / pieces[name])
    return {name: len(problem.triangles) / seconds / 1e6 for name, seconds in best.items()}


def timed(function: Callable[[], Any]) -> float:
    """Seconds that one call takes."""
    start = time.perf_counter()
    function()
    return time.perf_counter() - start


def whole_second(material: Material, rounds: int) -> dict[str, float]:
    """A whole second of a body of 2,000 triangles in the automatic scene, everything included."""
    scene = automatic_scene([Body(mesh_of_about(2_000), material)])
    frames = round(scene.frame_rate) + 1
    simulate(scene, frames=2)
    times = [timed(lambda: simulate(scene, frames=frames)) * 1000 for _ in range(rounds)]
    planned = plan(scene, frames=frames)
    return {
        "best_ms": min(times),
        "median_ms": statistics.median(times),
        "triangles": planned.triangles,
        "substeps_per_frame": planned.substeps_per_frame,
    }


def start_up_seconds(rounds: int, script: str = _START_UP) -> float:
    """Import, initialisation and first kernel in a new process, with Taichi's cache filled; the best."""
    command = [sys.executable, "-c", script, str(Path(__file__).parent)]
    times = []
    for _ in range(rounds + 1):
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        times.append(float(done.stdout.split()[-1]))
    return min(times[1:])


def contact_costs_on_one_core(rounds: int) -> Any:
    """The same in a process that may use one processor only."""
    script = Path(__file__).parent / "contact_cost.py"
    command = [sys.executable, str(script), "--one-core", "--rounds", str(rounds)]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def measure(rounds: int, sizes: dict[str, int]) -> dict[str, Any]:
    """Everything, each size in turn."""
    mtri: dict[str, dict[str, float | None]] = {name: dict.fromkeys(sizes) for name in ("ours", *PEERS)}
    differences: dict[str, dict[str, float | None]] = {name: dict.fromkeys(sizes) for name in PEERS}
    triangles = {}
    for size, count in sizes.items():
        mesh = mesh_of_about(count)
        solid, problem = solid_and_problem(mesh)
        contestants = {"ours": ours(solid)}
        contestants |= {name: ready for name in PEERS if (ready := peer(name, problem)) is not None}
        substeps, triangles[size] = int(solid.substeps[0]), len(problem.triangles)
        for name, difference in checked(contestants, problem, substeps).items():
            if name in differences:
                differences[name][size] = difference
        for name, speed in speeds(contestants, problem, substeps, rounds).items():
            mtri[name][size] = speed
    return {
        "mtri_per_s": mtri,
        "ratios": {name: {size: _ratio(mtri["ours"][size], mtri[name][size]) for size in sizes} for name in PEERS},
        "differences": differences,
        "triangles": triangles,
        "second_of_2k_body_ms": {
            "hair": whole_second(preset("hair"), rounds),
            "youngs_modulus_500": whole_second(Material(), rounds),
        },
        "startup_s": start_up_seconds(5),
        "startup_taichi_s": start_up_seconds(5, _TAICHI_START_UP),
        "contact": {"all_cores": contact_costs(rounds), "one_core": contact_costs_on_one_core(rounds)},
        "rounds": rounds,
        "machine": {"cores": os.cpu_count(), "processor": platform.machine(), "load": os.getloadavg()[0]},
    }


def _ratio(numerator: float | None, denominator: float | None) -> float | None:
    return None if numerator is None or denominator is None else numerator / denominator


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="print the whole document instead of a table")
    parser.add_argument("--rounds", type=int, default=12, help="how often each contestant is timed (default 12)")
    parser.add_argument("--sizes", nargs="+", choices=SIZES, default=list(SIZES), help="sizes of mesh (default all)")
    arguments = parser.parse_args()
    with contextlib.redirect_stdout(sys.stderr):  # Warp announces itself with plain prints
        result = measure(arguments.rounds, {size: SIZES[size] for size in arguments.sizes})
    if arguments.json:
        print(json.dumps(result, indent=2))
        return
    for name, speeds_of in result["mtri_per_s"].items():
        row = (f"{size} {'not installed' if speed is None else f'{speed:7.1f}'}" for size, speed in speeds_of.items())
        print(f"{name:>16}  {'   '.join(row)}")
    for name, second in result["second_of_2k_body_ms"].items():
        print(f"a second of 2k triangles, {name}: {second['best_ms']:.1f} ms")
    print(f"start-up: {result['startup_s']:.2f} s, of which Taichi by itself {result['startup_taichi_s']:.2f} s")


if __name__ == "__main__":
    main()
