# mypy: ignore-errors
"""What the kernels are made of: forces of a block of triangles, the step that they need, and the way of a vertex.

Triangles come in blocks, one in each lane of a vector, and leave their forces in slots of their own; each vertex then
gathers its slots. That has no two lanes write to one place, and runs as fast as hand-written vector code.

The functions take the arrays of ``arrays`` whole, by their names.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from types import SimpleNamespace
from typing import Any

from ..forces import FALLOFFS, STROKE_KINDS
from ..rig import FIRMNESS
from ..runtime import LANES
from .stepping import SAFETY, TICK

__all__ = ["LATE_SAFETY", "MOST_REFINEMENT", "SPEED_FLOOR", "STEP_LIMIT", "build_functions"]

MOST_REFINEMENT = 4
"""Large deformation stiffens triangles; a tick then takes up to this many times its planned substeps."""

SPEED_FLOOR = 5.0
"""Speed that is never cut [side/s]."""

STEP_LIMIT = 0.25
"""Part of its smallest altitude that a vertex faster than ``SPEED_FLOOR`` moves in a substep at most."""

BLOCK_MASK = 0x7FFFFFF
"""Masks the ends of loops over blocks, which changes nothing but tells the compiler that 48 n fits into 32 bits."""

LATE_SAFETY = (1 + SAFETY) / 2
"""Between the planned step and the limit, so that small strains change nothing."""

_KINDS = len(STROKE_KINDS)
_WIND, _REPEL, _ATTRACT = (STROKE_KINDS.index(kind) for kind in ("wind", "repel", "attract"))
_LINEAR, _SMOOTH, _CONSTANT = (FALLOFFS.index(falloff) for falloff in ("linear", "smooth", "constant"))


def build_functions(ti: Any) -> SimpleNamespace:
    """The functions that kernels are made of, by name."""
    vec2, vec4, lanes = (ti.types.vector(n, ti.f32) for n in (2, 4, LANES))
    indices = ti.types.vector(LANES, ti.i32)
    any_value = ti.template()

    @ti.func
    def displacement_gradient(u: any_value, i: indices, j: indices, k: indices, elements: any_value, n: ti.i32):
        """The four entries of grad u = [u1 - u0, u2 - u0] [X1 - X0, X2 - X0]^-1, row by row."""
        x = ti.Vector([u[i[lane]][0] for lane in range(LANES)])
        y = ti.Vector([u[i[lane]][1] for lane in range(LANES)])
        x1 = ti.Vector([u[j[lane]][0] for lane in range(LANES)]) - x
        y1 = ti.Vector([u[j[lane]][1] for lane in range(LANES)]) - y
        x2 = ti.Vector([u[k[lane]][0] for lane in range(LANES)]) - x
        y2 = ti.Vector([u[k[lane]][1] for lane in range(LANES)]) - y
        b00, b01, b10, b11 = elements[n, 0], elements[n, 1], elements[n, 2], elements[n, 3]
        return x1 * b00 + x2 * b10, x1 * b01 + x2 * b11, y1 * b00 + y2 * b10, y1 * b01 + y2 * b11

    @ti.func
    def pairs(x: lanes, y: lanes):
        """x and y of each lane side by side."""
        return ti.Vector([axis[lane] for lane in range(LANES) for axis in (x, y)])

    @ti.func
    def add_forces(solid: any_value, state: any_value, n: ti.i32):
        """Forces of block n: V P grad N (Appendix A) with P = 2 mu (F - R) + lambda (J - 1) cof F, F = I + grad u."""
        corners, elements = ti.static(solid.corners, solid.elements)
        g00, g01, g10, g11 = displacement_gradient(
            state.displacement, corners[n, 0], corners[n, 1], corners[n, 2], elements, n
        )
        cosine = 2.0 + g00 + g11 + 1e-15  # vanishes in rounding, but decides for the identity at 0, 0
        sine = g10 - g01
        scale = 1.0 / ti.sqrt(cosine * cosine + sine * sine)
        cosine, sine = cosine * scale, sine * scale
        shear = elements[n, 4]
        pressure = elements[n, 5] * (g00 + g11 + g00 * g11 - g01 * g10)
        p00 = shear * (1.0 + g00 - cosine) + pressure * (1.0 + g11)
        p01 = shear * (g01 + sine) - pressure * g10
        p10 = shear * (g10 - sine) - pressure * g01
        p11 = shear * (1.0 + g11 - cosine) + pressure * (1.0 + g00)
        b00, b01, b10, b11 = elements[n, 0], elements[n, 1], elements[n, 2], elements[n, 3]
        x1, y1 = 0.0 - (p00 * b00 + p01 * b01), 0.0 - (p10 * b00 + p11 * b01)
        x2, y2 = 0.0 - (p00 * b10 + p01 * b11), 0.0 - (p10 * b10 + p11 * b11)
        state.corner_forces[n, 0] = pairs(0.0 - x1 - x2, 0.0 - y1 - y2)
        state.corner_forces[n, 1] = pairs(x1, y1)
        state.corner_forces[n, 2] = pairs(x2, y2)

    @ti.func
    def magnitude(x: lanes):
        """abs(x), which the compiler does not know for vectors."""
        return ti.max(x, 0.0 - x)

    @ti.func
    def present_frequencies(solid: any_value, state: any_value, n: ti.i32):
        """omega^2 of deformed triangles: that at rest times a bound on the growth of Psi's second derivative."""
        corners, elements = ti.static(solid.corners, solid.elements)
        g00, g01, g10, g11 = displacement_gradient(
            state.displacement, corners[n, 0], corners[n, 1], corners[n, 2], elements, n
        )
        f00, f11 = 1.0 + g00, 1.0 + g11
        j = f00 * f11 - g01 * g10
        square = f00 * f00 + g01 * g01 + g10 * g10 + f11 * f11
        largest = 0.5 * (square + ti.sqrt(ti.max(square * square - 4.0 * j * j, 0.0)))  # singular value squared
        bulk = ti.max(largest + magnitude(2.0 * j - 1.0), magnitude(j - 1.0))
        shear, pressure = elements[n, 4], elements[n, 5]
        return elements[n, 6] * (shear + pressure * bulk) / (shear + 2.0 * pressure)

    @ti.func
    def planned_steps(part: ti.i32, solid: any_value, state: any_value):
        """Substeps of a part in a tick: the planned ones unless large deformation asks for more."""
        squared = lanes(0.0)
        for n in range(solid.starts[part][1] & BLOCK_MASK, solid.starts[part + 1][1] & BLOCK_MASK):
            squared = ti.max(squared, present_frequencies(solid, state, n))
        highest = 0.0
        for lane in ti.static(range(LANES)):
            highest = ti.max(highest, squared[lane])
        needed, count = ti.sqrt(highest) * (TICK / (2.0 * LATE_SAFETY)), solid.substeps[part]
        if needed > ti.cast(count, ti.f32):
            count = ti.cast(ti.ceil(ti.min(needed, ti.cast(count * MOST_REFINEMENT, ti.f32))), ti.i32)
        return count

    @ti.func
    def particle_push(q: vec2, drive: any_value, p: ti.i32):
        """Acceleration at q by one flow particle (Appendix "Interactive Animation"), nothing beyond its radius."""
        particle = ti.static(drive.particles)
        kind, falloff = drive.kinds[p] % _KINDS, drive.kinds[p] // _KINDS
        push = vec2(0.0, 0.0)
        offset = q - vec2(particle[p, 0], particle[p, 1])
        distance, radius = offset.norm(), particle[p, 4]
        if distance <= radius:
            falling = 1.0 - distance / radius
            if falloff == _CONSTANT:
                falling = 1.0
            elif falloff == _SMOOTH:
                falling = falling * falling * (1.0 + distance / radius) * (1.0 + distance / radius)
            if kind == _WIND:
                push = falling * vec2(particle[p, 2], particle[p, 3])
            elif kind == _REPEL and falloff == _LINEAR:
                push = offset / radius
            elif distance > 0.0:
                push = falling / distance * offset
                if kind == _ATTRACT:
                    push = push * -1.0
        return push * particle[p, 5]

    @ti.func
    def wind_push(q: vec2, tick: ti.i32, drive: any_value):
        """Acceleration at q by the wind field in a tick."""
        total = vec2(0.0, 0.0)
        if drive.uniform.shape[0] > 0:
            total = drive.uniform[tick]
            for m in range(drive.waves.shape[0]):
                wave = drive.waves[m]
                turned = ti.sin(wave[0] * q[0] + wave[1] * q[1] + drive.phases[tick, m])
                total = total + turned * vec2(wave[2], wave[3])
        return total

    @ti.func
    def place(vertex: vec4):
        """Where a vertex is at rest."""
        return vec2(vertex[0], vertex[1])

    @ti.func
    def external_acceleration(i: ti.i32, tick: ti.i32, solid: any_value, state: any_value, drive: any_value):
        """What strokes, wind and gravity give a vertex."""
        vertex, total = solid.vertices[i], vec2(0.0, 0.0)
        if vertex[2] > 0.0:
            q = place(vertex) + state.displacement[i]
            total = wind_push(q, tick, drive)
            for p in range(drive.first_particles[tick], drive.first_particles[tick + 1]):
                total = total + particle_push(q, drive, p)
            if solid.wind_response.shape[0] > 0:
                total = total * solid.wind_response[i]
            total = total + vec2(drive.gravity[0], drive.gravity[1])
        return total

    @ti.func
    def begin_tick(part: ti.i32, tick: ti.i32, count: ti.i32, solid: any_value, state: any_value, drive: any_value):
        """External acceleration of the vertices of a part in a tick, and their damping in one of its substeps."""
        damping, decay, dt = 0.0, 1.0, TICK / count
        for i in range(solid.starts[part][0], solid.starts[part + 1][0]):
            if solid.vertices[i][3] != damping:  # most have the same
                damping = solid.vertices[i][3]
                decay = ti.exp(0.0 - damping * dt)
            state.decay[i] = decay
            state.push[i] = external_acceleration(i, tick, solid, state, drive)

    @ti.func
    def affine(x: vec2, coefficients: any_value, tick: ti.i32, handle: ti.i32):
        """M x + d by the coefficients of a rig point."""
        c = ti.static(coefficients)
        return vec2(
            c[tick, handle, 0] * x[0] + c[tick, handle, 1] * x[1] + c[tick, handle, 4],
            c[tick, handle, 2] * x[0] + c[tick, handle, 3] * x[1] + c[tick, handle, 5],
        )

    @ti.func
    def goal(x: vec2, tick: ti.i32, handle: ti.i32, s: ti.f32, drive: any_value):
        """Displacement to which a rig point leads what was drawn at x, at a part s of a tick: a cubic in time."""
        a, b = affine(x, drive.rig_leads, tick, handle), affine(x, drive.rig_leads, tick + 1, handle)
        va, vb = TICK * affine(x, drive.rig_rates, tick, handle), TICK * affine(x, drive.rig_rates, tick + 1, handle)
        return a + s * (va + s * (3.0 * (b - a) - 2.0 * va - vb + s * (2.0 * (a - b) + va + vb)))

    @ti.func
    def pulled(speed: vec2, u: vec2, before: vec2, after: vec2, grip: ti.f32, dt: ti.f32):
        """Velocity after a step of the critically damped spring between a vertex and its goal, taken implicitly."""
        rate = dt * FIRMNESS * grip
        return (speed + (rate * rate * (after - u) + 2.0 * rate * (after - before)) / dt) / (1.0 + rate * (2.0 + rate))

    @ti.func
    def tether(
        i: ti.i32, tick: ti.i32, step: ti.i32, count: ti.i32, solid: any_value, state: any_value, drive: any_value
    ):
        """Put a vertex that is farther from its anchor than its tether allows back, and let it move no farther away.

        Where the anchor is at the end of the step follows from its rig point.
        """
        u, v = ti.static(state.displacement, state.velocity)
        anchor = solid.anchors[i]
        if anchor >= 0:
            begin, end, dt = step / ti.cast(count, ti.f32), (step + 1.0) / count, TICK / count
            x, handle = place(solid.vertices[anchor]), solid.handles[anchor]
            held, rate = vec2(0.0, 0.0), vec2(0.0, 0.0)
            if handle >= 0:
                held = goal(x, tick, handle, end, drive)
                rate = (held - goal(x, tick, handle, begin, drive)) / dt
            offset = place(solid.vertices[i]) - x + (u[i] - held)
            distance, length = offset.norm(), solid.tethers[i]
            if distance > length:
                outward = offset / distance
                u[i] = u[i] - (distance - length) * outward
                v[i] = v[i] - ti.max((v[i] - rate).dot(outward), 0.0) * outward

    @ti.func
    def move(
        i: ti.i32,
        tick: ti.i32,
        step: ti.i32,
        count: ti.i32,
        solid: any_value,
        state: any_value,
        drive: any_value,
    ):
        """One of the substeps of a vertex in a tick: v' = exp(-alpha dt) (v + dt (f / m + a)), u' = u + dt v'."""
        u, v = ti.static(state.displacement, state.velocity)
        vertex, handle, grip = solid.vertices[i], solid.handles[i], solid.grips[i]
        begin, end, dt = step / ti.cast(count, ti.f32), (step + 1.0) / count, TICK / count
        if handle < 0 or grip > 0.0:
            force = vec2(0.0, 0.0)
            for slot in range(solid.first_slots[i], solid.first_slots[i + 1]):
                force = force + state.force_pairs[solid.slots[slot]]
            speed = state.decay[i] * (v[i] + dt * (vertex[2] * force + state.push[i]))
            if grip > 0.0:
                before = goal(place(vertex), tick, handle, begin, drive)
                after = goal(place(vertex), tick, handle, end, drive)
                speed = pulled(speed, u[i], before, after, grip, dt)
            squared_speed = speed.norm_sqr()
            if squared_speed > SPEED_FLOOR * SPEED_FLOOR:
                limit = ti.max(solid.step_limits[i] / dt, SPEED_FLOOR)
                speed = speed * ti.min(limit / ti.sqrt(squared_speed), 1.0)
            v[i] = speed
            u[i] = u[i] + dt * speed
        else:
            v[i] = affine(place(vertex), drive.rig_rates, tick + 1, handle)
            u[i] = goal(place(vertex), tick, handle, end, drive)

    @ti.func
    def take_step(
        part: ti.i32,
        tick: ti.i32,
        step: ti.i32,
        count: ti.i32,
        solid: any_value,
        state: any_value,
        drive: any_value,
    ):
        """One of the substeps of a part in a tick.

        Tethers have a loop of their own, which costs nothing where there are none.
        """
        first, end = solid.starts[part], solid.starts[part + 1]
        for n in range(first[1] & BLOCK_MASK, end[1] & BLOCK_MASK):
            add_forces(solid, state, n)
        for i in range(first[0], end[0]):
            move(i, tick, step, count, solid, state, drive)
        if solid.anchors.shape[0] > 0:
            for i in range(first[0], end[0]):
                tether(i, tick, step, count, solid, state, drive)

    @ti.func
    def record(first: ti.i32, last: ti.i32, tick: ti.i32, state: any_value, drive: any_value):
        """Write down where vertices are after a tick, if it is one of those."""
        records = ti.static(state.records)
        if records.shape[0] > 0:
            every = (drive.first_particles.shape[0] - 1) // records.shape[0]
            if (tick + 1) % every == 0:
                for i in range(first, last):
                    records[(tick + 1) // every - 1, i] = state.displacement[i]

    return SimpleNamespace(
        add_forces=add_forces,
        planned_steps=planned_steps,
        begin_tick=begin_tick,
        take_step=take_step,
        record=record,
    )
