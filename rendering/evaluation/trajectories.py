"""A motion as the input of the paper's baselines that follow trajectories.

They are Drag Anything (Wu et al. 2024) and Motion-I2V (Shi et al. 2024). The paper takes their trajectories from its
own animations, so that all methods are asked for the same motion (section 4). Both are written as the public demo
scripts read them.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, require
from ...physics.motion import Motion, frame_at, layer_order, sample_times, tracks
from ..files import RecordedFiles, check_recorded_folder, write_recorded_folder
from ..pictures import save_image

__all__ = [
    "DRAG_ANYTHING_FRAMES",
    "MOTION_I2V_FRAMES",
    "MOTION_I2V_SIZE",
    "TRAJECTORIES",
    "save_drag_anything",
    "save_motion_i2v",
]

DRAG_ANYTHING_FRAMES = 20
"""Frames that Drag Anything's ``demo.py`` draws; it takes a place of the trajectory for each."""

MOTION_I2V_SIZE = (512, 320)
"""Width and height of the pictures in Motion-I2V's ``scripts/app.py`` [px]."""

MOTION_I2V_FRAMES = 16
"""Frames that it draws; it takes places of a drag as equally far apart in time."""

Picture = NDArray[np.uint8]
StrPath = str | Path

_FILES = (("drag-anything", ("demo.json", "demo.jpg")), ("motion-i2v", ("drags.json", "first_frame.png", "brush.png")))


def _present(folder: Path) -> list[str]:
    known = [name for _, names in _FILES for name in names if (folder / name).exists()]
    return sorted([*known, *(path.name for path in folder.glob("mask_*.png"))])


_KNOWN = RecordedFiles("trajectories", ".physanimator_trajectories.json", "only trajectories we wrote", _present)


def save_drag_anything(
    motion: Motion, picture: Picture, folder: StrPath, *, frames: int = DRAG_ANYTHING_FRAMES
) -> None:
    """Write the folder that Drag Anything's ``demo.py`` takes as ``validation_image``.

    ``demo.jpg`` is the first frame. ``demo.json`` has an entry for each body that can be seen: its mask, white on
    black, and the trajectory [px of the picture] of one place on it, which lies deep inside it and moves far.

    Args:
        motion: how the bodies move.
        picture: the first frame, uint8, shape [h, w, 3], of the motion's size.
        folder: where to; made if it does not exist.
        frames: places of a trajectory, over the whole motion; ``frame_number`` of the script must not be more.

    Raises:
        InvalidInputError: no body can be seen, or the folder holds files of those names that we did not write.

    Source: https://github.com/showlab/DragAnything, ``demo.py``, ``get_condition``.
    """
    require("frames", frames, 2 <= frames <= 1000, "2 to 1000")
    _check_size(motion, picture)
    times = sample_times(len(motion), frames)
    places = np.stack([frame_at(motion.positions, time, "cubic") for time in times])
    masks = body_masks(motion)
    starts = np.cumsum([0] + [len(body.mesh.vertices) for body in motion.bodies])
    seen = [number for number, mask in enumerate(masks) if mask.any()]
    if not seen:
        raise InvalidInputError("the motion must have a body that can be seen in its first frame. Got: none")

    def write(staging: Path) -> Iterable[str]:
        save_image(staging / "demo.jpg", picture)
        yield "demo.jpg"
        entries: dict[str, Any] = {}
        for number in seen:
            name = f"mask_{number}.png"
            save_image(staging / name, np.where(masks[number], np.uint8(255), np.uint8(0)))
            yield name
            own = places[:, starts[number] : starts[number + 1]]
            path = own[:, _telling(own, masks[number])]
            entries[str(number)] = {"mask_name": name, "trajectory": _rounded(path)}
        (staging / "demo.json").write_text(json.dumps(entries) + "\n", encoding="utf-8")
        yield "demo.json"

    write_recorded_folder(f"{folder}/", _KNOWN, write)


def save_motion_i2v(motion: Motion, picture: Picture, folder: StrPath, *, points: int = 8) -> None:
    """Write what Motion-I2V's ``scripts/app.py`` lets people draw.

    ``first_frame.png`` is the first frame, scaled until it covers 512 x 320 px and cut to its middle, as the script
    does. ``drags.json`` is the list of drags (``tracking_points``), each of 16 places [px of that picture]: one for
    each frame. ``brush.png`` (``image_brush["mask"]``) is white where bodies come in any frame.

    Args:
        motion: how the bodies move.
        picture: the first frame, uint8, shape [h, w, 3], of the motion's size.
        folder: where to; made if it does not exist.
        points: drags, at most.

    Raises:
        InvalidInputError: no body can be seen in what is left of the picture, or the folder holds files of those names
            that we did not write.

    Source: https://github.com/G-U-N/Motion-I2V, ``scripts/app.py``, ``preprocess_image`` and ``Drag.run``.
    """
    require("points", points, 1 <= points <= 1000, "1 to 1000")
    _check_size(motion, picture)
    width, height = MOTION_I2V_SIZE
    found = tracks(motion, points=points, static_points=0, frames=MOTION_I2V_FRAMES, width=width, height=height)
    brush = np.zeros((motion.height, motion.width), np.uint8)
    for t in range(len(motion)):
        brush |= np.maximum.reduce(body_masks(motion, t)).astype(np.uint8)

    def write(staging: Path) -> Iterable[str]:
        save_image(staging / "first_frame.png", _covering(picture, width, height, cv2.INTER_AREA))
        save_image(staging / "brush.png", _covering(brush * np.uint8(255), width, height, cv2.INTER_NEAREST))
        drags = [_rounded(found.path[:, n].astype(np.float64)) for n in range(found.count)]
        (staging / "drags.json").write_text(json.dumps(drags) + "\n", encoding="utf-8")
        return ["first_frame.png", "brush.png", "drags.json"]

    write_recorded_folder(f"{folder}/", _KNOWN, write)


TRAJECTORIES: dict[str, Callable[[Motion, Picture, StrPath], None]] = {
    "drag-anything": save_drag_anything,
    "motion-i2v": save_motion_i2v,
}
"""What writes each format, by its name."""


def check_trajectories(folder: StrPath) -> None:
    """Refuse a folder that could not be written, before the work.

    Raises:
        InvalidInputError: it holds files of those names that we did not write, or nothing can be written there.
    """
    check_recorded_folder(f"{folder}/", _KNOWN)


def body_masks(motion: Motion, frame: int = 0) -> list[NDArray[np.bool_]]:
    """Where each body is seen in a frame, behind those in front of it, shape [h, w] each."""
    masks = []
    start = 0
    for body in motion.bodies:
        corners = motion.positions[frame, start : start + len(body.mesh.vertices)][body.mesh.triangles]
        start += len(body.mesh.vertices)
        mask = np.zeros((motion.height, motion.width), np.uint8)
        for triangle in np.rint((np.asarray(corners, np.float64) - 0.5) * 16).astype(np.int32):
            cv2.fillConvexPoly(mask, triangle, 1, cv2.LINE_8, 4)
        masks.append((mask > 0) & ~(body.cover if body.cover is not None else np.False_))
    hidden = np.zeros((motion.height, motion.width), bool)
    for number in reversed(layer_order(motion.bodies)):
        masks[number], hidden = masks[number] & ~hidden, hidden | masks[number]
    return masks


def _telling(paths: NDArray[Any], mask: NDArray[np.bool_]) -> int:
    """Which of places [t, n, 2] stands for a body: deep inside it, and moved far."""
    depth = cv2.distanceTransform(np.pad(mask, 1).astype(np.uint8), cv2.DIST_L2, 5)[1:-1, 1:-1]
    height, width = mask.shape
    columns = np.clip(paths[0, :, 0].astype(int), 0, width - 1)
    rows = np.clip(paths[0, :, 1].astype(int), 0, height - 1)
    moved = np.linalg.norm(paths - paths[:1], axis=2).mean(axis=0)
    inside = depth[rows, columns]
    return int(np.argmax(inside * moved if (inside * moved).any() else inside))


def _rounded(path: NDArray[Any]) -> list[list[float]]:
    """As the scripts take them: they cut off the fraction, which makes pixel numbers of our positions."""
    return [[round(float(x), 2), round(float(y), 2)] for x, y in path]


def _covering(picture: NDArray[Any], width: int, height: int, how: int) -> NDArray[Any]:
    """Scaled until it covers the size, and cut to its middle."""
    rows, columns = picture.shape[:2]
    ratio = max(width / columns, height / rows)
    large = cv2.resize(
        picture, (max(width, round(columns * ratio)), max(height, round(rows * ratio))), interpolation=how
    )
    top, left = (large.shape[0] - height) // 2, (large.shape[1] - width) // 2
    return np.ascontiguousarray(large[top : top + height, left : left + width])


def _check_size(motion: Motion, picture: Picture) -> None:
    if picture.shape != (motion.height, motion.width, 3):
        raise InvalidInputError(
            f"picture must be RGB of the motion's size, {motion.width} x {motion.height} px. Got: {picture.shape}"
        )
