"""Boundaries of bodies and colliders in the form of the contact kernel, and what is close in the drawing."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..assembly import System, outline_spacing
from ..mesh import boundary_edges
from ..scene import Contact, Scene, outlines, window_of
from .closeness import Outline, neighbours_of, outward_of, overlaps_of, own_gaps, slits_at, slits_of

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
        edges: boundary edges in the winding of their triangles: their ends by their numbers among the points, the edge
            before, which ends where it begins, and the one after it, int32, shape [e, 4].
        edge_parts: connected part of each, and the slit that it is a side of, -1 for none, int32, shape [e, 2].
        drawn: place of each point as drawn [side], and the sum of the outward unit normals of its edges, float32, shape
            [n, 4].
        own_sides: distance that each point keeps from its own part [side], and the slit that it is on a side of, -1 for
            none, float32, shape [n, 2].
        bodies: body of each part, -1 for colliders, int32, shape [p].
        measures: mean length of each part's boundary edges at rest [side] and the speed of its fastest boundary vertex
            [side/s], float32, shape [p, 2].
        boxes: low and high corner of the box around each part when candidates were listed [side], float32, shape
            [p, 4].
        first_overlaps: where each point's entries of the following begin, int32, shape [n + 1].
        overlaps: parts that a point is in or near as drawn, and the distance that it keeps from each, negative inside
            [side], NEVER if it does not touch it, float32, shape [o, 2].
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
    edge_parts: Int32Array
    drawn: Float32Array
    own_sides: Float32Array
    bodies: Int32Array
    measures: Float32Array
    boxes: Float32Array
    first_overlaps: Int32Array
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
    drawn = np.concatenate([body.mesh.vertices / side for body in scene.bodies])[system.order]
    rest = np.concatenate([drawn, still])
    every, part_of_edge = np.concatenate(edges), np.concatenate(edge_parts)
    points, first = np.unique(every[:, 0], return_index=True)
    point_parts = part_of_edge[first]
    bodies = np.full(parts + len(scene.colliders), -1, dtype=np.int32)
    bodies[system.parts] = system.bodies
    own = np.linalg.norm(np.diff(rest[every], axis=1)[:, 0], axis=1)
    numbers = np.bincount(part_of_edge, minlength=len(bodies))
    mean = np.bincount(part_of_edge, weights=own, minlength=len(bodies)) / np.maximum(numbers, 1)
    outline = Outline(rest, every, part_of_edge, slits_of(rest, every, part_of_edge))
    thickness, on_slits = contact.thickness / side, slits_at(outline, points)
    gaps = np.zeros(len(points), np.float32)
    if contact.self_contact:
        gaps = own_gaps(outline, points, point_parts, on_slits.max(axis=1), thickness)
    overlaps = overlaps_of(outline, points, point_parts, on_slits.min(axis=1), parts=len(bodies), reach=thickness)
    room = LIST_LENGTH * len(points)
    buckets = 1 << max(4, int(np.ceil(np.log2(2 * len(every)))))
    surface = ContactSurface(
        points=points,
        point_parts=point_parts,
        edges=np.column_stack([np.searchsorted(points, every), neighbours_of(outline)]).astype(np.int32),
        edge_parts=np.column_stack([part_of_edge, outline.slits]).astype(np.int32),
        drawn=np.column_stack([rest[points], outward_of(outline, points)]).astype(np.float32),
        own_sides=np.column_stack([gaps, on_slits.max(axis=1)]).astype(np.float32),
        bodies=bodies,
        measures=np.column_stack([mean, np.zeros_like(mean)]).astype(np.float32),
        boxes=np.zeros((len(bodies), 4), np.float32),
        first_overlaps=overlaps[0],
        overlaps=overlaps[1],
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
