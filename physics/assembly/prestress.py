"""Gravity without sag: the rest shape whose equilibrium under gravity is the drawing.

The inverse of a static problem: x is known and X wanted, with forces(x; X) + m g = 0. Newton's method with the exact
derivative by X, under gravity that is raised step by step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import SimulationError
from ..interruption import checkpoint
from ..material import RestShape, deformation_gradients, forces, rotations, stress
from ..scene import Scene
from .system import System

if TYPE_CHECKING:
    from scipy.sparse import csc_array

__all__ = ["is_stable", "prestressed", "rest_shape_derivative", "unsagged"]

FloatArray = NDArray[np.float64]

_ITERATIONS = 12
_TOLERANCE = 1e-6  # of the load
_STILL = 1e-10  # [side]: a change of the rest shape that is rounding
_LEAST_STEP = 1 / 64  # of the load
_LEAST_AREA = 0.2  # of a triangle's area: a rest shape that is smaller will not be walked on through
_FEWEST_HELD = 2  # vertices; about a single one a part swings freely
_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])
_EDGE_CHANGES = [  # of the edge columns, with corner 0 along x, along y, then corners 1 and 2
    np.outer(axis, toward) for toward in ((-1.0, -1.0), (1.0, 0.0), (0.0, 1.0)) for axis in np.eye(2)
]


def unsagged(scene: Scene, system: System) -> NDArray[np.float32]:
    """How far the drawing is from a rest shape that gravity deforms into the drawing, x - X [side], shape [v, 2].

    It is 0 for a part of which at most one vertex is held: that falls or swings as a whole.

    Args:
        scene: gives gravity and the bodies' names.
        system: the bodies, their rest shape being the drawing.

    Raises:
        SimulationError: a part is too soft to carry itself as it was drawn.
    """
    displacement, held = np.zeros(system.rest.positions.shape, dtype=np.float32), ~system.free
    mu, lam = system.lame
    for part in range(len(system.starts) - 1):
        vertices = np.arange(system.starts[part, 0], system.starts[part + 1, 0])
        if (system.leaders[vertices] >= 0).sum() < _FEWEST_HELD or held[vertices].all():
            continue
        own = system.part_of_triangle == part
        drawn = RestShape(system.rest.positions[vertices], system.rest.triangles[own] - vertices[0])
        loads = system.masses[vertices, None] * np.array(scene.gravity)
        rest, carried = prestressed(drawn, mu[own], lam[own], loads, held[vertices])
        if carried < 1 or not is_stable(rest, drawn.positions, mu[own], lam[own], held[vertices]):
            raise SimulationError(_too_soft(scene, int(system.bodies[vertices[0]])))
        displacement[vertices] = drawn.positions - rest.positions
    return displacement


def _too_soft(scene: Scene, number: int) -> str:
    name = repr(scene.bodies[number].name) if scene.bodies[number].name else f"number {number}"
    x, y = scene.gravity
    return (
        f"Body {name} is too soft to keep the drawn shape under a gravity of ({x:g}, {y:g}) side/s^2. Weaken gravity,"
        " give the body a higher sway_frequency or youngs_modulus, hold more of it, or set sag, which lets it hang down"
        " from the drawing."
    )


def prestressed(
    drawn: RestShape, mu: FloatArray, lam: FloatArray, loads: FloatArray, held: NDArray[np.bool_]
) -> tuple[RestShape, float]:
    """The shape that hangs as it was drawn.

    Args:
        drawn: the drawing, as triangles [side].
        mu, lam: Lame parameters of each triangle, shape [t].
        loads: the weight m g of each vertex, shape [v, 2].
        held: vertices that do not move and whose rest position stays the drawn one, shape [v].

    Returns:
        The rest shape, and the share of the load for which it was found: 1, or less where the body is too soft to carry
        the whole.
    """
    free = np.flatnonzero(np.repeat(~held, 2))
    rest, carried, step = drawn, 0.0, 1.0
    while carried < 1 and step >= _LEAST_STEP:
        share = min(1.0, carried + step)
        found = _newton(rest, drawn, mu, lam, share * loads, free)
        if found is None:
            step /= 2
        else:
            rest, carried = found, share
    return rest, carried


def _newton(
    rest: RestShape, drawn: RestShape, mu: FloatArray, lam: FloatArray, loads: FloatArray, free: NDArray[np.int64]
) -> RestShape | None:
    from scipy.sparse.linalg import splu

    wanted = _TOLERANCE * max(float(np.abs(loads).max()), 1e-300)
    for _ in range(_ITERATIONS):
        checkpoint()
        missing = (forces(rest, drawn.positions, mu, lam) + loads).ravel()[free]
        if np.abs(missing).max(initial=0.0) <= wanted:
            return rest
        matrix = rest_shape_derivative(rest, drawn.positions, mu, lam)[free][:, free].tocsc()
        checkpoint()
        try:
            change = splu(matrix).solve(-missing)
        except RuntimeError:  # exactly singular
            return None
        positions = rest.positions.copy()
        positions.reshape(-1)[free] += change
        if not np.isfinite(positions).all():
            return None
        if np.abs(change).max() <= _STILL:
            return rest
        rest = RestShape(positions, rest.triangles)
        signed, before = np.linalg.det(rest.edges), np.linalg.det(drawn.edges)
        if (signed * before < _LEAST_AREA * before * before).any():
            return None
    return None


def rest_shape_derivative(rest: RestShape, positions: FloatArray, mu: FloatArray, lam: FloatArray) -> csc_array:
    """Derivative of the internal forces by the rest positions, shape [2v, 2v], as ``stiffness_matrix`` is laid out.

    Args:
        rest: the undeformed triangles.
        positions: deformed positions x [side], shape [v, 2].
        mu, lam: Lame parameters of each triangle, shape [t].
    """
    f, inverse, areas = deformation_gradients(rest, positions), rest.inverse_edges, rest.areas
    piola, gradients = stress(f, mu, lam), rest.shape_gradients
    blocks = np.empty((len(areas), 6, 6))
    for column, change in enumerate(_EDGE_CHANGES):
        # The edges D change by dD, hence D^-1 by -D^-1 dD D^-1 and V by V tr(dD D^-1).
        moved = change @ inverse
        d_piola = _stress_change(f, -f @ moved, mu, lam) + np.trace(moved, axis1=1, axis2=2)[:, None, None] * piola
        d_forces = np.einsum("tij,tkj->tki", d_piola, gradients) - np.einsum("tij,tkj->tki", piola, gradients @ moved)
        blocks[:, :, column] = -areas[:, None] * d_forces.reshape(-1, 6)
    return _assembled(rest, blocks)


def is_stable(rest: RestShape, positions: FloatArray, mu: FloatArray, lam: FloatArray, held: NDArray[np.bool_]) -> bool:
    """Whether a shape returns to its equilibrium from a small push: whether d2E/dx2 is positive definite."""
    from scipy.sparse.linalg import splu

    f, gradients = deformation_gradients(rest, positions), rest.shape_gradients
    blocks = np.empty((len(f), 6, 6))
    for column, change in enumerate(_EDGE_CHANGES):
        d_piola = _stress_change(f, change @ rest.inverse_edges, mu, lam)
        blocks[:, :, column] = rest.areas[:, None] * np.einsum("tij,tkj->tki", d_piola, gradients).reshape(-1, 6)
    free = np.flatnonzero(np.repeat(~held, 2))
    matrix = _assembled(rest, blocks)[free][:, free].tocsc()
    checkpoint()
    try:  # without pivoting, the pivots have the signs of the eigenvalues
        factors = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:
        return False
    return bool((factors.U.diagonal() > 0).all())


def _assembled(rest: RestShape, blocks: FloatArray) -> csc_array:
    from scipy.sparse import coo_array

    freedoms = (2 * rest.triangles[:, :, None] + np.arange(2)).reshape(-1, 6)
    rows, columns = np.repeat(freedoms, 6, axis=1), np.tile(freedoms, (1, 6))
    size = 2 * len(rest.positions)
    return coo_array((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsc()


def _stress_change(f: FloatArray, change: FloatArray, mu: FloatArray, lam: FloatArray) -> FloatArray:
    """Change of P = 2 mu (F - R) + lambda (J - 1) cof F with F, shape [t, 2, 2]."""
    cosine, sine = f[:, 0, 0] + f[:, 1, 1], f[:, 1, 0] - f[:, 0, 1]
    d_cosine, d_sine = change[:, 0, 0] + change[:, 1, 1], change[:, 1, 0] - change[:, 0, 1]
    angle = (cosine * d_sine - sine * d_cosine) / np.maximum(cosine**2 + sine**2, 1e-300)
    turned = angle[:, None, None] * (_TURN @ rotations(f))
    cofactors, d_cofactors = _cofactors(f), _cofactors(change)
    d_area = (cofactors * change).sum(axis=(1, 2))
    pressure = d_area[:, None, None] * cofactors + (np.linalg.det(f) - 1)[:, None, None] * d_cofactors
    return 2 * mu[:, None, None] * (change - turned) + lam[:, None, None] * pressure


def _cofactors(f: FloatArray) -> FloatArray:
    return np.stack([f[:, 1, 1], -f[:, 1, 0], -f[:, 0, 1], f[:, 0, 0]], axis=-1).reshape(-1, 2, 2)
