"""How small the time step must be, and how a few slivers are kept from dictating it.

An explicit step is stable below 2 / omega_max, with omega_max the highest frequency of all bodies together. Two quick
bounds lie above it: the frequency of each triangle alone, and the sum of stiffnesses around each vertex.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..limits import TICK
from ..material import RestShape, gradient_products

__all__ = [
    "MASS_BUDGET",
    "MOST_REFINEMENT",
    "SAFETY",
    "SPEED_FLOOR",
    "STEP_LIMIT",
    "TICK",
    "frequency_limits",
    "squared_frequencies",
    "substeps",
    "vertex_frequencies",
]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]

SAFETY = 0.9
"""The step as a part of the largest stable one: room for what deformation adds to the frequencies within a tick."""

MOST_REFINEMENT = 4
"""Large deformation stiffens triangles; a tick then takes up to this many times its planned substeps."""

SPEED_FLOOR = 5.0
"""Speed that is never cut [side/s]."""

STEP_LIMIT = 0.25
"""Part of its smallest altitude that a vertex faster than ``SPEED_FLOOR`` moves in a substep at most."""

MASS_BUDGET = 0.0007
"""Mass that may be added to a connected part to slow its stiffest spots, as a part of its own.

On hair, cloth and plants this lowers the first frequency by 0.2 % at most and saves a fifth of the substeps, more
where a mesh has slivers.
"""


def squared_frequencies(rest: RestShape, mu: FloatArray, lam: FloatArray, density: ArrayLike) -> FloatArray:
    """Highest omega^2 of each triangle alone, 3 lambda_max(K_e) / (rho V) [1/s^2], shape [t].

    In the principal axes of sum g g^T over the corners' shape gradients g, with eigenvalues a and b, the stretches
    along both axes couple through [[(2 mu + lambda) a, lambda sqrt(a b)], [., (2 mu + lambda) b]] and shear has
    mu (a + b). The highest of any triangle bounds the frequencies of the whole.
    """
    g = rest.shape_gradients
    ab = np.linalg.eigvalsh(np.einsum("tki,tkj->tij", g, g))
    a, b = ab[:, 0], ab[:, 1]
    stretch = 2 * mu + lam
    stretching = (stretch * (a + b) + np.sqrt((stretch * (a - b)) ** 2 + 4 * lam**2 * a * b)) / 2
    return 3 / np.asarray(density) * np.maximum(stretching, mu * (a + b))


def vertex_frequencies(rest: RestShape, mu: FloatArray, lam: FloatArray, masses: FloatArray) -> FloatArray:
    """Stiffness around each vertex over its mass [1/s^2], shape [v]; 0 where there is no mass.

    The stiffness is the sum of the norms of the blocks K_ab of its row (block Gershgorin): the highest of any vertex
    bounds omega^2 of the whole.
    """
    products = gradient_products(rest)
    shear, pressure = mu[:, None, None, None, None], lam[:, None, None, None, None]
    blocks = shear * products.swapaxes(3, 4) + pressure * products
    normal = mu[:, None, None] * (products[..., 0, 0] + products[..., 1, 1])
    blocks[..., 0, 0] += normal
    blocks[..., 1, 1] += normal
    squares = (blocks**2).sum(axis=(3, 4))
    determinants = blocks[..., 0, 0] * blocks[..., 1, 1] - blocks[..., 0, 1] * blocks[..., 1, 0]
    norms = np.sqrt((squares + np.sqrt(np.maximum(squares**2 - 4 * determinants**2, 0.0))) / 2)
    rows = rest.areas[:, None] * norms.sum(axis=2)
    sums = np.bincount(rest.triangles.ravel(), rows.ravel(), minlength=len(masses))
    return np.divide(sums, masses, out=np.zeros_like(sums), where=masses > 0)


def frequency_limits(squared: FloatArray, masses: FloatArray, parts: IndexArray) -> FloatArray:
    """Lowest omega^2 to which the mass budget can bring the part of each vertex, shape [n].

    Raising the mass of every vertex above a level w so far that it has w adds the sum of m (omega^2 / w - 1).

    Args:
        squared: omega^2 of each vertex [1/s^2], shape [n].
        masses: mass of each vertex, shape [n].
        parts: number of each vertex's connected part, shape [n].
    """
    limits = np.empty_like(squared)
    for part in np.unique(parts):
        of_part = parts == part
        order = np.argsort(-squared[of_part], kind="stable")
        omega, mass = squared[of_part][order], masses[of_part][order]
        level = np.cumsum(mass * omega) / (MASS_BUDGET * mass.sum() + np.cumsum(mass))
        following = np.append(omega[1:], 0.0)
        limits[of_part] = level[np.argmax(level >= following)]
    return limits


def substeps(squared_frequency: float) -> int:
    """Substeps in a tick at a highest omega^2 [1/s^2]."""
    return max(1, math.ceil(min(TICK * math.sqrt(squared_frequency) / (2 * SAFETY), 2.0**31)))
