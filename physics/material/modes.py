"""Lowest and highest frequency at which a body vibrates: K x = omega^2 M x with a diagonal M."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..interruption import checkpoint

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = ["highest_eigenvalue", "lowest_eigenvalue", "lowest_modes"]

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
    found = _eigenpairs(scaled, count=_RIGID_MODES + 1, sigma=-_SHIFT * top, which="LM", return_eigenvectors=False)
    if found is None or found[0][-1] <= _RIGID * top:
        return None
    return float(found[0][np.argmax(found[0] > _RIGID * top)])


def lowest_modes(stiffness: csr_array, masses: FloatArray, *, most: int, within: float) -> FloatArray:
    """The displacements of the slowest vibrations that deform, of any length, in rows, shape [m, n].

    Args:
        stiffness: K, symmetric and without negative eigenvalues, shape [n, n].
        masses: the diagonal of M, all above 0, shape [n].
        most: how many at most; none where they cannot be found.
        within: times as fast as the slowest of them, at most.
    """
    scaled = _mass_scaled(stiffness, masses)
    top = float(scaled.diagonal().max())
    count = min(_RIGID_MODES + most, max(scaled.shape[0] - 1, 1))
    found = _eigenpairs(scaled, count=count, sigma=-_SHIFT * top, which="LM", return_eigenvectors=True)
    if found is None:
        return np.empty((0, len(masses)))
    values, vectors = found
    deforming = values > _RIGID * top
    slow = deforming & (values <= within**2 * values[deforming].min(initial=np.inf))
    return np.asarray((vectors[:, slow] / np.sqrt(masses)[:, None]).T[:most])


def highest_eigenvalue(stiffness: csr_array, masses: FloatArray) -> float | None:
    """The highest omega^2, at most 1 % too high; None when it cannot be found."""
    scaled = _mass_scaled(stiffness, masses)
    found = _eigenpairs(scaled, count=1, which="LA", tol=_TOLERANCE, return_eigenvectors=False)
    return None if found is None else float(found[0][-1]) * (1 + _TOLERANCE)


def _mass_scaled(stiffness: csr_array, masses: FloatArray) -> csr_array:
    from scipy.sparse import dia_array

    scale = dia_array((1 / np.sqrt(masses)[None], [0]), shape=stiffness.shape)
    return (scale @ stiffness @ scale).tocsr()


def _eigenpairs(
    matrix: csr_array, *, count: int, return_eigenvectors: bool, **options: Any
) -> tuple[FloatArray, FloatArray] | None:
    """Some eigenvalues, ascending, and their vectors in columns if asked for; all where the matrix is small."""
    if matrix.shape[0] <= _DENSE:
        if return_eigenvectors:
            return tuple(np.linalg.eigh(matrix.toarray()))  # type: ignore[return-value]
        return np.linalg.eigvalsh(matrix.toarray()), np.empty((matrix.shape[0], 0))
    from scipy.sparse.linalg import ArpackError, eigsh

    start = np.random.default_rng(0).standard_normal(matrix.shape[0])  # always the same, for the same motion each run
    try:
        applied = _interruptible(matrix, options.get("sigma"))
        options.update(applied, return_eigenvectors=return_eigenvectors)
        found = eigsh(options.pop("matrix"), k=count, v0=start, **options)
    except (ArpackError, RuntimeError):  # no convergence; a factor that is exactly singular
        return None
    values, vectors = found if return_eigenvectors else (found, np.empty((matrix.shape[0], 0)))
    if not np.isfinite(values).all():
        return None
    order = np.argsort(values)
    return values[order], vectors[:, order] if return_eigenvectors else vectors


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
