# mypy: ignore-errors
"""The Taichi kernel of contact: boundary vertices are kept out of the boundary edges of other parts.

Edges go into a spatial hash. Every boundary vertex finds the nearest edge of each part around it; from pairs that
are too near, velocities and positions are projected along the edge's normal, weighted by the inverse masses, so that
momentum stays. Friction acts on what slides along the edge.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any

from .kernels import LATE_SAFETY, MOST_REFINEMENT, SPEED_FLOOR, build_functions
from .stepping import TICK

__all__ = ["LIST_LENGTH", "build_contact_kernel"]

LIST_LENGTH = 4
"""Contacts of one vertex, each with another part."""

_LAST_PASSES = 4  # at the end of a tick; within it one a step is enough
_LIST_STEPS = 4  # substeps for which a list of near pairs is good

_YIELDING = 0.5  # part of the thickness that gives way at first, so that pushes do not set light vertices ringing
_RETURN = 0.01  # part of it that comes back in a step


def build_contact_kernel(ti: Any) -> Any:
    """The kernel, compiled for Taichi's present program when first launched."""
    vec2, vec3, vec4 = (ti.types.vector(n, ti.f32) for n in (2, 3, 4))
    scalars, integers = ti.types.ndarray(dtype=ti.f32, ndim=1), ti.types.ndarray(dtype=ti.i32, ndim=1)
    vectors, vectors4 = ti.types.ndarray(dtype=vec2, ndim=1), ti.types.ndarray(dtype=vec4, ndim=1)
    pairs = ti.types.ndarray(dtype=ti.types.vector(2, ti.i32), ndim=1)
    triples = ti.types.ndarray(dtype=ti.types.vector(3, ti.i32), ndim=1)
    vec6 = ti.types.vector(6, ti.f32)
    vectors6 = ti.types.ndarray(dtype=vec6, ndim=1)
    stiffnesses = ti.types.ndarray(dtype=vec3, ndim=1)
    paths = ti.types.ndarray(dtype=vec6, ndim=2)
    tables = ti.types.ndarray(dtype=ti.f32, ndim=2)
    functions = build_functions(ti)
    displacement_gradient, add_forces = functions.displacement_gradient, functions.add_forces
    present_frequency, particle_push, wind_push = (
        functions.present_frequency,
        functions.particle_push,
        functions.wind_push,
    )
    drawn_at, move = functions.place, functions.move
    slots_i = ti.types.vector(LIST_LENGTH, ti.i32)
    slots_f = ti.types.vector(LIST_LENGTH, ti.f32)

    @ti.func
    def place(vertices: vectors4, u: vectors, i: ti.i32):
        return vec2(vertices[i][0], vertices[i][1]) + u[i]

    @ti.func
    def rest_place(vertices: vectors4, i: ti.i32):
        return vec2(vertices[i][0], vertices[i][1])

    @ti.func
    def bucket(x: ti.i32, y: ti.i32, mask: ti.i32):
        return ((x * 73856093) ^ (y * 19349663)) & mask

    @ti.func
    def along(p: vec2, a: vec2, b: vec2):
        """Where on the edge from a to b (0 to 1) the point nearest to p lies."""
        edge = b - a
        return ti.min(1.0, ti.max(0.0, edge.dot(p - a) / ti.max(edge.norm_sqr(), 1e-20)))

    @ti.func
    def detect(
        vertices: vectors4,
        u: vectors,
        v: vectors,
        points: integers,
        point_parts: integers,
        edges: pairs,
        edge_parts: integers,
        bodies: integers,
        spacing: scalars,
        first_overlaps: integers,
        overlap_parts: integers,
        overlaps: scalars,
        normals: vectors,
        heads: integers,
        order: integers,
        contacts: triples,
        contact_data: vectors4,
        touching: integers,
        thickness: ti.f32,
        within: ti.i32,
        horizon: ti.f32,
    ):
        """Lists the pairs that may touch in the time ahead: their number, the least excess of a gap, the top speed."""
        # How far to look: as far as the fastest vertices come together in the time ahead.
        mask = heads.shape[0] - 2
        fastest, longest = 0.0, 0.0
        for n in range(points.shape[0]):
            fastest = ti.max(fastest, v[points[n]].norm_sqr())
            normals[points[n]] = vec2(0.0, 0.0)
        fastest = ti.min(ti.sqrt(fastest), 2.0 * SPEED_FLOOR)  # what is led faster would have it look everywhere
        near = thickness + 2.0 * fastest * horizon
        for e in range(edges.shape[0]):
            a, b = edges[e][0], edges[e][1]
            edge = place(vertices, u, b) - place(vertices, u, a)
            length = edge.norm()
            longest = ti.max(longest, length)
            normal = vec2(-edge[1], edge[0]) / ti.max(length, 1e-12)
            normals[a] = normals[a] + normal
            normals[b] = normals[b] + normal
        deepest = 0.0
        for part in range(spacing.shape[0]):
            deepest = ti.max(deepest, spacing[part])
        cell = 0.5 * longest + ti.max(near, 2.0 * deepest)

        # The hash: edges by their middles, sorted by bucket.
        for k in range(heads.shape[0]):
            heads[k] = 0
        for e in range(edges.shape[0]):
            middle = 0.5 * (place(vertices, u, edges[e][0]) + place(vertices, u, edges[e][1])) / cell
            k = bucket(ti.cast(ti.floor(middle[0]), ti.i32), ti.cast(ti.floor(middle[1]), ti.i32), mask)
            heads[k] = heads[k] + 1
        total = 0
        for k in range(heads.shape[0]):
            total = total + heads[k]
            heads[k] = total
        for e in range(edges.shape[0]):
            middle = 0.5 * (place(vertices, u, edges[e][0]) + place(vertices, u, edges[e][1])) / cell
            k = bucket(ti.cast(ti.floor(middle[0]), ti.i32), ti.cast(ti.floor(middle[1]), ti.i32), mask)
            heads[k] = heads[k] - 1
            order[heads[k]] = e

        count = 0
        closest = near  # least excess of a distance over what is wanted
        for n in range(points.shape[0]):
            i, own = points[n], point_parts[n]
            p = place(vertices, u, i)
            parts, best, nearest = slots_i(-1), slots_f(0.0), slots_i(-1)
            x = ti.cast(ti.floor(p[0] / cell), ti.i32)
            y = ti.cast(ti.floor(p[1] / cell), ti.i32)
            for c in range(9):
                k = bucket(x + c % 3 - 1, y + c // 3 - 1, mask)
                for s in range(heads[k], heads[k + 1]):
                    e = order[s]
                    part = edge_parts[e]
                    a, b = edges[e][0], edges[e][1]
                    same = bodies[part] == bodies[own]
                    candidate = (not same) or (within == 1 and bodies[own] >= 0)
                    if candidate and a != i and b != i:
                        pa, pb = place(vertices, u, a), place(vertices, u, b)
                        away = p - (pa + along(p, pa, pb) * (pb - pa))
                        distance = away.norm_sqr()
                        reach = ti.max(near, 2.0 * spacing[part])
                        if distance < reach * reach:
                            allowed = True
                            if part == own:  # not what is near at rest anyway
                                q = rest_place(vertices, i)
                                qa, qb = rest_place(vertices, a), rest_place(vertices, b)
                                apart = (q - (qa + along(q, qa, qb) * (qb - qa))).norm()
                                allowed = apart > 2.0 * ti.max(spacing[part], thickness)
                            if allowed:
                                slot = -1
                                for j in ti.static(range(LIST_LENGTH)):
                                    if slot < 0 and (parts[j] == part or parts[j] < 0):
                                        slot = j
                                        if parts[j] < 0 or distance < best[j]:
                                            parts[j] = part
                                            best[j] = distance
                                            nearest[j] = e
            for j in ti.static(range(LIST_LENGTH)):
                if parts[j] >= 0:
                    e = nearest[j]
                    a, b = edges[e][0], edges[e][1]
                    pa, pb = place(vertices, u, a), place(vertices, u, b)
                    t = along(p, pa, pb)
                    away = p - (pa + t * (pb - pa))
                    edge = pb - pa
                    normal = vec2(-edge[1], edge[0]) / ti.max(edge.norm(), 1e-12)
                    outward = normal
                    if t <= 0.0:
                        outward = normals[a]
                    if t >= 1.0:
                        outward = normals[b]
                    distance = away.norm()
                    signed = distance
                    if away.dot(outward) < 0.0:
                        signed = -distance
                    if distance > 1e-6 and (t <= 0.0 or t >= 1.0):
                        normal = away / signed
                    wanted = thickness
                    for o in range(first_overlaps[n], first_overlaps[n + 1]):
                        if overlap_parts[o] == parts[j]:
                            if signed > thickness:
                                overlaps[o] = thickness
                            wanted = overlaps[o]
                    deep = 2.0 * spacing[parts[j]]
                    if parts[j] == own:
                        deep = 0.6 * spacing[own]
                    if signed > -deep and wanted > -deep:
                        closest = ti.min(closest, signed - wanted)
                        if signed - wanted < 2.0 * fastest * TICK:
                            touching[own] = 1
                            touching[parts[j]] = 1
                        if signed - wanted < 2.0 * fastest * horizon and count < contacts.shape[0]:
                            contacts[count] = ti.Vector([i, a, b])
                            contact_data[count] = vec4(normal[0], normal[1], t, wanted)
                            count = count + 1
        return vec3(ti.cast(count, ti.f32), closest, fastest)

    @ti.func
    def put_apart(
        vertices: vectors4,
        u: vectors,
        v: vectors,
        contacts: triples,
        contact_data: vectors4,
        count: ti.i32,
        friction: ti.f32,
        thickness: ti.f32,
        interval: ti.f32,
        passes: ti.i32,
    ):
        for _sweep in range(passes):
            for c in range(count):
                i, a, b = contacts[c][0], contacts[c][1], contacts[c][2]
                normal = vec2(contact_data[c][0], contact_data[c][1])
                t, wanted = contact_data[c][2], contact_data[c][3]
                wi, wa, wb = vertices[i][2], vertices[a][2], vertices[b][2]
                weight = wi + (1.0 - t) * (1.0 - t) * wa + t * t * wb
                if weight > 0.0:
                    gap = normal.dot(
                        place(vertices, u, i) - (1.0 - t) * place(vertices, u, a) - t * place(vertices, u, b)
                    )
                    push = ti.max(wanted - _YIELDING * thickness - gap, 0.0)
                    push = push + _RETURN * ti.max(wanted - gap - push, 0.0)
                    if push > 0.0:
                        shift = push / weight * normal
                        u[i] = u[i] + wi * shift
                        u[a] = u[a] - (1.0 - t) * wa * shift
                        u[b] = u[b] - t * wb * shift
                    relative = v[i] - (1.0 - t) * v[a] - t * v[b]
                    approach = relative.dot(normal)
                    # What is still apart may come as near as it wants to be, but no nearer.
                    missing = -approach - ti.max(gap - wanted, 0.0) / interval
                    if missing > 0.0:
                        impulse = missing * normal
                        slide = relative - approach * normal
                        speed = slide.norm()
                        if speed > 0.0:
                            impulse = impulse - slide * ti.min(friction * missing / speed, 1.0)
                        impulse = impulse / weight
                        v[i] = v[i] + wi * impulse
                        v[a] = v[a] - (1.0 - t) * wa * impulse
                        v[b] = v[b] - t * wb * impulse

    @ti.kernel
    def advance_touching(
        starts: pairs,
        planned: integers,
        vertices: vectors4,
        reach: scalars,
        leaders: integers,
        grips: scalars,
        triangles: triples,
        inverse_edges: vectors4,
        stiffness: stiffnesses,
        u: vectors,
        v: vectors,
        force: vectors,
        push: vectors,
        decay: scalars,
        rig_leads: paths,
        rig_rates: paths,
        first_particles: integers,
        particles: vectors6,
        kinds: integers,
        gravity_x: ti.f32,
        gravity_y: ti.f32,
        wind: vectors,
        wind_waves: vectors4,
        wind_phases: tables,
        points: integers,
        point_parts: integers,
        edges: pairs,
        edge_parts: integers,
        bodies: integers,
        spacing: scalars,
        first_overlaps: integers,
        overlap_parts: integers,
        overlaps: scalars,
        normals: vectors,
        heads: integers,
        order: integers,
        contacts: triples,
        contact_data: vectors4,
        touching: integers,
        counts: integers,
        report: scalars,
        friction: ti.f32,
        thickness: ti.f32,
        within: ti.i32,
    ):
        ti.loop_config(serialize=True)
        for _ in range(1):
            parts = planned.shape[0]
            for tick in range(first_particles.shape[0] - 1):
                # Parts that are near to anything take the same steps; the others each take their own.
                most = 1
                for part in range(parts):
                    squared = 0.0
                    for t in range(starts[part][1], starts[part + 1][1]):
                        i, j, k = triangles[t][0], triangles[t][1], triangles[t][2]
                        g = displacement_gradient(u[i], u[j], u[k], inverse_edges[t])
                        squared = ti.max(squared, present_frequency(g, stiffness[t]))
                    needed = ti.sqrt(squared) * (TICK / (2.0 * LATE_SAFETY))
                    count = planned[part]
                    if needed > ti.cast(count, ti.f32):
                        count = ti.cast(ti.ceil(ti.min(needed, ti.cast(count * MOST_REFINEMENT, ti.f32))), ti.i32)
                    counts[part] = count
                    most = ti.max(most, count)
                intervals = 1
                for part in range(parts):
                    if touching[part] == 1:
                        intervals = ti.max(intervals, counts[part])
                for part in range(parts):
                    dt = TICK / counts[part]
                    if touching[part] == 1:
                        dt = TICK / intervals
                        counts[part] = 0  # one step in every interval, others all of theirs in the first
                    for i in range(starts[part][0], starts[part + 1][0]):
                        decay[i] = ti.exp(-vertices[i][3] * dt)
                        total = vec2(0.0, 0.0)
                        if vertices[i][2] > 0.0:
                            q = drawn_at(vertices[i]) + u[i]
                            total = vec2(gravity_x, gravity_y) + wind_push(q, tick, wind, wind_waves, wind_phases)
                            for p in range(first_particles[tick], first_particles[tick + 1]):
                                total = total + particle_push(q, particles[p], kinds[p])
                        push[i] = total

                # The last round moves nothing: the frame that is shown may follow, so nothing shall be left inside.
                count, left = 0, 0
                for interval in range(intervals + 1):
                    moving, passes = interval < intervals, 1
                    if not moving:
                        left, passes = 0, _LAST_PASSES
                        for part in range(touching.shape[0]):
                            touching[part] = 0
                    if left == 0 and (intervals > 1 or not moving):
                        # The list holds until the fastest vertices could have come past what it foresees.
                        left = ti.max(1, ti.min(_LIST_STEPS, intervals - interval))
                        ahead = TICK
                        if moving:
                            ahead = left * TICK / intervals
                        found = detect(
                            vertices,
                            u,
                            v,
                            points,
                            point_parts,
                            edges,
                            edge_parts,
                            bodies,
                            spacing,
                            first_overlaps,
                            overlap_parts,
                            overlaps,
                            normals,
                            heads,
                            order,
                            contacts,
                            contact_data,
                            touching,
                            thickness,
                            within,
                            ahead,
                        )
                        count, report[0], report[1] = ti.cast(found[0], ti.i32), found[1], found[2]
                    if moving:
                        for part in range(parts):
                            steps, taken, whole = counts[part], 0, counts[part]
                            if steps == 0:
                                steps, taken, whole = 1, interval, intervals
                            elif interval > 0:
                                steps = 0
                            dt = TICK / whole
                            for step in range(steps):
                                add_forces(
                                    starts[part][1], starts[part + 1][1], triangles, inverse_edges, stiffness, u, force
                                )
                                for i in range(starts[part][0], starts[part + 1][0]):
                                    begin, end = (taken + step) / ti.cast(whole, ti.f32), (taken + step + 1.0) / whole
                                    move(
                                        i,
                                        tick,
                                        begin,
                                        end,
                                        dt,
                                        vertices,
                                        reach,
                                        leaders,
                                        grips,
                                        u,
                                        v,
                                        force,
                                        push,
                                        decay,
                                        rig_leads,
                                        rig_rates,
                                    )
                    if intervals > 1 or not moving:
                        left = left - 1
                        dt = TICK / ti.max(intervals, most)
                        put_apart(vertices, u, v, contacts, contact_data, count, friction, thickness, dt, passes)

    return advance_touching
