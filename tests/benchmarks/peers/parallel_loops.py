"""Eight parallel loops in one Taichi kernel, of which only their synchronisation takes time when they do nothing."""

# Taichi reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

from typing import Any

__all__ = ["build_kernel"]

TURNS = 1024  # a task for a core of its own; Taichi does not divide shorter loops


def build_kernel(ti: Any) -> Any:
    """A kernel of (tasks, iterations of a chain of sines in each task, values)."""
    scalars = ti.types.ndarray(dtype=ti.f32, ndim=1)

    @ti.kernel
    def loops(tasks: ti.i32, iterations: ti.i32, values: scalars):
        for _loop in ti.static(range(8)):
            for place in range(tasks * TURNS):
                if place % TURNS == 0:
                    task = place // TURNS
                    x = values[task * 16]
                    for _iteration in range(iterations):
                        x = ti.sin(x) + 0.5
                    values[task * 16] = x

    return loops
