"""Scenes in motion: the simulation in one call, seamless loops, and kernels compiled ahead of time."""

from __future__ import annotations

from .kernel_preparation import begin_aside, compile_aside, simulated_aside, simulated_beside
from .loop import first_frame, loop_frames, periodic
from .sample_simulations import simulate_samples
from .simulation import simulate

__all__ = [
    "begin_aside",
    "compile_aside",
    "first_frame",
    "loop_frames",
    "periodic",
    "simulate",
    "simulate_samples",
    "simulated_aside",
    "simulated_beside",
]
