"""Bodies in contact: their state, and launches of the contact kernel that advance it.

Every part takes its own substeps of a tick as without contact, but parts that touch take as many as the stiffest of
them, and contacts are resolved after each step: pushed apart more rarely, or while one stands still, they would gain
energy.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..assembly import System, drive
from ..material import RestShape
from ..runtime import LANES, taichi_runtime
from ..scene import Contact, Scene
from ..solver import Drive, Solid, State, counters, drive_group, launch_faster, most_threads, solid_group, state_group
from .surface import ContactSurface, contact_surface

if TYPE_CHECKING:
    from .kernels import ContactKernel

__all__ = ["TouchingBodies"]


_TRIANGLES_PER_THREAD = 600
"""A smaller share is not worth a thread's while.

Two threads compute four blobs that pile up, 1,532 triangles together, and the example's 5,659 1.35 times as fast as
one, where no other program has the processors; the 816 of a curl that folds on itself little faster, if at all.
"""


class ContactOptions(NamedTuple):
    """A scene's ``Contact`` in the kernel's units: the thickness in sides."""

    friction: float
    thickness: float
    self_contact: int


class _Touching(NamedTuple):
    """What the kernel reads; in the surface it also keeps its lists from one launch to the next."""

    solid: Solid
    surface: ContactSurface
    options: ContactOptions


class TouchingBodies:
    """The bodies of a scene with contact, and their state.

    Attributes:
        count: vertices of the bodies, which come first in the state; those of colliders follow.
        state: changed by ``advance``.
    """

    def __init__(
        self,
        scene: Scene,
        system: System,
        solid: Solid,
        contact: Contact,
        start: NDArray[np.float32] | None = None,
    ) -> None:
        """Prepare bodies that are drawn displaced from rest by ``start`` [side], shape [v, 2]; None: at rest."""
        self._scene = scene
        if start is not None:
            drawn = RestShape(system.rest.positions + start, system.rest.triangles)
            system = replace(system, rest=drawn)
        surface, still = contact_surface(scene, system, contact)
        added = np.zeros((len(still), 4), np.float32)
        added[:, :2] = still
        self._solid = solid._replace(vertices=np.concatenate([solid.vertices, added]))
        thickness = contact.thickness / scene.bodies[0].mesh.longest_side
        options = ContactOptions(contact.friction, thickness, int(contact.self_contact))
        self._touching = _Touching(self._solid, surface, options)
        self.count = len(solid.vertices)
        self.state = State.at_rest(self._solid)
        if start is not None:
            self.state.displacement[: self.count] = start

    def advance(self, first: int, end: int, *, block: int = 1) -> None:
        """Carry the state on from one tick to another, some ticks in a launch."""
        for tick in range(first, end, block):
            acting = drive(self._scene, tick, min(block, end - tick))
            taichi_runtime.launch(_advance, self._touching, self.state, acting)

    def record(self, first: int, end: int, *, count: int) -> NDArray[np.float32]:
        """Carry the state on in one launch; the displacement so many times meanwhile [side], shape [count, v, 2]."""
        recording = self.state.recording(count)
        taichi_runtime.launch(_advance, self._touching, recording, drive(self._scene, first, end - first))
        return recording.records


def _kernel(_taichi: Any) -> ContactKernel:
    from .kernels import build_contact_kernel  # which imports Taichi

    return build_contact_kernel()


def _advance(touching: _Touching, state: State, acting: Drive) -> None:
    kernel = taichi_runtime.compiled(_kernel)
    solid, surface, options = touching
    groups = solid_group(solid), state_group(state), drive_group(acting), surface._asdict(), options._asdict()
    packs, ticks, blocks = kernel.packed(*groups), len(acting.first_particles) - 1, np.diff(solid.starts[:, 1])

    def launch(threads: int) -> float:
        highest = np.zeros(ticks * len(blocks), dtype=np.float32)
        steps = np.zeros((ticks, len(blocks) + 1), dtype=np.int32)
        kernel.advance(threads, counters(int(solid.substeps.max()), ticks), highest, steps, *packs)
        return float(LANES * (np.abs(steps[:, :-1]) @ blocks).sum())  # parts that touch take more than is planned

    triangles = LANES * int(blocks.sum())
    threads = most_threads(triangles, _TRIANGLES_PER_THREAD)
    launch_faster(launch, threads=threads, kernel="contact", triangles=triangles)
