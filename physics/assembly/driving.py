"""What acts on the bodies, tick by tick, in the form that the kernels read."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..forces import eddies, particles_at, uniform
from ..rig import RigPoint, lead
from ..scene import Scene
from ..solver import CALM, TICK, Drive, WindTable

__all__ = ["drive", "tick_of"]


def tick_of(scene: Scene) -> float:
    """Time after which a scene's forces from outside are evaluated again [s]: its time step, if it has one."""
    return TICK if scene.time_step is None else scene.time_step


def drive(scene: Scene, first_tick: int, count: int) -> Drive:
    """Rig points, flow particles and wind of a scene during some ticks.

    Args:
        scene: the scene.
        first_tick: number of the first tick; tick i lasts from i to i + 1 times ``tick_of(scene)``.
        count: number of ticks.
    """
    length = tick_of(scene)
    times = (first_tick + np.arange(count + 1)) * length
    led = times if scene.loop is None else times % scene.loop
    side = scene.bodies[0].mesh.longest_side
    leads, rates = _rig_tables(scene.rig_points, led, side)
    # A tick that stands for several steps has the forces of its middle, a step of its own those of its beginning.
    within = 0.5 if scene.time_step is None else 0.0
    found, counts = particles_at(scene.strokes, times[:-1] + within * length)
    rows = found.position / side, found.direction, found.radius / side, found.strength
    return Drive(
        rig_leads=leads,
        rig_rates=rates,
        first_particles=np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        particles=np.column_stack(rows).astype(np.float32),
        kinds=found.kind,
        gravity=scene.gravity,
        wind=_wind_table(scene, (first_tick + within + np.arange(count)) * length),
        tick_length=length,
    )


def _rig_tables(
    rig_points: Sequence[RigPoint], times: NDArray[np.floating], side: float
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Coefficients of each rig point's affine displacement in sides, and their rates, two of shape [n + 1, g, 6]."""
    tables = np.zeros((2, len(times), max(1, len(rig_points)), 6), dtype=np.float32)
    for index, rig_point in enumerate(rig_points):
        tables[:, :, index] = np.array(lead(rig_point.motion, rig_point.position, times)) / ([1] * 4 + [side] * 2)
    return tables[0], tables[1]


def _wind_table(scene: Scene, times: NDArray[np.floating]) -> WindTable:
    if scene.wind is None:
        return CALM
    side = scene.bodies[0].mesh.longest_side
    waves = eddies(scene.wind, loop=scene.loop)
    phases = np.mod(waves.phase + times[:, None] * waves.rate, 2 * np.pi)  # small, to keep their digits
    return WindTable(
        uniform=uniform(scene.wind, times, loop=scene.loop).astype(np.float32),
        waves=np.column_stack([waves.wave * side, waves.amplitude]).astype(np.float32),
        phases=phases.astype(np.float32) if phases.size else np.zeros((len(times), 1), dtype=np.float32),
    )
