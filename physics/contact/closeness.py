"""What is close as drawn: the sides of slits, narrow gaps, and what overlaps. It keeps the distance that it has."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..interruption import checkpoint
from ..mesh import within_reach

__all__ = [
    "FACING",
    "NEVER",
    "Outline",
    "neighbours_of",
    "outward_of",
    "overlaps_of",
    "own_gaps",
    "slits_at",
    "slits_of",
]

FloatArray = NDArray[np.float64]
Float32Array = NDArray[np.float32]
Int32Array = NDArray[np.int32]

FACING = 0.3
"""Normals that point against each other by more than this, as a cosine, are of sides that face each other."""

NEVER = -1e6
"""The distance that is kept from a part that is not touched [side]."""


class Outline(NamedTuple):
    """Boundary edges of all parts, as drawn.

    Attributes:
        places: of all vertices [side], shape [v, 2].
        edges: by the numbers of their ends, in the winding of their triangles, shape [e, 2].
        parts: part of each edge, shape [e].
        slits: number of the slit that each is a side of, -1 for none, shape [e].
    """

    places: FloatArray
    edges: Int32Array
    parts: Int32Array
    slits: Int32Array


def slits_of(places: FloatArray, edges: Int32Array, parts: Int32Array) -> Int32Array:
    """Number of the slit of which each edge is a side: one with another edge of its part on it; -1 for none, [e].

    Args:
        places: of all vertices as drawn, shape [v, 2].
        edges: boundary edges by the numbers of their ends, shape [e, 2].
        parts: part of each edge, shape [e].
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    _, merged = np.unique(places, axis=0, return_inverse=True)
    ends = merged.reshape(-1)[edges].astype(np.int64)
    keys = np.column_stack([parts, ends.min(axis=1), ends.max(axis=1)])
    _, same, counts = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    on_slit = counts[same.reshape(-1)] > 1
    slits = np.full(len(edges), -1, dtype=np.int32)
    if on_slit.any():
        size, pairs = int(ends.max()) + 1, ends[on_slit]
        graph = coo_array((np.ones(len(pairs)), tuple(pairs.T)), shape=(size, size))
        slits[on_slit] = connected_components(graph, directed=False)[1][pairs[:, 0]]
    return slits


def slits_at(outline: Outline, points: Int32Array) -> Int32Array:
    """Slits that the edge before each point and the one after it are on, -1 for none, shape [n, 2]."""
    result = np.full((len(outline.places), 2), -1, dtype=np.int32)
    for side, ends in enumerate(outline.edges.T):
        result[ends, side] = outline.slits
    return np.asarray(result[points])


def outward_of(outline: Outline, points: Int32Array) -> FloatArray:
    """Sum of the outward unit normals of the two edges at each point; about none at the end of a slit, shape [n, 2]."""
    along = np.diff(outline.places[outline.edges], axis=1)[:, 0]
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    normals = np.column_stack([-along[:, 1], along[:, 0]])
    total = np.zeros_like(outline.places)
    for end in outline.edges.T:
        np.add.at(total, end, normals)
    return np.asarray(total[points])


def neighbours_of(outline: Outline) -> Int32Array:
    """For each edge of closed outlines one that ends where it begins, and one that begins where it ends, shape [e, 2].

    The outline goes on from one side of a slit to the other, as it is without it.
    """
    result = _following(outline.edges)
    whole = np.flatnonzero(outline.slits < 0)
    if len(whole) < len(outline.edges):
        apart = np.column_stack(
            [outline.places[outline.edges[whole]].reshape(-1, 2), np.repeat(outline.parts[whole], 2)]
        )
        _, merged = np.unique(apart, axis=0, return_inverse=True)
        result[whole] = whole[_following(merged.reshape(-1, 2))]
    return result


def _following(edges: NDArray[np.integer]) -> Int32Array:
    size = int(edges.max()) + 1
    ending, beginning = np.zeros(size, np.int32), np.zeros(size, np.int32)
    numbers = np.arange(len(edges), dtype=np.int32)
    ending[edges[:, 1]], beginning[edges[:, 0]] = numbers, numbers
    return np.column_stack([ending[edges[:, 0]], beginning[edges[:, 1]]])


def own_gaps(
    outline: Outline, points: Int32Array, point_parts: Int32Array, point_slits: Int32Array, thickness: float
) -> Float32Array:
    """Distance that each point keeps from its own part: the thickness, or less if a side that faces it is nearer, [n].

    On slits, whose sides lie on each other, it is 0.

    Args:
        outline: of all parts.
        points: vertices on it, ascending, shape [n].
        point_parts: part of each, shape [n].
        point_slits: slit that each is on a side of, -1 for none, shape [n].
        thickness: of the contact [side].
    """
    from scipy.spatial import cKDTree

    gaps = np.where(point_slits >= 0, 0.0, thickness)
    outward = outward_of(outline, points)
    starts, ends = outline.places[outline.edges[:, 0]], outline.places[outline.edges[:, 1]]
    along = ends - starts
    lengths = np.maximum(np.linalg.norm(along, axis=1), 1e-12)
    tree = cKDTree((starts + ends) / 2)
    for number, near in enumerate(tree.query_ball_point(outline.places[points], thickness + lengths.max() / 2)):
        edges = np.array(near, dtype=np.int64)
        own = (outline.parts[edges] == point_parts[number]) & (outline.edges[edges] != points[number]).all(axis=1)
        edges = edges[own]
        normals = np.column_stack([-along[edges, 1], along[edges, 0]]) / lengths[edges, None]
        way = outline.places[points[number]] - starts[edges]
        share = np.clip((way * along[edges]).sum(axis=1) / lengths[edges] ** 2, 0, 1)
        away = way - share[:, None] * along[edges]
        facing = normals @ outward[number] < -FACING
        in_front = (away * normals).sum(axis=1) >= FACING * np.linalg.norm(away, axis=1)
        gaps[number] = min(gaps[number], np.linalg.norm(away[facing & in_front], axis=1).min(initial=thickness))
    return gaps.astype(np.float32)


def overlaps_of(
    outline: Outline, points: Int32Array, point_parts: Int32Array, point_slits: Int32Array, *, parts: int, reach: float
) -> tuple[Int32Array, Float32Array]:
    """Which points are inside or nearly touch which other part as drawn, and the distance that they keep from it.

    A slit is none for other parts: they touch the outline as it is without it, and where they overlap the part, they
    and the sides of its slits do not touch.

    Args:
        outline: of all parts.
        points: vertices on it, ascending, shape [n].
        point_parts: part of each, shape [n].
        point_slits: slit that each is on a side of, -1 for none, shape [n].
        parts: how many there are.
        reach: below which a distance is near [side].

    Returns:
        Where each point's entries of the following begin, shape [n + 1]; the other parts, and the distances [side],
        negative inside, shape [o, 2].
    """
    numbers, others, distances = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)], [np.zeros(0)]
    place = outline.places[points]
    for part in range(parts):
        checkpoint()
        own = outline.edges[(outline.parts == part) & (outline.slits < 0)]
        if not len(own):
            continue
        corners = outline.places[own[:, 0]]
        low, high = corners.min(axis=0) - reach, corners.max(axis=0) + reach
        near = np.flatnonzero(((place > low) & (place < high)).all(axis=1) & (point_parts != part))
        if len(near):
            found, distance = within_reach(place[near], corners, outline.places[own[:, 1]], reach)
            numbers.append(near[found])
            others.append(np.full(len(found), part))
            distances.append(distance)
    found_all = np.concatenate(numbers), np.concatenate(others), np.concatenate(distances)
    number, other, distance = _without_slits(*found_all, point_parts, point_slits, deep=-reach)
    first = np.concatenate([[0], np.cumsum(np.bincount(number, minlength=len(points)))]).astype(np.int32)
    if not len(number):  # the kernel wants an entry
        return first, np.array([[-1, 0]], np.float32)
    order = np.lexsort((other, number))
    return first, np.column_stack([other, distance])[order].astype(np.float32)


def _without_slits(
    number: NDArray[np.int64],
    other: NDArray[np.int64],
    distance: FloatArray,
    point_parts: Int32Array,
    point_slits: Int32Array,
    *,
    deep: float,
) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
    """The entries of ``overlaps_of``, those of points on slits such that they never touch what their part overlaps.

    What overlaps it no deeper than the thickness does not count, so that slits, once open, meet it.
    """
    own, inside = point_parts[number], distance < deep
    overlapping = {*zip(own[inside].tolist(), other[inside].tolist(), strict=True)}
    overlapping |= {(part, owner) for owner, part in overlapping}
    on_slit = np.flatnonzero(point_slits >= 0)
    if not len(on_slit) or not overlapping:
        return number, other, distance
    kept = np.array(
        [point_slits[n] < 0 or (p, o) not in overlapping for n, p, o in zip(number, own, other, strict=True)]
    )
    added = [(n, part) for n in on_slit.tolist() for owner, part in overlapping if owner == point_parts[n]]
    numbers, others = np.array(added, dtype=np.int64).reshape(-1, 2).T
    return (
        np.concatenate([number[kept], numbers]),
        np.concatenate([other[kept], others]),
        np.concatenate([distance[kept], np.full(len(added), NEVER)]),
    )
