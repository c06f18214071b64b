"""In-betweens along a known motion: every pixel is fetched from where it is in both keyframes.

On a body, the deformed mesh of the in-between says where each pixel lies in either keyframe; both are read there
and mixed by time. Beside the bodies, each pixel comes from a keyframe in which no body covers it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.mesh import PixelBox, bounding_box, interpolate, triangle_ids
from ...physics.motion import Motion, layer_order
from ..pictures import as_dtype, nearest_pixels
from .backend import Clip, FloatImage, ModelFile

__all__ = ["MotionInterpolator"]

Mask = NDArray[np.bool_]

# Outlines and soft edges reach this far out of a mesh [px].
_RIM = 2
# How many other keyframes are searched for background that neither of the two shows.
_FURTHER_KEYFRAMES = 4
_HALF = 0.5


class MotionInterpolator:
    """In-betweens along the known motion of the bodies."""

    name = "motion"
    description = "Follows the simulated motion: sharp, exact, and without files"
    requires: tuple[ModelFile, ...] = ()

    def in_betweens(self, clip: Clip, number: int) -> Iterator[NDArray[Any]]:
        """Yield the frames between two keyframes."""
        first, last = _Keyframe(clip, number), _Keyframe(clip, number + 1)
        hidden = ~(first.free | last.free)
        plate = _plate(clip, number, first, last) if hidden.any() else first.picture
        masks = [_resized(mask, clip.size) for mask in clip.masks]
        for frame, place in clip.times(number):
            picture = np.where(hidden[..., None], plate, _mixed(first, last, place))
            for rank, body in enumerate(layer_order(first.motion.bodies)):
                mask = masks[body] if masks else None
                _draw_body(picture, _BodyPose(clip, body, rank, frame), first, last, place, mask)
            yield as_dtype(picture, clip.keyframes[number].dtype)


def _motion_of(clip: Clip) -> Motion:
    if clip.motion is None:
        raise InvalidInputError("backend 'motion' needs the motion of the clip. Got: none")
    return clip.motion


class _Keyframe:
    """A keyframe and which body covers which of its pixels."""

    def __init__(self, clip: Clip, number: int) -> None:
        self.motion = _motion_of(clip)
        self.picture = clip.keyframe(number)
        self.frame = clip.indices[number]
        self.rank, touched = _ranks(clip, self.frame)
        self.free = ~touched


def _positions(clip: Clip, body: int, frame: int) -> NDArray[np.float64]:
    """Vertices of a body in a frame [px of the keyframes], which may be of another size than the drawing."""
    motion = _motion_of(clip)
    scale = np.array(clip.size) / (motion.width, motion.height)
    return motion.of_body(body)[frame] * scale


def _ranks(clip: Clip, frame: int) -> tuple[NDArray[np.int32], Mask]:
    """Which body, counted from the back, covers each pixel in front, -1 for none; and what bodies and their rims touch.

    Shape [h, w] each.
    """
    motion, (width, height) = _motion_of(clip), clip.size
    ranks, picture = np.full((height, width), -1, dtype=np.int32), PixelBox(0, 0, width, height)
    touched = np.zeros((height, width), dtype=bool)
    for rank, body in enumerate(layer_order(motion.bodies)):
        here = triangle_ids(_positions(clip, body, frame), motion.bodies[body].mesh.triangles, picture) >= 0
        cover = _cover(clip, body)
        ranks[here] = rank
        ranks[here & cover] = -1  # something still is in front, which each keyframe shows
        touched |= (_widened(here & ~cover) > 0) & ~cover
    return ranks, touched


def _cover(clip: Clip, body: int) -> Mask:
    """Where something still is in front of a body, shape [h, w] of the keyframes."""
    width, height = clip.size
    cover = _motion_of(clip).bodies[body].cover
    if cover is None:
        return np.zeros((height, width), dtype=bool)
    return cv2.resize(cover.astype(np.float32), (width, height), interpolation=cv2.INTER_AREA) >= _HALF


def _widened(mask: Mask, by: int = _RIM) -> NDArray[np.uint8]:
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * by + 1, 2 * by + 1))
    return cv2.dilate(mask.astype(np.uint8), kernel)


def _mixed(first: _Keyframe, last: _Keyframe, place: float) -> FloatImage:
    """What is behind the bodies, from the keyframe that shows it, or from both by time."""
    share = np.where(last.free, np.where(first.free, np.float32(place), np.float32(1)), np.float32(0))
    return first.picture + share[..., None] * (last.picture - first.picture)


def _plate(clip: Clip, number: int, first: _Keyframe, last: _Keyframe) -> FloatImage:
    """Background from further keyframes, the nearest in time first, and from the nearest pixel where none shows it."""
    picture, known = _mixed(first, last, 0.5), first.free | last.free
    others = sorted(set(range(len(clip.keyframes))) - {number, number + 1}, key=lambda k: abs(k - number - 0.5))
    for other in others[:_FURTHER_KEYFRAMES]:
        keyframe = _Keyframe(clip, other)
        new = keyframe.free & ~known
        picture[new] = keyframe.picture[new]
        known |= new
    if not known.any() or known.all():
        return picture
    nearest = picture.reshape(-1, picture.shape[2])[nearest_pixels(known)[1]]
    # Streaks from single pixels are smoothed away.
    filled = cv2.GaussianBlur(nearest, (0, 0), 3)
    return np.where(known[..., None], picture, filled)


def _resized(mask: NDArray[Any], size: tuple[int, int]) -> FloatImage:
    return cv2.resize(np.asarray(mask, np.float32), size, interpolation=cv2.INTER_AREA)


class _BodyPose:
    """Where one body is in one frame, and where its pixels are in other frames."""

    def __init__(self, clip: Clip, body: int, rank: int, frame: int) -> None:
        self.clip, self.body, self.rank = clip, body, rank
        self.points = _positions(clip, body, frame)
        self.triangles = _motion_of(clip).bodies[body].mesh.triangles
        self.box = bounding_box(self.points, margin=_RIM + 2).clipped(*clip.size)

    def maps_to(self, others: list[NDArray[np.float64]]) -> tuple[Mask, list[FloatImage]]:
        """Pixels that the body covers, and for each of some other positions of its vertices the map to there.

        Maps hold the index coordinates that cv2.remap expects, shape [box height, box width, 2], and reach over the
        body's rim too.
        """
        values = np.concatenate([other - self.points for other in others], axis=1)
        planes = interpolate(self.points, self.triangles, values, self.box)
        covered = np.isfinite(planes[0])
        planes = np.where(covered, planes, 0)
        size = (2 * _RIM + 3, 2 * _RIM + 3)
        near = cv2.boxFilter(covered.astype(np.float32), -1, size, normalize=False, borderType=cv2.BORDER_CONSTANT)
        rim = ~covered & (near > 0.5)
        for plane in planes:
            total = cv2.boxFilter(plane, -1, size, normalize=False, borderType=cv2.BORDER_CONSTANT)
            plane[rim] = total[rim] / near[rim]
        columns = np.arange(self.box.left, self.box.right, dtype=np.float32)[None, :]
        rows = np.arange(self.box.top, self.box.bottom, dtype=np.float32)[:, None]
        return covered, [
            np.dstack([planes[2 * k] + columns, planes[2 * k + 1] + rows]).astype(np.float32)
            for k in range(len(others))
        ]


def _draw_body(
    picture: FloatImage, pose: _BodyPose, first: _Keyframe, last: _Keyframe, place: float, mask: FloatImage | None
) -> None:
    """Lay one body over the picture, its colours fetched from both keyframes."""
    if not (pose.box.width and pose.box.height):
        return
    motion, clip = first.motion, pose.clip
    rest = motion.bodies[pose.body].mesh.rescaled(*clip.size).vertices
    others = [_positions(clip, pose.body, first.frame), _positions(clip, pose.body, last.frame), rest]
    covered, (to_first, to_last, to_rest) = pose.maps_to(others)
    cover = _cover(clip, pose.body)
    weight_first = _visible(first, to_first, pose.rank, cover) * np.float32(1 - place)
    weight_last = _visible(last, to_last, pose.rank, cover) * np.float32(place)
    share = (weight_last / (weight_first + weight_last))[..., None]
    colour = _read(first.picture, to_first, cv2.INTER_CUBIC)
    colour += share * (_read(last.picture, to_last, cv2.INTER_CUBIC) - colour)
    alpha = _widened(covered, 1).astype(np.float32) if mask is None else _read(mask, to_rest, cv2.INTER_LINEAR)
    if mask is None:
        alpha = cv2.GaussianBlur(alpha, (0, 0), 0.7)
    else:
        alpha *= _widened(covered)
    alpha *= ~cover[pose.box.slices]
    below = picture[pose.box.slices]
    below += alpha[..., None] * (colour - below)


def _read(picture: FloatImage, at: FloatImage, method: int) -> FloatImage:
    read = cv2.remap(picture, at, None, method, borderMode=cv2.BORDER_REPLICATE)
    # Where resampling goes beyond an alpha of 1, premultiplied colours go along.
    return read / np.maximum(read[..., 3:], 1) if read.ndim == 3 and read.shape[2] == 4 else read


def _visible(keyframe: _Keyframe, at: FloatImage, rank: int, cover: Mask) -> FloatImage:
    """1 where a keyframe shows a body's pixel, next to 0 where anything hides it or it lies off the picture."""
    height, width = keyframe.rank.shape
    ranks = keyframe.rank.astype(np.float32)
    ranks = np.where(cover, np.float32(np.inf), ranks)
    seen = cv2.remap(ranks, at, None, cv2.INTER_NEAREST, borderMode=cv2.BORDER_REPLICATE) <= rank
    x, y = at[..., 0], at[..., 1]
    seen &= (x > -1) & (x < width) & (y > -1) & (y < height)
    return np.where(seen, np.float32(1), np.float32(1e-6))
