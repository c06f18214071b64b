"""numba: one loop over triangles that scatters (one core), or two parallel loops, of which the second gathers."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from .problem import Advance, Float32Array, Problem

__all__ = ["one_core", "two_cores"]

_OPTIONS: dict[str, Any] = {"fastmath": True, "error_model": "numpy", "boundscheck": False}


def one_core(problem: Problem) -> Advance:
    """Serial."""
    force = np.zeros_like(problem.displacement)
    step, decay = np.float32(problem.step), np.float32(problem.decay)

    def advance(u: Float32Array, v: Float32Array, steps: int) -> None:
        constants = (problem.triangles, problem.inverse_edges, problem.stiffness, problem.inverse_mass)
        _scatter(steps, *constants, step, decay, u, v, force)

    return advance


def two_cores(problem: Problem) -> Advance:
    """Parallel on numba's threads."""
    corner_forces = np.zeros((3 * len(problem.triangles), 2), dtype=np.float32)
    starts, order = problem.incidence
    step, decay = np.float32(problem.step), np.float32(problem.decay)

    def advance(u: Float32Array, v: Float32Array, steps: int) -> None:
        constants = (problem.triangles, problem.inverse_edges, problem.stiffness, problem.inverse_mass, starts, order)
        _gather(steps, *constants, step, decay, u, v, corner_forces)

    return advance


@numba.njit(inline="always", **_OPTIONS)
def _corner_forces(u: Any, i: Any, j: Any, k: Any, b: Any, stiffness: Any) -> Any:
    one, two = np.float32(1), np.float32(2)
    ax, ay, bx, by = u[j, 0] - u[i, 0], u[j, 1] - u[i, 1], u[k, 0] - u[i, 0], u[k, 1] - u[i, 1]
    g00, g01 = ax * b[0] + bx * b[2], ax * b[1] + bx * b[3]
    g10, g11 = ay * b[0] + by * b[2], ay * b[1] + by * b[3]
    cosine, sine = two + g00 + g11, g10 - g01
    scale = one / np.sqrt(cosine * cosine + sine * sine)
    cosine, sine = cosine * scale, sine * scale
    shear, pressure = stiffness[0], stiffness[1] * (g00 + g11 + g00 * g11 - g01 * g10)
    p00, p01 = shear * (one + g00 - cosine) + pressure * (one + g11), shear * (g01 + sine) - pressure * g10
    p10, p11 = shear * (g10 - sine) - pressure * g01, shear * (one + g11 - cosine) + pressure * (one + g00)
    first = p00 * b[0] + p01 * b[1], p10 * b[0] + p11 * b[1]
    return first[0], first[1], p00 * b[2] + p01 * b[3], p10 * b[2] + p11 * b[3]


@numba.njit(**_OPTIONS)
def _scatter(
    steps: Any,
    triangles: Any,
    edges: Any,
    stiffness: Any,
    inverse_mass: Any,
    dt: Any,
    decay: Any,
    u: Any,
    v: Any,
    f: Any,
) -> None:
    for _ in range(steps):
        for t in range(len(triangles)):
            i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            ax, ay, bx, by = _corner_forces(u, i, j, k, edges[t], stiffness[t])
            f[j, 0] -= ax
            f[j, 1] -= ay
            f[k, 0] -= bx
            f[k, 1] -= by
            f[i, 0] += ax + bx
            f[i, 1] += ay + by
        for i in range(len(u)):
            for axis in range(2):
                v[i, axis] = decay * (v[i, axis] + dt * inverse_mass[i] * f[i, axis])
                u[i, axis] += dt * v[i, axis]
                f[i, axis] = 0


@numba.njit(parallel=True, **_OPTIONS)
def _gather(
    steps: Any,
    triangles: Any,
    edges: Any,
    stiffness: Any,
    inverse_mass: Any,
    starts: Any,
    order: Any,
    dt: Any,
    decay: Any,
    u: Any,
    v: Any,
    f: Any,
) -> None:
    for _ in range(steps):
        for t in numba.prange(len(triangles)):
            i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            ax, ay, bx, by = _corner_forces(u, i, j, k, edges[t], stiffness[t])
            f[3 * t, 0] = ax + bx
            f[3 * t, 1] = ay + by
            f[3 * t + 1, 0] = -ax
            f[3 * t + 1, 1] = -ay
            f[3 * t + 2, 0] = -bx
            f[3 * t + 2, 1] = -by
        for i in numba.prange(len(u)):
            x, y = np.float32(0), np.float32(0)
            for e in range(starts[i], starts[i + 1]):
                x += f[order[e], 0]
                y += f[order[e], 1]
            v[i, 0] = decay * (v[i, 0] + dt * inverse_mass[i] * x)
            v[i, 1] = decay * (v[i, 1] + dt * inverse_mass[i] * y)
            u[i, 0] += dt * v[i, 0]
            u[i, 1] += dt * v[i, 1]
