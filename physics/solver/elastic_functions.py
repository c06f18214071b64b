# mypy: ignore-errors
"""Elastic forces in the kernels: those of a block of triangles, and the substeps that a part needs.

Triangles come in blocks, one in each lane of a vector, and leave their forces in slots of their own; each vertex then
gathers its slots. That has no two lanes write to one place, and runs as fast as hand-written vector code.
"""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import taichi as ti

from ..runtime import LANES
from .kernel_types import any_value, lanes
from .stepping import MOST_REFINEMENT, SAFETY, TICK

__all__ = ["BLOCK_MASK", "add_forces", "highest_frequency", "planned_steps", "steps_for"]

BLOCK_MASK = 0x7FFFFFF
"""Masks the ends of loops over blocks, which changes nothing but tells the compiler that 48 n fits into 32 bits."""

_LATE_SAFETY = (1 + SAFETY) / 2
"""Between the planned step and the limit, so that small strains change nothing."""


@ti.func
def gathered(u: any_value, corners: any_value, first: ti.i32, axis: ti.template()):
    """One axis of the displacement at one corner of each triangle of a block.

    Indices are read one by one: to take them out of a vector costs more.
    """
    return ti.Vector([u[corners[first + lane]][axis] for lane in range(LANES)])


@ti.func
def displacement_gradient(u: any_value, corners: any_value, elements: any_value, n: ti.i32):
    """The four entries of grad u = [u1 - u0, u2 - u0] [X1 - X0, X2 - X0]^-1, row by row."""
    i = 3 * LANES * n
    j, k = i + LANES, i + 2 * LANES
    x, y = gathered(u, corners, i, 0), gathered(u, corners, i, 1)
    x1, y1 = gathered(u, corners, j, 0) - x, gathered(u, corners, j, 1) - y
    x2, y2 = gathered(u, corners, k, 0) - x, gathered(u, corners, k, 1) - y
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
    g00, g01, g10, g11 = displacement_gradient(state.displacement, corners, elements, n)
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
    g00, g01, g10, g11 = displacement_gradient(state.displacement, corners, elements, n)
    f00, f11 = 1.0 + g00, 1.0 + g11
    j = f00 * f11 - g01 * g10
    square = f00 * f00 + g01 * g01 + g10 * g10 + f11 * f11
    largest = 0.5 * (square + ti.sqrt(ti.max(square * square - 4.0 * j * j, 0.0)))  # singular value squared
    bulk = ti.max(largest + magnitude(2.0 * j - 1.0), magnitude(j - 1.0))
    shear, pressure = elements[n, 4], elements[n, 5]
    return elements[n, 6] * (shear + pressure * bulk) / (shear + 2.0 * pressure)


@ti.func
def highest_frequency(first: ti.i32, end: ti.i32, solid: any_value, state: any_value):
    """The highest omega^2 of blocks of triangles [1/s^2]."""
    squared = lanes(0.0)
    for n in range(first & BLOCK_MASK, end & BLOCK_MASK):
        squared = ti.max(squared, present_frequencies(solid, state, n))
    highest = 0.0
    for lane in ti.static(range(LANES)):
        highest = ti.max(highest, squared[lane])
    return highest


@ti.func
def steps_for(highest: ti.f32, planned: ti.i32):
    """Substeps in a tick at a highest omega^2: the planned ones unless large deformation asks for more."""
    needed, count = ti.sqrt(highest) * (TICK / (2.0 * _LATE_SAFETY)), planned
    if needed > ti.cast(count, ti.f32):
        count = ti.cast(ti.ceil(ti.min(needed, ti.cast(count * MOST_REFINEMENT, ti.f32))), ti.i32)
    return count


@ti.func
def planned_steps(part: ti.i32, solid: any_value, state: any_value):
    """Substeps of a part in a tick."""
    highest = highest_frequency(solid.starts[part][1], solid.starts[part + 1][1], solid, state)
    return steps_for(highest, solid.substeps[part])
