"""Little simulations that need every kernel: what is compiled for them is compiled for all."""

from __future__ import annotations

import numpy as np

from ..forces import EnergyStroke
from ..mesh import TriangleMesh
from ..rig import Circle, RigPoint
from ..scene import Body, Contact, Scene
from .simulation import simulate

__all__ = ["simulate_samples"]


def simulate_samples(*, contact: bool) -> None:
    """Simulate a little scene that needs every kernel."""
    simulate(_touching() if contact else _moving(), frames=2)


def _moving() -> Scene:
    stroke = EnergyStroke("wind", ((0.0, 4.0), (8.0, 4.0)), 4.0)
    return Scene((Body(_grid(2)),), (stroke,), (RigPoint((0.0, 0.0), Circle(1.0)),))


def _touching() -> Scene:
    return Scene((Body(_grid(2)), Body(_grid(2))), contact=Contact())


def _grid(cells: int) -> TriangleMesh:
    """A square of 8 px cut into so many cells each way, of two triangles each."""
    x, y = np.meshgrid(*2 * [np.linspace(0.0, 8.0, cells + 1)])
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    upper = np.column_stack([corner, corner + 1, corner + cells + 1])
    lower = np.column_stack([corner + 1, corner + cells + 2, corner + cells + 1])
    triangles = np.concatenate([upper, lower]).astype(np.int32)
    return TriangleMesh(np.column_stack([x.ravel(), y.ravel()]), triangles, 8, 8)
