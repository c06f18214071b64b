"""Seamless loops: all forcing is made periodic, cycles run until the state repeats, and what is left is closed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidInputError, SimulationError, require
from ..forces import EnergyStroke, fitted_period
from ..motion import LoopReport
from ..progress import Progress
from ..rig import Combined, Pinned, Pulse, RigMotion, Swing, Wave, lead
from ..scene import Scene

__all__ = ["MOST_CYCLES", "TOLERANCE", "first_frame", "loop_frames", "periodic", "require_bounded", "settled"]

FloatArray = NDArray[np.float64]

TOLERANCE = 0.04
"""Residual below which a loop needs no further cycle [px]."""

MOST_CYCLES = 40
"""Cycles after which what is left of the residual is closed as it is."""

_LARGEST_RESIDUAL = 0.03  # [side]: more cannot be closed without being seen
_CLOSING = 0.75  # [s] over which the residual is closed, but no more than half of the loop
_CLOSED = 0.5  # [px]: a keyed path whose ends are nearer than this is closed
_ARM = 100.0  # [px] from the rig point, where turns and squashes are judged
_OUT_OF_HAND = 1000.0  # [side]
_PERIODS = 1e-6  # slack in counting periods


def loop_frames(scene: Scene) -> int:
    """Frames of one cycle of a looping scene: the loop's length in the nearest whole number of frames.

    Raises:
        InvalidInputError: the scene has no loop, or one that is shorter than two frames.
    """
    require("loop", scene.loop, scene.loop is not None, "a length in seconds")
    count = round((scene.loop or 0.0) * scene.frame_rate)
    require("loop", f"{scene.loop:g} s", count >= 2, f"at least two frames long ({2 / scene.frame_rate:.3g} s)")
    return count


def _seconds(scene: Scene) -> float:
    if scene.loop is None:
        raise InvalidInputError("loop must be a length in seconds. Got: None")
    return scene.loop


def periodic(scene: Scene) -> Scene:
    """The scene with everything that acts in it repeating after each cycle.

    The loop becomes a whole number of frames. Strokes without an end keep their rhythm as nearly as a whole number of
    particles in a cycle allows; one that ends repeats in each cycle, or more often if it repeats already; one that
    lasts longer than the loop never ends. Waves swing a whole number of times, and so do gusts of wind. Other motions
    of rig points begin anew in each cycle, and must then be back where they began.

    Raises:
        InvalidInputError: a rig point does not come back in time; the message names it.
    """
    seconds = loop_frames(scene) / scene.frame_rate
    strokes = tuple(_periodic_stroke(stroke, seconds) for stroke in scene.strokes)
    rig_points = []
    for number, rig_point in enumerate(scene.rig_points):
        motion = _periodic_motion(rig_point.motion, seconds, f"rig_points[{number}].motion")
        rig_points.append(replace(rig_point, motion=motion))
    return replace(scene, strokes=strokes, rig_points=tuple(rig_points), loop=seconds)


def _periodic_stroke(stroke: EnergyStroke, seconds: float) -> EnergyStroke:
    window = math.inf if stroke.end is None else stroke.end - stroke.start
    if window == math.inf or (stroke.repeat is None and window >= seconds * (1 - _PERIODS)):
        return replace(stroke, end=None, repeat=None, interval=fitted_period(stroke.interval, seconds))
    repeat = seconds if stroke.repeat is None else fitted_period(stroke.repeat, seconds)
    end = stroke.start + min(window, repeat)  # a repetition that had to become shorter
    return replace(stroke, end=end, repeat=repeat)


def _periodic_motion(motion: RigMotion, seconds: float, path: str) -> RigMotion:
    if isinstance(motion, Pinned):
        return motion
    if isinstance(motion, Wave | Swing | Pulse):
        return replace(motion, period=fitted_period(motion.period, seconds))
    if isinstance(motion, Combined):
        parts = enumerate(motion.motions)
        return Combined(tuple(_periodic_motion(part, seconds, f"{path}.motions[{k}]") for k, part in parts))  # type: ignore[misc]
    last = motion.times[-1]
    if last > seconds * (1 + _PERIODS):
        raise InvalidInputError(
            f"{path} must end within the loop of {seconds:g} s. Got: a last key at {last:g} s; move the keys closer"
            " together or make the loop longer"
        )
    # How far the ends are apart for what lies within an arm's length of the rig point.
    first, end = lead(motion, (0.0, 0.0), np.array([0.0, seconds])).coefficients
    away = float(np.abs((end - first) * ([_ARM] * 4 + [1] * 2)).max())
    if away > _CLOSED:
        raise InvalidInputError(
            f"{path} must come back to where it began, so that the motion can loop. Got: an end {away:.1f} px away;"
            " let the last key be like the first"
        )
    return motion


def first_frame(scene: Scene) -> int:
    """Frame of a periodic scene from which on as many particles are under way as in any later cycle."""
    under_way = [stroke.start + (0.0 if stroke.rests else stroke.travel.lifetime) for stroke in scene.strokes]
    return math.ceil(max(under_way, default=0.0) / _seconds(scene)) * loop_frames(scene)


def settled(
    scene: Scene,
    displacements: Iterator[NDArray[np.float32]],
    *,
    tolerance: float = TOLERANCE,
    most_cycles: int = MOST_CYCLES,
    progress: Progress | None = None,
) -> tuple[NDArray[np.float32], LoopReport]:
    """Run cycle after cycle until one is like the one before, and close it.

    The last frames are blended into those of the cycle before, which lead to frame 0: so the velocity goes on through
    the seam as well.

    Args:
        scene: a periodic scene.
        displacements: of every vertex in frame after frame, without end [side], each of shape [v, 2].
        tolerance: residual at which to stop [px].
        most_cycles: after which to stop whatever the residual, at least 2.
        progress: called after each frame; may raise to stop.

    Returns:
        The frames of one cycle [side], shape [f, v, 2], and a report.

    Raises:
        SimulationError: a position is no finite number, or the motion drifts so that it never repeats.
    """
    seconds = _seconds(scene)
    count, side = loop_frames(scene), max(scene.width, scene.height)
    overlap = max(1, min(count // 2, round(_CLOSING * scene.frame_rate)))
    report = _Estimate(scene, count, tolerance, progress)
    last, cycles = _cycle(scene, displacements, count, 0, report), 1
    while True:
        before, last = last, _cycle(scene, displacements, count, cycles, report)
        residual = float(np.linalg.norm(last - before, axis=2).max(initial=0.0)) * side
        cycles += 1
        if residual <= tolerance or cycles >= most_cycles:
            break
    if residual > _LARGEST_RESIDUAL * side:
        raise SimulationError(
            f"The motion does not repeat: after {cycles} cycles of {seconds:g} s it still changes by"
            f" {residual:.0f} px. Hold every body with a rig point, give the materials more damping, or weaken the"
            " strokes."
        )
    closed = _closed(before, last, overlap)
    left = float(np.linalg.norm(closed[-1] - before[-1], axis=1).max(initial=0.0)) * side
    if progress is not None:
        progress(count, count)
    return closed, LoopReport(seconds=seconds, frames=count, cycles=cycles, residual=residual, closed_residual=left)


def require_bounded(scene: Scene, displacement: NDArray[np.float32], when: str) -> None:
    """Refuse a motion that has got out of hand.

    Raises:
        SimulationError: a displacement [side] is no finite number, or at a time step that was asked for one that no
            drawing makes.
    """
    if scene.time_step is None and not np.isfinite(displacement).all():
        raise SimulationError(
            f"The motion is no longer finite in {when}. Weaken the strokes, or move the rig points less far."
        )
    if scene.time_step is not None and not (np.abs(displacement) < _OUT_OF_HAND).all():
        raise SimulationError(
            f"The motion has got out of hand in {when}: so far deformed, it needs a time_step below"
            f" {scene.time_step:g} s. Lower it, set it to 0 for steps that follow from the mesh, or weaken the strokes."
        )


def _cycle(
    scene: Scene, displacements: Iterator[NDArray[np.float32]], count: int, number: int, report: _Estimate
) -> NDArray[np.float32]:
    frames = []
    for frame in range(count):
        frames.append(np.array(next(displacements), dtype=np.float32))
        require_bounded(scene, frames[-1], f"frame {frame} of cycle {number}")
        report(number * count + frame + 1)
    return np.array(frames)


def _closed(before: NDArray[np.float32], last: NDArray[np.float32], overlap: int) -> NDArray[np.float32]:
    """The last cycle, whose last frames go over smoothly into those of the cycle before."""
    s = np.arange(1, overlap + 1) / (overlap + 1)
    share = (s * s * (3 - 2 * s)).astype(np.float32)[:, None, None]
    ending = last[-overlap:] + share * (before[-overlap:] - last[-overlap:])
    return np.concatenate([last[:-overlap], ending])


class _Estimate:
    """Reports progress in frames of one cycle, by how many cycles the damping lets expect."""

    def __init__(self, scene: Scene, count: int, tolerance: float, progress: Progress | None) -> None:
        seconds = _seconds(scene)
        damping = max(0.2, min(body.material.damping for body in scene.bodies))
        decay = 2 * math.log(100 / tolerance) / damping  # a swing dies away by half the damping
        self._count, self._progress = count, progress
        self._expected = min(MOST_CYCLES, 2 + decay / seconds) * count

    def __call__(self, frames: int) -> None:
        if self._progress is not None:
            share = min(1.0, frames / self._expected)
            self._progress(min(self._count - 1, int(share * self._count)), self._count)
