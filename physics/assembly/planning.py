"""How much work a simulation is, known before it starts; what is too much is refused with the reason and a remedy."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SimulationError, require
from ..forces import most_alive
from ..limits import DEFAULT_MINUTES, MAX_OUTLINE_POINTS, MOST_MINUTES
from ..material import Material
from ..scene import MAX_OUTLINE_CROSSINGS, OutlineCounts, Scene, count_outlines
from ..solver import TICK
from .driving import tick_of
from .outlines import outline_spacing
from .sway import SwayPart
from .system import System, assemble

__all__ = ["DEFAULT_MINUTES", "MAX_WORK", "SimulationPlan", "check_work", "plan", "plan_system", "work_of_minutes"]

UPDATES_PER_SECOND = 1.5e8
"""Triangle updates (one triangle in one substep) a second on one core of an ordinary machine, as measured by
``tests/benchmarks/simulation.py``; for estimates only, as are the other amounts of work here, which compare with it."""

MAX_WORK = DEFAULT_MINUTES * 60 * UPDATES_PER_SECOND
"""The most that is accepted unless told, ``DEFAULT_MINUTES``, in triangle updates."""

OUTLINE_WORK = 20.0
"""Work of one point of a collider's outline in a tick, in triangle updates."""

CROSSING_WORK = 200.0
"""Work of following a mask's outline from one pixel to the next, once, in triangle updates."""

CROWDING_WORK = 10.0
"""Work of two points of outlines in the same small square in a tick, in triangle updates."""

PARTICLE_WORK = 0.2
"""Work of one flow particle on one vertex in a tick, in triangle updates."""

WIND_WORK = 4.0
"""Work of a wind field on one vertex in a tick, in triangle updates."""

STROKE_WORK = 750.0
"""Work of finding the particles of one stroke in a tick, whether it has any or not, in triangle updates."""

CONTACT_WORK = 1.3
"""Factor on the work of a scene with contact: it took 1.16 to 1.23 times as long in the scenes of
``tests/benchmarks/contact_cost.py``, and this leaves room for more."""


NO_OUTLINES = OutlineCounts(0, 0, 0)


@dataclass(frozen=True)
class SimulationPlan:
    """What a simulation will take.

    Attributes:
        frames: number of frames, the drawing included.
        frame_rate: frames a second.
        substeps: substeps of the stiffest connected part in each tick; the others take fewer, and large deformation
            may take up to four times as many. One where the scene has a time step.
        triangles: triangles that are simulated.
        particles: most flow particles at any one time.
        outline_points: points of the outlines of colliders, where bodies can come, about.
        crossings: pixel edges that the outlines of colliders' masks follow.
        work: triangle updates in all; flow particles count for some.
        outside_work: the part of it that is not done on triangles and particles but on strokes, wind and outlines.
        estimated_seconds: of computing, on one core of an ordinary machine.
        costliest_body: number of the body with the connected part that takes the most work.
        sway: what became of the sway frequencies that materials ask for.
        parts: connected parts; without contact they are computed side by side, a thread for each.
        tick: time after which forces from outside are evaluated again [s].
    """

    frames: int
    frame_rate: float
    substeps: int
    triangles: int
    particles: int
    outline_points: int
    crossings: int
    work: float
    outside_work: float
    estimated_seconds: float
    costliest_body: int
    sway: tuple[SwayPart, ...]
    parts: int
    tick: float = TICK

    @property
    def step(self) -> float:
        """The time step of the stiffest part [s]."""
        return self.tick / self.substeps

    @property
    def substeps_per_frame(self) -> float:
        """Steps of the stiffest part from one frame to the next; a whole number where the frame rate divides 240."""
        return self.substeps / (self.tick * self.frame_rate)


def plan(scene: Scene, *, frames: int) -> SimulationPlan:
    """What ``simulate`` would take for a scene, without doing it.

    Args:
        scene: what to simulate.
        frames: number of frames, the drawing included.

    Raises:
        InvalidInputError: ``frames`` is below 1.
        SimulationError: a part is so stiff for its weight and its triangles so small that there is no time step.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.assembly import plan
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body, automatic_scene
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> plan(automatic_scene([Body(mesh)]), frames=24).frames
        24
    """
    return plan_system(scene, assemble(scene), frames=frames)


def plan_system(scene: Scene, system: System, *, frames: int) -> SimulationPlan:
    """The plan for a scene whose bodies are assembled already."""
    require("frames", frames, frames >= 1, "at least 1")
    duration = (frames - 1) / scene.frame_rate
    alive = sum(most_alive(stroke, horizon=duration) for stroke in scene.strokes)
    triangles = np.diff(system.starts[:, 1])
    factor = 1.0 if scene.contact is None else CONTACT_WORK
    elastic = factor * system.substeps * triangles
    counts = NO_OUTLINES if scene.contact is None else count_outlines(scene, outline_spacing(scene, system))
    outline_work = OUTLINE_WORK * counts.points + CROWDING_WORK * counts.crowding
    free, tick = int(system.free.sum()), tick_of(scene)
    ticks = math.ceil(duration / tick)
    outside = STROKE_WORK * len(scene.strokes) + outline_work
    outside += WIND_WORK * free if scene.wind is not None else 0.0
    work = ticks * (float(elastic.sum()) + PARTICLE_WORK * alive * free + outside)
    return SimulationPlan(
        frames=frames,
        frame_rate=scene.frame_rate,
        substeps=int(system.substeps.max()),
        triangles=int(system.active.sum()),
        particles=alive,
        outline_points=counts.points,
        crossings=counts.crossings,
        work=work,
        outside_work=ticks * outside,
        estimated_seconds=(work + CROSSING_WORK * counts.crossings) / UPDATES_PER_SECOND,
        costliest_body=int(system.bodies[system.starts[elastic.argmax(), 0]]),
        sway=system.sway,
        parts=len(triangles),
        tick=tick,
    )


def work_of_minutes(minutes: float) -> float:
    """Triangle updates that an ordinary machine does in so many minutes.

    Raises:
        InvalidInputError: ``minutes`` is no number above 0, or more than a week.
    """
    number = isinstance(minutes, int | float) and not isinstance(minutes, bool)
    require("max_minutes", minutes, number and 0 < minutes <= MOST_MINUTES, f"above 0 and at most {MOST_MINUTES:g}")
    return minutes * 60 * UPDATES_PER_SECOND


def check_work(
    scene: Scene, planned: SimulationPlan, *, max_minutes: float = DEFAULT_MINUTES, max_work: float | None = None
) -> None:
    """Refuse what is too much work.

    Args:
        scene: what is simulated.
        planned: its plan.
        max_minutes: of computing that are allowed.
        max_work: triangle updates that are allowed, instead of ``max_minutes``.

    Raises:
        SimulationError: the work is above what is allowed; the message tells how long it would take, and what helps.
    """
    _check_outlines(planned)
    duration = (planned.frames - 1) / planned.frame_rate
    share = min(1.0, duration)
    allowed = share * (work_of_minutes(max_minutes) if max_work is None else max_work)
    if planned.work <= allowed:
        return
    reason = f"{planned.substeps_per_frame:,.0f} substeps a frame for {planned.triangles:,} triangles"
    if planned.particles:
        reason += f" under up to {planned.particles:,} flow particles"
    if planned.outline_points:
        reason += f" beside {planned.outline_points:,} points of colliders"
    minutes = planned.work / share / 60 / UPDATES_PER_SECOND if share else math.inf
    longer = ""
    if max_work is None and minutes <= MOST_MINUTES / 1.1:
        needed = f"{1.1 * minutes:.2g}" if minutes < 10 else f"{1.1 * minutes:.0f}"
        longer = f" To wait for it, set max_minutes to {needed} (now {max_minutes:g})."
    raise SimulationError(
        f"The simulation of {planned.frames} frames needs {reason}, about {_duration(planned.estimated_seconds)} of"
        f" computing; at most {_duration(allowed / UPDATES_PER_SECOND)} are allowed.{longer}"
        f" {_remedies(scene, planned)}"
    )


def _check_outlines(planned: SimulationPlan) -> None:
    remedy = "draw the colliders with fewer corners, or mesh the bodies with a larger spacing"
    if planned.outline_points > MAX_OUTLINE_POINTS:
        raise SimulationError(
            f"The outlines of all colliders must have at most {MAX_OUTLINE_POINTS:,} points together; {remedy}."
            f" Got: {planned.outline_points:,}"
        )
    if planned.crossings > MAX_OUTLINE_CROSSINGS:
        raise SimulationError(
            f"The outlines of all colliders' masks must pass at most {MAX_OUTLINE_CROSSINGS:,} pixels together; paint"
            f" them without specks, or smaller. Got: {planned.crossings:,}"
        )


def _remedies(scene: Scene, planned: SimulationPlan) -> str:
    body = scene.bodies[planned.costliest_body]
    ends = body.mesh.vertices[body.mesh.edges]
    spacing = np.median(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))
    name = repr(body.name) if body.name else f"number {planned.costliest_body}"
    sways = any(part.body == planned.costliest_body for part in planned.sway)
    remedies = [] if scene.time_step is None else [f"raise time_step or set it to 0 (now {scene.time_step:g} s)"]
    remedies += [f"mesh body {name} with a larger spacing (now about {spacing:.3g} px)"]
    remedies.append(f"give it {_softer(body.material, sways=sways)}")
    if body.material.poisson_ratio > 0.45 and body.material.mu is None:
        remedies.append(f"a poisson_ratio further below 0.5 (now {body.material.poisson_ratio:g})")
    if planned.outline_points * OUTLINE_WORK > planned.substeps * planned.triangles:
        remedies.append("draw the colliders with fewer corners")
    if planned.particles * PARTICLE_WORK > planned.substeps:
        remedies.append("emit fewer flow particles (a larger interval or a higher speed)")
    remedies.append("make fewer frames")
    return f"To lower it: {', '.join(remedies[:-1])} or {remedies[-1]}."


def _softer(material: Material, *, sways: bool) -> str:
    """What would make a body softer, by the name under which its stiffness was given."""
    if sways:
        return f"a lower sway_frequency (now {material.sway_frequency:g} Hz)"
    if material.mu is not None:
        return f"a lower mu and lambda (now {material.mu:g} and {material.lambda_:g})"
    return f"a lower youngs_modulus (now {material.youngs_modulus:g})"


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.2g} seconds"
    if seconds < 90 * 60:
        return f"{seconds / 60:.0f} minutes"
    return f"{seconds / 3600:,.0f} hours"
