"""Contours: sub-pixel accuracy, simple closed curves, sampling by arc length."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from physanimator.physics.mesh import area_of, contours_at_half, resampled
from physanimator.physics.mesh.contours import perimeter_of, smoothed


def soft_disc(radius: float, centre: tuple[float, float], size: int = 100) -> np.ndarray:
    x, y = np.meshgrid(np.arange(size) + 0.5, np.arange(size) + 0.5)
    return np.clip(radius - np.hypot(x - centre[0], y - centre[1]) + 0.5, 0, 1).astype(np.float32)


def test_a_soft_disc_is_followed_to_a_tenth_of_a_pixel() -> None:
    (loop,) = contours_at_half(soft_disc(30.3, (50.2, 48.7)))
    radii = np.hypot(*(loop - (50.2, 48.7)).T)
    np.testing.assert_allclose(radii, 30.3, atol=0.1)
    assert area_of(loop) == pytest.approx(-np.pi * 30.3**2, rel=1e-3)


def test_a_hard_disc_is_followed_to_a_fraction_of_a_pixel_once_smoothed() -> None:
    (loop,) = contours_at_half((soft_disc(30.3, (50.2, 48.7)) > 0.5).astype(np.float32))
    radii = np.hypot(*(smoothed(loop, 1.0) - (50.2, 48.7)).T)
    assert np.abs(radii - 30.3).max() < 0.55
    assert perimeter_of(smoothed(loop, 1.0)) == pytest.approx(2 * np.pi * 30.3, rel=0.02)
    assert perimeter_of(loop) > 1.04 * 2 * np.pi * 30.3


def test_pixel_edges_lie_at_integers() -> None:
    mask = np.zeros((12, 12), np.float32)
    mask[3:7, 2:9] = 1
    (loop,) = contours_at_half(mask)
    assert loop.min(axis=0).tolist() == [2, 3]
    assert loop.max(axis=0).tolist() == [9, 7]


def test_outer_curves_and_holes_have_opposite_signs() -> None:
    ring = soft_disc(40, (50, 50)) - soft_disc(20, (50, 50))
    areas = sorted(area_of(loop) for loop in contours_at_half(ring))
    assert areas == pytest.approx([-np.pi * 1600, np.pi * 400], rel=0.01)


def test_pixels_that_meet_at_a_corner_are_apart() -> None:
    mask = np.zeros((8, 8), np.float32)
    mask[2:4, 2:4] = mask[4:6, 4:6] = 1
    assert len(contours_at_half(mask)) == 2
    assert len(contours_at_half(mask[::-1])) == 2


def test_values_of_exactly_one_half_make_no_double_points() -> None:
    mask = np.zeros((6, 6), np.float32)
    mask[1:5, 1:5] = 1
    mask[2, 2] = mask[3, 4] = 0.5
    points = np.concatenate(contours_at_half(mask))
    assert len(np.unique(points, axis=0)) == len(points)


@settings(max_examples=60, deadline=None)
@given(arrays(np.uint8, st.tuples(st.integers(1, 12), st.integers(1, 12)), elements=st.integers(0, 4)))
def test_no_two_points_of_any_mask_coincide(levels: np.ndarray) -> None:
    mask = np.pad(levels.astype(np.float32) / 4, 1)
    loops = contours_at_half(mask)
    points = np.concatenate([*loops, np.empty((0, 2))])
    assert len(np.unique(points, axis=0)) == len(points)
    inside = mask > 0.5
    pairs = np.count_nonzero(inside[:, 1:] != inside[:, :-1]) + np.count_nonzero(inside[1:] != inside[:-1])
    assert len(points) == pairs


@pytest.mark.parametrize("spacing", [2.0, 5.0, 12.0])
def test_resampling_with_one_spacing_is_uniform_by_arc_length(spacing: float) -> None:
    square = np.array([[0, 0], [30, 0], [30, 40], [0, 40.0]])
    points = resampled(square, lambda p: np.full(len(p), spacing))
    assert len(points) == round(140 / spacing)
    corners = np.array([0, 30, 70, 100, 140.0])
    at = 140 / len(points) * np.arange(len(points))
    closed = np.concatenate([square, square[:1]])
    expected = np.stack([np.interp(at, corners, closed[:, k]) for k in (0, 1)], axis=1)
    np.testing.assert_allclose(points, expected, atol=1e-9)


def test_resampling_follows_a_varying_spacing() -> None:
    (circle,) = contours_at_half(soft_disc(40, (50, 50)))
    points = resampled(circle, lambda p: 2 + p[:, 0] / 25)
    steps = np.hypot(*(np.roll(points, -1, axis=0) - points).T)
    middle = (points + np.roll(points, -1, axis=0)) / 2
    np.testing.assert_allclose(steps, 2 + middle[:, 0] / 25, rtol=0.05)


def test_smoothing_keeps_straight_lines_and_area() -> None:
    square = np.array([[0, 0], [40, 0], [40, 40], [0, 40.0]])
    round_one = smoothed(square, 1.5)
    straight = round_one[(round_one[:, 0] > 8) & (round_one[:, 0] < 32)]
    assert np.minimum(np.abs(straight[:, 1]), np.abs(straight[:, 1] - 40)).max() < 1e-3
    assert area_of(round_one) == pytest.approx(1600, rel=0.01)
