"""The practical limit: C compiled on the spot by gcc, with the vectors that are fastest on this processor.

More at once is not always faster: on a processor with vectors of 8 numbers, blocks of 4 triangles make 220 million a
second on one core, blocks of 8 135, and what gcc makes of a plain loop 94.
"""

from __future__ import annotations

import ctypes
import platform
import subprocess
import tempfile
import time
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .problem import Advance, Float32Array, Problem

__all__ = ["one_core", "two_cores"]

_SOURCE = Path(__file__).with_name("c_kernel.c")
_LANES = 16
# Triangles that are computed together, 0 for AVX-512 by hand; and how wide gcc's vectors are.
_WIDTHS = (0, 4, 8, 16)
_VECTORS = ("128", "256", "512")
_TRIAL_STEPS, _TRIALS = 100, 5


def one_core(problem: Problem) -> Advance:
    """On one core."""
    return _fastest(problem)


def two_cores(problem: Problem) -> Advance:
    """On all cores (the machine's, or as many as OMP_NUM_THREADS says), with OpenMP."""
    return _fastest(problem, "-fopenmp")


def _fastest(problem: Problem, *options: str) -> Advance:
    """The variant that carries the problem on in the least time.

    Raises:
        FileNotFoundError: there is no gcc.
    """
    found = [_advance(problem, library) for library in _libraries(*options)]
    return min(found, key=lambda advance: _seconds(advance, problem))


def _seconds(advance: Advance, problem: Problem) -> float:
    u, v = problem.displacement.copy(), np.zeros_like(problem.displacement)
    times = []
    for _ in range(_TRIALS):
        start = time.perf_counter()
        advance(u, v, _TRIAL_STEPS)
        times.append(time.perf_counter() - start)
    return min(times)


@cache
def _libraries(*options: str) -> list[Any]:
    """The kernel in every variant that this processor runs.

    Raises:
        FileNotFoundError: there is no gcc.
    """
    fixed = ["-O3", "-march=native", "-ffast-math", "-shared", "-fPIC", *options]
    known = subprocess.run(["gcc", "-march=native", "-dM", "-E", "-"], input="", capture_output=True, text=True).stdout
    libraries = []
    with tempfile.TemporaryDirectory() as folder:
        for width in _WIDTHS if "__AVX512F__" in known else _WIDTHS[1:]:
            for vectors in _VECTORS:
                library = Path(folder) / f"kernel-{width}-{vectors}.so"
                flags = [*fixed, f"-DWIDTH={width}"]
                if platform.machine() in ("x86_64", "AMD64"):
                    flags.append(f"-mprefer-vector-width={vectors}")
                subprocess.run(["gcc", *flags, str(_SOURCE), "-o", str(library), "-lm"], check=True)
                libraries.append(ctypes.CDLL(str(library)))
    return libraries


def _advance(problem: Problem, library: Any) -> Advance:
    count, vertices = len(problem.triangles), len(problem.inverse_mass)
    padded = -(-count // _LANES) * _LANES
    corners = np.zeros((3, padded), dtype=np.int32)
    corners[:, :count] = problem.triangles.T
    constants = np.zeros((6, padded), dtype=np.float32)
    constants[:, :count] = np.column_stack([problem.inverse_edges, problem.stiffness]).T
    starts, order = problem.incidence
    slots = (order % 3 * padded + order // 3).astype(np.int32)
    forces = np.zeros((3 * padded, 2), dtype=np.float32)
    step, decay = ctypes.c_float(problem.step), ctypes.c_float(problem.decay)

    def advance(u: Float32Array, v: Float32Array, steps: int) -> None:
        first = [_pointer(array) for array in (corners, constants, starts, slots, problem.inverse_mass)]
        state = [_pointer(array) for array in (u, v, forces)]
        library.advance(steps, padded, vertices, *first, step, decay, *state)

    return advance


def _pointer(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
