"""A motion as few shapes that are mixed: the singular vectors of what all vertices do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .key_frames import straight_error

__all__ = ["MorphTargets", "morph_targets"]


@dataclass(frozen=True, eq=False)
class MorphTargets:
    """Shapes whose weighted sum, added to the rest, is the motion.

    Attributes:
        targets: how each shape differs from the rest [px], shape [k, v, 2].
        weights: of the shapes in every frame, -1 to 1, shape [frames, k].
        error: how far any vertex ever is from where it should be [px].
    """

    targets: NDArray[np.float64]
    weights: NDArray[np.float64]
    error: float


def morph_targets(rest: NDArray[np.floating], positions: NDArray[np.floating], *, tolerance: float) -> MorphTargets:
    """As few shapes as keep every vertex within a tolerance.

    Source: Alexa and Mueller, "Representing Animations by Principal Components" (2000).

    Args:
        rest: the vertices as drawn [px], shape [v, 2].
        positions: in every frame [px], shape [frames, v, 2].
        tolerance: how far a vertex may ever be from where it was [px].
    """
    moves = (positions - rest).astype(np.float64)
    count, flat = len(moves), moves.reshape(len(moves), -1)
    left = np.linalg.eigh(flat @ flat.T)[1][:, ::-1]

    def error(number: int) -> float:
        basis = left[:, :number]
        return straight_error(moves, (basis @ (basis.T @ flat)).reshape(moves.shape))

    enough, too_few = 0, -1
    while enough < count and error(enough) > tolerance:
        enough, too_few = min(count, max(1, 2 * enough)), enough
    while enough - too_few > 1:
        middle = (enough + too_few) // 2
        enough, too_few = (middle, too_few) if error(middle) <= tolerance else (enough, middle)
    basis = left[:, :enough]
    shapes = basis.T @ flat
    longest = np.maximum(np.abs(basis).max(axis=0), 1e-12)
    targets = (shapes * longest[:, None]).reshape(enough, *moves.shape[1:])
    return MorphTargets(targets, basis / longest, error(enough))
