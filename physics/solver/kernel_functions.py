# mypy: ignore-errors
"""What the kernels are made of: a substep of a part, from the forces on its triangles to its vertices' positions."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from .elastic_functions import BLOCK_MASK, add_forces
from .handle_functions import affine, goal, place, pulled, tether, tick_length
from .kernel_types import any_value, vec2
from .stepping import SPEED_FLOOR

__all__ = ["move_vertices", "record", "take_step"]

_AT_ONCE = 8  # vertices that are moved together


@ti.func
def free_speed(i: ti.i32, dt: ti.f32, solid: any_value, state: any_value):
    """Velocity of a vertex after a substep, if nothing leads or slows it."""
    force = vec2(0.0, 0.0)
    for slot in range(solid.first_slots[i], solid.first_slots[i + 1]):
        force = force + state.force_pairs[solid.slots[slot]]
    return state.decay[i] * (state.velocity[i] + dt * (solid.vertices[i][2] * force + state.push[i]))


@ti.func
def all_free(i: ti.i32, end: ti.i32, solid: any_value):
    """Whether there are as many vertices before the end as are moved at once, and no rig point leads any of them."""
    handles = 0
    if i + _AT_ONCE <= end:
        handles = -1
        for k in ti.static(range(_AT_ONCE)):
            handles = handles & solid.handles[i + k]  # negative if all are
    return handles < 0


@ti.func
def move_at_once(i: ti.i32, dt: ti.f32, solid: any_value, state: any_value):
    """What ``move`` does to free vertices, to some at once, unless one is too fast; returns whether it has been done.

    Whatever is written may be what is read next, as far as the compiler knows: it reads all addresses anew.
    """
    speeds, places = ti.Matrix.zero(ti.f32, _AT_ONCE, 2), ti.Matrix.zero(ti.f32, _AT_ONCE, 2)
    fastest = 0.0
    for k in ti.static(range(_AT_ONCE)):
        speed = free_speed(i + k, dt, solid, state)
        u = state.displacement[i + k] + dt * speed
        fastest = ti.max(fastest, speed.norm_sqr())
        speeds[k, 0], speeds[k, 1], places[k, 0], places[k, 1] = speed[0], speed[1], u[0], u[1]
    slow = fastest <= SPEED_FLOOR * SPEED_FLOOR
    if slow:
        for k in ti.static(range(_AT_ONCE)):
            state.velocity[i + k] = vec2(speeds[k, 0], speeds[k, 1])
            state.displacement[i + k] = vec2(places[k, 0], places[k, 1])
    return slow


@ti.func
def move(
    i: ti.i32,
    tick: ti.i32,
    begin: ti.f32,
    end: ti.f32,
    dt: ti.f32,
    solid: any_value,
    state: any_value,
    drive: any_value,
):
    """One of the substeps of a vertex in a tick: v' = exp(-alpha dt) (v + dt (f / m + a)), u' = u + dt v'.

    It lasts dt [s], from one part of the tick to another (0 to 1).
    """
    u, v = ti.static(state.displacement, state.velocity)
    vertex, handle, grip = solid.vertices[i], solid.handles[i], solid.grips[i]
    if handle < 0 or grip > 0.0:
        speed = free_speed(i, dt, solid, state)
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
def move_vertices(
    first: ti.i32,
    end: ti.i32,
    tick: ti.i32,
    step: ti.i32,
    count: ti.i32,
    solid: any_value,
    state: any_value,
    drive: any_value,
):
    """One of the substeps of vertices in a tick, once the forces on their triangles are known.

    Tethers have a loop of their own, which costs nothing where there are none.
    """
    begin_of_step, end_of_step = step / ti.cast(count, ti.f32), (step + 1.0) / count
    dt = tick_length(drive) / count
    at = first
    while at < end:
        done = all_free(at, end, solid)
        if done:
            done = move_at_once(at, dt, solid, state)
        if done:
            at += _AT_ONCE
        else:
            move(at, tick, begin_of_step, end_of_step, dt, solid, state, drive)
            at += 1
    if solid.anchors.shape[0] > 0:
        for i in range(first, end):
            tether(i, tick, step, count, solid, state, drive)


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
    """One of the substeps of a part in a tick."""
    first, end = solid.starts[part], solid.starts[part + 1]
    for n in range(first[1] & BLOCK_MASK, end[1] & BLOCK_MASK):
        add_forces(solid, state, n)
    move_vertices(first[0], end[0], tick, step, count, solid, state, drive)


@ti.func
def record(first: ti.i32, last: ti.i32, tick: ti.i32, state: any_value, drive: any_value):
    """Store displacements after a tick, if it is one of those that are recorded."""
    records = ti.static(state.records)
    if records.shape[0] > 0:
        every = (drive.first_particles.shape[0] - 1) // records.shape[0]
        if (tick + 1) % every == 0:
            for i in range(first, last):
                records[(tick + 1) // every - 1, i] = state.displacement[i]
