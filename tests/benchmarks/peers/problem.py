"""The one problem that everybody integrates: a body that is held along one side and let go while bent."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

__all__ = ["Advance", "Problem"]

Float32Array = NDArray[np.float32]
Int32Array = NDArray[np.int32]

Advance = Callable[[Float32Array, Float32Array, int], None]
"""Carries displacement [side] and velocity [side/s], both of shape [v, 2], on by so many steps, in place."""


@dataclass(frozen=True, eq=False)
class Problem:
    """Fixed corotated triangles and a step: v' = decay (v + dt f / m), u' = u + dt v'.

    Attributes:
        triangles: vertex indices, int32, shape [t, 3].
        inverse_edges: row-major inverse of the rest edge columns [1/side], float32, shape [t, 4].
        stiffness: 2 mu V and lambda V, float32, shape [t, 2].
        inverse_mass: 0 where a vertex is held, float32, shape [v].
        displacement: at the start [side], float32, shape [v, 2]; the velocity is 0.
        step: dt [s].
        decay: what damping leaves of a velocity in a step.
    """

    triangles: Int32Array
    inverse_edges: Float32Array
    stiffness: Float32Array
    inverse_mass: Float32Array
    displacement: Float32Array
    step: float
    decay: float

    @cached_property
    def incidence(self) -> tuple[Int32Array, Int32Array]:
        """For each vertex where its corners begin, shape [v + 1], and the corners, 3 t + k for corner k of triangle t.

        The corners are in the order of the triangles, so that everybody sums in about the same order.
        """
        corners = self.triangles.ravel()
        order = np.argsort(corners, kind="stable").astype(np.int32)
        counts = np.bincount(corners, minlength=len(self.inverse_mass))
        return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32), order
