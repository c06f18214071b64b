"""The rasteriser: coverage without gaps, order, and affine interpolation."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.mesh import (
    PixelBox,
    affine_per_triangle,
    barycentric,
    bounding_box,
    interpolate,
    rasterise,
    triangle_ids,
)
from scipy.spatial import Delaunay

BOX = PixelBox(0, 0, 64, 48)


def centres(box: PixelBox) -> np.ndarray:
    y, x = np.mgrid[box.top : box.bottom, box.left : box.right] + 0.5
    return np.stack([x, y], axis=-1)


def random_mesh(seed: int, *, on_grid: bool) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    points = random.uniform((0, 0), (64, 48), (120, 2))
    points = np.round(points * 2) / 2 if on_grid else points
    points = np.unique(np.concatenate([points, [[0, 0], [64, 0], [0, 48], [64, 48]]]), axis=0)
    return points, Delaunay(points).simplices


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("on_grid", [False, True])
def test_every_pixel_of_a_mesh_is_covered_exactly_once(seed: int, on_grid: bool) -> None:
    points, triangles = random_mesh(seed, on_grid=on_grid)
    covered = np.bincount(rasterise(points, triangles, BOX).pixels(), minlength=64 * 48)
    assert (covered == 1).all()


def test_pixels_come_triangle_by_triangle_and_row_by_row() -> None:
    random = np.random.default_rng(4)
    points, triangles = random.uniform((-8, -8), (72, 56), (60, 2)), random.integers(0, 60, (40, 3))
    expected = [
        (number, int(row), int(column))
        for number in range(len(triangles))
        for row, column in np.argwhere(triangle_ids(points, triangles[[number]], BOX) == 0)
    ]
    fragments = rasterise(points, triangles, BOX)
    row, column = np.divmod(fragments.pixels(), BOX.width)
    assert list(zip(fragments.triangles().tolist(), row.tolist(), column.tolist(), strict=True)) == expected
    assert len(expected) > 5000


def test_a_complex_value_is_spread_as_its_two_parts_are() -> None:
    points, triangles = random_mesh(5, on_grid=False)
    values = np.random.default_rng(5).normal(size=(len(points), 2)) * 100
    fragments = rasterise(points, triangles, BOX)
    both = fragments.spread(affine_per_triangle(points, triangles, values[:, 0] + 1j * values[:, 1]))
    for part, column in ((both.real, values[:, 0]), (both.imag, values[:, 1])):
        assert np.array_equal(part, fragments.spread(affine_per_triangle(points, triangles, column)))


def test_ids_name_the_triangle_that_holds_the_pixel_centre() -> None:
    points, triangles = random_mesh(7, on_grid=False)
    ids = triangle_ids(points, triangles, BOX)
    weights = barycentric(centres(BOX).reshape(-1, 2), points[triangles[ids.reshape(-1)]])
    assert weights.min() > -1e-9


def test_winding_does_not_matter_and_the_later_triangle_wins() -> None:
    points = np.array([[2.0, 2], [40, 3], [5, 40]])
    ids = triangle_ids(points, [[0, 1, 2], [0, 2, 1]], BOX)
    assert set(np.unique(ids)) == {-1, 1}
    assert (ids == 1).sum() == pytest.approx(38 * 38 / 2, rel=0.05)


def test_nothing_is_drawn_outside_the_box_or_for_a_triangle_without_area() -> None:
    points = np.array([[-50.0, -50], [200, -50], [60, 200], [10, 10], [20, 20], [30, 30]])
    box = PixelBox(-5, 3, 10, 9)
    assert triangle_ids(points, [[0, 1, 2]], box).shape == (6, 15)
    assert (triangle_ids(points, [[3, 4, 5]], BOX) == -1).all()
    assert rasterise(points + 1000, [[0, 1, 2]], BOX).count == 0


def test_interpolation_reproduces_an_affine_function() -> None:
    points, triangles = random_mesh(3, on_grid=False)
    slope = np.array([[0.5, -2.0], [3.0, 0.25]])
    values = interpolate(points, triangles, points @ slope + 7, BOX)
    assert np.abs(values - np.moveaxis(centres(BOX) @ slope + 7, 2, 0)).max() < 1e-4


def test_interpolation_fills_outside_the_mesh() -> None:
    values = interpolate([[10.0, 10], [20, 10], [10, 20]], [[0, 1, 2]], [[1.0], [1], [1]], BOX, fill=-3)
    assert set(np.unique(values)) == {-3, 1}


def test_boxes() -> None:
    box = bounding_box([[-3.2, 4.5], [70.0, 5.0]], margin=2)
    assert box == PixelBox(-6, 2, 72, 7)
    assert box.clipped(64, 48) == PixelBox(0, 2, 64, 7)
    assert PixelBox(100, 0, 110, 5).clipped(64, 48).width == 0
