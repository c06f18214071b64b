# mypy: ignore-errors
"""Types in the signatures of the functions that kernels are made of.

Modules with such functions import Taichi at their top and are themselves imported late, when kernels are built.
"""

from __future__ import annotations

import taichi as ti

from ..runtime import LANES

__all__ = ["any_value", "int2", "lanes", "vec2", "vec4"]

any_value = ti.template()
"""Taken as it is when the kernel is compiled: packs and arrays, or named tuples of these."""

vec2 = ti.types.vector(2, ti.f32)
vec4 = ti.types.vector(4, ti.f32)
int2 = ti.types.vector(2, ti.i32)

lanes = ti.types.vector(LANES, ti.f32)
"""A number of each triangle of a block."""
