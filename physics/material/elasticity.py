"""Fixed corotated elasticity on triangles in numpy float64: the readable reference, and the oracle of the kernels.

Paper, Method "Deformable Body Model" and Appendix A. Two things differ from the text. The stress is written with
the cofactor matrix, P = 2 mu (F - R) + lambda (J - 1) cof F, because J F^-T is singular at J = 0. The rotation
R is the closest one to F in closed form, so that det R = +1 also for an inverted triangle, which then turns back.

Everything here is in the solver's units: lengths in sides (a side is the picture's longest), x right, y down.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..mesh import TriangleMesh

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = [
    "RestShape",
    "deformation_gradients",
    "elastic_constants",
    "energy",
    "energy_densities",
    "forces",
    "gradient_products",
    "lame_parameters",
    "lumped_masses",
    "rest_shape",
    "rotations",
    "semi_implicit_euler",
    "stiffness_matrix",
    "stress",
]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class RestShape:
    """Triangles before any deformation.

    Attributes:
        positions: rest positions X [side], shape [v, 2].
        triangles: vertex indices, shape [t, 3]; either winding.
    """

    positions: FloatArray
    triangles: IndexArray

    @cached_property
    def edges(self) -> FloatArray:
        """Columns X1 - X0 and X2 - X0 of each triangle [side], shape [t, 2, 2]."""
        return _edge_columns(self.positions, self.triangles)

    @cached_property
    def inverse_edges(self) -> FloatArray:
        """Inverse of ``edges`` [1/side], shape [t, 2, 2]."""
        return np.asarray(np.linalg.inv(self.edges), dtype=np.float64)

    @cached_property
    def areas(self) -> FloatArray:
        """Area V of each triangle [side^2], shape [t]."""
        return np.abs(np.linalg.det(self.edges)) / 2

    @cached_property
    def shape_gradients(self) -> FloatArray:
        """Gradient of each corner's linear shape function [1/side], shape [t, 3, 2]; the three sum to 0."""
        others = self.inverse_edges
        return np.concatenate([-others.sum(axis=1, keepdims=True), others], axis=1)

    @cached_property
    def smallest_altitudes(self) -> FloatArray:
        """Distance of each triangle's longest edge from the opposite corner [side], shape [t]."""
        return 1 / np.linalg.norm(self.shape_gradients, axis=2).max(axis=1)


def rest_shape(mesh: TriangleMesh) -> RestShape:
    """A mesh in the solver's units."""
    return RestShape(mesh.vertices / mesh.longest_side, mesh.triangles)


def lame_parameters(youngs_modulus: ArrayLike, poisson_ratio: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Lame parameters (mu, lambda) in plane strain, elementwise [density side^2 / s^2].

    Examples:
        >>> from physanimator.physics.material import lame_parameters
        >>> [round(float(each)) for each in lame_parameters(500.0, 0.25)]
        [200, 200]
    """
    e, nu = np.asarray(youngs_modulus, dtype=np.float64), np.asarray(poisson_ratio, dtype=np.float64)
    return e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu))


def elastic_constants(mu: ArrayLike, lam: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Young's modulus and Poisson's ratio in plane strain of Lame parameters, elementwise; the ratio is below 0.5.

    nu = lambda / (2 (lambda + mu)) and E = mu (3 lambda + 2 mu) / (lambda + mu), the inverse of ``lame_parameters``.

    Examples:
        >>> from physanimator.physics.material import elastic_constants
        >>> [round(float(each), 3) for each in elastic_constants(200.0, 200.0)]
        [500.0, 0.25]
    """
    shear, pressure = np.asarray(mu, dtype=np.float64), np.asarray(lam, dtype=np.float64)
    share = pressure / (pressure + shear)
    return shear * (2 + share), np.minimum(share / 2, np.nextafter(0.5, 0.0))


def deformation_gradients(rest: RestShape, positions: FloatArray) -> FloatArray:
    """F = [x1 - x0, x2 - x0] [X1 - X0, X2 - X0]^-1 of each triangle, shape [t, 2, 2] (Appendix A).

    Args:
        rest: the undeformed triangles.
        positions: deformed positions x [side], shape [v, 2].
    """
    return _edge_columns(positions, rest.triangles) @ rest.inverse_edges


def rotations(f: FloatArray) -> FloatArray:
    """The rotation closest to each F, det = +1 always, shape [t, 2, 2]; the identity where none is closest."""
    cosine, sine = f[:, 0, 0] + f[:, 1, 1], f[:, 1, 0] - f[:, 0, 1]
    length = np.hypot(cosine, sine)
    undecided = length == 0
    length = np.where(undecided, 1.0, length)
    cosine, sine = np.where(undecided, 1.0, cosine / length), sine / length
    return np.stack([cosine, -sine, sine, cosine], axis=-1).reshape(-1, 2, 2)


def energy_densities(f: FloatArray, mu: FloatArray, lam: FloatArray) -> FloatArray:
    """Psi = mu |F - R|^2 + lambda / 2 (det F - 1)^2 of each triangle, shape [t] (Method, fixed corotated)."""
    strain = f - rotations(f)
    return mu * (strain**2).sum(axis=(1, 2)) + lam / 2 * (_determinants(f) - 1) ** 2


def stress(f: FloatArray, mu: FloatArray, lam: FloatArray) -> FloatArray:
    """First Piola-Kirchhoff stress P = dPsi/dF of each triangle, shape [t, 2, 2] (Appendix A)."""
    pressure = lam * (_determinants(f) - 1)
    return 2 * mu[:, None, None] * (f - rotations(f)) + pressure[:, None, None] * _cofactors(f)


def energy(rest: RestShape, positions: FloatArray, mu: FloatArray, lam: FloatArray) -> float:
    """Elastic energy of all triangles together: the sum of Psi V."""
    return float(rest.areas @ energy_densities(deformation_gradients(rest, positions), mu, lam))


def forces(rest: RestShape, positions: FloatArray, mu: FloatArray, lam: FloatArray) -> FloatArray:
    """Internal force on each vertex, -dE/dx, shape [v, 2] (Appendix A)."""
    piola = stress(deformation_gradients(rest, positions), mu, lam)
    corners = -rest.areas[:, None, None] * np.einsum("tij,tkj->tki", piola, rest.shape_gradients)
    total = np.zeros_like(rest.positions)
    np.add.at(total, rest.triangles, corners)
    return total


def lumped_masses(rest: RestShape, density: ArrayLike) -> FloatArray:
    """Mass of each vertex, the sum of rho V / 3 over its triangles, shape [v] (Appendix A).

    Args:
        rest: the undeformed triangles.
        density: rho, one number or shape [t].
    """
    masses = np.zeros(len(rest.positions))
    np.add.at(masses, rest.triangles, (np.asarray(density) * rest.areas / 3)[:, None])
    return masses


def gradient_products(rest: RestShape) -> FloatArray:
    """Products g_a g_b^T of the corners' shape gradients of each triangle [1/side^2], shape [t, 3, 3, 2, 2]."""
    g = rest.shape_gradients
    products: FloatArray = g[:, :, None, :, None] * g[:, None, :, None, :]
    return products


def stiffness_matrix(rest: RestShape, mu: FloatArray, lam: FloatArray) -> csr_array:
    """K = d2E/dx2 at rest, shape [2v, 2v]; the coordinates of vertex i are rows 2i (x) and 2i + 1 (y).

    The rotation's own derivative makes the mu part 2 mu times the symmetric strain: at rest this is linear elasticity.
    """
    from scipy.sparse import coo_array

    products = gradient_products(rest)
    shear, pressure = ((values * rest.areas)[:, None, None, None, None] for values in (mu, lam))
    blocks = shear * products.swapaxes(3, 4) + pressure * products
    normal = shear[..., 0, 0] * (products[..., 0, 0] + products[..., 1, 1])
    blocks[..., 0, 0] += normal
    blocks[..., 1, 1] += normal
    blocks = blocks.swapaxes(2, 3)
    freedoms = (2 * rest.triangles[:, :, None] + np.arange(2)).reshape(-1, 6)
    rows, columns = np.repeat(freedoms, 6, axis=1), np.tile(freedoms, (1, 6))
    size = 2 * len(rest.positions)
    return coo_array((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsr()


def semi_implicit_euler(
    positions: FloatArray, velocities: FloatArray, acceleration: FloatArray, *, step: float, damping: float = 0.0
) -> tuple[FloatArray, FloatArray]:
    """One step v' = exp(-alpha dt) (v + dt a), x' = x + dt v' (Appendix A); returns (x', v')."""
    velocities = np.exp(-damping * step) * (velocities + step * acceleration)
    return positions + step * velocities, velocities


def _edge_columns(positions: FloatArray, triangles: IndexArray) -> FloatArray:
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    return np.stack([b - a, c - a], axis=-1)


def _determinants(f: FloatArray) -> FloatArray:
    return f[:, 0, 0] * f[:, 1, 1] - f[:, 0, 1] * f[:, 1, 0]


def _cofactors(f: FloatArray) -> FloatArray:
    return np.stack([f[:, 1, 1], -f[:, 1, 0], -f[:, 0, 1], f[:, 0, 0]], axis=-1).reshape(-1, 2, 2)
