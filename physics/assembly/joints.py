"""Narrow joints: places of a shape that are far too thin for what hangs on them.

The bending stiffness of a strip goes with the cube of its width. Where a mask is cut a few pixels too tight, a lock of
hair hangs by a neck as thin as a thread: it flaps like a door on its hinge, and, where that is the slowest motion of
the whole part, it alone would decide how stiff the part has to be for its sway. A drawn lock is no thread, so such a
neck is stiffened until the part bends over a length instead of at a point. All motions that are slow enough to be seen
count: a tip may turn over on its neck beside longer locks that sway more slowly.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..interruption import checkpoint
from ..material import RestShape, lame_parameters, lowest_modes, lumped_masses, stiffness_matrix

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = ["bending", "free_system", "joint_factors"]

FloatArray = NDArray[np.float64]

_BENDING = 0.8  # share of the mode's strain energy that counts as where it bends
# Area that bends as a share of the area that moves. A strip held at one end has 0.7; parts of drawings had 0.12 to 1,
# and a lock on a neck of some pixels 0.02, on one of half its width 0.1. Any bound from 0.1 to 0.15 tells them apart.
_HINGE = 0.125
# What hangs on a joint with most of the free area is the part itself, such as a plant on its stalk, not a lock of it.
_WHOLE = 0.5  # a strip held at one end moves 0.6 of its area
# Motions that are looked at. Wind moves those that are so many times as fast as the slowest by a sixteenth as much.
_MOST_MODES, _SLOW = 8, 4.0
_STEP = 4.0  # on the modulus of what bends, each time
_MOST_STEPS = 8  # 4^8: the cube of a neck 40 times too thin


def joint_factors(rest: RestShape, poisson_ratio: float, density: ArrayLike, held: NDArray[np.bool_]) -> FloatArray:
    """Factor on Young's modulus of each triangle, above 1 in narrow joints, shape [t].

    Args:
        rest: a connected shape [side].
        poisson_ratio: of its material.
        density: mass per area, one number or shape [t].
        held: which vertices do not move, shape [v].
    """
    factors = np.ones(len(rest.triangles))
    if held.all() or not held.any():
        return factors
    free = rest.areas[~held[rest.triangles].all(axis=1)].sum()
    for _ in range(_MOST_STEPS):
        checkpoint()
        mu, lam = lame_parameters(factors, poisson_ratio)
        hinges = np.zeros(len(factors), dtype=bool)
        for mode in lowest_modes(*free_system(rest, mu, lam, density, held), most=_MOST_MODES, within=_SLOW):
            moves = np.zeros((len(held), 2))
            moves[~held] = mode.reshape(-1, 2)
            bends, moving = bending(rest, moves, mu, lam), _moving_area(rest, moves)
            if rest.areas[bends].sum() < _HINGE * moving < _HINGE * _WHOLE * free:
                hinges[bends] = True
        if not hinges.any():
            break
        factors[hinges] *= _STEP
    return factors


def free_system(
    rest: RestShape, mu: FloatArray, lam: FloatArray, density: ArrayLike, held: NDArray[np.bool_]
) -> tuple[csr_array, FloatArray]:
    """Stiffness matrix and masses of the coordinates that are free to move."""
    free = np.repeat(~held, 2)
    return stiffness_matrix(rest, mu, lam)[free][:, free], np.repeat(lumped_masses(rest, density), 2)[free]


def bending(rest: RestShape, moves: FloatArray, mu: FloatArray, lam: FloatArray) -> NDArray[np.int64]:
    """Triangles that hold most of the strain energy, those with the most of it per area first."""
    gradient = np.einsum("tai,taj->tij", moves[rest.triangles], rest.shape_gradients)
    strain = (gradient + gradient.swapaxes(1, 2)) / 2
    density = mu * (strain**2).sum(axis=(1, 2)) + lam / 2 * np.trace(strain, axis1=1, axis2=2) ** 2
    order = np.argsort(-density, kind="stable")
    held = np.cumsum((density * rest.areas)[order])
    return order[: np.searchsorted(held, _BENDING * held[-1]) + 1]


def _moving_area(rest: RestShape, moves: FloatArray) -> float:
    """Area that takes part in a mode: (sum of |u|)^2 / sum of |u|^2 over the area; that of a part that shifts whole."""
    lengths = np.linalg.norm(moves, axis=1)[rest.triangles].mean(axis=1)
    return float((rest.areas @ lengths) ** 2 / (rest.areas @ lengths**2))
