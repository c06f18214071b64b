# mypy: ignore-errors
"""Broad phase of the contact search: for every boundary vertex, the candidate edges within a radius and a margin.

Edges go into a spatial hash by their middles; vertices outside the bounding boxes of all other bodies have none.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from ..solver.kernel_types import any_value, int2, vec2, vec4
from .closeness import FACING
from .edge_hash import bucket, cell_of, fill_hash, middle
from .functions import edge_ends, offset_from_edge
from .surface import FAR, LONGEST, MARGIN, RADIUS, SPACING

__all__ = [
    "INSIDE_DEPTH",
    "TOLERANCE",
    "build_hash",
    "coarsest_spacing",
    "known_outside",
    "list_candidates",
    "listed_position",
    "overlaps_nothing",
    "search_radii",
]

TOLERANCE = 0.05  # [mean edges] added to distances, for speed that is gained between two searches
INSIDE_DEPTH = 0.5  # [mean edges] behind an edge, from where on a point counts as inside
_INSIDE_RADIUS = 2.0  # [mean edges] within which edges are searched for a point that may be inside: the deepest contact


@ti.func
def may_touch(surface: any_value, n: ti.i32, e: ti.i32, options: any_value):
    """Whether a point may collide with an edge: with its own body in self contact, but not with edges that end at it.

    The sides of a slit touch each other; other parts meet the outline as it is without slits.
    """
    own, part, slit = surface.point_parts[n], surface.edge_parts[e][0], surface.edge_parts[e][1]
    body, edge = surface.bodies[own], surface.edges[e]
    allowed = surface.bodies[part] != body and slit < 0
    if surface.bodies[part] == body and body >= 0 and options.self_contact == 1:
        allowed = slit < 0
        if part == own:
            allowed = edge[0] != n and edge[1] != n and own_edge_may_touch(surface, n, e, options)
    return allowed


@ti.func
def own_edge_may_touch(surface: any_value, n: ti.i32, e: ti.i32, options: any_value):
    """Whether a point may collide with an edge of its own part: one that is far away as drawn, or faces it.

    Those along its own side of the outline, and behind it in a thin part, are always near.
    """
    a, b, p = (
        drawn_place(surface, surface.edges[e][0]),
        drawn_place(surface, surface.edges[e][1]),
        drawn_place(surface, n),
    )
    away = offset_from_edge(p, a, b)
    apart = away.norm()
    allowed = apart > 2.0 * ti.max(surface.measures[surface.point_parts[n]][SPACING], options.thickness)
    if not allowed:
        normal = vec2(a[1] - b[1], b[0] - a[0]) / ti.max((b - a).norm(), 1e-12)
        slit = surface.edge_parts[e][1]
        across = slit >= 0 and slit == ti.cast(surface.own_sides[n][1], ti.i32)
        facing = normal.dot(vec2(surface.drawn[n][2], surface.drawn[n][3])) < 0.0 - FACING
        allowed = facing and (across or (apart > 0.0 and away.dot(normal) >= FACING * apart))
    return allowed


@ti.func
def drawn_place(surface: any_value, n: ti.i32):
    """Position of a point as drawn."""
    return vec2(surface.drawn[n][0], surface.drawn[n][1])


@ti.func
def listed_position(surface: any_value, n: ti.i32):
    """Position of a point when the candidates were listed."""
    return vec2(surface.listed[n][0], surface.listed[n][1])


@ti.func
def overlaps_nothing(surface: any_value, n: ti.i32):
    """Whether a point is neither inside nor near another part at rest."""
    return surface.first_overlaps[n] == surface.first_overlaps[n + 1]


@ti.func
def known_outside(surface: any_value, n: ti.i32):
    """Whether a point was in front of all parts at the last search, so that a small search radius is enough."""
    return surface.listed[n][3] > 0.5


@ti.func
def coarsest_spacing(surface: any_value):
    """Mean edge length of the coarsest part."""
    width = 0.0
    for part in range(surface.measures.shape[0]):
        width = ti.max(width, surface.measures[part][SPACING])
    return width


@ti.func
def search_radii(surface: any_value, options: any_value):
    """Search radii without the margin: of points that may be inside, and of those known to be outside."""
    coarsest = coarsest_spacing(surface)
    inner = ti.max(options.thickness, _INSIDE_RADIUS * coarsest)
    return inner, ti.max(options.thickness + TOLERANCE * coarsest, INSIDE_DEPTH * coarsest)


@ti.func
def cell_size(surface: any_value):
    """Side of a cell of the hash: so large that all candidates of a point are in the nine cells around it."""
    memory = ti.static(surface.memory)
    return 0.5 * memory[LONGEST] + memory[RADIUS] + memory[MARGIN]


@ti.func
def find_boxes(surface: any_value):
    """Bounding box of each part; returns whether all points are known to be outside."""
    boxes = ti.static(surface.boxes)
    for part in range(boxes.shape[0]):
        boxes[part] = vec4(FAR, FAR, 0.0 - FAR, 0.0 - FAR)
    all_outside = True
    for n in range(surface.points.shape[0]):
        p, part = surface.positions[n], surface.point_parts[n]
        all_outside = all_outside and known_outside(surface, n)
        box = boxes[part]
        boxes[part] = vec4(ti.min(box[0], p[0]), ti.min(box[1], p[1]), ti.max(box[2], p[0]), ti.max(box[3], p[1]))
    return all_outside


@ti.func
def near_a_box(surface: any_value, options: any_value, n: ti.i32, reach: ti.f32):
    """Whether a point is within reach of the bounding box of another body; always with self contact."""
    p, own, found = surface.positions[n], surface.point_parts[n], options.self_contact == 1
    for part in range(surface.boxes.shape[0]):
        if surface.bodies[part] != surface.bodies[own]:
            box = surface.boxes[part]
            if box[0] - reach < p[0] < box[2] + reach and box[1] - reach < p[1] < box[3] + reach:
                found = True
    return found


@ti.func
def build_hash(surface: any_value, options: any_value):
    """Sort the edges into the hash, with the cell size that the search radius and the margin need."""
    all_outside = find_boxes(surface)
    longest = 0.0
    for e in range(surface.edges.shape[0]):
        a, b = edge_ends(surface, e)
        length, between = (b - a).norm(), 0.5 * (a + b)
        longest = ti.max(longest, length)
        body = ti.cast(surface.bodies[surface.edge_parts[e][0]], ti.f32)
        surface.middles[e] = vec4(between[0], between[1], 0.5 * length, body)
    surface.memory[LONGEST] = longest
    inner, outer = search_radii(surface, options)
    surface.memory[RADIUS] = ti.select(all_outside, outer, inner)
    fill_hash(surface, cell_size(surface))


@ti.func
def add_edges_around(surface: any_value, options: any_value, n: ti.i32, reach: ti.f32, first: ti.i32):
    """Write the edges in the nine cells around a point, as far as they may be within reach, behind the first
    candidates; returns the number of all.
    """
    heads, candidates = ti.static((surface.heads, surface.candidates))
    p, count, buckets = surface.positions[n], first, heads.shape[0] - 1
    other_than = ti.cast(surface.bodies[surface.point_parts[n]], ti.f32)
    if options.self_contact == 1:
        other_than = -2.0
    x, y = cell_of(p, cell_size(surface))
    for c in range(6):
        # Three rows of three cells, each one or two runs of buckets: after the last bucket comes the first.
        k = bucket(x - 1, y + c // 2 - 1, buckets)
        begin, end = k, ti.min(k + 3, buckets)
        if c % 2 == 1:
            begin, end = 0, ti.max(k + 3 - buckets, 0)
        for s in range(heads[begin], heads[end]):
            e = surface.order[s][0]
            if count < candidates.shape[0]:  # further candidates are left out where the room is used up
                candidates[count] = e
                far, body = reach + surface.middles[e][2], surface.middles[e][3]
                near = (p - middle(surface, e)).norm_sqr() < far * far and body != other_than
                count = count + ti.cast(near, ti.i32)
    return count


@ti.func
def keep_within_reach(surface: any_value, options: any_value, n: ti.i32, reach: ti.f32, first: ti.i32, end: ti.i32):
    """Of a point's candidates from the first one on, keep those within reach that it may touch.

    Returns where they end now, and the square of the distance to the nearest.
    """
    candidates = ti.static(surface.candidates)
    nearest_square, kept = FAR, first
    p = surface.positions[n]
    for c in range(first, end):
        e = candidates[c]
        candidates[kept] = e
        a, b = edge_ends(surface, e)
        square = offset_from_edge(p, a, b).norm_sqr()
        if square < reach * reach and may_touch(surface, n, e, options):
            nearest_square = ti.min(nearest_square, square)
            kept = kept + 1
    return kept, nearest_square


@ti.func
def list_candidates(surface: any_value, options: any_value):
    """List for each point the edges within its search radius and the margin."""
    inner, outer = search_radii(surface, options)
    count = 0
    for n in range(surface.points.shape[0]):
        first, p, nearest_square = count, surface.positions[n], FAR
        reach = ti.select(known_outside(surface, n), outer, inner) + surface.memory[MARGIN]
        if near_a_box(surface, options, n, reach):
            count = add_edges_around(surface, options, n, reach, first)
            count, nearest_square = keep_within_reach(surface, options, n, reach, first, count)
        surface.candidate_ranges[n] = int2(first, count)
        surface.listed[n] = vec4(p[0], p[1], ti.sqrt(nearest_square), surface.listed[n][3])
