"""simulate(): a scene becomes a motion.

Time runs in ticks of 1/240 s, or of the scene's time step, that are the same at every frame rate (see ``stepping``); a
frame that falls between two ticks is read from the cubic through both.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from itertools import count

import numpy as np
from numpy.typing import NDArray

from ..assembly import (
    AtRest,
    Prepare,
    Prepared,
    SimulationPlan,
    System,
    check_work,
    drive,
    plan,
    plan_system,
    tethers,
    work_of_minutes,
)
from ..contact import TouchingBodies
from ..errors import InvalidInputError, require
from ..limits import DEFAULT_MINUTES
from ..material import RestShape
from ..motion import Motion
from ..process_end import stop_at_end, working
from ..progress import Progress
from ..rig import Pinned
from ..runtime import taichi_runtime
from ..scene import Scene
from ..solver import STEP_LIMIT, Solid, State, advance, squared_frequencies
from .loop import MOST_CYCLES, first_frame, loop_frames, periodic, require_bounded, settled

__all__ = ["OnFrame", "SimulationPlan", "plan", "simulate"]

OnFrame = Callable[[int, NDArray[np.float32]], None]
"""Called with the number of a frame and its positions [px], shape [v, 2]: to be read before it returns."""

_LAUNCH_WORK = 2e6  # triangle updates: some 15 ms, for which a launch stops the other threads of the process
_OUTSIDE_WORK = 3e7  # the same for what is not done on triangles
_LONGER_BESIDE = 8  # times as much, where it stops none
_ON_TICK = 1e-6  # [ticks]


@working()
def simulate(
    scene: Scene,
    *,
    frames: int | None = None,
    progress: Progress | None = None,
    max_minutes: float = DEFAULT_MINUTES,
    max_work: float | None = None,
    on_frame: OnFrame | None = None,
    prepare: Prepare = Prepared,
) -> Motion:
    """Where every vertex is in every frame (paper, Appendix A; semi-implicit Euler).

    The motion does not depend on the frame rate nor on the picture's resolution. However strong the forces are, it
    stays finite: above 5 sides a second a vertex cannot move farther in a substep than a quarter of the smallest
    altitude of its triangles. A scene with a time step is integrated as the paper writes, in steps of just that length,
    with all forces evaluated in each, the masses just those of the triangles and no such limit: a motion that gets out
    of hand is refused.

    Args:
        scene: what to simulate.
        frames: number of frames, the drawing included. May be None where the scene loops: then those of one cycle;
            of more frames, each is that one cycle before.
        progress: called after each frame with (frames done, frames); may raise to stop.
        max_minutes: minutes of computing that are accepted, estimated for one core of an ordinary machine; a clip of
            less than a second may take its share of them.
        max_work: most triangle updates that are accepted, instead of ``max_minutes``; ``plan`` tells what a scene
            takes.
        on_frame: is shown each frame as soon as it is known; may raise to stop. Of a loop it is shown every cycle while
            the motion settles, and at the end the one that closes: a frame takes the place of an earlier one with its
            number.
        prepare: gives what is needed before the first step; ``Preparations`` keep it from one simulation to the next.

    Raises:
        InvalidInputError: ``frames`` is below 1.
        SimulationError: the work would be more than is accepted, a position is no finite number, or a scene that shall
            loop does not.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body, automatic_scene
        >>> from physanimator.physics.simulation import simulate
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = simulate(automatic_scene([Body(mesh)]), frames=3)
        >>> motion.positions.shape == (3, len(mesh.vertices), 2)
        True
    """
    if scene.loop is not None:
        cyclic = periodic(scene)
        return _looped(
            cyclic,
            prepare(cyclic),
            frames=frames,
            progress=progress,
            max_minutes=max_minutes,
            max_work=max_work,
            on_frame=on_frame,
        )
    if frames is None:
        raise InvalidInputError("frames must be a number where the scene has no loop. Got: None")
    prepared = prepare(scene)
    planned = plan_system(scene, prepared.system, frames=frames)
    check_work(scene, planned, max_minutes=max_minutes, max_work=max_work)
    side, order, at_rest = scene.bodies[0].mesh.longest_side, prepared.system.order, prepared.at_rest
    rest = at_rest.rest
    positions = np.empty((frames, len(rest), 2), dtype=np.float32)
    for frame, displacement in zip(range(frames), _displacements(scene, at_rest, planned), strict=False):
        positions[frame, order] = rest + displacement.astype(np.float64) * side
        require_bounded(scene, displacement, f"frame {frame}")
        if on_frame is not None:
            on_frame(frame, positions[frame])
        if progress is not None:
            progress(frame + 1, frames)
    return Motion(scene.bodies, positions, scene.frame_rate)


def _looped(
    scene: Scene,
    prepared: Prepared,
    *,
    frames: int | None,
    progress: Progress | None,
    max_minutes: float,
    max_work: float | None,
    on_frame: OnFrame | None,
) -> Motion:
    """One cycle of a periodic scene, again and again for as many frames as are wanted."""
    length = loop_frames(scene)
    require("frames", frames, frames is None or frames >= 1, "at least 1")
    planned = plan_system(scene, prepared.system, frames=length + 1)
    check_work(scene, planned, max_minutes=max_minutes, max_work=max_work)
    accepted = work_of_minutes(max_minutes) if max_work is None else max_work
    most = int(min(MOST_CYCLES, max(2.0, accepted / max(planned.work, 1.0))))
    side, order, at_rest = scene.bodies[0].mesh.longest_side, prepared.system.order, prepared.at_rest
    rest = at_rest.rest
    endless = _displacements(scene, at_rest, planned, first=first_frame(scene))
    if on_frame is not None:
        endless = _shown(endless, on_frame, length=length, rest=rest, order=order, side=side)
    cycle, report = settled(scene, endless, most_cycles=most, progress=progress)
    positions = np.empty((length, len(rest), 2), dtype=np.float32)
    positions[:, order] = rest + cycle.astype(np.float64) * side
    for frame in range(length if on_frame else 0):
        on_frame(frame, positions[frame])  # type: ignore[misc]
    shown = np.arange(length if frames is None else frames) % length
    return Motion(scene.bodies, positions[shown], scene.frame_rate, report)


def _shown(
    displacements: Iterator[NDArray[np.float32]],
    on_frame: OnFrame,
    *,
    length: int,
    rest: NDArray[np.float64],
    order: NDArray[np.int32],
    side: float,
) -> Iterator[NDArray[np.float32]]:
    """The same displacements, each shown under its frame of the cycle before it is handed on."""
    positions = np.empty((len(rest), 2), dtype=np.float32)
    for number, displacement in enumerate(displacements):
        positions[order] = rest + displacement.astype(np.float64) * side
        on_frame(number % length, positions)
        yield displacement


def _displacements(
    scene: Scene, at_rest: AtRest, planned: SimulationPlan, *, first: int = 0
) -> Iterator[NDArray[np.float32]]:
    """Displacement of every vertex of the system in frame after frame, without end [side], shape [v, 2].

    Args:
        at_rest: the bodies; it begins with them as drawn, without velocity.
        first: number of the frame with which to begin.
    """
    system, start = at_rest.system, at_rest.start
    solid, size = _solid(scene, system, start), len(system.masses)
    length = planned.tick
    done, _ = _ticks(first, scene.frame_rate, length)
    ticks = max(1.0, (planned.frames - 1) / (planned.frame_rate * planned.tick))
    inside = planned.work - planned.outside_work
    longest = min(_LAUNCH_WORK / (inside + ticks * size), _OUTSIDE_WORK / max(planned.outside_work, 1))
    block = max(1, int(longest * ticks * (_LONGER_BESIDE if taichi_runtime.is_beside() else 1)))
    if scene.contact is None:
        state = State.at_rest(solid)._replace(displacement=start.copy())
        run = partial(_run, scene, solid, state, block=block)
        record: Callable[..., NDArray[np.float32]] = partial(_record, scene, solid, state)
    else:
        touching = TouchingBodies(scene, system, solid, scene.contact, start)
        state, run, record = touching.state, partial(touching.advance, block=block), touching.record
    yield state.displacement[:size]
    per_frame, fraction = _ticks(1, scene.frame_rate, length)
    if fraction == 0 and block >= 2 * per_frame:
        most, left, together = block // per_frame, planned.frames - 1, 1
        while True:
            stop_at_end()
            for displacement in record(done, done + together * per_frame, count=together):
                yield displacement[:size]
            done, left = done + together * per_frame, left - together
            together = min(2 * together, most, left if left > 0 else most)  # the first frame comes at once
    for frame in count(first + 1):
        stop_at_end()
        whole, fraction = _ticks(frame, scene.frame_rate, length)
        run(done, whole)
        done = whole
        if fraction == 0:
            yield state.displacement[:size]
            continue
        before = state._replace(displacement=state.displacement.copy(), velocity=state.velocity.copy())
        run(whole, whole + 1)
        done = whole + 1
        yield _between(before, state, fraction, length)[:size]


def _ticks(frame: int, frame_rate: float, length: float) -> tuple[int, float]:
    """Whole ticks of a length [s] before a frame, and the part of the next one."""
    time = frame / (frame_rate * length)
    whole = math.floor(time + _ON_TICK)
    fraction = time - whole
    return whole, fraction if fraction > _ON_TICK else 0.0


def _run(scene: Scene, solid: Solid, state: State, first: int, end: int, *, block: int) -> None:
    """Advance the state from one tick to another, some ticks in a launch."""
    for tick in range(first, end, block):
        advance(solid, state, drive(scene, tick, min(block, end - tick)))


def _record(scene: Scene, solid: Solid, state: State, first: int, end: int, *, count: int) -> NDArray[np.float32]:
    """Advance the state in one launch; the displacement so many times meanwhile [side], shape [count, v, 2]."""
    recording = state.recording(count)
    advance(solid, recording, drive(scene, first, end - first))
    return recording.records


def _between(before: State, after: State, fraction: float, length: float) -> NDArray[np.float32]:
    """The cubic through the displacements and velocities of two ticks a length [s] apart."""
    s = np.float32(fraction)
    a, b = before.displacement, after.displacement
    va, vb = before.velocity * np.float32(length), after.velocity * np.float32(length)
    return a + s * (va + s * (3 * (b - a) - 2 * va - vb + s * (2 * (a - b) + va + vb)))


def _solid(scene: Scene, system: System, start: NDArray[np.float32] | None = None) -> Solid:
    """The assembled bodies in the kernels' form, without triangles that act on nothing free.

    Args:
        start: displacement in which they were drawn [side], shape [v, 2]; tethers are as long as in the drawing.
    """
    rest, active, free = system.rest, system.active, system.free
    mu, lam = system.lame
    inverse_mass = np.divide(1.0, system.masses, out=np.zeros_like(system.masses), where=free)
    altitudes = np.full(len(free), np.inf)
    np.minimum.at(altitudes, rest.triangles, rest.smallest_altitudes[:, None])
    moving = [index for index, point in enumerate(scene.rig_points) if not isinstance(point.motion, Pinned)]
    gripped = free & (system.grips > 0)
    kinematic = np.where(np.isin(system.leaders, moving), system.leaders, -1)
    squared = squared_frequencies(rest, mu, lam, system.density)
    squared = np.minimum(squared, system.highest[system.part_of_triangle])
    limits = STEP_LIMIT * altitudes
    if scene.time_step is not None:  # nothing asks for other steps than these, nor cuts them short
        squared, limits = np.zeros_like(squared), np.full_like(altitudes, np.finfo(np.float32).max)
    stiffness = np.column_stack([2 * mu * rest.areas, lam * rest.areas, squared])
    drawn = rest.positions if start is None else rest.positions + start
    anchors, lengths = tethers(RestShape(drawn, rest.triangles), system.leaders >= 0, system.stretch_limits)
    tethered, alike = (anchors >= 0).any(), (system.wind_response == 1).all()
    return Solid.of_triangles(
        starts=system.starts,
        substeps=system.substeps,
        vertices=np.column_stack([rest.positions, inverse_mass, system.damping]).astype(np.float32),
        step_limits=np.where(free, limits, 0.0).astype(np.float32),
        handles=np.where(gripped, system.grippers, kinematic).astype(np.int32),
        grips=np.where(gripped, system.grips, 0.0).astype(np.float32),
        triangles=np.ascontiguousarray(rest.triangles[active]),
        inverse_edges=rest.inverse_edges[active].reshape(-1, 4).astype(np.float32),
        stiffness=stiffness[active].astype(np.float32),
        **({"anchors": anchors, "tethers": lengths.astype(np.float32)} if tethered else {}),
        **({} if alike else {"wind_response": system.wind_response.astype(np.float32)}),
    )
