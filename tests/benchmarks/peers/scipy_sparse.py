"""scipy.sparse: the gradient of all triangles as one matrix, forces with its transpose; numpy for the rest."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from .problem import Advance, Float32Array, Problem

__all__ = ["one_core"]


def one_core(problem: Problem) -> Advance:
    """scipy's products run on one core."""
    count, vertices = len(problem.triangles), len(problem.inverse_mass)
    edges = problem.inverse_edges.reshape(-1, 2, 2)
    gradients = np.concatenate([-edges.sum(axis=1, keepdims=True), edges], axis=1)  # [t, corner, axis]
    rows = np.repeat(np.arange(2 * count).reshape(2, count), 3)  # d/dx of all triangles, then d/dy
    columns = np.tile(problem.triangles.ravel(), 2)
    values = np.concatenate([gradients[:, :, axis].ravel() for axis in range(2)])
    gradient = csr_array((values, (rows, columns)), shape=(2 * count, vertices), dtype=np.float32)
    divergence = gradient.T.tocsr()
    shear, bulk = problem.stiffness.T.copy()
    factor = np.float32(problem.step) * problem.inverse_mass[:, None]
    step, decay = np.float32(problem.step), np.float32(problem.decay)

    def advance(u: Float32Array, v: Float32Array, steps: int) -> None:
        for _ in range(steps):
            g = gradient @ u
            (g00, g10), (g01, g11) = g[:count].T, g[count:].T
            cosine, sine = 2 + g00 + g11, g10 - g01
            scale = 1 / np.sqrt(cosine * cosine + sine * sine)
            cosine, sine = cosine * scale, sine * scale
            pressure = bulk * (g00 + g11 + g00 * g11 - g01 * g10)
            e00, e11 = 1 + g00, 1 + g11
            stress = np.empty_like(g)
            stress[:count, 0], stress[count:, 0] = shear * (e00 - cosine) + pressure * e11, shear * (g01 + sine)
            stress[count:, 0] -= pressure * g10
            stress[:count, 1], stress[count:, 1] = shear * (g10 - sine) - pressure * g01, shear * (e11 - cosine)
            stress[count:, 1] += pressure * e00
            v -= factor * (divergence @ stress)
            v *= decay
            u += step * v

    return advance
