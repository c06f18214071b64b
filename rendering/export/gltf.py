"""A puppet as a glTF 2.0 scene: a textured mesh for each piece, which few morph targets move.

Sources: Khronos Group, "glTF 2.0 Specification" (2021); its extension KHR_materials_unlit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.progress import Progress
from ..files import StrPath, replacing
from .glb import ARRAY_BUFFER, Buffer, glb
from .morph_targets import MorphTargets, morph_targets
from .puppet import MovingMesh, Puppet, PuppetPiece

__all__ = ["GltfScene", "gltf_scene", "save_gltf"]

_APART = 1e-3
"""Distance of a piece from the one behind it, in heights of the picture: programs sort what is transparent by it."""

_LINEAR, _LINEAR_MIPMAP_LINEAR, _CLAMP_TO_EDGE = 9729, 9987, 33071
_QUAD = np.array([[0, 1, 2], [0, 2, 3]])


@dataclass(frozen=True, eq=False)
class GltfScene:
    """A scene as a file.

    Attributes:
        data: of the .glb file.
        targets: how many morph targets all meshes have together.
        error: how far any vertex ever is from where the motion has it [px].
    """

    data: bytes
    targets: int
    error: float


def gltf_scene(puppet: Puppet, *, tolerance: float, progress: Progress | None = None) -> GltfScene:
    """A puppet as a scene: the picture is 1 m high, stands upright with the middle of its lower edge at the origin,
    and looks to +z. Meshes are in pixels, and their node scales them. Unlit, so that colours are as drawn.

    Args:
        puppet: the pieces and their motion, all of blend mode normal.
        tolerance: how far a vertex may ever be from where the motion has it [px].
        progress: called after each piece; may raise to stop.

    Raises:
        InvalidInputError: the file would be larger than such a file can be.
    """
    buffer, channels, samplers = Buffer(), [], []
    nodes: list[dict[str, Any]] = []
    meshes: list[dict[str, Any]] = []
    times: int | None = None
    count, error = 0, 0.0
    for number, piece in enumerate(puppet.pieces):
        found = None if piece.mesh is None else _motion(puppet, piece.mesh, tolerance)
        meshes.append(_mesh(puppet, piece, found, number, buffer))
        depth = number * _APART * puppet.height
        nodes.append({"name": piece.name, "mesh": number, "translation": [0.0, 0.0, depth]})
        if found is not None:
            count, error = count + len(found.targets), max(error, found.error)
        if found is not None and len(found.targets):
            times = buffer.floats(puppet.times(), bounds=True) if times is None else times
            samplers.append({"input": times, "output": buffer.floats(found.weights.ravel())})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": number, "path": "weights"}})
        if progress is not None:
            progress(number + 1, len(puppet.pieces))
    pictures = [buffer.png(piece.pixels) for piece in puppet.pieces]
    root = {"name": "picture", "scale": [1 / puppet.height] * 3, "children": list(range(len(nodes)))}
    document = {
        "asset": {"version": "2.0", "generator": "PhysAnimator"},
        "extensionsUsed": ["KHR_materials_unlit"],
        "scene": 0,
        "scenes": [{"nodes": [len(nodes)]}],
        "nodes": [*nodes, root],
        "meshes": meshes,
        "materials": [_material(piece, number) for number, piece in enumerate(puppet.pieces)],
        "textures": [{"source": number, "sampler": 0} for number in range(len(pictures))],
        "images": [
            {"name": piece.name, "mimeType": "image/png", "bufferView": view}
            for piece, view in zip(puppet.pieces, pictures, strict=True)
        ],
        "samplers": [
            {
                "magFilter": _LINEAR,
                "minFilter": _LINEAR_MIPMAP_LINEAR,
                "wrapS": _CLAMP_TO_EDGE,
                "wrapT": _CLAMP_TO_EDGE,
            }
        ],
    }
    if channels:
        document["animations"] = [{"name": "motion", "channels": channels, "samplers": samplers}]
    return GltfScene(glb(document, buffer), count, error)


def save_gltf(puppet: Puppet, path: StrPath, *, tolerance: float, progress: Progress | None = None) -> GltfScene:
    """Write a puppet as a scene; see :func:`gltf_scene`.

    Args:
        puppet: the pieces and their motion.
        path: a name in .glb.
        tolerance: how far a vertex may ever be from where the motion has it [px].
        progress: called after each piece; may raise to stop.

    Raises:
        InvalidInputError: nothing can be written there, or the file would be larger than such a file can be.
    """
    scene = gltf_scene(puppet, tolerance=tolerance, progress=progress)
    with replacing(path) as temporary:
        temporary.write_bytes(scene.data)
    return scene


def _motion(puppet: Puppet, mesh: MovingMesh, tolerance: float) -> MorphTargets:
    """The shapes of a mesh, y up."""
    return morph_targets(puppet.upright(mesh.rest), puppet.upright(puppet.played(mesh)), tolerance=tolerance)


def _mesh(
    puppet: Puppet, piece: PuppetPiece, found: MorphTargets | None, number: int, buffer: Buffer
) -> dict[str, Any]:
    if piece.mesh is None:
        left, top, width, height = piece.box
        corners = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], dtype=np.float64)
        rest, places, triangles = np.array([left, top]) + corners * (width, height), corners, _QUAD
    else:
        rest, places, triangles = piece.mesh.rest, piece.mesh.places, piece.mesh.triangles
    primitive: dict[str, Any] = {
        "attributes": {
            "POSITION": buffer.floats(_deep(puppet.upright(rest)), target=ARRAY_BUFFER, bounds=True),
            "TEXCOORD_0": buffer.floats(places, target=ARRAY_BUFFER),
        },
        "indices": buffer.indices(triangles),
        "material": number,
    }
    mesh: dict[str, Any] = {"name": piece.name, "primitives": [primitive]}
    if found is None or not len(found.targets):
        return mesh
    primitive["targets"] = [
        {"POSITION": buffer.floats(_deep(target), target=ARRAY_BUFFER, bounds=True)} for target in found.targets
    ]
    names = [f"shape {order}" for order in range(1, len(found.targets) + 1)]
    extras = {"targetNames": names, "error_px": round(found.error, 4)}
    return mesh | {"weights": [0.0] * len(names), "extras": extras}


def _material(piece: PuppetPiece, number: int) -> dict[str, Any]:
    return {
        "name": piece.name,
        "alphaMode": "OPAQUE" if piece.opaque else "BLEND",
        "doubleSided": True,
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": number},
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        },
        "extensions": {"KHR_materials_unlit": {}},
    }


def _deep(points: NDArray[np.floating]) -> NDArray[np.floating]:
    """Points of a plane in space."""
    return np.pad(points, ((0, 0), (0, 1)))
