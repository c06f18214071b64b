"""Closed-form matting: alpha that follows the colours wherever these lie on a line between two (Levin et al., 2008).

In a window of 3 x 3 pixels alpha shall be an affine function of the colour, as it is where one colour lies over
another. The sum of squared deviations over all windows is a quadratic form in alpha, the matting Laplacian.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["solve_alpha"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

_WINDOW = np.array([(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1)])
_PIXELS = len(_WINDOW)
# Unknown pixels up to which the system is factorised, and the rounds of the solver beyond.
_FACTORISED, _MOST_ROUNDS = 50_000, 500
# Variance of the colours that counts for noise: on flat areas alpha is then smooth instead of undetermined.
_NOISE = 1e-4


def solve_alpha(image: FloatImage, given: FloatImage, unknown: Mask, guess: FloatImage, *, trust: float) -> FloatImage:
    """Alpha of the unknown pixels, so that it fits the known ones beside them.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        given: alpha in 0 to 1, shape [h, w]; kept where it is known.
        unknown: where alpha is sought, shape [h, w].
        guess: what alpha probably is there, shape [h, w].
        trust: weight of the guess against the colours.

    Returns:
        Alpha in 0 to 1, shape [h, w].
    """
    from scipy.sparse import csr_matrix, identity

    windows = _windows_at(unknown)
    if not len(windows):
        return np.where(unknown, guess, given).astype(np.float32)
    pixels, places = np.unique(windows, return_inverse=True)
    places = places.reshape(windows.shape)
    rows, columns = np.repeat(places, _PIXELS, axis=1).ravel(), np.tile(places, (1, _PIXELS)).ravel()
    entries = _deviations(image.reshape(-1, 3)[windows].astype(np.float64)).ravel()
    laplacian = csr_matrix((entries, (rows, columns)), shape=(len(pixels), len(pixels)))
    sought = unknown.ravel()[pixels]
    system = laplacian[sought][:, sought] + trust * identity(int(sought.sum()))
    known = given.ravel()[pixels[~sought]].astype(np.float64)
    wanted = trust * guess.ravel()[pixels[sought]].astype(np.float64) - laplacian[sought][:, ~sought] @ known
    alpha = np.where(unknown, guess, given).astype(np.float32).ravel()
    alpha[pixels[sought]] = np.clip(_solution(system, wanted, guess.ravel()[pixels[sought]]), 0, 1)
    return alpha.reshape(unknown.shape)


def _solution(system: Any, wanted: NDArray[np.float64], start: FloatImage) -> NDArray[np.float64]:
    """What solves the linear system, a sparse positive definite matrix.

    Along edges a factorisation is fastest, but where areas are unknown, as in a mask of noise, it fills up and takes
    minutes. There conjugate gradients are fast: the trust in the guess keeps the matrix well conditioned.
    """
    from scipy.sparse.linalg import cg, spsolve

    if len(wanted) <= _FACTORISED:
        return np.asarray(spsolve(system.tocsc(), wanted))
    scale = 1 / np.sqrt(system.diagonal())
    scaled = system.multiply(scale[:, None]).multiply(scale).tocsr()
    found, _ = cg(scaled, wanted * scale, x0=start / scale, maxiter=_MOST_ROUNDS)
    return np.asarray(found * scale)


def _windows_at(unknown: Mask) -> NDArray[np.int64]:
    """Flat indices of the pixels of every window within the picture that holds an unknown pixel, shape [n, 9]."""
    height, width = unknown.shape
    if min(height, width) < 3:
        return np.zeros((0, _PIXELS), np.int64)
    held = np.zeros((height, width), dtype=bool)
    for row, column in _WINDOW:
        held[1:-1, 1:-1] |= unknown[1 + row : height - 1 + row, 1 + column : width - 1 + column]
    rows, columns = np.nonzero(held)
    return (rows[:, None] + _WINDOW[:, 0]) * width + columns[:, None] + _WINDOW[:, 1]


def _deviations(colours: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each window's own quadratic form: how far alphas are from an affine function of its colours.

    Args:
        colours: RGB, shape [n, 9, 3].

    Returns:
        Matrices, shape [n, 9, 9].
    """
    offset = colours - colours.mean(axis=1, keepdims=True)
    covariance = np.einsum("nki,nkj->nij", offset, offset) / _PIXELS + _NOISE / _PIXELS * np.eye(3)
    likeness = np.einsum("nki,nij,nlj->nkl", offset, np.linalg.inv(covariance), offset)
    return np.eye(_PIXELS) - (1 + likeness) / _PIXELS
