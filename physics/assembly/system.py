"""All bodies of a scene as one set of arrays in the solver's units: what is integrated."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..errors import SimulationError
from ..linear_algebra import on_one_thread
from ..material import RestShape, highest_eigenvalue, lumped_masses, stiffness_matrix
from ..mesh import TriangleMesh
from ..scene import Body, Holds, Scene, StrokesAs, holds_of
from ..solver import frequency_limits, substeps, vertex_frequencies
from .painted_bodies import with_paint
from .roots import roots_of
from .sway import SwayPart, resolve_stiffness

__all__ = ["System", "assemble"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]

_STIFFNESS = 1e-12, 1e20  # [density side^2 / s^2], factors included
_DENSITY = 1e-12, 1e14  # [1], factors included
_LEAST_ALTITUDE = 1e-9  # of a triangle [side]
_MOST_SUBSTEPS = 1_000_000
_MOST_ASSEMBLED = 200_000  # triangles up to which the stiffness matrix takes little enough memory


@dataclass(frozen=True, eq=False)
class System:
    """Every body of a scene, one connected part after the other.

    Attributes:
        rest: rest shape of all bodies together [side].
        order: index of each vertex among the scene's vertices, body after body, shape [v].
        parts: number of the connected part of each vertex, counted through all bodies, ascending, shape [v].
        bodies: number of each vertex's body, shape [v].
        youngs_modulus: of each triangle [density side^2 / s^2], shape [t]; triangles are in the order of their parts.
        lame: (mu, lambda) of each triangle [density side^2 / s^2], two of shape [t].
        density: of each triangle, shape [t].
        masses: of each vertex, shape [v]; 0 where it has no triangle. Where slivers would dictate the step, they are
            a little higher than what the density gives; not so where the step is asked for.
        damping: of each vertex [1/s], shape [v].
        leaders: index of the rig point that leads each vertex, -1 where it is free, shape [v].
        grips: how firmly a rig point pulls each vertex along that it does not lead, 0..1, shape [v].
        grippers: index of that rig point, -1 where there is none, shape [v].
        stretch_limits: of each vertex, infinite for none, shape [v].
        wind_response: factor that makes an acceleration of what wind and strokes do to each vertex, shape [v].
        sway: what became of the sway frequencies that materials ask for.
        time_step: that was asked for [s]; None for the one that suits each part.
    """

    rest: RestShape
    order: IndexArray
    parts: IndexArray
    bodies: IndexArray
    youngs_modulus: FloatArray
    lame: tuple[FloatArray, FloatArray]
    density: FloatArray
    masses: FloatArray
    damping: FloatArray
    leaders: IndexArray
    grips: FloatArray
    grippers: IndexArray
    stretch_limits: FloatArray
    wind_response: FloatArray
    sway: tuple[SwayPart, ...]
    time_step: float | None = None

    @cached_property
    def free(self) -> NDArray[np.bool_]:
        """Whether forces move each vertex, shape [v]; one without a triangle stays where it was drawn."""
        return (self.leaders < 0) & (self.masses > 0)

    @cached_property
    def active(self) -> NDArray[np.bool_]:
        """Whether each triangle acts on any free vertex, shape [t]."""
        a, b, c = self.free[self.rest.triangles].T
        return a | b | c

    @cached_property
    def part_of_triangle(self) -> IndexArray:
        """Number of each triangle's connected part, ascending, shape [t]."""
        return self.parts[self.rest.triangles[:, 0]]

    @cached_property
    def starts(self) -> IndexArray:
        """First vertex and first active triangle of each part, and where the last part ends, shape [p + 1, 2]."""
        edges = np.arange(self.parts[-1] + 2)
        triangles = self.part_of_triangle[self.active]
        return np.column_stack([np.searchsorted(self.parts, edges), np.searchsorted(triangles, edges)]).astype(np.int32)

    @cached_property
    def vertex_frequencies(self) -> FloatArray:
        """Bound on omega^2 around each vertex [1/s^2], 0 where it is not free, shape [v]."""
        return np.where(self.free, vertex_frequencies(self.rest, *self.lame, self.masses), 0.0)

    @cached_property
    def highest(self) -> FloatArray:
        """The highest omega^2 of each part at rest [1/s^2], at most a little too high, 0 if nothing is free: [p]."""
        highest = np.maximum.reduceat(self.vertex_frequencies, self.starts[:-1, 0])
        if len(self.active) > _MOST_ASSEMBLED:
            return highest
        free = np.repeat(self.free, 2)
        stiffness, masses = stiffness_matrix(self.rest, *self.lame)[free][:, free], np.repeat(self.masses, 2)[free]
        ends = np.concatenate([[0], np.cumsum(free)])[2 * self.starts[:, 0]]
        for part in np.flatnonzero(highest):
            own = slice(ends[part], ends[part + 1])
            exact = highest_eigenvalue(stiffness[own, own], masses[own])
            highest[part] = highest[part] if exact is None else min(highest[part], exact)
        return highest

    @cached_property
    def substeps(self) -> IndexArray:
        """Substeps of each part in a tick, shape [p]; one where the step is asked for.

        Raises:
            SimulationError: there are so many that nothing could be simulated, or the step that is asked for is too
                long.
        """
        if self.time_step is not None:
            self._require_stable(self.time_step)
            return np.ones(len(self.highest), dtype=np.int32)
        counts = [substeps(squared) for squared in self.highest]
        most = int(np.argmax(counts))
        if counts[most] > _MOST_SUBSTEPS:
            raise SimulationError(
                f"Body number {self.bodies[self.starts[most, 0]]} is so stiff for its weight and the size of its"
                f" triangles that it would take more than {_MOST_SUBSTEPS:,} steps in 1/240 s. Give it a lower"
                " youngs_modulus or sway_frequency or a higher density, or mesh it with a larger spacing."
            )
        return np.array(counts, dtype=np.int32)

    def _require_stable(self, step: float) -> None:
        """Refuse a step beyond 2 / omega_max, from which on semi-implicit Euler swings ever farther."""
        stiffest = int(np.argmax(self.highest))
        limit = 2 / math.sqrt(max(self.highest[stiffest], 1e-300))
        if step > limit:
            digits = math.floor(math.log10(limit)) - 1  # two of them, rounded down
            named = f"{math.floor(limit / 10**digits) * 10**digits:.{max(-digits, 0)}f} s"
            number = self.bodies[self.starts[stiffest, 0]]
            raise SimulationError(
                f"time_step must be at most {named} for body number {number}, beyond which it would swing ever farther;"
                " or set it to 0 for steps that follow from the mesh, give the body a softer material, or mesh it with"
                f" a larger spacing. Got: {step:g} s"
            )


@on_one_thread
def assemble(scene: Scene, holds: Holds | None = None) -> System:
    """Put the bodies of a scene together and settle how stiff and heavy each of their parts is.

    Args:
        scene: what is put together.
        holds: what its rig points hold, where that is known already.

    Raises:
        SimulationError: a body is so stiff, so soft, so light or so finely meshed that floats cannot bear it.
    """
    bodies, side = with_paint(scene.bodies, scene.paint), scene.bodies[0].mesh.longest_side
    for number, body in enumerate(bodies):
        _require_bearable(body, number)
    held_by = holds_of(scene) if holds is None else holds
    leaders = held_by.leaders
    stiffness = [
        resolve_stiffness(body, held >= 0, number, roots=roots_of(body.mesh, held, scene.rig_points))
        for number, (body, held) in enumerate(zip(bodies, leaders, strict=True))
    ]
    lame = [body.material.lame_at(values) for body, (values, _) in zip(bodies, stiffness, strict=True)]
    mu, lam = (np.concatenate(values) for values in zip(*lame, strict=True))
    vertex_counts = [len(body.mesh.vertices) for body in bodies]
    triangle_counts = [len(body.mesh.triangles) for body in bodies]
    parts = _numbered_through(
        (body.mesh.components for body in bodies), [body.mesh.components.max() + 1 for body in bodies]
    )
    triangles = _numbered_through((body.mesh.triangles for body in bodies), vertex_counts)
    order, rank = np.argsort(parts, kind="stable").astype(np.int32), np.empty(len(parts), dtype=np.int32)
    rank[order] = np.arange(len(order), dtype=np.int32)
    along = np.argsort(parts[triangles[:, 0]], kind="stable")
    density = np.concatenate([b.material.densities(n) for b, n in zip(bodies, triangle_counts, strict=True)])[along]
    rest = RestShape(np.concatenate([body.mesh.vertices / side for body in bodies])[order], rank[triangles[along]])
    system = System(
        rest=rest,
        order=order,
        parts=parts[order],
        bodies=np.repeat(np.arange(len(bodies), dtype=np.int32), vertex_counts)[order],
        youngs_modulus=np.concatenate([values for values, _ in stiffness])[along],
        lame=(mu[along], lam[along]),
        density=density,
        masses=lumped_masses(rest, density),
        damping=np.repeat([body.material.damping for body in bodies], vertex_counts)[order]
        * _damping_scale(bodies, rest, density, along),
        leaders=np.concatenate(leaders)[order],
        grips=np.concatenate(held_by.grips)[order],
        grippers=np.concatenate(held_by.grippers)[order],
        stretch_limits=np.repeat([body.material.stretch_limit or np.inf for body in bodies], vertex_counts)[order],
        wind_response=np.repeat([body.material.wind_response for body in bodies], vertex_counts)[order],
        sway=tuple(part for _, parts in stiffness for part in parts),
        time_step=scene.time_step,
    )
    if scene.strokes_as != "acceleration":
        system = replace(system, wind_response=system.wind_response * _per_force(system, scene.strokes_as))
    return system if scene.time_step is not None else replace(system, masses=_masses_with_slower_slivers(system))


def _per_force(system: System, strokes_as: StrokesAs) -> FloatArray:
    """Acceleration of each vertex by a force of strength 1 on the area around it, or on itself, shape [v]."""
    moved = lumped_masses(system.rest, 1.0) if strokes_as == "force" else np.ones(len(system.masses))
    return np.divide(moved, system.masses, out=np.zeros_like(moved), where=system.masses > 0)


def _require_bearable(body: Body, number: int) -> None:
    """Refuse values with whose squares and ratios the step cannot be computed."""
    material, mesh = body.material, body.mesh
    scale = material.stiffness_scale
    scale = np.ones(1) if scale is None else scale
    stiffness = material.youngs_modulus * np.array([scale.min(), scale.max() * material.root_stiffness])
    altitudes = 2 * mesh.areas / _longest_edges(mesh) / mesh.longest_side
    for name, values, (low, high) in (
        ("youngs_modulus", stiffness, _STIFFNESS),
        ("density", material.densities(len(mesh.triangles)), _DENSITY),
    ):
        if values.min() < low or values.max() > high:
            got = values.min() if values.min() < low else values.max()
            raise SimulationError(
                f"The {name} of body number {number}, with its factors, must be {low:g} to {high:g}. Got: {got:.3g}"
            )
    if altitudes.min() < _LEAST_ALTITUDE:
        raise SimulationError(
            f"The triangles of body number {number} must not be narrower than {_LEAST_ALTITUDE:g} of the picture's"
            f" longest side. Got: {altitudes.min():.3g}"
        )


def _longest_edges(mesh: TriangleMesh) -> FloatArray:
    """Length of the longest edge of each triangle [px], shape [t]."""
    corners = mesh.vertices[mesh.triangles]
    return np.asarray(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1))


def _damping_scale(
    bodies: Sequence[Body], rest: RestShape, density: FloatArray, along: NDArray[np.integer]
) -> FloatArray:
    """Factor on the damping of each vertex: the mean over its triangles, weighted by their mass, shape [v]."""
    scales = [
        np.ones(len(body.mesh.triangles)) if body.material.damping_scale is None else body.material.damping_scale
        for body in bodies
    ]
    masses = lumped_masses(rest, density)
    weighted = lumped_masses(rest, density * np.concatenate(scales)[along])
    return np.divide(weighted, masses, out=np.ones_like(masses), where=masses > 0)


def _masses_with_slower_slivers(system: System) -> FloatArray:
    """Raise the mass of the stiffest vertices of each part, as far as the mass budget goes."""
    free, masses, squared = system.free, system.masses.copy(), system.vertex_frequencies
    limits = frequency_limits(squared[free], masses[free], system.parts[free])
    masses[free] *= np.maximum(squared[free] / limits, 1.0)
    return masses


def _numbered_through(arrays: Iterable[IndexArray], counts: Iterable[int]) -> IndexArray:
    """Indices of one body after the other, each raised by the count of all that come before."""
    sizes = np.fromiter(counts, dtype=np.int64)
    starts = np.cumsum(sizes) - sizes
    return np.concatenate([array + start for array, start in zip(arrays, starts, strict=True)]).astype(np.int32)
