"""Lowest and highest frequency at which a body vibrates: K x = omega^2 M x with a diagonal M."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..interruption import checkpoint

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = ["highest_eigenvalue", "lowest_eigenvalue"]

FloatArray = NDArray[np.float64]

_DENSE = 60  # degrees of freedom up to which a dense solver is the simpler one
_TOLERANCE = 1e-2  # of the highest eigenvalue
_RIGID_MODES = 3  # motions without deformation that are looked past
_RIGID = 1e-15  # of the highest diagonal entry: an eigenvalue below is rounding; slender strands reach 1e-13
_SHIFT = 1e-9  # of the highest diagonal entry: keeps a shape that can move freely from being singular


def lowest_eigenvalue(stiffness: csr_array, masses: FloatArray) -> float | None:
    """The lowest omega^2 of a vibration that deforms; None when it cannot be found.

    A shape that is held at a single point, or hangs together by one, also turns freely; that does not count.

    Args:
        stiffness: K, symmetric and without negative eigenvalues, shape [n, n].
        masses: the diagonal of M, all above 0, shape [n].
    """
    scaled = _mass_scaled(stiffness, masses)
    top = float(scaled.diagonal().max())
    values = _eigenvalues(scaled, count=_RIGID_MODES + 1, sigma=-_SHIFT * top, which="LM")
    if values is None or values[-1] <= _RIGID * top:
        return None
    return float(values[np.argmax(values > _RIGID * top)])


def highest_eigenvalue(stiffness: csr_array, masses: FloatArray) -> float | None:
    """The highest omega^2, at most 1 % too high; None when it cannot be found."""
    values = _eigenvalues(_mass_scaled(stiffness, masses), count=1, which="LA", tol=_TOLERANCE)
    return None if values is None else float(values[-1]) * (1 + _TOLERANCE)


def _mass_scaled(stiffness: csr_array, masses: FloatArray) -> csr_array:
    from scipy.sparse import dia_array

    scale = dia_array((1 / np.sqrt(masses)[None], [0]), shape=stiffness.shape)
    return (scale @ stiffness @ scale).tocsr()


def _eigenvalues(matrix: csr_array, *, count: int, **options: Any) -> FloatArray | None:
    """Some eigenvalues, ascending; all of them where the matrix is small."""
    if matrix.shape[0] <= _DENSE:
        return np.linalg.eigvalsh(matrix.toarray())
    from scipy.sparse.linalg import ArpackError, eigsh

    start = np.random.default_rng(0).standard_normal(matrix.shape[0])  # always the same, for the same motion each run
    try:
        applied = _interruptible(matrix, options.get("sigma"))
        found = eigsh(applied.pop("matrix"), k=count, v0=start, return_eigenvectors=False, **options, **applied)
    except (ArpackError, RuntimeError):  # no convergence; a factor that is exactly singular
        return None
    return np.sort(found) if np.isfinite(found).all() else None


def _interruptible(matrix: csr_array, sigma: float | None) -> dict[str, Any]:
    """What eigenvalues are found with: the matrix and, near sigma, its shifted inverse; each use is a checkpoint."""
    from scipy.sparse import eye_array
    from scipy.sparse.linalg import LinearOperator, splu

    checkpoint()
    columns = matrix.tocsc()
    apply = columns.__matmul__ if sigma is None else splu((columns - sigma * eye_array(columns.shape[0])).tocsc()).solve

    def applied(vector: FloatArray) -> FloatArray:
        checkpoint()
        return apply(vector)

    operator = LinearOperator(columns.shape, matvec=applied, dtype=columns.dtype)
    return {"matrix": operator} if sigma is None else {"matrix": columns, "OPinv": operator}
