"""A puppet as a skeleton of Spine 4.2: a slot for each piece, meshes with deform keys, and stills as regions.

Source: http://esotericsoftware.com/spine-json-format
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import half_edges
from ...physics.progress import Progress
from .key_frames import key_frames, straight_error
from .outline import outline_first, outline_of
from .puppet import MovingMesh, Puppet, PuppetPiece

__all__ = ["ANIMATION", "SpineSkeleton", "spine_skeleton"]

ANIMATION = "motion"
"""Name of the one animation."""

_VERSION = "4.2.43"
_BLENDS = {"multiply": "multiply", "screen": "screen", "add": "additive"}
_DECIMALS = 2  # of lengths [px]


@dataclass(frozen=True, eq=False)
class SpineSkeleton:
    """A skeleton as data.

    Attributes:
        document: what its JSON file holds.
        keys: how many deform keys all pieces have together.
        error: how far any vertex ever is from where the motion has it [px].
    """

    document: dict[str, Any]
    keys: int
    error: float


def spine_skeleton(
    puppet: Puppet, pictures: Mapping[str, str], *, tolerance: float, progress: Progress | None = None
) -> SpineSkeleton:
    """A puppet as a skeleton. Its origin is the middle of the picture's lower edge, y goes up, lengths are pixels.

    Args:
        puppet: the pieces and their motion.
        pictures: name of each piece's picture, without its ending, by the piece's name.
        tolerance: how far a vertex may ever be from where the motion has it [px].
        progress: called after each piece; may raise to stop.
    """
    slots, skin, deforms = [], {}, {}
    keys, error = 0, 0.0
    for number, piece in enumerate(puppet.pieces, 1):
        attachment = pictures[piece.name]
        slot = {"name": piece.name, "bone": "root", "attachment": attachment}
        slots.append(slot | ({"blend": _BLENDS[piece.blend]} if piece.blend in _BLENDS else {}))
        if piece.mesh is None:
            skin[piece.name] = {attachment: _region(puppet, piece)}
        else:
            order = outline_first(len(piece.mesh.rest), outline := outline_of(piece.mesh.rest, piece.mesh.triangles))
            setup = puppet.upright(piece.mesh.rest[order]).round(_DECIMALS)
            skin[piece.name] = {attachment: _mesh(piece, piece.mesh, order, len(np.unique(outline)), setup)}
            moved = puppet.upright(puppet.played(piece.mesh)[:, order])
            timeline, apart = _deform(puppet.times(), setup, moved, tolerance)
            error, keys = max(error, apart), keys + len(timeline)
            if timeline:
                deforms[piece.name] = {attachment: {"deform": timeline}}
        if progress is not None:
            progress(number, len(puppet.pieces))
    animation = {"attachments": {"default": deforms}} if deforms else {}
    document = {
        "skeleton": {
            "hash": " ",
            "spine": _VERSION,
            "x": -puppet.width / 2,
            "y": 0,
            "width": puppet.width,
            "height": puppet.height,
            "fps": puppet.frame_rate,
            "images": "./images/",
        },
        "bones": [{"name": "root"}],
        "slots": slots,
        "skins": [{"name": "default", "attachments": skin}],
        "animations": {ANIMATION: animation},
    }
    return SpineSkeleton(document, keys, error)


def _region(puppet: Puppet, piece: PuppetPiece) -> dict[str, Any]:
    left, top, width, height = piece.box
    (x, y), *_ = puppet.upright(np.array([[left + width / 2, top + height / 2]]))
    return {"x": float(x), "y": float(y), "width": width, "height": height}


def _mesh(
    piece: PuppetPiece, mesh: MovingMesh, order: NDArray[np.int64], hull: int, setup: NDArray[np.float64]
) -> dict[str, Any]:
    number = np.argsort(order)
    triangles = number[mesh.triangles]
    edges = np.unique(np.sort(half_edges(triangles), axis=1), axis=0)
    height, width = piece.pixels.shape[:2]
    return {
        "type": "mesh",
        "uvs": mesh.places[order].round(6).ravel().tolist(),
        "triangles": triangles.ravel().tolist(),
        "vertices": setup.ravel().tolist(),
        "hull": hull,
        "edges": (2 * edges).ravel().tolist(),  # of numbers, not of vertices
        "width": width,
        "height": height,
    }


def _deform(
    times: NDArray[np.float64], setup: NDArray[np.float64], moved: NDArray[np.float64], tolerance: float
) -> tuple[list[dict[str, Any]], float]:
    """Keys of a mesh, none where it never leaves its place, and how far any vertex is from where it should be [px]."""
    offsets = (moved - setup).round(_DECIMALS)
    kept = key_frames(moved, setup + offsets, tolerance=tolerance)
    if len(kept) == 1 and straight_error(moved, setup[None]) <= tolerance:
        return [], straight_error(moved, setup[None])
    frames = np.arange(len(moved))
    after = np.clip(np.searchsorted(kept, frames, side="right"), 1, max(1, len(kept) - 1))
    begin, end = np.array(kept)[after - 1], np.array(kept)[np.minimum(after, len(kept) - 1)]
    share = np.where(end > begin, (frames - begin) / np.maximum(end - begin, 1), 0)[:, None, None]
    between = setup + offsets[begin] + share * (offsets[end] - offsets[begin])
    return [_key(float(times[frame]), offsets[frame].ravel()) for frame in kept], straight_error(moved, between)


def _key(time: float, offsets: NDArray[np.float64]) -> dict[str, Any]:
    """A key without the zeros at both ends."""
    key: dict[str, Any] = {"time": round(time, 5)} if time else {}
    moved = np.flatnonzero(offsets)
    if len(moved):
        first, last = int(moved[0]), int(moved[-1])
        key |= {"offset": first} if first else {}
        key["vertices"] = (offsets[first : last + 1] + 0.0).tolist()
    return key
