"""How much work a simulation is, known before it starts; what is too much is refused with the reason and a remedy."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .errors import SimulationError, require
from .particles import most_alive
from .scene import Scene
from .schedule import schedule
from .stepping import TICK
from .sway import SwayPart
from .system import System, assemble

__all__ = ["MAX_WORK", "SimulationPlan", "check_work", "plan", "plan_system"]

MAX_WORK = 2e10
"""Most triangle updates (one triangle in one substep) that are accepted: some minutes on one core.

A clip of less than a second may not take more than its share of them: a single tick must not take seconds.
"""

UPDATES_PER_SECOND = 1.5e8
"""Triangle updates a second on one core of an ordinary machine; for estimates only."""

PARTICLE_WORK = 0.2
"""Work of one flow particle on one vertex in triangle updates."""


CONTACT_WORK = 1.3
"""Factor on the work of bodies that touch."""


@dataclass(frozen=True)
class SimulationPlan:
    """What a simulation will take.

    Attributes:
        frames: number of frames, the drawing included.
        frame_rate: frames a second.
        substeps: substeps of the stiffest connected part in each tick of 1/240 s; the others take fewer, and large
            deformation may take up to four times as many.
        triangles: triangles that are simulated.
        particles: most flow particles at any one time.
        work: triangle updates in all; flow particles count for some.
        estimated_seconds: of computing, on one core of an ordinary machine.
        costliest_body: number of the body with the connected part that takes the most work.
        sway: what became of the sway frequencies that materials ask for.
        alone: connected parts that a thread computes by itself, side by side with others.
        shared: for each connected part that several threads compute together, how many.
    """

    frames: int
    frame_rate: float
    substeps: int
    triangles: int
    particles: int
    work: float
    estimated_seconds: float
    costliest_body: int
    sway: tuple[SwayPart, ...]
    alone: int
    shared: tuple[int, ...]

    @property
    def step(self) -> float:
        """The time step of the stiffest part [s]."""
        return TICK / self.substeps

    @property
    def substeps_per_frame(self) -> float:
        """Steps of the stiffest part from one frame to the next; a whole number where the frame rate divides 240."""
        return self.substeps / (TICK * self.frame_rate)


def plan(scene: Scene, *, frames: int) -> SimulationPlan:
    """How ``simulate`` would go about a scene, without doing it.

    Args:
        scene: what to simulate.
        frames: number of frames, the drawing included.

    Raises:
        InvalidInputError: ``frames`` is below 1.
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
    chosen = schedule(triangles, system.substeps, threads=None if scene.contact is None else 1)
    work = math.ceil(duration / TICK) * (float(elastic.sum()) + PARTICLE_WORK * alive * int(system.free.sum()))
    return SimulationPlan(
        frames=frames,
        frame_rate=scene.frame_rate,
        substeps=int(system.substeps.max()),
        triangles=int(system.active.sum()),
        particles=alive,
        work=work,
        estimated_seconds=work / UPDATES_PER_SECOND,
        costliest_body=int(system.bodies[system.starts[elastic.argmax(), 0]]),
        sway=system.sway,
        alone=len(chosen.alone),
        shared=tuple(threads for _, threads in chosen.shared),
    )


def check_work(scene: Scene, planned: SimulationPlan, *, max_work: float = MAX_WORK) -> None:
    """Refuse what is too much work.

    Raises:
        SimulationError: the work is above ``max_work``; the message tells how long it would take, and what helps.
    """
    duration = (planned.frames - 1) / planned.frame_rate
    allowed = max_work * min(1.0, duration)
    if planned.work <= allowed:
        return
    reason = f"{planned.substeps_per_frame:,.0f} substeps a frame for {planned.triangles:,} triangles"
    if planned.particles:
        reason += f" under up to {planned.particles:,} flow particles"
    raise SimulationError(
        f"The simulation of {planned.frames} frames needs {reason}, about {_duration(planned.estimated_seconds)} of"
        f" computing; at most {_duration(allowed / UPDATES_PER_SECOND)} are allowed. {_remedies(scene, planned)}"
    )


def _remedies(scene: Scene, planned: SimulationPlan) -> str:
    body = scene.bodies[planned.costliest_body]
    ends = body.mesh.vertices[body.mesh.edges]
    spacing = np.median(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))
    name = repr(body.name) if body.name else f"number {planned.costliest_body}"
    sways = any(part.body == planned.costliest_body for part in planned.sway)
    softer = (
        f"a lower sway_frequency (now {body.material.sway_frequency:g} Hz)"
        if sways
        else f"a lower youngs_modulus (now {body.material.youngs_modulus:g})"
    )
    remedies = [f"mesh body {name} with a larger spacing (now about {spacing:.3g} px)", f"give it {softer}"]
    if body.material.poisson_ratio > 0.45:
        remedies.append(f"a poisson_ratio further below 0.5 (now {body.material.poisson_ratio:g})")
    if planned.particles * PARTICLE_WORK > planned.substeps:
        remedies.append("emit fewer flow particles (a larger interval or a higher speed)")
    remedies.append("make fewer frames")
    return f"To lower it: {', '.join(remedies[:-1])} or {remedies[-1]}."


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.2g} seconds"
    if seconds < 90 * 60:
        return f"{seconds / 60:.0f} minutes"
    return f"{seconds / 3600:,.0f} hours"
