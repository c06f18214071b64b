"""The practical limit: C with this machine's widest vectors, compiled on the spot by gcc."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .problem import Advance, Float32Array, Problem

__all__ = ["one_core", "two_cores"]

_SOURCE = Path(__file__).with_name("c_kernel.c")
_LANES = 16


def one_core(problem: Problem) -> Advance:
    """On one core."""
    return _advance(problem, _library())


def two_cores(problem: Problem) -> Advance:
    """On all cores (the machine's, or as many as OMP_NUM_THREADS says), with OpenMP."""
    return _advance(problem, _library("-fopenmp"))


@cache
def _library(*options: str) -> Any:
    """The compiled kernel.

    Raises:
        FileNotFoundError: there is no gcc.
    """
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / "kernel.so"
        flags = ["-O3", "-march=native", "-ffast-math", "-shared", "-fPIC", *options]
        subprocess.run(["gcc", *flags, str(_SOURCE), "-o", str(library), "-lm"], check=True)
        return ctypes.CDLL(str(library))


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
