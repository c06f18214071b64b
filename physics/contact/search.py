# mypy: ignore-errors
"""How the contact kernel finds vertices near boundary edges of other parts.

Broad phase: every vertex has a list of candidate edges, those within a margin around it. The list is valid until the
fastest vertices could have moved through the margin. Narrow phase: of the candidates, the nearest edge of each part is
a contact.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from ..solver import SPEED_FLOOR, TICK
from ..solver.kernel_types import any_value
from .functions import position
from .listing import build_hash, coarsest_spacing, list_candidates, listed_position, search_radii
from .narrow_phase import list_contacts
from .surface import (
    CONTACTS,
    FAR,
    FASTEST,
    GAP,
    GOT_INSIDE,
    LIST_LENGTH,
    MARGIN,
    MOVED_SINCE_LISTING,
    MOVED_SINCE_SEARCH,
    NEAREST_SQUARE,
    SEARCH,
    SPACING,
    SPEED,
    TIME,
    VALID_FOR,
)

__all__ = ["find_contacts"]

# A wider margin has more candidates looked through, a narrower one has them listed more often.
_MARGIN_TICKS = 24.0  # [ticks] for which the margin lasts at the present speed
_LARGEST_MARGIN = 3.0  # [mean edges]
_VALID_DISTANCE = 0.25  # [mean edges] that vertices may move until contacts are searched for again

_NOTHING, _CONTACTS_ONLY, _CANDIDATES_TOO = 0.0, 1.0, 2.0  # what a search has to do: values of SEARCH


@ti.func
def measure_speeds(surface: any_value, state: any_value):
    """Find the speed of the fastest boundary vertex of each part; returns the highest."""
    measures = ti.static(surface.measures)
    fastest = 0.0
    for part in range(measures.shape[0]):
        measures[part][SPEED] = 0.0
    own, most = 0, 0.0
    for n in range(surface.points.shape[0]):  # points are ordered by part
        if surface.point_parts[n] != own:
            measures[own][SPEED] = ti.max(measures[own][SPEED], most)
            own, most = surface.point_parts[n], 0.0
        most = ti.max(most, state.velocity[surface.points[n]].norm_sqr())
    measures[own][SPEED] = ti.max(measures[own][SPEED], most)
    for part in range(measures.shape[0]):
        # Limited, since a handle that jumps would make every edge a candidate.
        measures[part][SPEED] = ti.min(ti.sqrt(measures[part][SPEED]), 2.0 * SPEED_FLOOR)
        fastest = ti.max(fastest, measures[part][SPEED])
    return fastest


@ti.func
def begin_search(surface: any_value, solid: any_value, state: any_value, options: any_value, time: ti.f32):
    """Decide what to search for in the time ahead [s]: nothing, contacts among candidates, or these too."""
    memory = ti.static(surface.memory)
    fastest = measure_speeds(surface, state)
    ahead, soon = 2.0 * fastest * time, 2.0 * fastest * TICK
    memory[FASTEST], memory[TIME], memory[SEARCH] = fastest, time, _NOTHING
    if memory[CONTACTS] < 0.0 or memory[GAP] < 2.0 * ahead:
        since_listing, since_search = 0.0, 0.0  # squares of the farthest way of a point
        for n in range(surface.points.shape[0]):
            p = position(solid, state, surface.points[n])
            since_search = ti.max(since_search, (p - surface.positions[n]).norm_sqr())
            surface.positions[n] = p
            since_listing = ti.max(since_listing, (p - listed_position(surface, n)).norm_sqr())
        memory[MOVED_SINCE_LISTING], memory[MOVED_SINCE_SEARCH] = (
            ti.sqrt(since_listing),
            ti.select(memory[CONTACTS] < 0.0, 0.0, ti.sqrt(since_search)),
        )
        least = ti.max(ti.max(ahead, soon), 2.0 * memory[MOVED_SINCE_SEARCH])
        left = memory[MARGIN] - 2.0 * memory[MOVED_SINCE_LISTING]
        memory[SEARCH] = _CONTACTS_ONLY
        # Twice the need at the end of a tick, so that the lists seldom run out within the next one.
        due = ti.select(time < TICK, least, 2.0 * least)
        if left < due or memory[CONTACTS] < 0.0:
            left = ti.max(least, ti.min(_MARGIN_TICKS * soon, _LARGEST_MARGIN * coarsest_spacing(surface)))
            memory[SEARCH], memory[MARGIN], memory[MOVED_SINCE_LISTING] = _CANDIDATES_TOO, left, 0.0
            build_hash(surface, options)
        memory[GAP] = left


@ti.func
def end_search(surface: any_value, options: any_value):
    """Move the contacts together in memory, and estimate for how long the list is valid [s]."""
    memory = ti.static(surface.memory)
    if memory[SEARCH] > _NOTHING:
        count = 0
        for n in range(surface.points.shape[0]):
            for j in range(surface.contact_counts[n]):
                surface.contacts[count] = surface.contacts[LIST_LENGTH * n + j]
                surface.contact_data[count] = surface.contact_data[LIST_LENGTH * n + j]
                count = count + 1
        memory[CONTACTS] = ti.cast(count, ti.f32)
        inner, _ = search_radii(surface, options)
        gap = ti.sqrt(memory[NEAREST_SQUARE]) - inner
        memory[GAP] = ti.min(gap, memory[GAP])
        if memory[GOT_INSIDE] > 0.0:
            memory[MARGIN], memory[GOT_INSIDE] = (
                0.0,
                0.0,
            )  # so that the next search lists candidates within the wider radius
    memory[GAP] = memory[GAP] - 2.0 * memory[FASTEST] * memory[TIME]
    finest = FAR
    for part in range(surface.measures.shape[0]):
        finest = ti.min(finest, surface.measures[part][SPACING])
    memory[VALID_FOR] = _VALID_DISTANCE * finest / ti.max(memory[FASTEST], 1e-6)


@ti.func
def find_contacts(surface: any_value, solid: any_value, state: any_value, options: any_value, time: ti.f32):
    """List the pairs of a vertex and an edge that may touch in the time ahead [s]."""
    memory = ti.static(surface.memory)
    begin_search(surface, solid, state, options, time)
    if memory[SEARCH] == _CANDIDATES_TOO:
        list_candidates(surface, options)
    if memory[SEARCH] > _NOTHING:
        memory[NEAREST_SQUARE] = list_contacts(surface, options)
    end_search(surface, options)
