"""The JSON form of a scene and its parts."""

from __future__ import annotations

from dataclasses import is_dataclass
from typing import Any

import numpy as np

from ..fields import described_fields
from ..material import Material
from ..mesh import runs_of
from ..rig import (
    Circle,
    Combined,
    KeyedPath,
    MaskRegion,
    Pinned,
    Polygon,
    Pulse,
    Rotation,
    Squash,
    Swing,
    Wave,
)
from ..scene import Body, LayerRegion, Scene

__all__ = [
    "COLLIDER_TYPES",
    "ELASTIC_CONSTANTS",
    "MOTION_TYPES",
    "REGION_TYPES",
    "SCENE_VERSION",
    "SHAPE_TYPES",
    "encode",
    "encode_material",
    "scene_to_dict",
]

SCENE_VERSION = 2
"""Version of the document's format; a reader refuses what is newer."""

ELASTIC_CONSTANTS = ("youngs_modulus", "poisson_ratio")
"""Keys of a material for which mu and lambda may stand."""

REGION_TYPES: dict[str, type] = {"circle": Circle, "polygon": Polygon, "mask": MaskRegion}
SHAPE_TYPES: dict[str, type] = {"polygon": Polygon, "mask": MaskRegion}
COLLIDER_TYPES: dict[str, type] = {**SHAPE_TYPES, "layer": LayerRegion}
MOTION_TYPES: dict[str, type] = {
    "pinned": Pinned,
    "path": KeyedPath,
    "wave": Wave,
    "rotation": Rotation,
    "swing": Swing,
    "squash": Squash,
    "pulse": Pulse,
    "combined": Combined,
}

_TYPE_NAMES = {kind: name for name, kind in (REGION_TYPES | COLLIDER_TYPES | MOTION_TYPES).items()}


def scene_to_dict(scene: Scene, *, meshes: bool = True) -> dict[str, Any]:
    """A scene as plain JSON data, every value written out.

    Args:
        scene: the scene.
        meshes: whether to include the bodies' meshes; without, reading it again needs them.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.document import scene_to_dict
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.scene import Body, Scene
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> document = scene_to_dict(Scene((Body(mesh),)), meshes=False)
        >>> document["width"], document["frame_rate"]
        (60, 24.0)
    """
    options = {
        "loop": encode(scene.loop),
        "wind": encode(scene.wind),
        "sag": True if scene.sag else None,
        "time_step": encode(scene.time_step),
        "strokes_as": None if scene.strokes_as == "acceleration" else scene.strokes_as,
    }
    return {
        "version": SCENE_VERSION,
        "width": int(scene.width),
        "height": int(scene.height),
        "frame_rate": float(scene.frame_rate),
        **{name: entry for name, entry in options.items() if entry is not None},
        "gravity": encode(scene.gravity),
        "bodies": [_encode_body(body, mesh=meshes) for body in scene.bodies],
        "strokes": encode(scene.strokes),
        "rig_points": encode(scene.rig_points),
        **({"contact": encode(scene.contact)} if scene.contact is not None else {}),
        **{
            name: encode(getattr(scene, name))
            for name in ("colliders", "paint", "query_points", "still", "order")
            if getattr(scene, name)
        },
    }


def encode(value: Any) -> Any:
    """The JSON form of a value or of a part of a scene; fields that are None are left out."""
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, bool):
        return value
    if isinstance(value, int | np.integer):
        return int(value)
    if isinstance(value, float | np.floating):
        return float(value)
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, tuple):
        return [encode(entry) for entry in value]
    tag = {"type": _TYPE_NAMES[type(value)]} if type(value) in _TYPE_NAMES else {}
    if isinstance(value, LayerRegion):
        return {**tag, "name": value.name}
    if isinstance(value, MaskRegion):
        height, width = value.mask.shape
        return {**tag, "width": width, "height": height, "runs": runs_of(value.mask)}
    kind: type = type(value)
    described = described_fields(kind) if is_dataclass(kind) else {}
    if not described and not tag:
        raise TypeError(f"a scene holds no {type(value).__name__}")
    entries = {each.key: encode(getattr(value, name)) for name, each in described.items()}
    return {**tag, **{name: entry for name, entry in entries.items() if entry is not None}}


def encode_material(material: Material) -> dict[str, Any]:
    """A material with one of the two pairs that say how stiff it is, so that whoever edits it edits what counts."""
    encoded: dict[str, Any] = encode(material)
    left_out = ("mu", "lambda") if material.mu is None else ELASTIC_CONSTANTS
    return {name: value for name, value in encoded.items() if name not in left_out}


def _encode_body(body: Body, *, mesh: bool) -> dict[str, Any]:
    encoded: dict[str, Any] = {"name": body.name, "layer": int(body.layer), "material": encode_material(body.material)}
    if body.strands:
        encoded["strands"] = True
    if body.attach != "none":
        encoded["attach"] = body.attach
    if mesh:
        encoded["mesh"] = {"vertices": body.mesh.vertices.tolist(), "triangles": body.mesh.triangles.tolist()}
    return encoded
