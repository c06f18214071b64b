# mypy: ignore-errors
"""How the contact kernel finds vertices near boundary edges of other parts.

Edges go into a spatial hash, from which every boundary vertex lists those around it that it may come near to; the list
is good until the fastest vertices could have come farther than it foresees. Of its edges, the nearest one of each part
is a contact.

A search has a beginning and an end that one thread sees to, and pieces of points between them that several may share.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any

from .contact_surface import (
    CANDIDATES,
    CONTACTS,
    FASTEST,
    FORESEEN,
    GAP,
    GOOD_FOR,
    LIST_LENGTH,
    LONGEST,
    MOVED,
    NEAREST,
    POINTS_AT_ONCE,
    SEARCH,
    SPACING,
    SPEED,
    TIME,
)
from .kernel_functions import SPEED_FLOOR
from .stepping import TICK

__all__ = ["build_contact_search"]

_FORESIGHT = 24.0  # ticks that a list of candidates is good for, if so many do not reach over several edges
_STALE = 0.25  # of a mean edge, that vertices may move until the nearest edges are looked for again
_SLACK = 0.05  # of a mean edge, for speed that is gained meanwhile

_NOTHING, _LOOK, _LIST = 0.0, 1.0, 2.0  # what a search has to do


def build_contact_search(ti: Any, contact: SimpleNamespace) -> SimpleNamespace:
    """The functions of a search, by name, on those that ``build_contact_functions`` made."""
    vec2, vec4, int2 = ti.types.vector(2, ti.f32), ti.types.vector(4, ti.f32), ti.types.vector(2, ti.i32)
    slots_i, slots_f = ti.types.vector(LIST_LENGTH, ti.i32), ti.types.vector(LIST_LENGTH, ti.f32)
    any_value = ti.template()
    rest_place, place, along, offset = contact.rest_place, contact.place, contact.along, contact.offset
    edge_ends, normal_of = contact.edge_ends, contact.normal_of

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

    @ti.func
    def plainly_apart(surface: any_value, options: any_value, n: ti.i32, e: ti.i32, time: ti.f32):
        """Whether a point is so far in front of an edge, and free at rest, that nothing more need be known of them."""
        own, part = surface.point_parts[n], surface.edge_parts[e]
        a, b = edge_ends(surface, e)
        way, along_edge = surface.places[n] - a, b - a
        t, cross = way.dot(along_edge), way[1] * along_edge[0] - way[0] * along_edge[1]
        square = along_edge.norm_sqr()
        reach = options.thickness + (surface.measures[own][SPEED] + surface.measures[part][SPEED]) * ti.max(time, TICK)
        reach = reach + _SLACK * surface.measures[part][SPACING]
        free = surface.first_overlaps[n] == surface.first_overlaps[n + 1]
        return free and t > 0.0 and t < square and cross > 0.0 and cross * cross > reach * reach * square

    @ti.func
    def add_contact(surface: any_value, options: any_value, n: ti.i32, e: ti.i32, time: ti.f32):
        """List point n and edge e as a contact if they may meet in the time ahead."""
        own, part = surface.point_parts[n], surface.edge_parts[e]
        approach, slack = (
            surface.measures[own][SPEED] + surface.measures[part][SPEED],
            _SLACK * surface.measures[part][SPACING],
        )
        p = surface.places[n]
        a, b = edge_ends(surface, e)
        t = along(p, a, b)
        away, normal = offset(p, a, b), normal_of(surface, e)
        outward = normal
        if t <= 0.0:
            outward = normal + normal_of(surface, surface.neighbours[e][0])
        if t >= 1.0:
            outward = normal + normal_of(surface, surface.neighbours[e][1])
        signed = away.norm()
        if away.dot(outward) < 0.0:
            signed = 0.0 - signed
        if ti.abs(signed) > 1e-6 and (t <= 0.0 or t >= 1.0):
            normal = away / signed
        wanted = options.thickness
        for o in range(surface.first_overlaps[n], surface.first_overlaps[n + 1]):
            if surface.overlap_parts[o] == part:
                if signed > options.thickness:
                    surface.overlaps[o] = options.thickness
                wanted = surface.overlaps[o]
        deep = 2.0 * surface.measures[part][SPACING]
        if part == own:
            deep = 0.6 * surface.measures[own][SPACING]
        if signed > 0.0 - deep and wanted > 0.0 - deep:
            if signed - wanted < approach * TICK + slack:
                surface.touching[own] = ti.max(surface.touching[own], 1)
                surface.touching[part] = ti.max(surface.touching[part], 1)
            if signed - wanted < approach * time + slack:
                count = surface.found[n]
                surface.contacts[LIST_LENGTH * n + count] = int2(n, e)
                surface.contact_data[LIST_LENGTH * n + count] = vec4(normal[0], normal[1], t, wanted)
                surface.found[n] = count + 1

    @ti.func
    def look_around(surface: any_value, options: any_value, low: ti.i32, high: ti.i32):
        """List the contacts of a piece's points; returns the square of the distance to the nearest candidate."""
        memory = ti.static(surface.memory)
        time, nearest_square = memory[TIME], 1e6
        ahead = 2.0 * memory[FASTEST] * time
        looked_at, half = ti.max(options.thickness + ahead, widest(surface)), 0.5 * memory[LONGEST] + memory[MOVED]
        nearest_middle = 1e6
        for n in range(low, high):
            surface.found[n] = 0
            span, p = surface.candidate_ranges[n], surface.places[n]
            least = surface.marks[n][2] - (p - mark(surface, n)).norm() - memory[MOVED]
            if span[0] < span[1] and least > looked_at:
                nearest_square = ti.min(nearest_square, least * least)
            elif span[0] < span[1]:
                parts, best, nearest = slots_i(-1), slots_f(0.0), slots_i(-1)
                for c in range(span[0], span[1]):
                    e = surface.candidates[c]
                    part = surface.edge_parts[e]
                    a, b = edge_ends(surface, e)
                    reach = ti.max(options.thickness + ahead, 2.0 * surface.measures[part][SPACING])
                    distance, far = (p - 0.5 * (a + b)).norm_sqr(), reach + half
                    if distance < far * far:
                        distance = offset(p, a, b).norm_sqr()
                        nearest_square = ti.min(nearest_square, distance)
                    else:
                        nearest_middle = ti.min(nearest_middle, distance)
                    if distance < reach * reach:
                        taken = False
                        for j in ti.static(range(LIST_LENGTH)):
                            if (not taken) and (parts[j] == part or parts[j] < 0):
                                taken = True
                                if parts[j] < 0 or distance < best[j]:
                                    parts[j], best[j], nearest[j] = part, distance, e
                for j in ti.static(range(LIST_LENGTH)):
                    if parts[j] >= 0 and not plainly_apart(surface, options, n, nearest[j], time):
                        add_contact(surface, options, n, nearest[j], time)
        from_middle = ti.max(ti.sqrt(nearest_middle) - half, 0.0)
        return ti.min(nearest_square, from_middle * from_middle)

    @ti.func
    def measure_speeds(surface: any_value, state: any_value):
        """Take note of the fastest boundary vertex of each part; returns the speed of the fastest of all."""
        measures = ti.static(surface.measures)
        fastest = 0.0
        for part in range(measures.shape[0]):
            measures[part][SPEED] = 0.0
        own, most = 0, 0.0
        for n in range(surface.points.shape[0]):  # those of a part lie one behind the other
            if surface.point_parts[n] != own:
                measures[own][SPEED] = ti.max(measures[own][SPEED], most)
                own, most = surface.point_parts[n], 0.0
            most = ti.max(most, state.velocity[surface.points[n]].norm_sqr())
        measures[own][SPEED] = ti.max(measures[own][SPEED], most)
        for part in range(measures.shape[0]):
            # What is led faster than that would have it look everywhere.
            measures[part][SPEED] = ti.min(ti.sqrt(measures[part][SPEED]), 2.0 * SPEED_FLOOR)
            fastest = ti.max(fastest, measures[part][SPEED])
        return fastest

    @ti.func
    def begin_search(surface: any_value, solid: any_value, state: any_value, options: any_value, time: ti.f32):
        """Find out what has to be done for the contacts that may come about in the time ahead [s]."""
        memory = ti.static(surface.memory)
        fastest = measure_speeds(surface, state)
        ahead, soon = 2.0 * fastest * time, 2.0 * fastest * TICK
        memory[FASTEST], memory[TIME], memory[SEARCH] = fastest, time, _NOTHING
        if memory[CONTACTS] < 0.0 or memory[GAP] < 2.0 * ahead:
            moved = 0.0  # since the candidates were listed
            for n in range(surface.points.shape[0]):
                p = place(solid, state, surface.points[n])
                surface.places[n] = p
                moved = ti.max(moved, (p - mark(surface, n)).norm_sqr())
            memory[MOVED] = ti.sqrt(moved)
            left = memory[FORESEEN] - 2.0 * memory[MOVED]
            memory[SEARCH] = _LOOK
            if left < ahead or memory[CONTACTS] < 0.0:
                left = ti.max(ahead, ti.min(_FORESIGHT * soon, widest(surface)))
                memory[SEARCH], memory[FORESEEN], memory[MOVED] = _LIST, left, 0.0
                begin_listing(surface, options)
            memory[GAP], memory[NEAREST] = left, 1e6

    @ti.func
    def search(surface: any_value, solid: any_value, options: any_value, piece: ti.i32):
        """Do it for one piece of the points."""
        memory = ti.static(surface.memory)
        if memory[SEARCH] > _NOTHING:
            low = piece * POINTS_AT_ONCE
            high = ti.min(low + POINTS_AT_ONCE, surface.points.shape[0])
            if memory[SEARCH] == _LIST:
                list_candidates(surface, solid, options, low, high)
            ti.atomic_min(memory[NEAREST], look_around(surface, options, low, high))

    @ti.func
    def end_search(surface: any_value, options: any_value):
        """Put the contacts one behind the other, and tell for how long they are good [s]."""
        memory = ti.static(surface.memory)
        if memory[SEARCH] > _NOTHING:
            count = 0
            for n in range(surface.points.shape[0]):
                for j in range(surface.found[n]):
                    surface.contacts[count] = surface.contacts[LIST_LENGTH * n + j]
                    surface.contact_data[count] = surface.contact_data[LIST_LENGTH * n + j]
                    count = count + 1
            memory[CONTACTS] = ti.cast(count, ti.f32)
            gap = ti.sqrt(ti.atomic_min(memory[NEAREST], 1e6)) - ti.max(options.thickness, widest(surface))
            memory[GAP] = ti.min(gap, memory[GAP])
        memory[GAP] = memory[GAP] - 2.0 * memory[FASTEST] * memory[TIME]
        narrowest = 1e6
        for part in range(surface.measures.shape[0]):
            narrowest = ti.min(narrowest, surface.measures[part][SPACING])
        memory[GOOD_FOR] = _STALE * narrowest / ti.max(memory[FASTEST], 1e-6)

    @ti.func
    def pieces(surface: any_value):
        """How many pieces a search has."""
        return (surface.points.shape[0] + POINTS_AT_ONCE - 1) // POINTS_AT_ONCE

    @ti.func
    def find_contacts(surface: any_value, solid: any_value, state: any_value, options: any_value, time: ti.f32):
        """A whole search."""
        begin_search(surface, solid, state, options, time)
        for piece in range(pieces(surface)):
            search(surface, solid, options, piece)
        end_search(surface, options)

    return SimpleNamespace(
        begin_search=begin_search, search=search, end_search=end_search, pieces=pieces, find_contacts=find_contacts
    )
