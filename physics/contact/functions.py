# mypy: ignore-errors
"""What the contact kernel is made of: where vertices and edges are, and how those too near are put apart."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any

from ..solver import TICK
from .surface import CONTACTS, STEPS

__all__ = ["build_contact_functions"]

_YIELDING = 0.5  # part of the thickness that gives way at first, so that pushes do not set light vertices ringing
_RETURN = 0.01  # part of it that comes back in a step
# A part that takes so few steps in a tick may be pushed by a whole thickness at once; stiffer ones, whose elasticity
# turns a push in a short step into speed, by less, with the square of their steps.
_PUSHED_AT_ONCE = 36
_THIN = 1e-3  # [side], of contacts that are thinner
_LEAST_PUSH = 1e-6  # [side]; what is less makes no difference that could be seen
_LEAST_SPEED = 1e-4  # [side/s]


def build_contact_functions(ti: Any) -> SimpleNamespace:
    """The functions that the contact kernel is made of, by name."""
    vec2, any_value = ti.types.vector(2, ti.f32), ti.template()

    @ti.func
    def rest_place(solid: any_value, i: ti.i32):
        return vec2(solid.vertices[i][0], solid.vertices[i][1])

    @ti.func
    def place(solid: any_value, state: any_value, i: ti.i32):
        return rest_place(solid, i) + state.displacement[i]

    @ti.func
    def along(p: vec2, a: vec2, b: vec2):
        """Where on the edge from a to b (0 to 1) the point nearest to p lies."""
        edge = b - a
        return ti.min(1.0, ti.max(0.0, edge.dot(p - a) / ti.max(edge.norm_sqr(), 1e-20)))

    @ti.func
    def offset(p: vec2, a: vec2, b: vec2):
        """From the nearest point of the edge to p."""
        return p - (a + along(p, a, b) * (b - a))

    @ti.func
    def edge_ends(surface: any_value, e: ti.i32):
        """Where the ends of an edge were when places were last noted."""
        ends = surface.edges[e]
        return surface.places[ends[0]], surface.places[ends[1]]

    @ti.func
    def normal_of(surface: any_value, e: ti.i32):
        """Unit normal of an edge, which points away from its part."""
        a, b = edge_ends(surface, e)
        edge = b - a
        return vec2(0.0 - edge[1], edge[0]) / ti.max(edge.norm(), 1e-12)

    @ti.func
    def steps_in(interval: ti.i32, intervals: ti.i32, steps: ti.i32):
        """How many of its steps of a tick a part takes in one of so many intervals: they are spread evenly."""
        return (interval + 1) * steps // intervals - interval * steps // intervals

    @ti.func
    def put_contact_apart(
        surface: any_value,
        solid: any_value,
        state: any_value,
        options: any_value,
        c: ti.i32,
        steps: ti.i32,
        rate: ti.f32,
    ):
        """Project positions and velocities along a contact's normal, weighted by the inverse masses.

        ``steps`` are those that the stiffer one takes in a tick, and ``rate`` is one over the time in which the two may
        come together [1/s]. Returns 1 if anything had to be done.
        """
        u, v = ti.static(state.displacement, state.velocity)
        pair, data = surface.contacts[c], surface.contact_data[c]
        edge = surface.edges[pair[1]]
        i, a, b = surface.points[pair[0]], surface.points[edge[0]], surface.points[edge[1]]
        normal, t, wanted = vec2(data[0], data[1]), data[2], data[3]
        gap = normal.dot(place(solid, state, i) - (1.0 - t) * place(solid, state, a) - t * place(solid, state, b))
        push = ti.max(wanted - _YIELDING * options.thickness - gap, 0.0)
        push = push + _RETURN * ti.max(wanted - gap - push, 0.0)
        stiffness = ti.max(ti.cast(steps, ti.f32) / _PUSHED_AT_ONCE, 1.0)
        push = ti.min(push, ti.max(options.thickness, _THIN) / (stiffness * stiffness))
        relative = v[i] - (1.0 - t) * v[a] - t * v[b]
        approach = relative.dot(normal)
        # What is still apart may come as near as it wants to be, but no nearer.
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
    def put_apart(
        surface: any_value,
        solid: any_value,
        state: any_value,
        options: any_value,
        interval: ti.i32,
        intervals: ti.i32,
        passes: ti.i32,
    ):
        """Put apart the pairs of parts of which the stiffer one has just taken a step.

        The other may move only at the end of its longer step, for which nothing may come too near. After a pass in
        which nothing had to be done, none would find anything.
        """
        activity = ti.static(surface.activity)
        count, left = ti.cast(surface.memory[CONTACTS], ti.i32), passes
        while left > 0:
            done = 0
            for c in range(count):
                pair = surface.contacts[c]
                own, part = surface.point_parts[pair[0]], surface.edge_parts[pair[1]]
                one, other = activity[own][STEPS], activity[part][STEPS]
                more, fewer = ti.max(one, other), ti.min(one, other)
                if fewer == 0:  # a collider
                    fewer = more
                if more >= intervals or steps_in(interval, intervals, more) > 0:
                    done = done | put_contact_apart(surface, solid, state, options, c, more, fewer / TICK)
            left = ti.select(done > 0, left - 1, 0)

    return SimpleNamespace(
        rest_place=rest_place,
        place=place,
        along=along,
        offset=offset,
        edge_ends=edge_ends,
        normal_of=normal_of,
        steps_in=steps_in,
        put_apart=put_apart,
    )
