"""Tracks on a picture: each point as a dot with a tail of where it came from."""

from __future__ import annotations

import colorsys
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require
from ...physics.motion import Fit, Tracks
from ..pictures import as_float, as_picture
from .canvas import DARK, FRACTION_BITS, canvas_from, fixed_point, scale_to

__all__ = ["draw_tracks", "reframed"]

_GREY = (200, 205, 215)
_STILL = 0.5  # [px]: a track that spans less does not move


def reframed(image: NDArray[Any], width: int, height: int, fit: Fit) -> NDArray[Any]:
    """A picture brought to another size as tracks are.

    Args:
        image: uint8 or float, shape [h, w, 3].
        width: wanted width [px].
        height: wanted height [px].
        fit: scaled to cover the size and cut to its middle, or stretched.

    Returns:
        The picture, shape [height, width, 3], same type.
    """
    scale = np.array([width / image.shape[1], height / image.shape[0]])
    if fit == "crop":
        scale[:] = scale.max()
        shown = np.rint(np.array([width, height]) / scale).astype(int)
        left, top = (np.array(image.shape[1::-1]) - shown) // 2
        image = image[top : top + shown[1], left : left + shown[0]]
    smaller = scale.max() < 1
    return cv2.resize(image, (width, height), interpolation=cv2.INTER_AREA if smaller else cv2.INTER_LINEAR)


def draw_tracks(image: NDArray[Any], tracks: Tracks, sample: int, *, tail: int = 16) -> NDArray[Any]:
    """The picture with the tracks at one time.

    Moving points have a colour each and a tail that fades and narrows; hidden ones are rings without a tail; points
    that stand still are grey.

    Args:
        image: what the tracks belong to, RGB, uint8 or float in 0..1, shape [h, w, 3]; of any size.
        tracks: where points are.
        sample: number of the time.
        tail: how many samples back the tails reach.

    Returns:
        A new picture of the same size and type.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion, tracks
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.overlays import draw_tracks
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> draw_tracks(picture, tracks(motion, points=4, static_points=0), sample=1).dtype
        dtype('uint8')
    """
    require("sample", sample, 0 <= sample < len(tracks), f"0 to {len(tracks) - 1}")
    canvas = canvas_from(image)
    path = tracks.path.astype(np.float64) * scale_to(canvas, tracks.width, tracks.height)
    unit = max(canvas.shape[:2]) / 1280
    colours = _colours(path)
    first = max(0, sample - tail)
    for number, colour in enumerate(colours):
        if colour != _GREY and tracks.visibility[sample, number]:
            _tail(canvas, path[first : sample + 1, number], colour, unit)
    for number, colour in enumerate(colours):
        radius = unit * (3.5 if colour == _GREY else 5.5)
        _dot(canvas, path[sample, number], colour, radius, filled=bool(tracks.visibility[sample, number]))
    return canvas if as_picture(image).dtype == np.uint8 else as_float(canvas)


def _colours(path: NDArray[np.float64]) -> list[tuple[int, int, int]]:
    """A colour for each point: far apart for neighbours in order, grey for what stands still."""
    moves = (path.max(axis=0) - path.min(axis=0)).max(axis=1) > _STILL
    # Steps of the golden ratio: each hue falls into the widest gap that earlier ones leave.
    hues = (0.618034 * np.arange(len(moves))) % 1.0
    bright = [tuple(round(255 * part) for part in colorsys.hsv_to_rgb(hue, 0.75, 1.0)) for hue in hues]
    return [(red, green, blue) if moved else _GREY for (red, green, blue), moved in zip(bright, moves, strict=True)]


def _tail(canvas: NDArray[np.uint8], line: NDArray[np.float64], colour: tuple[int, int, int], unit: float) -> None:
    steps = len(line) - 1
    for number in range(steps):
        strength = (number + 1) / steps
        segment = fixed_point(line[number : number + 2])
        low = np.maximum(segment.min(axis=0) // 2**FRACTION_BITS - 12, 0)
        high = segment.max(axis=0) // 2**FRACTION_BITS + 12
        patch = canvas[low[1] : high[1], low[0] : high[0]]
        if not patch.size:
            continue
        drawn = patch.copy()
        width = max(1, round(unit * 5 * strength))
        cv2.polylines(drawn, [segment - low * 2**FRACTION_BITS], False, colour, width, cv2.LINE_AA, FRACTION_BITS)
        cv2.addWeighted(drawn, strength, patch, 1 - strength, 0, dst=drawn)
        patch[:] = drawn


def _dot(
    canvas: NDArray[np.uint8],
    centre: NDArray[np.float64],
    colour: tuple[int, int, int],
    radius: float,
    *,
    filled: bool,
) -> None:
    x, y = (int(value) for value in fixed_point(centre))
    sixteenths = round(radius * 2**FRACTION_BITS)
    if filled:
        cv2.circle(canvas, (x, y), sixteenths + 20, DARK, -1, cv2.LINE_AA, FRACTION_BITS)
        cv2.circle(canvas, (x, y), sixteenths, colour, -1, cv2.LINE_AA, FRACTION_BITS)
    else:
        cv2.circle(canvas, (x, y), sixteenths, colour, 1, cv2.LINE_AA, FRACTION_BITS)
