"""Locks of one part: the shorter one is, the faster it sways, so that it turns no farther than longer ones.

How often a part sways is said for the whole of it. A short lock, or a tip that alone bends, goes as far as the whole
would where it is no faster, and so turns over: an inner tip flips out from under the locks beside it. It is stiffened
where it bends, until its frequency is f (length of the part / its length). Of an elastic strip it goes with the square.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..interruption import checkpoint
from ..material import RestShape, lame_parameters, lowest_modes
from .joints import bending, free_system

__all__ = ["lock_factors"]

FloatArray = NDArray[np.float64]

_MOVING, _STILL = 0.5, 0.1  # shares of the farthest displacement: the lock's tip moves by more than the first
_BETWEEN = 0.75  # the part of a strip, held at one end, from where its first mode moves by the second share to its tip
# A lock may be so many times too soft for its length: those of drawings that did not turn over were up to 1.6 times,
# where a long one grows thin towards its tip; an inner tip that did was 2.2 times.
_TOO_SOFT = 1.75
_RISE = 4  # power of what is beyond, with which the stiffening comes in
_MOST_LOCKS, _MOST_ROUNDS = 8, 4
_SLOWEST = 4.0  # times the frequency of the slowest; what sways faster hardly moves


def lock_factors(
    rest: RestShape,
    modulus: FloatArray,
    poisson_ratio: float,
    density: ArrayLike,
    held: NDArray[np.bool_],
    ways: FloatArray,
) -> FloatArray:
    """Factor on Young's modulus of each triangle, above 1 where short locks bend that are too soft, shape [t].

    Args:
        rest: a connected shape [side].
        modulus: Young's modulus of each triangle, only their ratios count, shape [t].
        poisson_ratio: of its material.
        density: mass per area, one number or shape [t].
        held: which vertices do not move, shape [v].
        ways: how far along the shape each vertex is from what is held, in any unit, shape [v].
    """
    factors, slowest = np.ones(len(rest.triangles)), None
    if held.all() or not held.any():
        return factors
    for _ in range(_MOST_ROUNDS):
        checkpoint()
        mu, lam = lame_parameters(modulus * factors, poisson_ratio)
        stiffness, masses = free_system(rest, mu, lam, density, held)
        missing = np.ones(len(factors))
        for mode in lowest_modes(stiffness, masses, most=_MOST_LOCKS, within=_SLOWEST):
            squared = float(mode @ (stiffness @ mode) / (mode @ (masses * mode)))
            slowest = squared if slowest is None else slowest
            moves = np.zeros((len(held), 2))
            moves[~held] = mode.reshape(-1, 2)
            softness = slowest / squared * (float(ways.max()) / _length(moves, ways)) ** 2
            if softness > _TOO_SOFT:
                places = bending(rest, moves, mu, lam)
                # Not at once, so that a little longer or coarser a lock does not move quite differently.
                missing[places] = np.maximum(missing[places], min(softness, (softness / _TOO_SOFT) ** _RISE))
        if (missing == 1).all():
            break
        factors *= missing
    return factors


def _length(moves: FloatArray, ways: FloatArray) -> float:
    """Length of the lock that moves in a mode; that of a strip held at one end is its own.

    It is the geometric mean of the length of what moves, which is all where a single row of vertices is free, and of
    the way from what is held to its tip: a tip that ends among longer locks follows them.
    """
    far = np.linalg.norm(moves, axis=1)
    far /= far.max()
    tip = float(ways[far > _MOVING].max())
    moving = tip - float(ways[far > _STILL].min())
    return math.sqrt(tip * (moving / _BETWEEN or tip))
