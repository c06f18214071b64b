# mypy: ignore-errors
"""How the contact kernel finds vertices near boundary edges of other parts.

Every vertex has a list of edges that it may come near to, which is good until the fastest vertices could have come
farther than it foresees. Of these edges, the nearest one of each part is a contact.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any

from ..solver import SPEED_FLOOR, TICK
from .listing import INSIDE, SLACK, build_contact_listing
from .surface import (
    CONTACTS,
    ENTERED,
    FASTEST,
    FORESEEN,
    GAP,
    GOOD_FOR,
    LIST_LENGTH,
    MOVED,
    NEAREST,
    SEARCH,
    SPACING,
    SPEED,
    TIME,
    TOUCHING,
    WALKED,
)

__all__ = ["build_contact_search"]

_FORESIGHT = 24.0  # ticks that a list of candidates is good for, if so many do not reach over several edges
_FARTHEST = 3.0  # mean edges that it is foreseen to need at most
_STALE = 0.25  # of a mean edge, that vertices may move until the nearest edges are looked for again

_NOTHING, _LOOK, _LIST = 0.0, 1.0, 2.0  # what a search has to do


def build_contact_search(ti: Any, contact: SimpleNamespace) -> Any:
    """The function that searches, made of those that ``build_contact_functions`` made."""
    vec4, int2 = ti.types.vector(4, ti.f32), ti.types.vector(2, ti.i32)
    slots_i, slots_f = ti.types.vector(LIST_LENGTH, ti.i32), ti.types.vector(LIST_LENGTH, ti.f32)
    any_value = ti.template()
    place, along, offset = contact.place, contact.along, contact.offset
    edge_ends, normal_of = contact.edge_ends, contact.normal_of
    listing = build_contact_listing(ti, contact)
    mark, free, outside = listing.mark, listing.free, listing.outside
    widest, reaches = listing.widest, listing.reaches
    begin_listing, list_candidates = listing.begin_listing, listing.list_candidates

    @ti.func
    def plainly_apart(surface: any_value, options: any_value, n: ti.i32, e: ti.i32, time: ti.f32):
        """Whether a point is so far in front of an edge, and free at rest, that nothing more need be known of them."""
        own, part = surface.point_parts[n], surface.edge_parts[e]
        a, b = edge_ends(surface, e)
        way, along_edge = surface.places[n] - a, b - a
        t, cross = way.dot(along_edge), way[1] * along_edge[0] - way[0] * along_edge[1]
        square = along_edge.norm_sqr()
        reach = options.thickness + (surface.measures[own][SPEED] + surface.measures[part][SPEED]) * ti.max(time, TICK)
        reach = reach + SLACK * surface.measures[part][SPACING]
        return free(surface, n) and t > 0.0 and t < square and cross > 0.0 and cross * cross > reach * reach * square

    @ti.func
    def add_contact(surface: any_value, options: any_value, n: ti.i32, e: ti.i32, time: ti.f32):
        """List point n and edge e as a contact if they may meet in the time ahead; the distance, negative behind it."""
        own, part = surface.point_parts[n], surface.edge_parts[e]
        approach, slack = (
            surface.measures[own][SPEED] + surface.measures[part][SPEED],
            SLACK * surface.measures[part][SPACING],
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
                surface.activity[own][TOUCHING] = 1
                surface.activity[part][TOUCHING] = 1
            if signed - wanted < approach * time + slack:
                count = surface.found[n]
                surface.contacts[LIST_LENGTH * n + count] = int2(n, e)
                surface.contact_data[LIST_LENGTH * n + count] = vec4(normal[0], normal[1], t, wanted)
                surface.found[n] = count + 1
        return signed

    @ti.func
    def look_around(surface: any_value, options: any_value):
        """List the contacts of all points; returns the square of the distance to the nearest candidate."""
        memory = ti.static(surface.memory)
        time, nearest_square = memory[TIME], 1e6
        ahead = 2.0 * memory[FASTEST] * time
        inner, outer = reaches(surface, options)
        inner = ti.max(inner, options.thickness + ahead)
        # Found is what was in front of an edge when last looked at, wherever it is now, and what may get near soon.
        outer = outer + ti.max(2.0 * memory[FASTEST] * ti.max(time, TICK), 2.0 * memory[WALKED])
        for n in range(surface.points.shape[0]):
            surface.found[n] = 0
            span, p, in_front = surface.candidate_ranges[n], surface.places[n], outside(surface, n)
            reach = ti.select(in_front, outer, inner)
            least = surface.marks[n][2] - (p - mark(surface, n)).norm() - memory[MOVED]
            if span[0] < span[1] and least > reach:
                nearest_square = ti.min(nearest_square, least * least)
            elif span[0] < span[1]:
                parts, best, nearest = slots_i(-1), slots_f(0.0), slots_i(-1)
                for c in range(span[0], span[1]):
                    e = surface.candidates[c]
                    a, b = edge_ends(surface, e)
                    distance = offset(p, a, b).norm_sqr()
                    nearest_square = ti.min(nearest_square, distance)
                    if distance < reach * reach:
                        part, taken = surface.edge_parts[e], False
                        for j in ti.static(range(LIST_LENGTH)):
                            if (not taken) and (parts[j] == part or parts[j] < 0):
                                taken = True
                                if parts[j] < 0 or distance < best[j]:
                                    parts[j], best[j], nearest[j] = part, distance, e
                near, within = False, False
                for j in ti.static(range(LIST_LENGTH)):
                    if parts[j] >= 0:
                        near = True
                        if not plainly_apart(surface, options, n, nearest[j], time):
                            signed = add_contact(surface, options, n, nearest[j], time)
                            if signed < 0.0 - INSIDE * surface.measures[parts[j]][SPACING]:
                                within = True
                if within and in_front:
                    surface.marks[n][3] = 0.0
                    memory[ENTERED] = 1.0
                if near and not within and not in_front and free(surface, n):
                    surface.marks[n][3] = 1.0
        return nearest_square

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
            moved, walked = 0.0, 0.0  # since the candidates were listed, and since they were last looked at
            for n in range(surface.points.shape[0]):
                p = place(solid, state, surface.points[n])
                walked = ti.max(walked, (p - surface.places[n]).norm_sqr())
                surface.places[n] = p
                moved = ti.max(moved, (p - mark(surface, n)).norm_sqr())
            memory[MOVED], memory[WALKED] = ti.sqrt(moved), ti.select(memory[CONTACTS] < 0.0, 0.0, ti.sqrt(walked))
            least = ti.max(ti.max(ahead, soon), 2.0 * memory[WALKED])
            left = memory[FORESEEN] - 2.0 * memory[MOVED]
            memory[SEARCH] = _LOOK
            # At the end of a tick threads share what has to be done, so that it is done in time.
            due = ti.select(time < TICK, least, 2.0 * least)
            if left < due or memory[CONTACTS] < 0.0:
                left = ti.max(least, ti.min(_FORESIGHT * soon, _FARTHEST * widest(surface)))
                memory[SEARCH], memory[FORESEEN], memory[MOVED] = _LIST, left, 0.0
                begin_listing(surface, options)
            memory[GAP] = left

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
            inner, _ = reaches(surface, options)
            gap = ti.sqrt(memory[NEAREST]) - inner
            memory[GAP] = ti.min(gap, memory[GAP])
            if memory[ENTERED] > 0.0:
                memory[FORESEEN], memory[ENTERED] = 0.0, 0.0  # which lists candidates anew, farther around it
        memory[GAP] = memory[GAP] - 2.0 * memory[FASTEST] * memory[TIME]
        narrowest = 1e6
        for part in range(surface.measures.shape[0]):
            narrowest = ti.min(narrowest, surface.measures[part][SPACING])
        memory[GOOD_FOR] = _STALE * narrowest / ti.max(memory[FASTEST], 1e-6)

    @ti.func
    def find_contacts(surface: any_value, solid: any_value, state: any_value, options: any_value, time: ti.f32):
        """List the contacts that may come about in the time ahead [s]."""
        memory = ti.static(surface.memory)
        begin_search(surface, solid, state, options, time)
        if memory[SEARCH] == _LIST:
            list_candidates(surface, solid, options)
        if memory[SEARCH] > _NOTHING:
            memory[NEAREST] = look_around(surface, options)
        end_search(surface, options)

    return find_contacts
