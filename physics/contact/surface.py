"""Boundaries of bodies and colliders in the form of the contact kernel, and how they overlap at rest."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..assembly import System, outline_spacing
from ..interruption import checkpoint
from ..mesh import boundary_edges, within_reach
from ..scene import Contact, Scene, outlines, window_of

__all__ = [
    "CANDIDATES",
    "CONTACTS",
    "FAR",
    "FASTEST",
    "GAP",
    "GOT_INSIDE",
    "LIST_LENGTH",
    "LONGEST",
    "MARGIN",
    "MOVED_SINCE_LISTING",
    "MOVED_SINCE_SEARCH",
    "NEAREST_SQUARE",
    "RADIUS",
    "SEARCH",
    "SPACING",
    "SPEED",
    "STEPS",
    "TIME",
    "TOUCHING",
    "VALID_FOR",
    "VALID_LEFT",
    "ContactSurface",
    "contact_surface",
]

FloatArray = NDArray[np.float64]
Float32Array = NDArray[np.float32]
Int32Array = NDArray[np.int32]

FAR = 1e6
"""Farther than anything [side]."""

LIST_LENGTH = 4
"""Most contacts of one vertex, each with another part."""

CANDIDATES = 96
"""Most candidate edges of a vertex, on average over all vertices."""

(
    MARGIN,  # for motion, within which candidates were listed [side]
    CONTACTS,  # how many there are; -1 before the first search
    GAP,  # by which every point is farther from all edges than the search radius, at least [side]
    VALID_FOR,  # how long the list of contacts is valid from its search on [s]
    VALID_LEFT,  # how much of that is left [s]
    SEARCH,  # what the present search has to do
    TIME,  # ahead, for which it lists contacts [s]
    FASTEST,  # speed of the fastest boundary vertex [side/s]
    LONGEST,  # length of the longest edge [side]
    NEAREST_SQUARE,  # squared distance from a point to a candidate, the least of all [side^2]
    MOVED_SINCE_LISTING,  # farthest way of a point since the candidates were listed [side]
    MOVED_SINCE_SEARCH,  # farthest way of a point since the search before [side]
    RADIUS,  # within which candidates were listed, besides the margin [side]
    GOT_INSIDE,  # 1 if a point has got behind an edge since
) = range(14)
"""Places of the numbers in ``ContactSurface.memory``."""

SPACING, SPEED = range(2)
"""Places of the numbers in ``ContactSurface.measures``."""

TOUCHING, STEPS = range(2)
"""Places of the numbers in ``ContactSurface.activity``."""


class ContactSurface(NamedTuple):
    """What the contact kernel reads and writes besides the bodies; vertices of colliders follow those of the bodies.

    Attributes:
        points: vertices on a boundary, ascending, int32, shape [n].
        point_parts: connected part of each, colliders counted after all parts, int32, shape [n].
        edges: boundary edges in the winding of their triangles by the numbers of their ends among the points, int32,
            shape [e, 2].
        neighbours: boundary edge before each, which ends where it begins, and the one after it, int32, shape [e, 2].
        edge_parts: connected part of each, int32, shape [e].
        bodies: body of each part, -1 for colliders, int32, shape [p].
        measures: mean length of each part's boundary edges at rest [side] and the speed of its fastest boundary vertex
            [side/s], float32, shape [p, 2].
        boxes: low and high corner of the box around each part when candidates were listed [side], float32, shape
            [p, 4].
        first_overlaps: where each point's entries of the following two begin, int32, shape [n + 1].
        overlap_parts: parts that a point is in or near at rest, int32, shape [o].
        overlaps: distance that it keeps from each, negative inside [side], float32, shape [o].
        heads, order: the spatial hash: where each bucket begins in order, and the edges by bucket, beside which stands
            the bucket of each edge by its number, int32, shapes [k + 1], [e, 2].
        middles: the middle of each edge when candidates were listed, half its length [side], and its body, float32,
            shape [e, 4].
        candidate_ranges, candidates: where the candidate edges of each point begin and end, int32, shape [n, 2], and
            the edges, int32.
        positions: each point at the latest search [side], float32, shape [n, 2].
        listed: each point when the candidates were listed, its distance from the nearest of them [side], and 1 if it is
            known to be outside of all other parts, float32, shape [n, 4].
        contact_counts: number of contacts of each point in the present search, int32, shape [n].
        contacts: pairs of a point and the edge that it may touch, int32, shape [c, 2].
        contact_data: normal (2), parameter along the edge, and distance to keep [side] of each contact, float32, shape
            [c, 4].
        activity: of each part 1 if it may touch another within a tick, by the latest search, and its substeps in the
            present tick (0 for colliders), int32, shape [p, 2].
        memory: numbers that the kernel keeps from search to search, at the places named above, float32, shape [14].
    """

    points: Int32Array
    point_parts: Int32Array
    edges: Int32Array
    neighbours: Int32Array
    edge_parts: Int32Array
    bodies: Int32Array
    measures: Float32Array
    boxes: Float32Array
    first_overlaps: Int32Array
    overlap_parts: Int32Array
    overlaps: Float32Array
    heads: Int32Array
    order: Int32Array
    middles: Float32Array
    candidate_ranges: Int32Array
    candidates: Int32Array
    positions: Float32Array
    listed: Float32Array
    contact_counts: Int32Array
    contacts: Int32Array
    contact_data: Float32Array
    activity: Int32Array
    memory: Float32Array


def contact_surface(scene: Scene, system: System, contact: Contact) -> tuple[ContactSurface, FloatArray]:
    """The surfaces of a scene, and the vertices of its colliders [side], shape [c, 2]."""
    side = scene.bodies[0].mesh.longest_side
    body_edges = boundary_edges(system.rest.triangles)
    spacing, window = outline_spacing(scene, system), window_of(scene)
    count, parts = len(system.parts), int(system.parts[-1]) + 1
    positions, edges, edge_parts = [], [body_edges], [system.parts[body_edges[:, 0]]]
    for number, collider in enumerate(scene.colliders):
        for loop in outlines(collider, scene.width, scene.height, spacing, window):
            along = np.arange(len(loop))
            edges.append((np.column_stack([along, (along + 1) % len(loop)]) + count).astype(np.int32))
            edge_parts.append(np.full(len(loop), parts + number, dtype=np.int32))
            positions.append(loop / side)
            count += len(loop)
    still = np.concatenate(positions) if positions else np.zeros((0, 2))
    rest = np.concatenate([system.rest.positions, still])
    every, part_of_edge = np.concatenate(edges), np.concatenate(edge_parts)
    points, first = np.unique(every[:, 0], return_index=True)
    point_parts = part_of_edge[first]
    bodies = np.full(parts + len(scene.colliders), -1, dtype=np.int32)
    bodies[system.parts] = system.bodies
    own = np.linalg.norm(np.diff(rest[every], axis=1)[:, 0], axis=1)
    numbers = np.bincount(part_of_edge, minlength=len(bodies))
    mean = np.bincount(part_of_edge, weights=own, minlength=len(bodies)) / np.maximum(numbers, 1)
    overlaps = _overlaps(rest, points, point_parts, every, part_of_edge, len(bodies), contact.thickness / side)
    room = LIST_LENGTH * len(points)
    buckets = 1 << max(4, int(np.ceil(np.log2(2 * len(every)))))
    surface = ContactSurface(
        points=points,
        point_parts=point_parts,
        edges=np.searchsorted(points, every).astype(np.int32),
        neighbours=_neighbours(every),
        edge_parts=part_of_edge,
        bodies=bodies,
        measures=np.column_stack([mean, np.zeros_like(mean)]).astype(np.float32),
        boxes=np.zeros((len(bodies), 4), np.float32),
        first_overlaps=overlaps[0],
        overlap_parts=overlaps[1],
        overlaps=overlaps[2],
        heads=np.zeros(buckets + 1, np.int32),
        order=np.zeros((len(every), 2), np.int32),
        middles=np.zeros((len(every), 4), np.float32),
        candidate_ranges=np.zeros((len(points), 2), np.int32),
        candidates=np.zeros(CANDIDATES * len(points), np.int32),
        positions=np.zeros((len(points), 2), np.float32),
        listed=np.column_stack([np.zeros((len(points), 3)), np.diff(overlaps[0]) == 0]).astype(np.float32),
        contact_counts=np.zeros(len(points), np.int32),
        contacts=np.zeros((room, 2), np.int32),
        contact_data=np.zeros((room, 4), np.float32),
        activity=np.tile(np.array([1, 0], np.int32), (len(bodies), 1)),
        memory=np.array([0.0, -1.0, *[0.0] * 12], np.float32),
    )
    return surface, still


def _neighbours(edges: Int32Array) -> Int32Array:
    """For each edge of closed outlines one that ends where it begins, and one that begins where it ends."""
    size = int(edges.max()) + 1
    ending, beginning = np.zeros(size, np.int32), np.zeros(size, np.int32)
    numbers = np.arange(len(edges), dtype=np.int32)
    ending[edges[:, 1]], beginning[edges[:, 0]] = numbers, numbers
    return np.column_stack([ending[edges[:, 0]], beginning[edges[:, 1]]])


def _overlaps(
    rest: FloatArray,
    points: Int32Array,
    point_parts: Int32Array,
    edges: Int32Array,
    edge_parts: Int32Array,
    parts: int,
    thickness: float,
) -> tuple[Int32Array, Int32Array, Float32Array]:
    """Which points are inside or nearly touch which other part at rest, and the distance that they keep from it."""
    numbers, others, distances = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)], [np.zeros(0)]
    for part in range(parts):
        checkpoint()
        own = edges[edge_parts == part]
        if not len(own):
            continue
        corners = rest[own[:, 0]]
        low, high = corners.min(axis=0) - thickness, corners.max(axis=0) + thickness
        around = ((rest[points] > low) & (rest[points] < high)).all(axis=1) & (point_parts != part)
        near = np.flatnonzero(around)
        if len(near):
            found, distance = within_reach(rest[points[near]], corners, rest[own[:, 1]], thickness)
            numbers.append(near[found])
            others.append(np.full(len(found), part))
            distances.append(distance)
    number, other, distance = np.concatenate(numbers), np.concatenate(others), np.concatenate(distances)
    first = np.concatenate([[0], np.cumsum(np.bincount(number, minlength=len(points)))]).astype(np.int32)
    if not len(number):  # the kernel wants an entry
        return first, np.array([-1], np.int32), np.zeros(1, np.float32)
    order = np.lexsort((other, number))
    return first, other[order].astype(np.int32), distance[order].astype(np.float32)
