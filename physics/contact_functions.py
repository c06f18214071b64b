# mypy: ignore-errors
"""What the contact kernel is made of: finding vertices near boundary edges of other parts, and putting them apart.

Edges go into a spatial hash, from which every boundary vertex lists those around it that it may come near to; the list
is good until the fastest vertices could have come farther than it foresees. Of its edges, the nearest one of each part
is a contact.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any, NamedTuple

from .contact_surface import LIST_LENGTH
from .kernel_functions import SPEED_FLOOR
from .stepping import TICK

__all__ = ["ContactOptions", "build_contact_functions"]

_YIELDING = 0.5  # part of the thickness that gives way at first, so that pushes do not set light vertices ringing
_RETURN = 0.01  # part of it that comes back in a step
_FORESIGHT = 24.0  # ticks that a list of candidates is good for, if so many do not reach over several edges
_STALE = 0.25  # of a mean edge, that vertices may move until the nearest edges are looked for again
_SLACK = 0.05  # of a mean edge, for speed that is gained meanwhile


class ContactOptions(NamedTuple):
    """Values of ``collision.Contact`` in the kernel's units: the thickness in sides."""

    friction: Any
    thickness: Any
    within: Any


def build_contact_functions(ti: Any) -> SimpleNamespace:
    """The functions that the contact kernel is made of, by name."""
    vec2, vec4, int2 = ti.types.vector(2, ti.f32), ti.types.vector(4, ti.f32), ti.types.vector(2, ti.i32)
    slots_i, slots_f = ti.types.vector(LIST_LENGTH, ti.i32), ti.types.vector(LIST_LENGTH, ti.f32)
    any_value = ti.template()

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
        ends = surface.edge_points[e]
        return surface.places[ends[0]], surface.places[ends[1]]

    @ti.func
    def normal_of(surface: any_value, e: ti.i32):
        """Unit normal of an edge, which points away from its part."""
        a, b = edge_ends(surface, e)
        edge = b - a
        return vec2(0.0 - edge[1], edge[0]) / ti.max(edge.norm(), 1e-12)

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
        allowed = surface.bodies[part] != surface.bodies[own]
        if (not allowed) and options.within == 1 and surface.bodies[own] >= 0 and edge[0] != i and edge[1] != i:
            allowed = True
            if part == own:
                apart = offset(rest_place(solid, i), rest_place(solid, edge[0]), rest_place(solid, edge[1])).norm()
                allowed = apart > 2.0 * ti.max(surface.spacing[part], options.thickness)
        return allowed

    @ti.func
    def list_candidates(surface: any_value, solid: any_value, options: any_value, margin: ti.f32):
        """For each point the edges within the reach of a contact and a margin."""
        heads = ti.static(surface.heads)
        longest, deepest = 0.0, 0.0
        for e in range(surface.edges.shape[0]):
            a, b = edge_ends(surface, e)
            longest = ti.max(longest, (b - a).norm_sqr())
        longest = ti.sqrt(longest)
        for part in range(surface.spacing.shape[0]):
            deepest = ti.max(deepest, surface.spacing[part])
        size = 0.5 * longest + ti.max(options.thickness, 2.0 * deepest) + margin
        fill_hash(surface, size)
        count = 0
        for n in range(surface.points.shape[0]):
            surface.first_candidates[n] = count
            i, own = surface.points[n], surface.point_parts[n]
            p = surface.places[n]
            x, y = cell_of(p, size)
            for c in range(9):
                k = bucket(x + c % 3 - 1, y + c // 3 - 1, heads.shape[0] - 1)
                for s in range(heads[k], heads[k + 1]):
                    e = surface.order[s]
                    part = surface.edge_parts[e]
                    if options.within == 1 or surface.bodies[part] != surface.bodies[own]:
                        reach = ti.max(options.thickness, 2.0 * surface.spacing[part]) + margin
                        a, b = edge_ends(surface, e)
                        far = reach + 0.5 * longest
                        if (p - 0.5 * (a + b)).norm_sqr() < far * far and count < surface.candidates.shape[0]:
                            near = offset(p, a, b).norm_sqr() < reach * reach
                            if near and may_touch(surface, solid, i, own, e, options):
                                surface.candidates[count] = e
                                count = count + 1
        surface.first_candidates[surface.points.shape[0]] = count

    @ti.func
    def plainly_apart(surface: any_value, options: any_value, n: ti.i32, e: ti.i32, time: ti.f32):
        """Whether a point is so far in front of an edge, and free at rest, that nothing more need be known of them."""
        own, part = surface.point_parts[n], surface.edge_parts[e]
        a, b = edge_ends(surface, e)
        way, along_edge = surface.places[n] - a, b - a
        t, cross = way.dot(along_edge), way[1] * along_edge[0] - way[0] * along_edge[1]
        square = along_edge.norm_sqr()
        reach = options.thickness + (surface.speeds[own] + surface.speeds[part]) * ti.max(time, TICK)
        reach = reach + _SLACK * surface.spacing[part]
        free = surface.first_overlaps[n] == surface.first_overlaps[n + 1]
        return free and t > 0.0 and t < square and cross > 0.0 and cross * cross > reach * reach * square

    @ti.func
    def add_contact(surface: any_value, options: any_value, n: ti.i32, e: ti.i32, time: ti.f32):
        """List point n and edge e as a contact if they may meet in the time ahead."""
        own, part = surface.point_parts[n], surface.edge_parts[e]
        approach, slack = surface.speeds[own] + surface.speeds[part], _SLACK * surface.spacing[part]
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
        deep = 2.0 * surface.spacing[part]
        if part == own:
            deep = 0.6 * surface.spacing[own]
        if signed > 0.0 - deep and wanted > 0.0 - deep:
            if signed - wanted < approach * TICK + slack:
                surface.touching[own] = ti.max(surface.touching[own], 1)
                surface.touching[part] = ti.max(surface.touching[part], 1)
            count = ti.cast(surface.memory[1], ti.i32)
            if signed - wanted < approach * time + slack and count < surface.contacts.shape[0]:
                surface.contacts[count] = int2(n, e)
                surface.contact_data[count] = vec4(normal[0], normal[1], t, wanted)
                surface.memory[1] = ti.cast(count + 1, ti.f32)

    @ti.func
    def look_around(surface: any_value, solid: any_value, options: any_value, fastest: ti.f32, time: ti.f32):
        """List the contacts among the candidates, or find how far all is from any."""
        ahead, soon = 2.0 * fastest * time, 2.0 * fastest * TICK
        width, nearest_square = 0.0, 1e6
        for part in range(surface.spacing.shape[0]):
            width = ti.max(width, 2.0 * surface.spacing[part])
        moved = 0.0  # since the candidates were listed
        for n in range(surface.points.shape[0]):
            moved = ti.max(moved, (surface.places[n] - surface.marks[n]).norm_sqr())
        if surface.memory[0] < 2.0 * ti.sqrt(moved) + ahead or surface.memory[1] < 0.0:
            margin = ti.max(ahead, ti.min(_FORESIGHT * soon, width))
            list_candidates(surface, solid, options, margin)
            surface.memory[0] = margin
            for n in range(surface.points.shape[0]):
                surface.marks[n] = surface.places[n]
        surface.memory[1] = 0.0
        for n in range(surface.points.shape[0]):
            if surface.first_candidates[n] < surface.first_candidates[n + 1]:
                p = surface.places[n]
                parts, best, nearest = slots_i(-1), slots_f(0.0), slots_i(-1)
                for c in range(surface.first_candidates[n], surface.first_candidates[n + 1]):
                    e = surface.candidates[c]
                    part = surface.edge_parts[e]
                    a, b = edge_ends(surface, e)
                    distance = offset(p, a, b).norm_sqr()
                    nearest_square = ti.min(nearest_square, distance)
                    reach = ti.max(options.thickness + ahead, 2.0 * surface.spacing[part])
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
        gap = ti.sqrt(nearest_square) - ti.max(options.thickness, width)
        surface.memory[2] = ti.min(gap, surface.memory[0] - 2.0 * ti.sqrt(moved))

    @ti.func
    def measure_speeds(surface: any_value, state: any_value):
        """Take note of the fastest boundary vertex of each part; returns the speed of the fastest of all."""
        speeds = ti.static(surface.speeds)
        fastest = 0.0
        for part in range(speeds.shape[0]):
            speeds[part] = 0.0
        own, most = 0, 0.0
        for n in range(surface.points.shape[0]):  # those of a part lie one behind the other
            if surface.point_parts[n] != own:
                speeds[own] = ti.max(speeds[own], most)
                own, most = surface.point_parts[n], 0.0
            most = ti.max(most, state.velocity[surface.points[n]].norm_sqr())
        speeds[own] = ti.max(speeds[own], most)
        for part in range(speeds.shape[0]):
            # What is led faster than that would have it look everywhere.
            speeds[part] = ti.min(ti.sqrt(speeds[part]), 2.0 * SPEED_FLOOR)
            fastest = ti.max(fastest, speeds[part])
        return fastest

    @ti.func
    def find_contacts(surface: any_value, solid: any_value, state: any_value, options: any_value, time: ti.f32):
        """List the contacts that may come about in the time ahead, and mark the parts that may touch in a tick."""
        fastest = measure_speeds(surface, state)
        ahead = 2.0 * fastest * time
        if surface.memory[1] < 0.0 or surface.memory[2] < 2.0 * ahead:
            for n in range(surface.points.shape[0]):
                surface.places[n] = place(solid, state, surface.points[n])
            look_around(surface, solid, options, fastest, time)
        surface.memory[2] = surface.memory[2] - ahead
        narrowest = 1e6
        for part in range(surface.spacing.shape[0]):
            narrowest = ti.min(narrowest, surface.spacing[part])
        return _STALE * narrowest / ti.max(fastest, 1e-6)

    @ti.func
    def steps_in(interval: ti.i32, intervals: ti.i32, steps: ti.i32):
        """How many of its steps of a tick a part takes in one of so many intervals: they are spread evenly."""
        return (interval + 1) * steps // intervals - interval * steps // intervals

    @ti.func
    def put_contact_apart(
        surface: any_value, solid: any_value, state: any_value, options: any_value, c: ti.i32, rate: ti.f32
    ):
        """Project positions and velocities along a contact's normal, weighted by the inverse masses.

        ``rate`` is one over the time in which the two may come together [1/s].
        """
        u, v = ti.static(state.displacement, state.velocity)
        pair, data = surface.contacts[c], surface.contact_data[c]
        i, a, b = surface.points[pair[0]], surface.edges[pair[1]][0], surface.edges[pair[1]][1]
        normal, t, wanted = vec2(data[0], data[1]), data[2], data[3]
        gap = normal.dot(place(solid, state, i) - (1.0 - t) * place(solid, state, a) - t * place(solid, state, b))
        push = ti.max(wanted - _YIELDING * options.thickness - gap, 0.0)
        push = push + _RETURN * ti.max(wanted - gap - push, 0.0)
        relative = v[i] - (1.0 - t) * v[a] - t * v[b]
        approach = relative.dot(normal)
        # What is still apart may come as near as it wants to be, but no nearer.
        missing = 0.0 - approach - ti.max(gap - wanted, 0.0) * rate
        wi, wa, wb = solid.vertices[i][2], (1.0 - t) * solid.vertices[a][2], t * solid.vertices[b][2]
        weight = wi + (1.0 - t) * wa + t * wb
        if weight > 0.0 and (push > 0.0 or missing > 0.0):
            share = 1.0 / weight
            shift = share * push * normal
            u[i] = u[i] + wi * shift
            u[a] = u[a] - wa * shift
            u[b] = u[b] - wb * shift
            if missing > 0.0:
                slide = relative - approach * normal
                speed = slide.norm() + 1e-20
                impulse = share * (missing * normal - ti.min(options.friction * missing / speed, 1.0) * slide)
                v[i] = v[i] + wi * impulse
                v[a] = v[a] - wa * impulse
                v[b] = v[b] - wb * impulse

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

        The other may move only at the end of its longer step, for which nothing may come too near.
        """
        steps = ti.static(surface.steps)
        for _sweep in range(passes):
            for c in range(ti.cast(surface.memory[1], ti.i32)):
                pair = surface.contacts[c]
                one, other = steps[surface.point_parts[pair[0]]], steps[surface.edge_parts[pair[1]]]
                more, fewer = ti.max(one, other), ti.min(one, other)
                if fewer == 0:  # a collider
                    fewer = more
                if steps_in(interval, intervals, more) > 0:
                    put_contact_apart(surface, solid, state, options, c, fewer / TICK)

    return SimpleNamespace(find_contacts=find_contacts, put_apart=put_apart, steps_in=steps_in)
