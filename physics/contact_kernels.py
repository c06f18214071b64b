# mypy: ignore-errors
"""The Taichi kernel of contact: boundary vertices are kept out of the boundary edges of other parts.

Edges go into a spatial hash. Every boundary vertex finds the nearest edge of each part around it; from pairs that
are too near, velocities and positions are projected along the edge's normal, weighted by the inverse masses, so that
momentum stays. Friction acts on what slides along the edge.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any

__all__ = ["LIST_LENGTH", "build_contact_kernel"]

LIST_LENGTH = 4
"""Contacts of one vertex, each with another part."""

_PASSES = 4
_SOLID = 0.5  # part of the thickness that is restored at once; the rest of it yields, and so adds no bounce
_SOFTNESS = 0.0  # part of what then is missing that comes back in an interval


def build_contact_kernel(ti: Any) -> Any:
    """The kernel, compiled for Taichi's present program when first launched."""
    vec2, vec4 = ti.types.vector(2, ti.f32), ti.types.vector(4, ti.f32)
    scalars, integers = ti.types.ndarray(dtype=ti.f32, ndim=1), ti.types.ndarray(dtype=ti.i32, ndim=1)
    vectors, vectors4 = ti.types.ndarray(dtype=vec2, ndim=1), ti.types.ndarray(dtype=vec4, ndim=1)
    pairs = ti.types.ndarray(dtype=ti.types.vector(2, ti.i32), ndim=1)
    triples = ti.types.ndarray(dtype=ti.types.vector(3, ti.i32), ndim=1)
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

    @ti.kernel
    def resolve(
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
        report: scalars,
        friction: ti.f32,
        thickness: ti.f32,
        within: ti.i32,
        interval: ti.f32,
        horizon: ti.f32,
    ):
        ti.loop_config(serialize=True)
        for _ in range(1):
            mask = heads.shape[0] - 2
            # How far to look: as far as the fastest vertices come together in the time ahead.
            fastest, longest = 0.0, 0.0
            for n in range(points.shape[0]):
                fastest = ti.max(fastest, v[points[n]].norm_sqr())
                normals[points[n]] = vec2(0.0, 0.0)
            fastest = ti.sqrt(fastest)
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
                            if signed - wanted < 2.0 * fastest * interval and count < contacts.shape[0]:
                                contacts[count] = ti.Vector([i, a, b])
                                contact_data[count] = vec4(normal[0], normal[1], t, wanted)
                                count = count + 1

            for _sweep in range(_PASSES):
                for c in range(count):
                    i, a, b = contacts[c][0], contacts[c][1], contacts[c][2]
                    normal = vec2(contact_data[c][0], contact_data[c][1])
                    t, wanted = contact_data[c][2], contact_data[c][3]
                    wi, wa, wb = vertices[i][2], vertices[a][2], vertices[b][2]
                    weight = wi + (1.0 - t) * (1.0 - t) * wa + t * t * wb
                    if weight > 0.0:
                        gap = normal.dot(
                            place(vertices, u, i)
                            - (1.0 - t) * place(vertices, u, a)
                            - t * place(vertices, u, b)
                        )
                        push = ti.max(wanted - _SOLID * thickness - gap, 0.0)
                        push = push + _SOFTNESS * ti.max(wanted - gap - push, 0.0)
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
            report[0] = closest
            report[1] = fastest
            report[2] = ti.cast(count, ti.f32)

    return resolve
