"""The solver: semi-implicit Euler substeps of elastic bodies as Taichi kernels, and how many of them are needed."""

from __future__ import annotations

from .arrays import CALM, Drive, Solid, State, WindTable
from .kernel_functions import REACH, SPEED_FLOOR, build_functions
from .kernels import BLOCKS_AT_ONCE, SMALL, VERTICES_AT_ONCE, array_types
from .pace import Pace
from .scheduling import TRIANGLES_PER_THREAD, most_threads, schedule
from .solver import advance
from .stepping import SAFETY, TICK, frequency_limits, squared_frequencies, substeps, vertex_frequencies

__all__ = [
    "BLOCKS_AT_ONCE",
    "CALM",
    "REACH",
    "SAFETY",
    "SMALL",
    "SPEED_FLOOR",
    "TICK",
    "TRIANGLES_PER_THREAD",
    "VERTICES_AT_ONCE",
    "Drive",
    "Pace",
    "Solid",
    "State",
    "WindTable",
    "advance",
    "array_types",
    "build_functions",
    "frequency_limits",
    "most_threads",
    "schedule",
    "squared_frequencies",
    "substeps",
    "vertex_frequencies",
]
