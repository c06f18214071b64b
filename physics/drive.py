"""What acts on the bodies, tick by tick, in the form that the kernels read."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .particles import Particles, all_particles
from .rigging import displacement, velocity
from .scene import Scene
from .solver import Drive
from .stepping import TICK

__all__ = ["drive"]


def drive(scene: Scene, first_tick: int, count: int) -> Drive:
    """Rig points and flow particles of a scene during some ticks.

    Args:
        scene: the scene.
        first_tick: number of the first tick; tick i lasts from i to i + 1 times ``TICK``.
        count: number of ticks.
    """
    times = (first_tick + np.arange(count + 1)) * TICK
    side = scene.bodies[0].mesh.longest_side
    motions = [rig_point.motion for rig_point in scene.rig_points]
    groups = [all_particles(scene.strokes, float(t) + TICK / 2) for t in times[:-1]] if scene.strokes else []
    sizes = [len(group.kind) for group in groups] or [0] * count
    return Drive(
        rig_displacements=_rig_table([displacement(motion, times) / side for motion in motions], count),
        rig_velocities=_rig_table([velocity(motion, times) / side for motion in motions], count),
        first_particles=np.cumsum([0, *sizes]).astype(np.int32),
        particles=np.concatenate([_rows(group, side) for group in groups] or [np.zeros((0, 6), np.float32)]),
        kinds=np.concatenate([group.kind for group in groups] or [np.zeros(0, np.int32)]),
        gravity=scene.gravity,
    )


def _rig_table(columns: list[NDArray[np.float64]], count: int) -> NDArray[np.float32]:
    if not columns:
        return np.zeros((count + 1, 1, 2), dtype=np.float32)
    return np.ascontiguousarray(np.stack(columns, axis=1), dtype=np.float32)


def _rows(group: Particles, side: float) -> NDArray[np.float32]:
    scaled = (group.position / side, group.direction, group.radius / side, group.strength)
    return np.column_stack(scaled).astype(np.float32)
