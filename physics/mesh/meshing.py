"""Mask -> TriangleMesh: contours, spacing by local width, conforming Delaunay triangulation."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import MeshingError, require
from ..process_end import working
from .contours import area_of, contours_at_half, resampled, smoothed
from .masks import continued, coverage_of, fitted, largest_area, refuse_noise, with_sound_details, without_specks
from .spacing import GAP_FACTOR, SpacingField, spacing_field
from .triangle_mesh import UNITS_ACROSS, TriangleMesh
from .triangulation import CrossingEdgesError, interior_seeds, morton_order, triangulate

__all__ = ["LEAST_SPACING", "MOST_TRIANGLES", "SMALLEST_PART", "mesh_from_mask"]

FloatArray = NDArray[np.float64]

MOST_TRIANGLES = 200_000
"""A mesh that would have more is refused."""

LEAST_SPACING = 2.0
"""The least distance of vertices that can be asked for [px]."""

SMALLEST_PART = 4
"""The least area of a white part that becomes a mesh, unless another is asked for [px^2]."""

_WANTED_TRIANGLES = 2000
_MOST_PIXELS = 2**27  # of a mask that is continued past the border, with room around it
_EQUILATERAL = np.sqrt(3) / 4
# Bounds of the spacings that are chosen here, in pixels and in units (see ``UNITS_ACROSS``).
_LEAST_SPACING_PX, _LEAST_SPACING = 5.0, 0.0075
_LEAST_FLOOR_PX, _MOST_FLOOR = 2.5, 0.0075
# Coarser triangles cannot make up for more thin parts than this.
_MOST_COARSENING = 2.0
_MARGIN = 0.04
# White that is smaller is meshed in so much larger pixels, in which triangles follow it as they follow larger parts.
_SMALL = 64.0  # [px], the diagonal of its box
# White parts below so many px^2 are specks, or below this share of the largest part if it is small.
_SPECK, _SPECK_SHARE = 16.0, 0.05
# Thinnest part and smoothing of outlines, in smallest spacings.
_THINNEST = 0.9
_SMOOTHING = 0.35
# Area of the smallest outline, in squares of the smallest spacing; a part that was widened to the thinnest has 0.34.
_SMALLEST_LOOP = 0.05
# Outlines that cross are sampled anew, so many times, each time at this fraction of the spacing.
_ATTEMPTS, _TIGHTER = 8, 0.7


@working()
def mesh_from_mask(
    mask: ArrayLike,
    *,
    spacing: float | None = None,
    width: int | None = None,
    height: int | None = None,
    min_angle: float = 25.0,
    elements_across: int = 3,
    smallest_spacing: float | None = None,
    border_margin: float | None = None,
    smallest_part: float | None = None,
    smallest_hole: float | None = None,
    uniform: bool = False,
) -> TriangleMesh:
    """A triangle mesh of the white parts of a mask (paper, Method, "Deformable Body Model").

    Outlines follow the mask at sub-pixel accuracy and are sampled evenly by arc length. The spacing shrinks where a
    part is thinner than ``elements_across`` elements, but never below ``smallest_spacing``, because the smallest
    triangle decides how many steps a simulation needs; parts thinner than that spacing are widened to it.

    Args:
        mask: bool, integers 0 to 255 or floats 0 to 1, shape [h, w]; white moves.
        spacing: largest distance between neighbouring vertices [px]; None chooses it for about
            2000 triangles or fewer, more where many parts are thin.
        width: width of the picture [px]; None means that of the mask.
        height: height of the picture [px]; None means that of the mask.
        min_angle: smallest angle of a triangle [degrees], except at sharp corners.
        elements_across: how many triangles thin strands get across.
        smallest_spacing: lower bound of the spacing in thin parts [px]; None chooses it from ``spacing``.
        border_margin: how far parts that touch the picture's border are continued past it [px], so that they can
            sway without opening a gap there; None chooses twice the spacing or 9 % of the white's own size.
        smallest_part: white parts below this area [px^2] are dropped; None means 16, or a twentieth of the largest
            part if that is less, but at least 4.
        smallest_hole: holes below this area [px^2] are filled; None means half of spacing squared.
        uniform: sample outlines at the same spacing everywhere, as the paper says, whatever ``elements_across`` and
            ``min_angle``: thin parts are then stiffer than they are. Outlines that would cross are all sampled more
            finely, and get points in between only where triangles would be very low.

    Raises:
        InvalidInputError: an option is out of range.
        MeshingError: the mask is unusable or noise, holds no white part that is large enough, does not have the
            picture's proportions, or would need too many triangles.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> mask = np.zeros((60, 80))
        >>> mask[10:50, 20:60] = 1
        >>> mesh = mesh_from_mask(mask, spacing=10)
        >>> mesh.width, mesh.height, len(mesh.triangles) > 20
        (80, 60, True)
    """
    options = _Options(
        spacing, min_angle, elements_across, smallest_spacing, border_margin, smallest_part, smallest_hole, uniform, 1.0
    )
    coverage = coverage_of(mask)
    height = coverage.shape[0] if height is None else height
    width = coverage.shape[1] if width is None else width
    for name, size in (("width", width), ("height", height)):
        require(name, size, size >= 1, "at least 1 px")
    coverage = fitted(coverage, width, height)
    refuse_noise(coverage)
    coverage = _without_specks(coverage, smallest_part)
    low, high, length = _box(coverage)
    corner, times = np.zeros(2), 1
    if length < _SMALL:
        times = int(np.ceil(_SMALL / length))
        coverage, corner = _enlarged(coverage, low, high, times)
        options, spacing = options.enlarged(times), spacing and spacing * times
    _require_bounded(options, (high - low) * times, times)
    options = replace(options, unit=length * times / UNITS_ACROSS)
    shape = _prepared(coverage, spacing, options) if spacing else _for_wanted_triangles(coverage, options)
    if shape.expected_triangles > MOST_TRIANGLES:
        raise MeshingError(
            f"spacing must be larger: a mesh may have at most {MOST_TRIANGLES} triangles."
            f" Got: {shape.field.values.max():.4g} px, which makes about {shape.expected_triangles:.0f}"
        )
    points, triangles = _meshed(shape, options)
    return _in_morton_order(points / times, triangles, shape.origin / times + corner, width, height)


def _require_bounded(options: _Options, sides: NDArray[np.int64], times: int) -> None:
    """Refuse lengths that would continue a part with these sides [px] to an area that no memory holds."""
    spacing, margin = options.spacing or 0.0, options.border_margin
    reach = spacing + (2 * spacing if margin is None else margin)
    if (int(sides[0]) + 2 * reach) * (int(sides[1]) + 2 * reach) > _MOST_PIXELS:
        name, value = ("spacing", spacing) if margin is None or spacing >= margin else ("border_margin", margin)
        height, width = sides // times
        raise MeshingError(
            f"{name} must be smaller than the part, which is {width} x {height} px. Got: {value / times:.4g} px"
        )


def _without_specks(coverage: NDArray[np.float32], smallest_part: float | None) -> NDArray[np.float32]:
    if smallest_part is None:
        smallest_part = max(SMALLEST_PART, min(_SPECK, _SPECK_SHARE * largest_area(coverage)))
    return without_specks(coverage, smallest_part)


def _box(coverage: NDArray[np.float32]) -> tuple[NDArray[np.int64], NDArray[np.int64], float]:
    """First and last but one row and column of the white, and the diagonal of its box [px]."""
    inside = coverage > 0.5
    rows, columns = np.nonzero(inside.any(axis=1))[0], np.nonzero(inside.any(axis=0))[0]
    low, high = np.array([rows[0], columns[0]]), np.array([rows[-1], columns[-1]]) + 1
    return low, high, float(np.hypot(*(high - low)))


def _enlarged(
    coverage: NDArray[np.float32], low: NDArray[np.int64], high: NDArray[np.int64], times: int
) -> tuple[NDArray[np.float32], FloatArray]:
    """The white of a mask in pixels of which so many are one across, and where its corner lies in the mask [px]."""
    first, last = np.maximum(low - 2, 0), np.minimum(high + 2, coverage.shape)
    crop = coverage[first[0] : last[0], first[1] : last[1]]
    return np.repeat(np.repeat(crop, times, axis=0), times, axis=1), first[::-1].astype(np.float64)


@dataclass(frozen=True)
class _Options:
    spacing: float | None
    min_angle: float
    elements_across: int
    smallest_spacing: float | None
    border_margin: float | None
    smallest_part: float | None
    smallest_hole: float | None
    uniform: bool
    unit: float

    def enlarged(self, times: int) -> _Options:
        """The same in pixels of which so many are one across."""
        longer = {
            name: value * times
            for name in ("spacing", "smallest_spacing", "border_margin")
            if (value := getattr(self, name)) is not None
        }
        hole = None if self.smallest_hole is None else self.smallest_hole * times**2
        return replace(self, smallest_hole=hole, **longer)

    def __post_init__(self) -> None:
        for name in ("spacing", "smallest_spacing"):
            value = getattr(self, name)
            require(name, value, value is None or LEAST_SPACING <= value < np.inf, f"at least {LEAST_SPACING:g} px")
        require("min_angle", self.min_angle, 0 <= self.min_angle <= 30, "0 to 30 degrees")
        require("elements_across", self.elements_across, 1 <= self.elements_across <= 20, "1 to 20")
        for name, unit in (("border_margin", "px"), ("smallest_hole", "px^2"), ("smallest_part", "px^2")):
            value = getattr(self, name)
            require(name, value, value is None or 0 <= value < np.inf, f"at least 0 {unit}")


@dataclass(frozen=True, eq=False)
class _Shape:
    """What is to be meshed: a soft mask, where its corner lies in the picture [px], and the wanted spacing."""

    coverage: NDArray[np.float32]
    origin: FloatArray
    field: SpacingField
    floor: float

    @property
    def inside(self) -> NDArray[np.bool_]:
        return self.coverage > 0.5

    @property
    def expected_triangles(self) -> float:
        return self.field.expected_triangles(self.inside)


def _prepared(coverage: NDArray[np.float32], spacing: float, options: _Options) -> _Shape:
    """The shape at one spacing [px]: continued past the border and freed of details below its triangles."""
    across, floor = options.elements_across, options.smallest_spacing
    if floor is None:
        floor = max(_LEAST_FLOOR_PX, min(spacing / across, _MOST_FLOOR * options.unit))
    floor = min(floor, spacing)
    margin = max(2 * spacing, _MARGIN * options.unit) if options.border_margin is None else options.border_margin
    smallest_hole = spacing**2 / 2 if options.smallest_hole is None else options.smallest_hole
    around, origin = continued(coverage, int(np.ceil(margin)), int(np.ceil(spacing)) + 2)
    sound = with_sound_details(
        around, thinnest=_THINNEST * floor, narrowest=floor / GAP_FACTOR, smallest_hole=smallest_hole
    )
    finest = spacing if options.uniform else floor
    field = spacing_field(sound > 0.5, spacing=spacing, floor=finest, elements_across=across)
    return _Shape(sound, origin, field, floor)


def _for_wanted_triangles(coverage: NDArray[np.float32], options: _Options) -> _Shape:
    """The shape at a spacing that needs no more triangles than wanted, or few more."""
    area = float(np.count_nonzero(coverage > 0.5))
    least = max(_LEAST_SPACING_PX, _LEAST_SPACING * options.unit, options.smallest_spacing or 0)
    first = spacing = max(least, float(np.sqrt(area / (_WANTED_TRIANGLES * _EQUILATERAL))))
    shape = _prepared(coverage, spacing, options)
    while shape.expected_triangles > _WANTED_TRIANGLES and spacing < _MOST_COARSENING * first:
        spacing *= 1.02 * np.sqrt(shape.expected_triangles / _WANTED_TRIANGLES)
        spacing = min(spacing, _MOST_COARSENING * first)
        shape = _prepared(coverage, spacing, options)
    return shape


def _meshed(shape: _Shape, options: _Options) -> tuple[FloatArray, NDArray[np.int64]]:
    """Vertices [px in the shape's mask] and triangles."""
    outlines = [smoothed(loop, _SMOOTHING * shape.floor) for loop in contours_at_half(shape.coverage)]
    # Filled gaps leave single pixels beside the parts: smoothed, they are points, of which no triangle can be made.
    outlines = [outline for outline in outlines if abs(area_of(outline)) >= _SMALLEST_LOOP * shape.floor**2]
    field = shape.field
    for _ in range(_ATTEMPTS):
        loops = [resampled(outline, field.at) for outline in outlines]
        seeds = interior_seeds(loops, field, shape.inside)
        try:
            return triangulate(loops, seeds, field, min_angle=options.min_angle, refine=not options.uniform)
        except CrossingEdgesError:
            field = SpacingField(field.values * _TIGHTER, field.cell)
    raise MeshingError("mask must have outlines that do not cross at this spacing; use a smaller spacing")


def _in_morton_order(
    points: FloatArray, triangles: NDArray[np.int64], origin: FloatArray, width: int, height: int
) -> TriangleMesh:
    """The mesh without unused points, with neighbours in the plane near each other in memory."""
    used = np.unique(triangles)
    order = used[morton_order(points[used])]
    number = np.empty(len(points), dtype=np.int64)
    number[order] = np.arange(len(order))
    points, triangles = points[order], number[triangles]
    triangles = triangles[morton_order(points[triangles].mean(axis=1))]
    return TriangleMesh(points + origin, triangles.astype(np.int32), width, height)
