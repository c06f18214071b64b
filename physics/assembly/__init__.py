"""The bodies of a scene as one system: held vertices, sway, tethers, prestress, and what a simulation costs."""

from __future__ import annotations

from .driving import drive, tick_of
from .outlines import outline_spacing
from .painted_bodies import with_paint
from .planning import MAX_WORK, SimulationPlan, check_work, plan, plan_system, work_of_minutes
from .preparation import AtRest, Preparations, Prepare, Prepared
from .prestress import is_stable, prestressed, rest_shape_derivative
from .sway import SwayPart
from .system import System, assemble
from .tethering import tethers

__all__ = [
    "MAX_WORK",
    "AtRest",
    "Preparations",
    "Prepare",
    "Prepared",
    "SimulationPlan",
    "SwayPart",
    "System",
    "assemble",
    "check_work",
    "drive",
    "is_stable",
    "outline_spacing",
    "plan",
    "plan_system",
    "prestressed",
    "rest_shape_derivative",
    "tethers",
    "tick_of",
    "with_paint",
    "work_of_minutes",
]
