# mypy: ignore-errors
"""Narrow phase and response of contact: positions of vertices and edges, and how a contact is resolved."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from ..solver import TICK
from ..solver.kernel_types import any_value, vec2
from .surface import CONTACTS, STEPS

__all__ = [
    "edge_ends",
    "edge_parameter",
    "normal_of",
    "offset_from_edge",
    "position",
    "resolve_contacts",
    "rest_position",
    "steps_in",
]

# Part of the thickness that may be penetrated before positions are corrected: a correction of all of it in every step
# sets light vertices ringing. The rest is corrected slowly, by a part in a step (Baumgarte stabilisation).
_YIELDING = 0.5
_RETURN = 0.01
# A part that takes so few steps in a tick may be pushed by a whole thickness at once; stiffer ones, whose elasticity
# turns a push in a short step into speed, by less, with the square of their steps.
_PUSHED_AT_ONCE = 36
_THIN = 1e-3  # [side], in place of the thickness of contacts that are thinner
_LEAST_PUSH = 1e-6  # [side]; what is less makes no difference that could be seen
_LEAST_SPEED = 1e-4  # [side/s]


@ti.func
def rest_position(solid: any_value, i: ti.i32):
    return vec2(solid.vertices[i][0], solid.vertices[i][1])


@ti.func
def position(solid: any_value, state: any_value, i: ti.i32):
    return rest_position(solid, i) + state.displacement[i]


@ti.func
def edge_parameter(p: vec2, a: vec2, b: vec2):
    """Parameter, 0 at a to 1 at b, of the point of an edge that is nearest to p."""
    edge = b - a
    return ti.min(1.0, ti.max(0.0, edge.dot(p - a) / ti.max(edge.norm_sqr(), 1e-20)))


@ti.func
def offset_from_edge(p: vec2, a: vec2, b: vec2):
    """Vector from the nearest point of the edge to p."""
    return p - (a + edge_parameter(p, a, b) * (b - a))


@ti.func
def edge_ends(surface: any_value, e: ti.i32):
    """Ends of an edge at the latest search."""
    ends = surface.edges[e]
    return surface.positions[ends[0]], surface.positions[ends[1]]


@ti.func
def normal_of(surface: any_value, e: ti.i32):
    """Outward unit normal of an edge."""
    a, b = edge_ends(surface, e)
    edge = b - a
    return vec2(0.0 - edge[1], edge[0]) / ti.max(edge.norm(), 1e-12)


@ti.func
def steps_in(interval: ti.i32, intervals: ti.i32, steps: ti.i32):
    """Steps of a part in one interval of a tick, over whose intervals they are spread evenly: 0 or 1."""
    return (interval + 1) * steps // intervals - interval * steps // intervals


@ti.func
def resolve_contact(
    surface: any_value,
    solid: any_value,
    state: any_value,
    options: any_value,
    c: ti.i32,
    steps: ti.i32,
    rate: ti.f32,
):
    """Project positions and velocities along a contact's normal, weighted by the inverse masses.

    ``steps`` are those of the stiffer part in a tick, and ``rate`` is one over the time step of the softer one
    [1/s]. Returns 1 if anything was corrected.
    """
    u, v = ti.static(state.displacement, state.velocity)
    pair, data = surface.contacts[c], surface.contact_data[c]
    edge = surface.edges[pair[1]]
    i, a, b = surface.points[pair[0]], surface.points[edge[0]], surface.points[edge[1]]
    normal, t, wanted = vec2(data[0], data[1]), data[2], data[3]
    gap = normal.dot(position(solid, state, i) - (1.0 - t) * position(solid, state, a) - t * position(solid, state, b))
    push = ti.max(wanted - _YIELDING * options.thickness - gap, 0.0)
    push = push + _RETURN * ti.max(wanted - gap - push, 0.0)
    stiffness = ti.max(ti.cast(steps, ti.f32) / _PUSHED_AT_ONCE, 1.0)
    push = ti.min(push, ti.max(options.thickness, _THIN) / (stiffness * stiffness))
    relative = v[i] - (1.0 - t) * v[a] - t * v[b]
    approach = relative.dot(normal)
    # While a gap is left, the approach may close it in the softer one's step, but not more.
    missing = 0.0 - approach - ti.max(gap - wanted, 0.0) * rate
    wi, wa, wb = solid.vertices[i][2], (1.0 - t) * solid.vertices[a][2], t * solid.vertices[b][2]
    weight, done = wi + (1.0 - t) * wa + t * wb, 0
    if weight > 0.0 and (push > _LEAST_PUSH or missing > _LEAST_SPEED):
        done = 1
        share = 1.0 / weight
        shift = share * push * normal
        u[i] = u[i] + wi * shift
        u[a] = u[a] - wa * shift
        u[b] = u[b] - wb * shift
        if missing > _LEAST_SPEED:
            slide = relative - approach * normal
            speed = slide.norm() + 1e-20
            impulse = share * (missing * normal - ti.min(options.friction * missing / speed, 1.0) * slide)
            v[i] = v[i] + wi * impulse
            v[a] = v[a] - wa * impulse
            v[b] = v[b] - wb * impulse
    return done


@ti.func
def resolve_contacts(
    surface: any_value,
    solid: any_value,
    state: any_value,
    options: any_value,
    interval: ti.i32,
    intervals: ti.i32,
    passes: ti.i32,
):
    """Resolve the contacts of those pairs of parts of which the stiffer one has just taken a step.

    The softer one moves later, at the end of its longer step, until which the gap has to last. A pass that
    corrects nothing is the last one.
    """
    activity = ti.static(surface.activity)
    count, left = ti.cast(surface.memory[CONTACTS], ti.i32), passes
    while left > 0:
        done = 0
        for c in range(count):
            pair = surface.contacts[c]
            own, part = surface.point_parts[pair[0]], surface.edge_parts[pair[1]][0]
            one, other = activity[own][STEPS], activity[part][STEPS]
            more, fewer = ti.max(one, other), ti.min(one, other)
            if fewer == 0:  # a collider
                fewer = more
            if more >= intervals or steps_in(interval, intervals, more) > 0:
                done = done | resolve_contact(surface, solid, state, options, c, more, fewer / TICK)
        left = ti.select(done > 0, left - 1, 0)
