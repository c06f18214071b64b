"""What moves the air: energy strokes with their flow particles, and wind everywhere (paper, "Energy Strokes")."""

from __future__ import annotations

from .flow_particles import Particles, acceleration, all_particles, most_alive, particles, particles_at
from .rhythm import fitted_period
from .strokes import FALLOFFS, STROKE_KINDS, EnergyStroke
from .wind import Wind, eddies, uniform

__all__ = [
    "FALLOFFS",
    "STROKE_KINDS",
    "EnergyStroke",
    "Particles",
    "Wind",
    "acceleration",
    "all_particles",
    "eddies",
    "fitted_period",
    "most_alive",
    "particles",
    "particles_at",
    "uniform",
]
