"""The solver: semi-implicit Euler substeps of elastic bodies as Taichi kernels, and how many of them are needed."""

from __future__ import annotations

from .arguments import PackedArguments, argument_packs, array_types, drive_group, solid_group, state_group
from .arrays import CALM, Drive, Solid, State, WindTable
from .kernel_functions import REACH, SPEED_FLOOR, build_functions
from .solver import advance
from .stepping import SAFETY, TICK, frequency_limits, squared_frequencies, substeps, vertex_frequencies

__all__ = [
    "CALM",
    "REACH",
    "SAFETY",
    "SPEED_FLOOR",
    "TICK",
    "Drive",
    "PackedArguments",
    "Solid",
    "State",
    "WindTable",
    "advance",
    "argument_packs",
    "array_types",
    "build_functions",
    "drive_group",
    "frequency_limits",
    "solid_group",
    "squared_frequencies",
    "state_group",
    "substeps",
    "vertex_frequencies",
]
