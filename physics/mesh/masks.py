"""Masks made ready for meshing: read, fitted to the picture, continued past its border, freed of too fine details."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..arrays import OVERSHOOT, as_array, beyond_one
from ..errors import InvalidInputError, MeshingError

__all__ = [
    "continued",
    "coverage_of",
    "distance_to_zero",
    "fitted",
    "largest_area",
    "may_be_inverted",
    "refuse_noise",
    "with_sound_details",
    "without_specks",
]

Coverage = NDArray[np.float32]
"""A soft mask in 0 to 1, shape [h, w]; what is above one half belongs to the shape."""

_ASPECT_TOLERANCE = 0.01
_NEARLY_ALL = 0.9
# Areas below this are specks [px^2]; so many of them are noise, where most of their colour is narrower than 3 px.
_SPECK, _MANY_SPECKS = 16, 1000
_MOSTLY = 0.5
# A disc of radius r leaves a square corner uncovered up to 0.41 r away; such corners are not thin parts.
_CORNER = 0.5
_PIXELATION = 0.25


def coverage_of(mask: ArrayLike, *, name: str = "mask") -> Coverage:
    """A mask as numbers from 0 to 1.

    Args:
        mask: bool; whole numbers 0 to 255, or 0 to 65535, or 0 and 1 only; or floating-point numbers 0 to 1, which may
            overshoot a little as resampling leaves them. An array, a tensor or a Pillow picture of shape [h, w],
            [h, w, 1] or [1, h, w].
        name: what the caller calls the mask, for messages.

    Returns:
        Coverage, float32, shape [h, w].

    Raises:
        MeshingError: it is none of these, or whole numbers that count labels instead of saying how much is covered.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import coverage_of
        >>> coverage_of(np.array([[0, 255]], np.uint8)).tolist()
        [[0.0, 1.0]]
    """
    try:
        values = as_array(mask, name)
    except InvalidInputError as error:
        raise MeshingError(str(error)) from error
    if values.ndim == 3 and 1 in (values.shape[0], values.shape[2]):
        values = values.reshape(values.shape[:2] if values.shape[2] == 1 else values.shape[1:])
    if values.ndim != 2 or values.size == 0:
        raise MeshingError(f"{name} must be one plane of shape [height, width]. Got: shape {values.shape}")
    if values.dtype == np.bool_:
        return values.astype(np.float32)
    if np.issubdtype(values.dtype, np.integer):
        return _from_whole_numbers(values, name)
    low, high = float(values.min()), float(values.max())  # NaN if any value is
    if not (np.isfinite(low) and np.isfinite(high)):
        raise MeshingError(f"{name} must hold finite numbers. Got: NaN or infinity")
    if low < -OVERSHOOT or high > 1 + OVERSHOOT:
        raise MeshingError(f"{name} must hold {beyond_one(low, high)}")
    coverage = values.astype(np.float32)
    return coverage if low >= 0 and high <= 1 else np.clip(coverage, 0, 1)


def _from_whole_numbers(values: NDArray[Any], name: str) -> Coverage:
    low, high = int(values.min()), int(values.max())
    full = 1 if high <= 1 else 255 if high <= 255 else 65535
    # Labels are small numbers: at these values nothing would be even half covered.
    if low < 0 or high > 65535 or 1 < high < full / 2:
        raise MeshingError(
            f"{name} must hold whole numbers from 0 to 255 (or to 65535), the highest where the part is; of labels"
            f" choose one, as in mask == 1. Got: {low} to {high}"
        )
    return values.astype(np.float32) / np.float32(full)


def fitted(coverage: Coverage, width: int, height: int, *, name: str = "mask") -> Coverage:
    """The mask at the picture's size [px]: one of the same proportions is scaled, softly.

    Raises:
        MeshingError: its proportions differ from the picture's by more than a hundredth, or by more than a pixel.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import fitted
        >>> fitted(np.ones((30, 40), np.float32), 80, 60).shape
        (60, 80)
    """
    rows, columns = coverage.shape
    if (rows, columns) == (height, width):
        return coverage
    smaller = min(columns / width, rows / height)
    off = max(abs(columns - width * smaller), abs(rows - height * smaller))  # [px of the mask]
    if off > 1 and abs(columns * height / (rows * width) - 1) > _ASPECT_TOLERANCE:
        raise MeshingError(
            f"{name} must have the picture's size or at least its proportions ({width} x {height} px)."
            f" Got: {columns} x {rows} px"
        )
    method = cv2.INTER_AREA if columns > width else cv2.INTER_LINEAR
    return np.asarray(cv2.resize(coverage, (width, height), interpolation=method), dtype=np.float32)


def may_be_inverted(coverage: Coverage) -> bool:
    """Whether a mask covers most of the picture, up to its border, as one does whose black and white are exchanged."""
    inside = coverage > 0.5
    share = float(inside.mean())
    border = np.concatenate([inside[0], inside[-1], inside[:, 0], inside[:, -1]])
    return share > _NEARLY_ALL or (share > 0.5 and float(border.mean()) > 0.5)


def refuse_noise(coverage: Coverage) -> None:
    """
    Raises:
        MeshingError: the mask is noise: white or black is hardly more than specks of the other's, by the thousand.
    """
    inside = (coverage > 0.5).astype(np.uint8)
    for colour, plane in (("white", inside), ("black", 1 - inside)):
        opened = cv2.morphologyEx(plane, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8), borderValue=0)
        if cv2.countNonZero(opened) >= _MOSTLY * cv2.countNonZero(plane):
            continue
        specks = int(np.count_nonzero(_parts(plane > 0, connectivity=4)[1] < _SPECK))
        if specks > _MANY_SPECKS:
            raise MeshingError(
                f"mask must show parts in even white. Got: {specks} specks of {colour}, as noise makes them"
            )


def largest_area(coverage: NDArray[Any]) -> int:
    """Area of the largest connected part of a mask [px^2], 0 where nothing is white.

    Args:
        coverage: bool, or 0 to 1 of which what is above one half is white; shape [h, w].
    """
    inside = coverage > 0.5
    return int(_parts(inside, connectivity=8)[1].max()) if inside.any() else 0


def without_specks(coverage: Coverage, smallest_part: float) -> Coverage:
    """The mask without connected parts below an area [px^2].

    Raises:
        MeshingError: nothing remains.
    """
    inside = coverage > 0.5
    if not inside.any():
        raise MeshingError("mask must show what is to move in white. Got: a mask without any white")
    labels, areas = _parts(inside, connectivity=8)
    small = areas < smallest_part
    if small.all():
        raise MeshingError(
            f"mask must have a white part of at least {smallest_part:g} px^2. Got: the largest has {areas.max()} px^2"
        )
    return np.where(np.append(False, small)[labels], np.float32(0), coverage) if small.any() else coverage


def continued(coverage: Coverage, margin: int, room: int) -> tuple[Coverage, NDArray[np.float64]]:
    """The mask continued past the picture's border, cropped to what is white, with room around it.

    Args:
        coverage: the mask, not empty.
        margin: how far white that touches the border goes on beyond it [px].
        room: width of the black frame around the white [px].

    Returns:
        The crop, and the position of its upper left corner [px], shape [2].
    """
    inside = coverage > 0.5
    rows, columns = np.nonzero(inside.any(axis=1))[0], np.nonzero(inside.any(axis=0))[0]
    low, high = np.array([rows[0], columns[0]]), np.array([rows[-1], columns[-1]]) + 1
    limit = np.array(coverage.shape)
    # One pixel more than the white keeps the soft outer half of its edge.
    first, last = np.maximum(low - 1, 0), np.minimum(high + 1, limit)
    before, after = margin * (low == 0), margin * (high == limit)
    crop = coverage[first[0] : last[0], first[1] : last[1]]
    crop = np.pad(crop, tuple(zip(before, after, strict=True)), mode="edge")
    return np.pad(crop, room), (first - before - room)[::-1].astype(np.float64)


def with_sound_details(coverage: Coverage, *, thinnest: float, narrowest: float, smallest_hole: float) -> Coverage:
    """The mask with nothing finer than triangles can follow.

    Parts thinner than ``thinnest`` [px] are widened to it rather than dropped, so that nothing loses its hold; gaps
    narrower than ``narrowest`` [px] and holes below ``smallest_hole`` [px^2] are filled. All else stays as it is,
    at sub-pixel accuracy. The mask must have a black frame.
    """
    inside = coverage > 0.5
    wanted = _without_narrow_gaps(_without_thin_parts(inside, thinnest / 2), narrowest / 2)
    labels, areas = _parts(~wanted, connectivity=4)
    wanted |= np.append(False, areas < smallest_hole)[labels]
    added = wanted & ~inside
    return np.where(added, np.float32(1), coverage) if added.any() else coverage


def distance_to_zero(shape: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Distance from each cell's centre to the nearest centre of a false cell [cells] within 2 %, shape [h, w]."""
    distance = cv2.distanceTransform(shape.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    return np.asarray(distance, dtype=np.float32)


def _without_thin_parts(inside: NDArray[np.bool_], radius: float) -> NDArray[np.bool_]:
    """The shape united with discs along the middle of its parts into which no such disc fits."""
    depth = distance_to_zero(inside) - 0.5
    core = depth >= radius
    thin = inside & (distance_to_zero(~core) > (1 + _CORNER) * radius + _PIXELATION) if core.any() else inside
    if not thin.any():
        return inside
    middle = thin & (depth >= cv2.dilate(depth, np.ones((3, 3), np.uint8)) - 0.3)
    return inside | (distance_to_zero(~middle) <= radius)


def _without_narrow_gaps(inside: NDArray[np.bool_], radius: float) -> NDArray[np.bool_]:
    """The shape united with all outside of it that no disc reaches which stays outside."""
    free = distance_to_zero(~inside) - 0.5 >= radius
    return inside | (distance_to_zero(~free) > radius + 0.5)


def _parts(shape: NDArray[np.bool_], *, connectivity: int) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Number of the connected part at each pixel (0: none), shape [h, w], and the area of part 1, 2, ... [px^2]."""
    count, labels = cv2.connectedComponents(shape.astype(np.uint8), connectivity=connectivity)
    return np.asarray(labels, dtype=np.int32), np.bincount(labels.reshape(-1), minlength=count)[1:]
