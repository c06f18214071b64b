# mypy: ignore-errors
"""External acceleration in the kernels: flow particles, wind and gravity, evaluated at the start of each tick."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from ..forces import FALLOFFS, STROKE_KINDS
from .handle_functions import place, tick_length
from .kernel_types import any_value, vec2

__all__ = ["begin_vertices"]

_KINDS = len(STROKE_KINDS)
_WIND, _REPEL, _ATTRACT = (STROKE_KINDS.index(kind) for kind in ("wind", "repel", "attract"))
_LINEAR, _SMOOTH, _CONSTANT = (FALLOFFS.index(falloff) for falloff in ("linear", "smooth", "constant"))


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
def external_acceleration(i: ti.i32, tick: ti.i32, solid: any_value, state: any_value, drive: any_value):
    """Acceleration of a vertex by strokes, wind and gravity; 0 for kinematic and pinned ones."""
    vertex, total = solid.vertices[i], vec2(0.0, 0.0)
    if vertex[2] > 0.0:
        q = place(vertex) + state.displacement[i]
        total = wind_push(q, tick, drive)
        for p in range(drive.first_particles[tick], drive.first_particles[tick + 1]):
            total = total + particle_push(q, drive, p)
        if solid.wind_response.shape[0] > 0:
            total = total * solid.wind_response[i]
        total = total + vec2(drive.constants[0], drive.constants[1])
    return total


@ti.func
def begin_vertices(
    first: ti.i32,
    end: ti.i32,
    tick: ti.i32,
    count: ti.i32,
    solid: any_value,
    state: any_value,
    drive: any_value,
):
    """External acceleration of vertices in a tick, and their damping in one of its substeps."""
    damping, decay, dt = 0.0, 1.0, tick_length(drive) / count
    for i in range(first, end):
        if solid.vertices[i][3] != damping:  # most have the same
            damping = solid.vertices[i][3]
            decay = ti.exp(0.0 - damping * dt)
        state.decay[i] = decay
        state.push[i] = external_acceleration(i, tick, solid, state, drive)
