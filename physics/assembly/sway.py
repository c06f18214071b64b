"""Stiffness from the sway: artists know how often a strand swings, not its Young's modulus.

A frequency goes with the square root of the stiffness, so E = E0 (f / f0)^2, with f0 the first eigenfrequency of a
connected part of the body, held where its rig points hold it, at a Young's modulus E0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..interruption import checkpoint
from ..material import (
    RestShape,
    highest_eigenvalue,
    lame_parameters,
    lowest_eigenvalue,
    lumped_masses,
    rest_shape,
)
from ..mesh import TriangleMesh, ways_from
from ..scene import Body
from ..solver import SAFETY, TICK, frequency_limits, vertex_frequencies
from .joints import free_system, joint_factors
from .locks import lock_factors
from .roots import root_factors

__all__ = ["SWAY_SUBSTEPS", "SwayPart", "first_frequency", "resolve_stiffness"]

FloatArray = NDArray[np.float64]

SWAY_SUBSTEPS = 400
"""Most substeps in 1/240 s that a sway frequency may ask for; a part that would need more sways slower instead."""


@dataclass(frozen=True)
class SwayPart:
    """A connected part of a body whose stiffness comes from a sway frequency.

    Attributes:
        body: number of the body.
        part: number of the part, as in ``TriangleMesh.components``.
        wanted: the sway frequency that its material and its length ask for [Hz].
        achieved: how often it will sway [Hz]; less than wanted when the stiffness had to be bounded. Short locks of it
            may sway faster.
        youngs_modulus: the stiffness that follows, at the tip [density side^2 / s^2].
    """

    body: int
    part: int
    wanted: float
    achieved: float
    youngs_modulus: float


def first_frequency(
    rest: RestShape, mu: FloatArray, lam: FloatArray, density: ArrayLike, held: NDArray[np.bool_]
) -> float | None:
    """Lowest frequency at which a connected shape vibrates about its held vertices [Hz].

    Args:
        rest: the shape [side].
        mu, lam: Lame parameters of each triangle, shape [t].
        density: mass per area, one number or shape [t].
        held: which vertices do not move, shape [v]; with a single one, turning about it does not count.

    Returns:
        None where nothing is free, nothing is held, or the eigenvalue cannot be found.
    """
    if held.all() or not held.any():
        return None
    squared = lowest_eigenvalue(*free_system(rest, mu, lam, density, held))
    return None if squared is None else math.sqrt(squared) / (2 * math.pi)


def resolve_stiffness(
    body: Body, held: NDArray[np.bool_], number: int = 0, *, roots: NDArray[np.bool_] | None = None
) -> tuple[FloatArray, list[SwayPart]]:
    """Young's modulus of each triangle of a body, from its material and, where it asks for one, its sway frequency.

    The frequency is that of the body's longest part; shorter ones sway faster, as pendulums do, in proportion to
    1 / sqrt(length). Parts of which nothing is held, or everything, keep the material's own Young's modulus. Where a
    part sways, narrow joints are stiffened first; see :mod:`.joints`. Roots are stiffer than tips as the material says.
    Locks that are too soft for their length are stiffened last, so that nothing else changes; see :mod:`.locks`.

    Args:
        body: the body.
        held: which of its vertices are held or led, shape [v].
        number: number of the body in its scene, for the report.
        roots: at which of its vertices it is rooted, shape [v]; None for those that are held.

    Returns:
        Young's modulus [density side^2 / s^2], shape [t], and a report of each part that sways.
    """
    material, mesh = body.material, body.mesh
    modulus = np.full(len(mesh.triangles), float(material.youngs_modulus))
    if material.stiffness_scale is not None:
        modulus *= material.stiffness_scale
    unpainted = root_factors(mesh, held if roots is None else roots, material.root_stiffness)
    modulus *= unpainted
    report: list[SwayPart] = []
    if material.sway_frequency is None:
        return modulus, report
    rest, part_of_triangle = rest_shape(mesh), mesh.components[mesh.triangles[:, 0]]
    lengths, densities, ways = _lengths(mesh), material.densities(len(modulus)), ways_from(mesh, held)
    for part in np.unique(part_of_triangle[held[mesh.triangles].any(axis=1)]):
        checkpoint()
        chosen = part_of_triangle == part
        shape, vertices = _part_of(rest, chosen)
        density, held_here = densities[chosen], held[vertices]
        joints = joint_factors(shape, material.poisson_ratio, density, held_here)
        modulus[chosen] *= joints
        soft = unpainted[chosen] * joints
        locks = lock_factors(shape, soft, material.poisson_ratio, density, held_here, ways[vertices])
        mu, lam = lame_parameters(modulus[chosen], material.poisson_ratio)
        natural = first_frequency(shape, mu, lam, density, held_here)
        if natural is None:
            continue
        wanted = material.sway_frequency * math.sqrt(lengths.max() / lengths[part])
        factor = (wanted / natural) ** 2
        factor = min(factor, _most_stiffening(shape, mu * locks, lam * locks, density, held_here, wanted=factor))
        modulus[chosen] *= factor * locks
        achieved = natural * math.sqrt(factor)
        stiffness = material.youngs_modulus * factor
        report.append(SwayPart(number, int(part), wanted, achieved, stiffness))
    return modulus, report


def _lengths(mesh: TriangleMesh) -> FloatArray:
    """Diagonal of each connected part's bounding box [px]."""
    count = int(mesh.components.max()) + 1
    parts = [mesh.vertices[mesh.components == part] for part in range(count)]
    return np.array([np.hypot(*np.ptp(part, axis=0)) for part in parts])


def _part_of(rest: RestShape, chosen: NDArray[np.bool_]) -> tuple[RestShape, NDArray[np.integer]]:
    """The chosen triangles as a shape of their own, and which vertices it has."""
    vertices, triangles = np.unique(rest.triangles[chosen], return_inverse=True)
    return RestShape(rest.positions[vertices], triangles.reshape(-1, 3).astype(np.int32)), vertices


def _most_stiffening(
    shape: RestShape, mu: FloatArray, lam: FloatArray, density: ArrayLike, held: NDArray[np.bool_], *, wanted: float
) -> float:
    """Largest factor on the stiffness of a part that leaves it within ``SWAY_SUBSTEPS``."""
    allowed = (SAFETY * 2 * SWAY_SUBSTEPS / TICK) ** 2
    masses = lumped_masses(shape, density)
    squared = vertex_frequencies(shape, mu, lam, masses)[~held]
    highest = float(frequency_limits(squared, masses[~held], np.zeros(len(squared), dtype=np.int32)).max())
    if wanted * highest > allowed:  # by the quick bound, which is on the safe side
        highest = min(highest, highest_eigenvalue(*free_system(shape, mu, lam, density, held)) or highest)
    return allowed / highest
