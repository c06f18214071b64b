# mypy: ignore-errors
"""Narrow phase of the contact search: of the candidates of a vertex, the nearest edge of each part is a contact."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from ..solver import TICK
from ..solver.kernel_types import any_value, int2, vec4
from .closeness import NEVER
from .functions import edge_ends, edge_parameter, normal_of, offset_from_edge
from .listing import INSIDE_DEPTH, TOLERANCE, known_outside, listed_position, overlaps_nothing, search_radii
from .surface import (
    FAR,
    FASTEST,
    GOT_INSIDE,
    LIST_LENGTH,
    MOVED_SINCE_LISTING,
    MOVED_SINCE_SEARCH,
    SPACING,
    SPEED,
    TIME,
    TOUCHING,
)

__all__ = ["list_contacts"]

# A vertex that is deeper behind an edge than this is left alone: the nearest way out of a thin part may be another.
_DEEPEST = 2.0  # [mean edges]
_DEEPEST_SELF = 0.6  # [mean edges], behind an edge of its own part

_slots_of_parts, _slots_of_distances = ti.types.vector(LIST_LENGTH, ti.i32), ti.types.vector(LIST_LENGTH, ti.f32)


@ti.func
def clearly_apart(surface: any_value, options: any_value, n: ti.i32, e: ti.i32, time: ti.f32):
    """Whether a point is in front of an edge, too far to touch it within a tick, and overlaps nothing at rest."""
    own, part = surface.point_parts[n], surface.edge_parts[e][0]
    a, b = edge_ends(surface, e)
    way, along_edge = surface.positions[n] - a, b - a
    t, cross = way.dot(along_edge), way[1] * along_edge[0] - way[0] * along_edge[1]
    square = along_edge.norm_sqr()
    reach = options.thickness + (surface.measures[own][SPEED] + surface.measures[part][SPEED]) * ti.max(time, TICK)
    reach = reach + TOLERANCE * surface.measures[part][SPACING]
    return (
        overlaps_nothing(surface, n)
        and t > 0.0
        and t < square
        and cross > 0.0
        and cross * cross > reach * reach * square
    )


@ti.func
def add_contact(surface: any_value, options: any_value, n: ti.i32, e: ti.i32, time: ti.f32):
    """List point n and edge e as a contact if they may touch in the time ahead [s].

    Returns the signed distance, negative behind the edge.
    """
    own, part = surface.point_parts[n], surface.edge_parts[e][0]
    approach, slack = (
        surface.measures[own][SPEED] + surface.measures[part][SPEED],
        TOLERANCE * surface.measures[part][SPACING],
    )
    p = surface.positions[n]
    a, b = edge_ends(surface, e)
    t = edge_parameter(p, a, b)
    away, normal = offset_from_edge(p, a, b), normal_of(surface, e)
    outward = normal
    if t <= 0.0:
        outward = normal + normal_of(surface, surface.edges[e][2])
    if t >= 1.0:
        outward = normal + normal_of(surface, surface.edges[e][3])
    signed = away.norm()
    if away.dot(outward) < 0.0:
        signed = 0.0 - signed
    if ti.abs(signed) > 1e-6 and (t <= 0.0 or t >= 1.0):
        normal = away / signed
    wanted = options.thickness
    if part == own:
        wanted = surface.own_sides[n][0]
    for o in range(surface.first_overlaps[n], surface.first_overlaps[n + 1]):
        if ti.cast(surface.overlaps[o][0], ti.i32) == part:
            if signed > options.thickness and surface.overlaps[o][1] > NEVER:
                surface.overlaps[o][1] = options.thickness
            wanted = surface.overlaps[o][1]
    deepest = _DEEPEST * surface.measures[part][SPACING]
    if part == own:
        deepest = _DEEPEST_SELF * surface.measures[own][SPACING]
    if signed > 0.0 - deepest and wanted > 0.0 - deepest:
        if signed - wanted < approach * TICK + slack:
            surface.activity[own][TOUCHING] = 1
            surface.activity[part][TOUCHING] = 1
        if signed - wanted < approach * time + slack:
            count = surface.contact_counts[n]
            surface.contacts[LIST_LENGTH * n + count] = int2(n, e)
            surface.contact_data[LIST_LENGTH * n + count] = vec4(normal[0], normal[1], t, wanted)
            surface.contact_counts[n] = count + 1
    return signed


@ti.func
def nearest_edges(surface: any_value, n: ti.i32, reach: ti.f32):
    """The parts of a point's candidate edges within reach, -1 for none; the nearest edge of each; the square of the
    distance to the nearest candidate of all.
    """
    p, span, nearest_square = surface.positions[n], surface.candidate_ranges[n], FAR
    parts, best, nearest = _slots_of_parts(-1), _slots_of_distances(0.0), _slots_of_parts(-1)
    for c in range(span[0], span[1]):
        e = surface.candidates[c]
        a, b = edge_ends(surface, e)
        distance = offset_from_edge(p, a, b).norm_sqr()
        nearest_square = ti.min(nearest_square, distance)
        if distance < reach * reach:
            part, taken = surface.edge_parts[e][0], False
            for j in ti.static(range(LIST_LENGTH)):
                if (not taken) and (parts[j] == part or parts[j] < 0):
                    taken = True
                    if parts[j] < 0 or distance < best[j]:
                        parts[j], best[j], nearest[j] = part, distance, e
    return parts, nearest, nearest_square


@ti.func
def list_contacts_of(surface: any_value, options: any_value, n: ti.i32, reach: ti.f32):
    """List the contacts of a point; returns the square of the distance to its nearest candidate."""
    parts, nearest, nearest_square = nearest_edges(surface, n, reach)
    near, inside, was_outside = False, False, known_outside(surface, n)
    for j in ti.static(range(LIST_LENGTH)):
        if parts[j] >= 0:
            near = True
            if not clearly_apart(surface, options, n, nearest[j], surface.memory[TIME]):
                signed = add_contact(surface, options, n, nearest[j], surface.memory[TIME])
                if signed < 0.0 - INSIDE_DEPTH * surface.measures[parts[j]][SPACING]:
                    inside = True
    if inside and was_outside:
        surface.listed[n][3] = 0.0
        surface.memory[GOT_INSIDE] = 1.0
    if near and not inside and not was_outside and overlaps_nothing(surface, n):
        surface.listed[n][3] = 1.0
    return nearest_square


@ti.func
def list_contacts(surface: any_value, options: any_value):
    """List the contacts of all points; returns the square of the distance to the nearest candidate."""
    memory = ti.static(surface.memory)
    time, nearest_square = memory[TIME], FAR
    ahead = 2.0 * memory[FASTEST] * time
    inner, outer = search_radii(surface, options)
    inner = ti.max(inner, options.thickness + ahead)
    # The radius of a point that was outside at the last search reaches as far as it has moved since: so an edge that it
    # has crossed meanwhile is still found.
    outer = outer + ti.max(2.0 * memory[FASTEST] * ti.max(time, TICK), 2.0 * memory[MOVED_SINCE_SEARCH])
    for n in range(surface.points.shape[0]):
        surface.contact_counts[n] = 0
        span, moved = surface.candidate_ranges[n], (surface.positions[n] - listed_position(surface, n)).norm()
        reach = ti.select(known_outside(surface, n), outer, inner)
        nearest_possible = surface.listed[n][2] - moved - memory[MOVED_SINCE_LISTING]
        if span[0] < span[1] and nearest_possible > reach:
            nearest_square = ti.min(nearest_square, nearest_possible * nearest_possible)
        elif span[0] < span[1]:
            nearest_square = ti.min(nearest_square, list_contacts_of(surface, options, n, reach))
    return nearest_square
