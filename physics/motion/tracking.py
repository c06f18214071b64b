"""Tracks: the paths of a few points, as motion-controlled video models take them.

Points on the bodies lead the motion; points of the background that no body ever covers tell the model what stands
still.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ..errors import require
from .flow import layer_order
from .motion import Motion
from .resampling import INTERPOLATIONS, Interpolation, frame_at, sample_times
from .track_points import BodyPoints, Frame, background_points, body_points

__all__ = ["FITS", "MOST_TRACKS", "Fit", "Tracks", "check_track_options", "tracks"]

FloatArray = NDArray[np.float64]

Fit = Literal["crop", "stretch"]
"""How the illustration comes to another size: scaled to cover it and cut to its middle, or stretched."""
FITS: tuple[Fit, ...] = get_args(Fit)

MOST_TRACKS = 4096
_RANGES = {
    "points": (1, MOST_TRACKS, ""),
    "static_points": (0, MOST_TRACKS, ""),
    "frames": (1, 10_000, ""),
    "width": (1, 16_384, " px"),
    "height": (1, 16_384, " px"),
}


@dataclass(frozen=True, eq=False)
class Tracks:
    """Where points are over time.

    Attributes:
        path: positions [px], x right, y down, pixel centres at integer + 0.5, float32, shape [t, n, 2]; those of the
            background come last. Positions outside the picture stay as they are.
        visibility: false where a point is outside the picture or hidden by a body in front, bool, shape [t, n].
        width: of the picture that they belong to [px].
        height: of that picture [px].
        frame_rate: samples a second.
    """

    path: NDArray[np.float32]
    visibility: NDArray[np.bool_]
    width: int
    height: int
    frame_rate: float

    def __len__(self) -> int:
        """Number of samples over time."""
        return len(self.path)

    @property
    def count(self) -> int:
        """Number of points."""
        return self.path.shape[1]

    def to_json(self, *, decimals: int = 2) -> str:
        """The paths as ``[[{"x": 12.5, "y": 40.25}, ...], ...]``: a list of samples for each point.

        The text knows no visibility; what reads it takes every point as visible.

        Args:
            decimals: of the coordinates.
        """
        rounded = self.path.astype(np.float64).round(decimals).transpose(1, 0, 2).tolist()
        return json.dumps([[{"x": x, "y": y} for x, y in line] for line in rounded], separators=(",", ":"))


def tracks(
    motion: Motion,
    *,
    points: int = 64,
    static_points: int = 16,
    frames: int | None = None,
    width: int | None = None,
    height: int | None = None,
    fit: Fit = "crop",
    weighting: float = 0.5,
    interpolation: Interpolation = "cubic",
) -> Tracks:
    """Follow points of a motion; equal inputs give equal tracks.

    Args:
        motion: how the bodies move. Points begin where they can be seen in its first frame.
        points: points on the bodies, by farthest-point sampling; fewer where the bodies have fewer pixels.
        static_points: points of the background that no body reaches; fewer where there is less room.
        frames: samples over the whole motion, from its first frame to its last; one a frame when None.
        width: of the picture that the tracks are for [px]; the illustration's when None.
        height: of that picture [px]; the illustration's when None.
        fit: how the illustration comes to that size.
        weighting: how much denser the points lie where the bodies move more; 0 covers the bodies evenly, at 0.5 their
            number grows with the movement, at 1 with its square.
        interpolation: between two frames.

    Raises:
        InvalidInputError: an option is out of its range, or no body can be seen in the first frame.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion, tracks
        >>> from physanimator.physics.scene import Body
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> found = tracks(motion, points=4, static_points=2)
        >>> found.path.shape
        (2, 6, 2)
    """
    frames = len(motion) if frames is None else frames
    size = (motion.width if width is None else width, motion.height if height is None else height)
    check_track_options(points=points, static_points=static_points, frames=frames, width=size[0], height=size[1])
    require("fit", fit, fit in FITS, f"one of {', '.join(FITS)}")
    require("weighting", weighting, 0 <= weighting <= 8, "0 to 8")
    require("interpolation", interpolation, interpolation in INTERPOLATIONS, f"one of {', '.join(INTERPOLATIONS)}")
    scale, frame = _placed(motion, size, fit)
    followed = body_points(motion, points, frame=frame, weighting=weighting)
    still = background_points(motion, static_points, frame=frame)
    paths, seen = [], []
    for time in sample_times(len(motion), frames):
        positions = frame_at(motion.positions, time, interpolation)
        moved = followed.at(positions)
        paths.append(np.concatenate([moved, still]))
        seen.append(
            np.concatenate([frame.holds(moved) & ~_hidden(motion, followed, positions, moved), still[:, 0] >= 0])
        )
    path = (np.stack(paths) - (frame.left, frame.top)) * scale
    rate = motion.frame_rate * (frames - 1) / (len(motion) - 1) if len(motion) > 1 and frames > 1 else motion.frame_rate
    return Tracks(path.astype(np.float32), np.stack(seen), *size, rate)


def check_track_options(**numbers: int | None) -> None:
    """Refuse numbers that :func:`tracks` would refuse, before any long work; None passes.

    Args:
        numbers: any of points, static_points, frames, width and height.

    Raises:
        InvalidInputError: one is out of its range.
    """
    for name, number in numbers.items():
        least, most, unit = _RANGES[name]
        require(name, number, number is None or least <= number <= most, f"{least} to {most}{unit}")


def _placed(motion: Motion, size: tuple[int, int], fit: Fit) -> tuple[FloatArray, Frame]:
    """Scale in x and y, and the part of the illustration that the picture shows."""
    scale = np.array([size[0] / motion.width, size[1] / motion.height])
    if fit == "crop":
        scale[:] = scale.max()
    shown = np.array(size) / scale
    left, top = (np.array([motion.width, motion.height]) - shown) / 2
    return scale, Frame(left, top, left + shown[0], top + shown[1])


def _hidden(motion: Motion, followed: BodyPoints, positions: FloatArray, moved: FloatArray) -> NDArray[np.bool_]:
    """Whether each point lies behind something still, or in a triangle of a body in front of its own, shape [n]."""
    rank = np.argsort(layer_order(motion.bodies))
    starts = np.cumsum([0] + [len(body.mesh.vertices) for body in motion.bodies])
    hidden = np.zeros(len(moved), dtype=bool)
    for number, body in enumerate(motion.bodies):
        behind = np.flatnonzero(rank[followed.body] < rank[number])
        if len(behind):
            hidden[behind] |= _covered(moved[behind], positions[starts[number] :][body.mesh.triangles])
        if body.cover is not None:
            own = np.flatnonzero(followed.body == number)
            column, row = np.floor(moved[own]).astype(np.int64).T
            height, width = body.cover.shape
            within = (column >= 0) & (column < width) & (row >= 0) & (row < height)
            hidden[own[within]] |= body.cover[row[within], column[within]]
    return hidden


def _covered(points: FloatArray, triangles: FloatArray) -> NDArray[np.bool_]:
    """Whether each point, shape [n, 2], lies in one of the triangles, whichever way they wind, shape [t, 3, 2]."""
    from scipy.spatial import cKDTree

    centres = triangles.mean(axis=1)
    reach = np.hypot(*(triangles - centres[:, None]).transpose(2, 0, 1)).max()
    near = cKDTree(centres).query_ball_point(points, reach * (1 + 1e-9))
    which = np.repeat(np.arange(len(points)), [len(each) for each in near])
    corners = triangles[np.concatenate([*near, []]).astype(np.int64)]
    along, across = np.roll(corners, -1, axis=1) - corners, points[which, None] - corners
    side = along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0]
    inside = (side >= 0).all(axis=1) | (side <= 0).all(axis=1)
    covered = np.zeros(len(points), dtype=bool)
    covered[which[inside]] = True
    return covered
