"""The solver: semi-implicit Euler substeps of elastic bodies as Taichi kernels, and how many of them are needed."""

from __future__ import annotations

from .arguments import PackedArguments, argument_packs, array_types, drive_group, solid_group, state_group
from .arrays import CALM, Drive, Solid, State, WindTable
from .pace import counters, launch_faster, most_threads
from .solver import advance, read_kernels
from .stepping import (
    SAFETY,
    SPEED_FLOOR,
    STEP_LIMIT,
    TICK,
    frequency_limits,
    squared_frequencies,
    substeps,
    vertex_frequencies,
)

__all__ = [
    "CALM",
    "SAFETY",
    "SPEED_FLOOR",
    "STEP_LIMIT",
    "TICK",
    "Drive",
    "PackedArguments",
    "Solid",
    "State",
    "WindTable",
    "advance",
    "argument_packs",
    "array_types",
    "counters",
    "drive_group",
    "frequency_limits",
    "launch_faster",
    "most_threads",
    "read_kernels",
    "solid_group",
    "squared_frequencies",
    "state_group",
    "substeps",
    "vertex_frequencies",
]
