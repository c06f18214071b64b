"""The solver: semi-implicit Euler substeps of elastic bodies as Taichi kernels, and how many of them are needed."""

from __future__ import annotations

from .arrays import CALM, Drive, Solid, State, WindTable
from .kernel_functions import REACH, SPEED_FLOOR, build_functions
from .kernels import array_types
from .solver import advance
from .stepping import SAFETY, TICK, frequency_limits, squared_frequencies, substeps, vertex_frequencies

__all__ = [
    "CALM",
    "REACH",
    "SAFETY",
    "SPEED_FLOOR",
    "TICK",
    "Drive",
    "Solid",
    "State",
    "WindTable",
    "advance",
    "array_types",
    "build_functions",
    "frequency_limits",
    "squared_frequencies",
    "substeps",
    "vertex_frequencies",
]
