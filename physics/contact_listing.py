# mypy: ignore-errors
"""How the contact kernel lists, for every boundary vertex, the edges around it that it may come near to for a while.

Edges go into a spatial hash by their middles; vertices that are near no box around another part are not looked up.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any

from .contact_surface import CANDIDATES, FORESEEN, LONGEST, SPACING

__all__ = ["build_contact_listing"]


def build_contact_listing(ti: Any, contact: SimpleNamespace) -> SimpleNamespace:
    """The functions of the listing, by name, on those that ``build_contact_functions`` made."""
    vec2, vec4, any_value = ti.types.vector(2, ti.f32), ti.types.vector(4, ti.f32), ti.template()
    rest_place, offset, edge_ends = contact.rest_place, contact.offset, contact.edge_ends

    @ti.func
    def cell_of(p: vec2, size: ti.f32):
        return ti.cast(ti.floor(p[0] / size), ti.i32), ti.cast(ti.floor(p[1] / size), ti.i32)

    @ti.func
    def bucket(x: ti.i32, y: ti.i32, count: ti.i32):
        return ((x * 73856093) ^ (y * 19349663)) & (count - 1)

    @ti.func
    def middle_bucket(surface: any_value, e: ti.i32, size: ti.f32):
        a, b = edge_ends(surface, e)
        x, y = cell_of(0.5 * (a + b), size)
        return bucket(x, y, surface.heads.shape[0] - 1)

    @ti.func
    def fill_hash(surface: any_value, size: ti.f32):
        """Edges by the cells of their middles: those of bucket k are order[heads[k]:heads[k + 1]]."""
        heads, order = ti.static(surface.heads, surface.order)
        for k in range(heads.shape[0]):
            heads[k] = 0
        for e in range(surface.edges.shape[0]):
            k = middle_bucket(surface, e, size)
            heads[k] = heads[k] + 1
        total = 0
        for k in range(heads.shape[0]):
            total = total + heads[k]
            heads[k] = total
        for e in range(surface.edges.shape[0]):
            k = middle_bucket(surface, e, size)
            heads[k] = heads[k] - 1
            order[heads[k]] = e

    @ti.func
    def may_touch(surface: any_value, solid: any_value, i: ti.i32, own: ti.i32, e: ti.i32, options: any_value):
        """Whether a vertex of a part minds an edge: not its own ones, nor what is near at rest anyway."""
        part, edge = surface.edge_parts[e], surface.edges[e]
        a, b = surface.points[edge[0]], surface.points[edge[1]]
        allowed = surface.bodies[part] != surface.bodies[own]
        if (not allowed) and options.within == 1 and surface.bodies[own] >= 0 and a != i and b != i:
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
    def widest(surface: any_value):
        """Within which distance of an edge a point is looked at, of any part."""
        width = 0.0
        for part in range(surface.measures.shape[0]):
            width = ti.max(width, 2.0 * surface.measures[part][SPACING])
        return width

    @ti.func
    def cell_size(surface: any_value, options: any_value):
        """Side of a cell of the hash: all edges that a point may come near to are in the nine around it."""
        memory = ti.static(surface.memory)
        return 0.5 * memory[LONGEST] + ti.max(options.thickness, widest(surface)) + memory[FORESEEN]

    @ti.func
    def find_boxes(surface: any_value):
        """Take note of the box around each part: its low corner and its high one."""
        boxes = ti.static(surface.boxes)
        for part in range(boxes.shape[0]):
            boxes[part] = vec4(1e6, 1e6, -1e6, -1e6)
        for n in range(surface.points.shape[0]):
            p, part = surface.places[n], surface.point_parts[n]
            box = boxes[part]
            boxes[part] = vec4(ti.min(box[0], p[0]), ti.min(box[1], p[1]), ti.max(box[2], p[0]), ti.max(box[3], p[1]))

    @ti.func
    def near_a_box(surface: any_value, options: any_value, n: ti.i32):
        """Whether a point is near the box around a part whose edges it may come near to."""
        p, own, found = surface.places[n], surface.point_parts[n], options.within == 1
        for part in range(surface.boxes.shape[0]):
            if surface.bodies[part] != surface.bodies[own]:
                reach = ti.max(options.thickness, 2.0 * surface.measures[part][SPACING]) + surface.memory[FORESEEN]
                box = surface.boxes[part]
                if box[0] - reach < p[0] < box[2] + reach and box[1] - reach < p[1] < box[3] + reach:
                    found = True
        return found

    @ti.func
    def begin_listing(surface: any_value, options: any_value):
        """Put the edges into the hash."""
        find_boxes(surface)
        longest = 0.0
        for e in range(surface.edges.shape[0]):
            a, b = edge_ends(surface, e)
            longest = ti.max(longest, (b - a).norm_sqr())
        surface.memory[LONGEST] = ti.sqrt(longest)
        fill_hash(surface, cell_size(surface, options))

    @ti.func
    def list_candidates(surface: any_value, solid: any_value, options: any_value, low: ti.i32, high: ti.i32):
        """For each point of a piece the edges within the reach of a contact and what the list foresees."""
        heads, memory = ti.static(surface.heads, surface.memory)
        size, margin, half = cell_size(surface, options), memory[FORESEEN], 0.5 * memory[LONGEST]
        count, room = CANDIDATES * low, CANDIDATES * high
        for n in range(low, high):
            surface.candidate_ranges[n][0] = count
            i, own = surface.points[n], surface.point_parts[n]
            p, nearest_square = surface.places[n], 1e6
            x, y = cell_of(p, size)
            for c in range(ti.select(near_a_box(surface, options, n), 9, 0)):
                k = bucket(x + c % 3 - 1, y + c // 3 - 1, heads.shape[0] - 1)
                for s in range(heads[k], heads[k + 1]):
                    e = surface.order[s]
                    part = surface.edge_parts[e]
                    if options.within == 1 or surface.bodies[part] != surface.bodies[own]:
                        reach = ti.max(options.thickness, 2.0 * surface.measures[part][SPACING]) + margin
                        a, b = edge_ends(surface, e)
                        far = reach + half
                        if (p - 0.5 * (a + b)).norm_sqr() < far * far and count < room:
                            square = offset(p, a, b).norm_sqr()
                            if square < reach * reach and may_touch(surface, solid, i, own, e, options):
                                nearest_square = ti.min(nearest_square, square)
                                surface.candidates[count] = e
                                count = count + 1
            surface.candidate_ranges[n][1] = count
            surface.marks[n] = vec4(p[0], p[1], ti.sqrt(nearest_square), 0.0)

    return SimpleNamespace(mark=mark, widest=widest, begin_listing=begin_listing, list_candidates=list_candidates)
