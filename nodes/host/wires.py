"""The wires of this pack: every custom type is named once here, with what travels along it.

A body keeps the mask that it was cut out with, because the renderer needs its soft edge and the artist should not
have to connect it twice. The physics types know nothing of it: the classes below pair the two. They show no contents in
messages, because the host prints every input of a node that failed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from comfy_api.latest import io
from numpy.typing import NDArray

from ...physics.mesh import TriangleMesh
from ...physics.motion import Motion
from ...physics.scene import Attachment, Body, Collider, Contact, Scene

__all__ = [
    "BodiesWire",
    "ContactWire",
    "FlowWire",
    "MaskedBody",
    "MaskedMesh",
    "MaskedMotion",
    "MaskedScene",
    "MaterialWire",
    "MeshWire",
    "MotionWire",
    "RigWire",
    "SceneWire",
    "StrokesWire",
    "Touch",
    "WindWire",
]

Mask = NDArray[np.float32]

MeshWire = io.Custom("PHYSANIMATOR_MESH")
"""Carries a MaskedMesh."""
MaterialWire = io.Custom("PHYSANIMATOR_MATERIAL")
"""Carries a physics.material.Material."""
BodiesWire = io.Custom("PHYSANIMATOR_BODIES")
"""Carries a tuple of MaskedBody."""
StrokesWire = io.Custom("PHYSANIMATOR_STROKES")
"""Carries a tuple of physics.strokes.EnergyStroke."""
WindWire = io.Custom("PHYSANIMATOR_WIND")
"""Carries a physics.wind.Wind."""
RigWire = io.Custom("PHYSANIMATOR_RIG")
"""Carries a tuple of physics.rig.RigPoint."""
ContactWire = io.Custom("PHYSANIMATOR_CONTACT")
"""Carries a Touch."""
SceneWire = io.Custom("PHYSANIMATOR_SCENE")
"""Carries a MaskedScene."""
MotionWire = io.Custom("PHYSANIMATOR_MOTION")
"""Carries a MaskedMotion."""
FlowWire = io.Custom("PHYSANIMATOR_FLOW")
"""Carries a physics.flow.FlowSequence."""


@dataclass(frozen=True, eq=False, repr=False)
class MaskedMesh:
    """A mesh and the mask that it came from.

    Attributes:
        mesh: the shape.
        mask: coverage 0..1, float32, shape [h, w] of the illustration.
    """

    mesh: TriangleMesh
    mask: Mask


@dataclass(frozen=True, eq=False, repr=False)
class MaskedBody:
    """A body, its mask, and where an automatic scene shall hold it.

    Attributes:
        body: shape and material.
        mask: coverage 0..1, float32, shape [h, w] of the illustration.
        attach: side at which it is attached to the rest of the picture.
    """

    body: Body
    mask: Mask
    attach: Attachment = "auto"


@dataclass(frozen=True, eq=False, repr=False)
class Touch:
    """How bodies touch, and the still shapes that they keep out of."""

    contact: Contact
    colliders: tuple[Collider, ...] = ()


@dataclass(frozen=True, eq=False, repr=False)
class MaskedScene:
    """A scene and one mask for each of its bodies."""

    scene: Scene
    masks: tuple[Mask, ...]


@dataclass(frozen=True, eq=False, repr=False)
class MaskedMotion:
    """A motion and one mask for each of its bodies."""

    motion: Motion
    masks: tuple[Mask, ...]
