# mypy: ignore-errors
"""How the contact kernel lists, for every boundary vertex, the edges around it that it may come near to for a while.

Edges go into a spatial hash by their middles; vertices that are near no box around another part are not looked up.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any

from .surface import FORESEEN, LONGEST, REACH, SPACING

__all__ = ["INSIDE", "SLACK", "build_contact_listing"]

SLACK = 0.05  # of a mean edge, for speed that is gained between two searches
INSIDE = 0.5  # of a mean edge, behind an edge, from where on a point counts as inside
_WIDE = 2.0  # mean edges; within these of an edge a point is looked at that may be inside


def build_contact_listing(ti: Any, contact: SimpleNamespace) -> SimpleNamespace:
    """The functions of the listing, by name, on those that ``build_contact_functions`` made."""
    vec2, vec4, int2 = ti.types.vector(2, ti.f32), ti.types.vector(4, ti.f32), ti.types.vector(2, ti.i32)
    any_value = ti.template()
    rest_place, offset, edge_ends = contact.rest_place, contact.offset, contact.edge_ends

    @ti.func
    def cell_of(p: vec2, size: ti.f32):
        return ti.cast(ti.floor(p[0] / size), ti.i32), ti.cast(ti.floor(p[1] / size), ti.i32)

    @ti.func
    def bucket(x: ti.i32, y: ti.i32, count: ti.i32):
        """Where a cell is in the hash; cells of a row lie one behind the other."""
        return (x + y * 19349663) & (count - 1)

    @ti.func
    def middle(surface: any_value, e: ti.i32):
        """Where the middle of an edge was when the candidates were listed."""
        return vec2(surface.middles[e][0], surface.middles[e][1])

    @ti.func
    def fill_hash(surface: any_value, size: ti.f32):
        """Edges by the cells of their middles: those of bucket k are order[heads[k]:heads[k + 1]]."""
        heads, order = ti.static(surface.heads, surface.order)
        for k in range(heads.shape[0]):
            heads[k] = 0
        for e in range(surface.edges.shape[0]):
            x, y = cell_of(middle(surface, e), size)
            k = bucket(x, y, heads.shape[0] - 1)
            order[e][1] = k
            heads[k] = heads[k] + 1
        total = 0
        for k in range(heads.shape[0]):
            total = total + heads[k]
            heads[k] = total
        for e in range(surface.edges.shape[0]):
            k = order[e][1]
            heads[k] = heads[k] - 1
            order[heads[k]][0] = e

    @ti.func
    def may_touch(surface: any_value, solid: any_value, i: ti.i32, own: ti.i32, e: ti.i32, options: any_value):
        """Whether a vertex of a part minds an edge: not its own ones, nor what is near at rest anyway."""
        part, edge = surface.edge_parts[e], surface.edges[e]
        a, b = surface.points[edge[0]], surface.points[edge[1]]
        allowed = surface.bodies[part] != surface.bodies[own]
        if (not allowed) and options.self_contact == 1 and surface.bodies[own] >= 0 and a != i and b != i:
            allowed = True
            if part == own:
                apart = offset(rest_place(solid, i), rest_place(solid, a), rest_place(solid, b)).norm()
                allowed = apart > 2.0 * ti.max(surface.measures[part][SPACING], options.thickness)
        return allowed

    @ti.func
    def mark(surface: any_value, n: ti.i32):
        """Where a point was when the candidates were listed."""
        return vec2(surface.marks[n][0], surface.marks[n][1])

    @ti.func
    def free(surface: any_value, n: ti.i32):
        """Whether a point is in no other part at rest, nor near one."""
        return surface.first_overlaps[n] == surface.first_overlaps[n + 1]

    @ti.func
    def outside(surface: any_value, n: ti.i32):
        """Whether a point is known to be in front of all parts, so that it need be looked at near their edges only."""
        return surface.marks[n][3] > 0.5

    @ti.func
    def widest(surface: any_value):
        """The mean edge of the coarsest part."""
        width = 0.0
        for part in range(surface.measures.shape[0]):
            width = ti.max(width, surface.measures[part][SPACING])
        return width

    @ti.func
    def reaches(surface: any_value, options: any_value):
        """Within which distance of an edge a point is looked at, besides what may come about meanwhile.

        The first one is for points that may be inside, the second one for those known to be outside.
        """
        coarsest = widest(surface)
        inner = ti.max(options.thickness, _WIDE * coarsest)
        return inner, ti.max(options.thickness + SLACK * coarsest, INSIDE * coarsest)

    @ti.func
    def cell_size(surface: any_value):
        """Side of a cell of the hash: all edges that a point may come near to are in the nine around it."""
        memory = ti.static(surface.memory)
        return 0.5 * memory[LONGEST] + memory[REACH] + memory[FORESEEN]

    @ti.func
    def find_boxes(surface: any_value):
        """Take note of the box around each part, its low corner and its high one; whether all points are outside."""
        boxes = ti.static(surface.boxes)
        for part in range(boxes.shape[0]):
            boxes[part] = vec4(1e6, 1e6, -1e6, -1e6)
        all_outside = True
        for n in range(surface.points.shape[0]):
            p, part = surface.places[n], surface.point_parts[n]
            all_outside = all_outside and outside(surface, n)
            box = boxes[part]
            boxes[part] = vec4(ti.min(box[0], p[0]), ti.min(box[1], p[1]), ti.max(box[2], p[0]), ti.max(box[3], p[1]))
        return all_outside

    @ti.func
    def near_a_box(surface: any_value, options: any_value, n: ti.i32, reach: ti.f32):
        """Whether a point is within reach of the box around a part whose edges it may come near to."""
        p, own, found = surface.places[n], surface.point_parts[n], options.self_contact == 1
        for part in range(surface.boxes.shape[0]):
            if surface.bodies[part] != surface.bodies[own]:
                box = surface.boxes[part]
                if box[0] - reach < p[0] < box[2] + reach and box[1] - reach < p[1] < box[3] + reach:
                    found = True
        return found

    @ti.func
    def begin_listing(surface: any_value, options: any_value):
        """Put the edges into the hash."""
        all_outside = find_boxes(surface)
        longest = 0.0
        for e in range(surface.edges.shape[0]):
            a, b = edge_ends(surface, e)
            length, between = (b - a).norm(), 0.5 * (a + b)
            longest = ti.max(longest, length)
            body = ti.cast(surface.bodies[surface.edge_parts[e]], ti.f32)
            surface.middles[e] = vec4(between[0], between[1], 0.5 * length, body)
        surface.memory[LONGEST] = longest
        inner, outer = reaches(surface, options)
        surface.memory[REACH] = ti.select(all_outside, outer, inner)
        fill_hash(surface, cell_size(surface))

    @ti.func
    def list_candidates(surface: any_value, solid: any_value, options: any_value):
        """For each point the edges within the reach of a contact and what the list foresees."""
        heads, memory, candidates = ti.static(surface.heads, surface.memory, surface.candidates)
        size, buckets = cell_size(surface), heads.shape[0] - 1
        inner, outer = reaches(surface, options)
        count, room = 0, candidates.shape[0]
        for n in range(surface.points.shape[0]):
            first = count
            i, own, p = surface.points[n], surface.point_parts[n], surface.places[n]
            reach = ti.select(outside(surface, n), outer, inner) + memory[FORESEEN]
            other_than = ti.cast(surface.bodies[own], ti.f32)
            if options.self_contact == 1:
                other_than = -2.0
            x, y = cell_of(p, size)
            for c in range(ti.select(near_a_box(surface, options, n, reach), 6, 0)):
                # Three rows of three cells; what is beyond the last bucket continues at the first.
                k = bucket(x - 1, y + c // 2 - 1, buckets)
                begin, end = k, ti.min(k + 3, buckets)
                if c % 2 == 1:
                    begin, end = 0, ti.max(k + 3 - buckets, 0)
                for s in range(heads[begin], heads[end]):
                    e = surface.order[s][0]
                    if count < room:  # what is listed already stays where there is no room
                        candidates[count] = e
                        far, body = reach + surface.middles[e][2], surface.middles[e][3]
                        near = (p - middle(surface, e)).norm_sqr() < far * far and body != other_than
                        count = count + ti.cast(near, ti.i32)
            nearest_square, kept = 1e6, first
            for c in range(first, count):
                e = candidates[c]
                candidates[kept] = e
                a, b = edge_ends(surface, e)
                square = offset(p, a, b).norm_sqr()
                near = square < reach * reach
                if near and options.self_contact == 1:
                    near = may_touch(surface, solid, i, own, e, options)
                if near:
                    nearest_square = ti.min(nearest_square, square)
                    kept = kept + 1
            count = kept
            surface.candidate_ranges[n] = int2(first, count)
            surface.marks[n] = vec4(p[0], p[1], ti.sqrt(nearest_square), surface.marks[n][3])

    return SimpleNamespace(
        mark=mark,
        widest=widest,
        free=free,
        outside=outside,
        reaches=reaches,
        begin_listing=begin_listing,
        list_candidates=list_candidates,
    )
