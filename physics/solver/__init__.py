"""The solver: semi-implicit Euler substeps of elastic bodies as Taichi kernels, and how many of them are needed."""

from __future__ import annotations

from .arguments import PackedArguments, argument_packs, array_types, drive_group, solid_group, state_group
from .arrays import CALM, Drive, Solid, State, WindTable
from .kernel_functions import SPEED_FLOOR, STEP_LIMIT, build_functions
from .pace import launch_faster
from .sharing import DONE, build_sharing, counters
from .solver import advance
from .stepping import SAFETY, TICK, frequency_limits, squared_frequencies, substeps, vertex_frequencies

__all__ = [
    "CALM",
    "DONE",
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
    "build_functions",
    "build_sharing",
    "counters",
    "drive_group",
    "frequency_limits",
    "launch_faster",
    "solid_group",
    "squared_frequencies",
    "state_group",
    "substeps",
    "vertex_frequencies",
]
