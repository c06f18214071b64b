"""Painted materials: masks that say where a body is stiffer, heavier or more damped.

Each triangle takes the mean of the mask over it and with it a factor between two: low^(1 - mean) high^mean.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import within
from ..errors import require
from ..limits import LARGEST, LEAST_FACTOR, MOST_FACTOR
from ..mesh import TriangleMesh, coverage_of
from .material import Material

__all__ = ["mask_means", "painted", "painted_by_means"]

FloatArray = NDArray[np.float64]

_SPLIT = 4  # each edge of a triangle is split in so many parts, which makes its square of smaller triangles
_FACTORS = (1e-6, LARGEST)  # what painting over painting may come to


def painted(
    material: Material,
    mesh: TriangleMesh,
    *,
    stiffness: ArrayLike | None = None,
    damping: ArrayLike | None = None,
    density: ArrayLike | None = None,
    low: float = 1.0,
    high: float = 4.0,
) -> Material:
    """The material with factors for each triangle from masks; factors that it has already are multiplied.

    Args:
        material: what is painted on.
        mesh: of the body that will be made of it.
        stiffness: mask, bool, 0..1 float or 0..255 integers, shape [h, w]; stretched over the picture. Under a sway
            frequency it says where the body is stiffer than elsewhere; the whole still sways as often.
        damping: mask of the damping.
        density: mask of the mass.
        low: factor where a mask is 0.
        high: factor where a mask is 1; it may be below ``low``.

    Raises:
        InvalidInputError: a mask is unusable, a factor is out of bounds, or the material has been painted for another
            mesh.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.material import painted, preset
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> stiff = painted(preset("hair"), mesh, stiffness=np.ones((60, 60)), high=3.0)
        >>> float(np.max(stiff.stiffness_scale))
        3.0
    """
    for name, factor in (("low", low), ("high", high)):
        require(name, factor, within(factor, LEAST_FACTOR, MOST_FACTOR), f"{LEAST_FACTOR} to {MOST_FACTOR:g}")
    masks = {"stiffness": stiffness, "damping": damping, "density": density}
    for name, mask in masks.items():
        if mask is not None:
            before, count = getattr(material, f"{name}_scale"), len(mesh.triangles)
            fits = before is None or len(before) == count
            require("mesh", f"{count} triangles", fits, f"the one that {name} has been painted for")
            material = painted_by_means(material, mask_means(mask, mesh), {name: (low, high)})
    return material


def painted_by_means(material: Material, means: FloatArray, factors: Mapping[str, tuple[float, float]]) -> Material:
    """The material with factors for each triangle, multiplied by those that it has.

    Args:
        material: what is painted on.
        means: of the mask over each triangle, 0..1, shape [t].
        factors: for each of "stiffness", "damping" and "density" that is painted, its factor at 0 and at 1.
    """
    changes: dict[str, Any] = {}
    for name, (low, high) in factors.items():
        before = getattr(material, f"{name}_scale")
        found = low ** (1 - means) * high**means * (1.0 if before is None else before)
        changes[f"{name}_scale"] = np.clip(found, *_FACTORS)
    return replace(material, **changes)


def mask_means(mask: ArrayLike, mesh: TriangleMesh) -> FloatArray:
    """The mean of a mask over each triangle, by a sample in each of 16 equal parts, 0..1, shape [t].

    Args:
        mask: bool, 0..1 float or 0..255 integers, shape [h, w]; stretched over the illustration. Beyond the border its
            nearest pixel counts.
        mesh: the mesh.

    Raises:
        InvalidInputError: the mask is of another shape, not finite, or beyond 0..1.
    """
    binary = isinstance(mask, np.ndarray) and mask.dtype == bool and mask.ndim == 2 and mask.size > 0
    coverage: NDArray[Any] = (
        np.asarray(mask) if binary else coverage_of(mask)
    )  # a mask of two values is read as it is, without a copy
    size = np.array([coverage.shape[1], coverage.shape[0]])
    corners = mesh.vertices[mesh.triangles] * (size / [mesh.width, mesh.height])
    sums, weights = np.zeros(len(corners)), _weights()
    for weight in weights:
        column, row = np.clip(np.floor(weight @ corners), 0, size - 1).astype(np.int64).T
        sums += coverage[row, column]
    return np.clip(sums / len(weights), 0.0, 1.0)


def _weights() -> FloatArray:
    """Barycentric coordinates of the centroids of the equal parts of a triangle, shape [parts, 3]."""
    upright = [(i + 1 / 3, j + 1 / 3) for i in range(_SPLIT) for j in range(_SPLIT - i)]
    turned = [(i + 2 / 3, j + 2 / 3) for i in range(_SPLIT - 1) for j in range(_SPLIT - 1 - i)]
    first, second = np.array(upright + turned).T / _SPLIT
    return np.column_stack([first, second, 1 - first - second])
