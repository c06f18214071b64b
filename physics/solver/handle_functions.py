# mypy: ignore-errors
"""Rig points (handles) in the kernels: the positions that they prescribe, springs towards these, and tethers."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from ..rig import FIRMNESS
from .kernel_types import any_value, vec2

__all__ = ["affine", "goal", "place", "pulled", "tether", "tick_length"]


@ti.func
def tick_length(drive: any_value):
    """Length of a tick [s]."""
    return drive.constants[2]


@ti.func
def place(vertex: ti.template()):
    """Where a vertex is at rest."""
    return vec2(vertex[0], vertex[1])


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
    """Displacement that a rig point prescribes at x, at a part s (0 to 1) of a tick: a cubic in time."""
    a, b = affine(x, drive.rig_leads, tick, handle), affine(x, drive.rig_leads, tick + 1, handle)
    length = tick_length(drive)
    va, vb = length * affine(x, drive.rig_rates, tick, handle), length * affine(x, drive.rig_rates, tick + 1, handle)
    return a + s * (va + s * (3.0 * (b - a) - 2.0 * va - vb + s * (2.0 * (a - b) + va + vb)))


@ti.func
def pulled(speed: vec2, u: vec2, before: vec2, after: vec2, grip: ti.f32, dt: ti.f32):
    """Velocity after an implicit step of the critically damped spring between a vertex and its goal."""
    rate = dt * FIRMNESS * grip
    return (speed + (rate * rate * (after - u) + 2.0 * rate * (after - before)) / dt) / (1.0 + rate * (2.0 + rate))


@ti.func
def tether(i: ti.i32, tick: ti.i32, step: ti.i32, count: ti.i32, solid: any_value, state: any_value, drive: any_value):
    """Project a vertex back to its tether's length from the anchor, and take away velocity that leads farther off.

    Where the anchor is at the end of the step follows from its rig point.
    """
    u, v = ti.static(state.displacement, state.velocity)
    anchor = solid.anchors[i]
    if anchor >= 0:
        begin, end, dt = step / ti.cast(count, ti.f32), (step + 1.0) / count, tick_length(drive) / count
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
