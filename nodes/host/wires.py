"""The wires of this pack: every custom type is named once here, with what travels along it.

A body keeps the mask that it was cut out with, because the renderer needs its soft edge and the artist should not
have to connect it twice. The physics types know nothing of it: the classes below pair the two. They show no contents in
messages, because the host prints every input of a node that failed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce

import numpy as np
from comfy_api.latest import io
from numpy.typing import NDArray

from ...physics.mesh import TriangleMesh
from ...physics.motion import FlowSequence, Motion
from ...physics.scene import Body, Collider, Contact, Held, Scene
from ...rendering.moving_layers import LayerSource, MovingLayers, moving_layers_of

__all__ = [
    "BodiesWire",
    "ContactWire",
    "FlowOfMotion",
    "FlowWire",
    "LayersWire",
    "MaskedBody",
    "MaskedMesh",
    "MaskedMotion",
    "MaskedScene",
    "MaterialWire",
    "MeshWire",
    "MotionWire",
    "RigWire",
    "SceneOrTextWire",
    "SceneWire",
    "SeeThroughWire",
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
SceneOrTextWire = io.Custom("PHYSANIMATOR_SCENE,STRING")
"""Takes a MaskedScene, or the text of a scene document."""
MotionWire = io.Custom("PHYSANIMATOR_MOTION")
"""Carries a MaskedMotion."""
FlowWire = io.Custom("PHYSANIMATOR_FLOW")
"""Carries a FlowOfMotion."""
LayersWire = io.Custom("LAYERS")
"""Carries ComfyUI's own dictionary of layers; the host has the type since 0.31, and older ones link it as well."""
SeeThroughWire = io.Custom("SEETHROUGH_PARTS")
"""Carries the parts of the See-through nodes."""


@dataclass(frozen=True, eq=False, repr=False)
class MaskedMesh:
    """A mesh and the mask that it came from.

    Attributes:
        mesh: the shape.
        mask: coverage 0..1, float32, shape [h, w] of the illustration.
        in_front: where something that stands still is in front of it, 0..1, shape [h, w]; None for nowhere.
    """

    mesh: TriangleMesh
    mask: Mask
    in_front: Mask | None = None


@dataclass(frozen=True, eq=False, repr=False)
class MaskedBody:
    """A body, its mask, and where an automatic scene shall hold it.

    Attributes:
        body: shape and material.
        mask: coverage 0..1, float32, shape [h, w] of the illustration.
        attach: side at which it is attached to the rest of the picture.
        source: the layer that it is; None where its mask cuts it out.
        in_front: where something that stands still is in front of it, 0..1, shape [h, w]; None for nowhere.
    """

    body: Body
    mask: Mask
    attach: Held = "auto"
    source: LayerSource | None = None
    in_front: Mask | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Touch:
    """How bodies touch, and the still shapes that they keep out of."""

    contact: Contact
    colliders: tuple[Collider, ...] = ()


@dataclass(frozen=True, eq=False, repr=False)
class MaskedScene:
    """A scene, one mask for each of its bodies, and what stands still in front of them.

    Attributes:
        scene: what moves, and what acts on it.
        masks: one for each body.
        layers: the layers that the bodies are; None where masks cut them out.
        in_front: what stands still in front of all bodies, 0..1, shape [h, w]; None for nothing, and with layers.
    """

    scene: Scene
    masks: tuple[Mask, ...]
    layers: MovingLayers | None = None
    in_front: Mask | None = None

    @classmethod
    def of(cls, scene: Scene, bodies: Sequence[MaskedBody]) -> MaskedScene:
        """A scene with what its bodies carry.

        Raises:
            InvalidInputError: layers and masks are mixed.
        """
        masks = tuple(item.mask for item in bodies)
        layers = moving_layers_of([item.source for item in bodies])
        fronts = [item.in_front for item in bodies if item.in_front is not None]
        if layers is not None or not fronts:
            return cls(scene, masks, layers)
        in_front = reduce(np.maximum, fronts)
        covered = tuple(replace(body, cover=in_front > 0.5) for body in scene.bodies)
        return cls(replace(scene, bodies=covered), masks, None, in_front)


@dataclass(frozen=True, eq=False, repr=False)
class MaskedMotion:
    """A motion, and what its scene carries beside it: see MaskedScene."""

    motion: Motion
    masks: tuple[Mask, ...]
    layers: MovingLayers | None = None
    in_front: Mask | None = None


class FlowOfMotion(FlowSequence):
    """The flow of a motion, and the layers that it moves.

    Attributes:
        layers: see MaskedScene.
    """

    def __init__(self, motion: MaskedMotion) -> None:
        super().__init__(motion.motion)
        self.layers = motion.layers
