# mypy: ignore-errors
"""The Taichi kernels: semi-implicit Euler for fixed corotated triangles under flow particles and rig points.

The unit is a tick (``stepping.TICK``). At its start the external acceleration of every vertex is evaluated and the
step is chosen; then follow whole substeps: forces of all triangles, then velocities and positions of all vertices.
One launch runs several ticks. Connected parts do not feel each other: each takes its own steps, and
the loop over them is parallel, though Taichi may leave few parts to one core. Within a part all is serial.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any

from .falloff import FIRMNESS
from .stepping import SAFETY, TICK

__all__ = ["LATE_SAFETY", "MOST_REFINEMENT", "REACH", "SPEED_FLOOR", "build_functions", "build_kernels"]

MOST_REFINEMENT = 4
"""Large deformation stiffens triangles; a tick then takes up to this many times its planned substeps."""

SPEED_FLOOR = 5.0
"""Speed that is never cut [side/s]."""

REACH = 0.25
"""Part of its smallest altitude that a vertex faster than ``SPEED_FLOOR`` moves in a substep at most."""

LATE_SAFETY = (1 + SAFETY) / 2
"""Between the planned step and the limit, so that small strains change nothing."""

_SMALL = 0x7FFFFFF
"""Masks the ends of loops over triangles, which changes nothing but tells the compiler that 4 t fits into 32 bits.

It then loads neighbouring numbers together: 120 rather than 90 million triangles a second.
"""


def build_functions(ti: Any) -> SimpleNamespace:
    """The functions that kernels are made of, by name."""
    vec2, vec4 = ti.types.vector(2, ti.f32), ti.types.vector(4, ti.f32)
    vec3, mat2 = ti.types.vector(3, ti.f32), ti.types.matrix(2, 2, ti.f32)
    vectors, vectors4 = ti.types.ndarray(dtype=vec2, ndim=1), ti.types.ndarray(dtype=vec4, ndim=1)
    vec6 = ti.types.vector(6, ti.f32)
    scalars, integers = ti.types.ndarray(dtype=ti.f32, ndim=1), ti.types.ndarray(dtype=ti.i32, ndim=1)
    triples = ti.types.ndarray(dtype=ti.types.vector(3, ti.i32), ndim=1)
    stiffnesses = ti.types.ndarray(dtype=vec3, ndim=1)
    paths = ti.types.ndarray(dtype=vec6, ndim=2)
    tables = ti.types.ndarray(dtype=ti.f32, ndim=2)

    @ti.func
    def displacement_gradient(u0: vec2, u1: vec2, u2: vec2, b: vec4):
        """Grad u = [u1 - u0, u2 - u0] [X1 - X0, X2 - X0]^-1."""
        d1, d2 = u1 - u0, u2 - u0
        return mat2(
            [
                [d1[0] * b[0] + d2[0] * b[2], d1[0] * b[1] + d2[0] * b[3]],
                [d1[1] * b[0] + d2[1] * b[2], d1[1] * b[1] + d2[1] * b[3]],
            ]
        )

    @ti.func
    def corner_forces(g: mat2, b: vec4, stiffness: vec3):
        """Columns V P grad N1, V P grad N2 (Appendix A), with P = 2 mu (F - R) + lambda (J - 1) cof F, F = I + g."""
        cosine = 2.0 + g[0, 0] + g[1, 1] + 1e-15  # vanishes in rounding, but decides for the identity at 0, 0
        sine = g[1, 0] - g[0, 1]
        scale = 1.0 / ti.sqrt(cosine * cosine + sine * sine)
        cosine, sine = cosine * scale, sine * scale
        shear = stiffness[0]
        pressure = stiffness[1] * (g[0, 0] + g[1, 1] + g[0, 0] * g[1, 1] - g[0, 1] * g[1, 0])
        p00 = shear * (1.0 + g[0, 0] - cosine) + pressure * (1.0 + g[1, 1])
        p01 = shear * (g[0, 1] + sine) - pressure * g[1, 0]
        p10 = shear * (g[1, 0] - sine) - pressure * g[0, 1]
        p11 = shear * (1.0 + g[1, 1] - cosine) + pressure * (1.0 + g[0, 0])
        return mat2(
            [
                [p00 * b[0] + p01 * b[1], p00 * b[2] + p01 * b[3]],
                [p10 * b[0] + p11 * b[1], p10 * b[2] + p11 * b[3]],
            ]
        )

    @ti.func
    def add_forces(
        first: ti.i32,
        end: ti.i32,
        triangles: triples,
        inverse_edges: vectors4,
        stiffness: stiffnesses,
        u: vectors,
        force: vectors,
    ):
        for t in range(first & _SMALL, end & _SMALL):
            i, j, k, b = triangles[t][0], triangles[t][1], triangles[t][2], inverse_edges[t]
            h = corner_forces(displacement_gradient(u[i], u[j], u[k], b), b, stiffness[t])
            f1, f2 = vec2(h[0, 0], h[1, 0]), vec2(h[0, 1], h[1, 1])
            force[j] = force[j] - f1  # not -=, which would be atomic
            force[k] = force[k] - f2
            force[i] = force[i] + f1 + f2

    @ti.func
    def present_frequency(g: mat2, stiffness: vec3):
        """omega^2 of a deformed triangle: that at rest times a bound on the growth of Psi's second derivative."""
        f = g + mat2([[1.0, 0.0], [0.0, 1.0]])
        j, square = f.determinant(), f.norm_sqr()
        largest = 0.5 * (square + ti.sqrt(ti.max(square * square - 4.0 * j * j, 0.0)))  # singular value squared
        bulk = ti.max(largest + ti.abs(2.0 * j - 1.0), ti.abs(j - 1.0))
        return stiffness[2] * (stiffness[0] + stiffness[1] * bulk) / (stiffness[0] + 2.0 * stiffness[1])

    @ti.func
    def particle_push(q: vec2, particle: vec6, kind: ti.i32):
        """Acceleration at q by one flow particle (Appendix "Interactive Animation"), nothing beyond its radius.

        The kind is 0 wind, 1 repel, 2 attract, plus 3 for a smooth or 6 for a constant falloff.
        """
        push = vec2(0.0, 0.0)
        offset = q - vec2(particle[0], particle[1])
        distance, radius = offset.norm(), particle[4]
        if distance <= radius:
            falling = 1.0 - distance / radius
            if kind >= 6:
                falling = 1.0
            elif kind >= 3:
                falling = falling * falling * (1.0 + distance / radius) * (1.0 + distance / radius)
            if kind % 3 == 0:
                push = falling * vec2(particle[2], particle[3])
            elif kind == 1:
                push = offset / radius
            elif distance > 0.0:
                push = falling / distance * offset
                if kind % 3 == 2:
                    push = -push
        return push * particle[5]

    @ti.func
    def hermite(a: vec2, b: vec2, va: vec2, vb: vec2, s: ti.f32):
        """The cubic from a to b that starts with va and ends with vb."""
        return a + s * (va + s * (3.0 * (b - a) - 2.0 * va - vb + s * (2.0 * (a - b) + va + vb)))

    @ti.func
    def led(x: vec2, c: vec6):
        """M x + d by the coefficients of a rig point."""
        return vec2(c[0] * x[0] + c[1] * x[1] + c[4], c[2] * x[0] + c[3] * x[1] + c[5])

    @ti.func
    def place(vertex: vec4):
        """Where a vertex was drawn."""
        return vec2(vertex[0], vertex[1])

    @ti.func
    def goal(x: vec2, tick: ti.i32, leader: ti.i32, s: ti.f32, rig_leads: paths, rig_rates: paths):
        """Displacement to which a rig point leads what was drawn at x, at a part s of a tick."""
        a, b = led(x, rig_leads[tick, leader]), led(x, rig_leads[tick + 1, leader])
        va, vb = led(x, rig_rates[tick, leader]), led(x, rig_rates[tick + 1, leader])
        return hermite(a, b, TICK * va, TICK * vb, s)

    @ti.func
    def pulled(speed: vec2, u: vec2, before: vec2, after: vec2, grip: ti.f32, dt: ti.f32):
        """Velocity after a step of the critically damped spring between a vertex and its goal, taken implicitly."""
        rate = dt * FIRMNESS * grip
        return (speed + (rate * rate * (after - u) + 2.0 * rate * (after - before)) / dt) / (1.0 + rate * (2.0 + rate))

    @ti.func
    def wind_push(q: vec2, tick: ti.i32, wind: vectors, wind_waves: vectors4, wind_phases: tables):
        """Acceleration at q by the wind field in a tick."""
        total = vec2(0.0, 0.0)
        if wind.shape[0] > 0:
            total = wind[tick]
            for m in range(wind_waves.shape[0]):
                wave = wind_waves[m]
                turned = ti.sin(wave[0] * q[0] + wave[1] * q[1] + wind_phases[tick, m])
                total = total + turned * vec2(wave[2], wave[3])
        return total

    @ti.func
    def move(
        i: ti.i32,
        tick: ti.i32,
        begin: ti.f32,
        end: ti.f32,
        dt: ti.f32,
        vertices: vectors4,
        reach: scalars,
        leaders: integers,
        grips: scalars,
        u: vectors,
        v: vectors,
        force: vectors,
        push: vectors,
        decay: scalars,
        rig_leads: paths,
        rig_rates: paths,
    ):
        """One substep of a vertex, which lasts from one part of a tick to another; uses its force up."""
        leader, grip, x = leaders[i], grips[i], place(vertices[i])
        if leader < 0 or grip > 0.0:
            speed = decay[i] * (v[i] + dt * (vertices[i][2] * force[i] + push[i]))
            if grip > 0.0:
                before = goal(x, tick, leader, begin, rig_leads, rig_rates)
                after = goal(x, tick, leader, end, rig_leads, rig_rates)
                speed = pulled(speed, u[i], before, after, grip, dt)
            limit = ti.max(reach[i] / dt, SPEED_FLOOR)
            squared_speed = speed.norm_sqr()
            if squared_speed > limit * limit:
                speed = speed * (limit / ti.sqrt(squared_speed))
            v[i] = speed
            u[i] = u[i] + dt * speed
        else:
            v[i] = led(x, rig_rates[tick + 1, leader])
            u[i] = goal(x, tick, leader, end, rig_leads, rig_rates)
        force[i] = vec2(0.0, 0.0)

    return SimpleNamespace(
        displacement_gradient=displacement_gradient,
        add_forces=add_forces,
        present_frequency=present_frequency,
        particle_push=particle_push,
        place=place,
        wind_push=wind_push,
        move=move,
    )


def build_kernels(ti: Any) -> tuple[Any, Any]:
    """The kernels, compiled for Taichi's present program when first launched."""
    vec2, vec3, vec4 = (ti.types.vector(n, ti.f32) for n in (2, 3, 4))
    scalars, integers = ti.types.ndarray(dtype=ti.f32, ndim=1), ti.types.ndarray(dtype=ti.i32, ndim=1)
    vectors, vectors4 = ti.types.ndarray(dtype=vec2, ndim=1), ti.types.ndarray(dtype=vec4, ndim=1)
    vec6 = ti.types.vector(6, ti.f32)
    vectors6 = ti.types.ndarray(dtype=vec6, ndim=1)
    pairs = ti.types.ndarray(dtype=ti.types.vector(2, ti.i32), ndim=1)
    triples = ti.types.ndarray(dtype=ti.types.vector(3, ti.i32), ndim=1)
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
    place, move = functions.place, functions.move

    @ti.kernel
    def advance(
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
    ):
        ti.loop_config(block_dim=1)
        for part in range(planned.shape[0]):
            first_vertex, end_vertex = starts[part][0], starts[part + 1][0]
            first_triangle, end_triangle = starts[part][1], starts[part + 1][1]
            for tick in range(first_particles.shape[0] - 1):
                # The step of this tick: the planned one unless large deformation asks for a smaller one.
                squared = 0.0
                for t in range(first_triangle & _SMALL, end_triangle & _SMALL):
                    i, j, k = triangles[t][0], triangles[t][1], triangles[t][2]
                    g = displacement_gradient(u[i], u[j], u[k], inverse_edges[t])
                    squared = ti.max(squared, present_frequency(g, stiffness[t]))
                needed = ti.sqrt(squared) * (TICK / (2.0 * LATE_SAFETY))
                count = planned[part]
                if needed > ti.cast(count, ti.f32):
                    count = ti.cast(ti.ceil(ti.min(needed, ti.cast(count * MOST_REFINEMENT, ti.f32))), ti.i32)
                dt = TICK / count

                # External acceleration and damping of this tick.
                for i in range(first_vertex, end_vertex):
                    decay[i] = ti.exp(-vertices[i][3] * dt)
                    total = vec2(0.0, 0.0)
                    if vertices[i][2] > 0.0:
                        q = place(vertices[i]) + u[i]
                        total = vec2(gravity_x, gravity_y) + wind_push(q, tick, wind, wind_waves, wind_phases)
                        for p in range(first_particles[tick], first_particles[tick + 1]):
                            total = total + particle_push(q, particles[p], kinds[p])
                    push[i] = total

                for step in range(count):
                    add_forces(first_triangle, end_triangle, triangles, inverse_edges, stiffness, u, force)
                    for i in range(first_vertex, end_vertex):
                        begin, end = step / ti.cast(count, ti.f32), (step + 1.0) / count
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

    @ti.kernel
    def forces(triangles: triples, inverse_edges: vectors4, stiffness: stiffnesses, u: vectors, force: vectors):
        ti.loop_config(serialize=True)
        for _ in range(1):
            add_forces(0, triangles.shape[0], triangles, inverse_edges, stiffness, u, force)

    return advance, forces
