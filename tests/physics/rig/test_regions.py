"""Which vertices follow a rig point, and where it leads them."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import (
    Circle,
    KeyedPath,
    MaskRegion,
    Pinned,
    Polygon,
    RigPoint,
    Wave,
    coarseness_of,
    displacement,
    distances_of,
    leaders_of,
    regions,
    vertices_of,
)
from physanimator.physics.rig.regions import velocity
from physanimator.physics.scene import Body, Scene, holds_of, unused_rig_points

FAR = ((900.0, 900.0), (950.0, 900.0), (900.0, 950.0))


def mesh_of(vertices: list[tuple[float, float]], width: int = 100, height: int = 100) -> TriangleMesh:
    """A mesh whose last three vertices, far away, make its one triangle; the others are free to lie anywhere."""
    count = len(vertices)
    return TriangleMesh(np.array([*vertices, *FAR]), np.array([[count, count + 1, count + 2]]), width, height)


def selected(rig_point: RigPoint, vertices: list[tuple[float, float]], **size: int) -> list[bool]:
    return vertices_of(rig_point, mesh_of(vertices, **size))[: len(vertices)].tolist()


def test_circle_includes_its_edge() -> None:
    rig_point = RigPoint((10, 10), Circle(5.0))
    vertices = [(10, 10), (13, 14), (13.001, 14), (15, 10), (10, 15.001), (5, 5)]
    assert selected(rig_point, vertices) == [True, True, False, True, False, False]


def test_polygon_includes_its_edge_and_leaves_out_its_notch() -> None:
    notched = Polygon(((0, 0), (40, 0), (40, 40), (20, 10), (0, 40)))
    inside = [(20, 5), (2, 30), (38, 30)]
    edge = [(0, 0), (20, 0), (40, 20), (20, 10), (30, 25), (10, 25), (1, 38.5)]
    outside = [(20, 12), (30, 26), (-1, 20), (41, 0), (20, -0.01), (20, 40)]
    result = selected(RigPoint((0, 0), notched), [*inside, *edge, *outside])
    assert result == [True] * 10 + [False] * 6


@pytest.mark.parametrize("turn", [1, -1])
def test_polygon_is_even_odd_in_either_winding(turn: int) -> None:
    star = [(50 + 40 * math.sin(0.8 * math.pi * k), 50 - 40 * math.cos(0.8 * math.pi * k)) for k in range(5)]
    rig_point = RigPoint((0, 0), Polygon(tuple(star[::turn])))
    assert selected(rig_point, [(50, 50), (50, 20), (50, 85)]) == [False, True, False]


def test_polygon_with_repeated_corners() -> None:
    square = Polygon(((0, 0), (0, 0), (10, 0), (10, 10), (10, 10), (0, 10), (0, 0)))
    assert selected(RigPoint((0, 0), square), [(5, 5), (10, 5), (10.1, 5)]) == [True, True, False]


@settings(deadline=None, max_examples=50)
@given(seed=st.integers(0, 10_000))
def test_triangle_against_barycentric_coordinates(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b, c = corners = rng.uniform(0, 100, (3, 2))
    points = rng.uniform(0, 100, (60, 2))
    weights = np.linalg.solve(np.array([b - a, c - a]).T, (points - a).T)
    inside = (weights[0] >= 0) & (weights[1] >= 0) & (weights.sum(axis=0) <= 1)
    rig_point = RigPoint((0, 0), Polygon(tuple(map(tuple, corners))))
    assert selected(rig_point, list(map(tuple, points))) == inside.tolist()


def test_mask_selects_painted_pixels_and_their_edges() -> None:
    mask = np.zeros((100, 100), dtype=bool)
    mask[20:30, 10:15] = True  # x from 10 to 15, y from 20 to 30
    inside = [(12.5, 25.5), (10, 20), (15, 30), (15, 22.2)]
    outside = [(9.9, 25), (15.1, 25), (12, 30.1), (25.5, 12.5)]
    assert selected(RigPoint((0, 0), MaskRegion(mask)), [*inside, *outside]) == [True] * 4 + [False] * 4


def test_mask_stretches_over_the_picture() -> None:
    mask = np.zeros((50, 25), dtype=bool)
    mask[10:15, 5:10] = True
    vertices = [(20, 20), (39.9, 29.9), (19.9, 25), (40.1, 25), (30, 30.1), (7, 12)]
    result = selected(RigPoint((0, 0), MaskRegion(mask)), vertices, width=100, height=100)
    assert result == [True, True, False, False, False, False]


def test_vertices_beyond_the_border_follow_the_nearest_pixel() -> None:
    mask = np.zeros((100, 100), dtype=bool)
    mask[:, 95:] = True
    assert selected(RigPoint((0, 0), MaskRegion(mask)), [(107, 50), (100, 50), (-7, 50), (97, -3)]) == [
        True, True, False, True,
    ]  # fmt: skip


def test_later_rig_point_leads() -> None:
    mesh = mesh_of([(10, 10), (20, 10), (30, 10), (40, 10)])
    rig_points = [
        RigPoint((15, 10), Circle(6.0)),
        RigPoint((25, 10), Circle(6.0)),
        RigPoint((40, 10), Circle(1.0), body=1),
    ]
    assert leaders_of(rig_points, mesh)[:4].tolist() == [0, 1, 1, -1]
    assert leaders_of(rig_points, mesh, body=1)[:4].tolist() == [0, 1, 1, 2]
    assert leaders_of([], mesh).tolist() == [-1] * 7


def test_pinned_stays() -> None:
    assert displacement(Pinned(), 3.0).tolist() == [0, 0]
    assert displacement(Pinned(), np.arange(4.0)).shape == (4, 2)
    np.testing.assert_array_equal(velocity(Pinned(), np.arange(4.0)), np.zeros((4, 2)))


def test_wave_by_hand() -> None:
    wave = Wave(amplitude=10.0, period=2.0, direction=(3.0, 4.0))
    np.testing.assert_allclose(displacement(wave, 0.5), (6, 8))
    np.testing.assert_allclose(
        displacement(wave, [0.0, 1 / 6, 1.0, 1.5]), [(0, 0), (3, 4), (0, 0), (-6, -8)], atol=1e-14
    )
    np.testing.assert_allclose(velocity(wave, [0.0, 0.5]), [(6 * math.pi, 8 * math.pi), (0, 0)], atol=1e-13)


def test_path_passes_its_keys_relative_to_the_first_and_holds_outside() -> None:
    path = KeyedPath((1, 2, 4), ((50, 60), (70, 60), (70, 20)))
    np.testing.assert_allclose(
        displacement(path, [0, 1, 2, 4, 9]), [(0, 0), (0, 0), (20, 0), (20, -40), (20, -40)], atol=1e-12
    )
    np.testing.assert_array_equal(velocity(path, [0.0, 0.999, 4.0, 9.0]), np.zeros((4, 2)))
    assert velocity(path, 1.5)[0] > 0


def test_path_of_two_keys_is_straight_and_even() -> None:
    path = KeyedPath((0, 2), ((0, 0), (10, 20)))
    np.testing.assert_allclose(displacement(path, 0.5), (2.5, 5))
    np.testing.assert_allclose(velocity(path, [0.0, 1.9]), [(5, 10)] * 2)


def test_path_never_overshoots() -> None:
    points = ((0, 0), (1, 50), (100, 51), (100, 51), (101, 0))
    path = KeyedPath((0.0, 1.0, 1.1, 2.0, 5.0), points)
    for (start, end), (p, q) in zip([(0, 1), (1, 1.1), (1.1, 2), (2, 5)], pairwise(points), strict=True):
        way = displacement(path, np.linspace(start, end, 200))
        low, high = np.minimum(p, q), np.maximum(p, q)
        assert (way >= low - 1e-9).all()
        assert (way <= high + 1e-9).all()


MOTIONS = [
    Wave(amplitude=-7.0, period=0.7, direction=(1.0, -2.0)),
    KeyedPath((0.2, 0.5, 1.5, 1.6), ((0, 0), (30, -5), (-20, 8), (0, 100))),
]


@pytest.mark.parametrize("motion", MOTIONS, ids=["wave", "path"])
def test_velocity_integrates_to_the_displacement(motion: Wave | KeyedPath) -> None:
    times = np.linspace(0, 2, 40_001)
    middles = (times[1:] + times[:-1]) / 2
    way = np.cumsum(velocity(motion, middles) * np.diff(times)[:, None], axis=0)
    np.testing.assert_allclose(way, displacement(motion, times[1:]), atol=0.03)


@pytest.mark.parametrize("motion", [Pinned(), *MOTIONS], ids=["pinned", "wave", "path"])
def test_times_together_or_one_by_one(motion: Pinned | Wave | KeyedPath) -> None:
    times = np.array([0.0, 0.3, 0.5, 1.55, 3.0])
    for function in (displacement, velocity):
        np.testing.assert_array_equal(function(motion, times), [function(motion, t) for t in times])
        assert function(motion, 0.3).shape == (2,)
        assert function(motion, times.reshape(5, 1)).shape == (5, 1, 2)


def test_unused_rig_points_are_named_with_their_distance() -> None:
    body = Body(mesh_of([(100, 100), (110, 100)], width=1000, height=1000))
    painted = np.zeros((1000, 1000), dtype=bool)
    painted[500:520, 500:520] = True
    scene = Scene(
        (body, body),
        rig_points=(
            RigPoint((100, 105), Circle(12.0)),
            RigPoint((100, 48), Circle(12.0)),
            RigPoint((0, 0), Polygon(((0, 0), (70, 0), (70, 100))), body=1),
            RigPoint((0, 0), MaskRegion(np.zeros((5, 5)))),
            RigPoint((0, 0), MaskRegion(painted)),
        ),
    )
    sentences = unused_rig_points(scene)
    assert sentences[0] == (
        "rig_points[1] touches no body: its region of radius 12 px lies 40 px away; a radius of 52 px would reach it"
    )
    assert sentences[1] == (
        "rig_points[2] touches no vertex of body 1: its polygon lies 30 px away from the nearest vertex"
    )
    assert sentences[2] == "rig_points[3] touches no body: nothing is painted in its mask"
    # from the last painted pixel (519, 519) to that of the vertex (900, 900): 381 sqrt(2) px
    assert sentences[3] == "rig_points[4] touches no body: its mask lies about 538.8 px away from the nearest vertex"
    assert len(sentences) == 4


def blots(width: int, height: int) -> MaskRegion:
    rng, mask = np.random.default_rng(5), np.zeros((height, width), dtype=bool)
    for x, y, radius in rng.uniform((0, 0, 2), (width, height, 30), (6, 3)):
        rows, columns = np.mgrid[:height, :width]
        mask |= np.hypot(columns - x, rows - y) < radius
    return MaskRegion(mask)


@pytest.mark.parametrize("coarse", [1, 2, 3, 7])
@pytest.mark.parametrize("size", [(200, 120), (201, 127), (5, 300)])
def test_distances_from_a_mask_whose_pixels_are_taken_together(coarse: int, size: tuple[int, int]) -> None:
    region = blots(*size)
    painted = np.argwhere(region.mask)[:, ::-1] + 0.5
    places = np.random.default_rng(1).uniform((0, 0), size, (200, 2))
    mesh = mesh_of([(x, y) for x, y in places], *size)
    exact = np.linalg.norm(places[:, None] - painted, axis=2).min(axis=1)
    found = distances_of(RigPoint((0, 0), region), mesh, coarse=coarse)[: len(places)]
    assert np.abs(found - exact).max() < 1.5 * coarse + 0.5
    inside = vertices_of(RigPoint((0, 0), region), mesh)[: len(places)]
    assert (found[inside] <= coarse).all()


def test_the_masks_of_a_scene_are_measured_on_so_many_pixels_together(monkeypatch: pytest.MonkeyPatch) -> None:
    import cv2

    mesh, measured = mesh_of([(10.0, 10.0), (60.0, 60.0)]), []
    transform = cv2.distanceTransform
    monkeypatch.setattr(
        cv2, "distanceTransform", lambda mask, *rest: measured.append(mask.size) or transform(mask, *rest)
    )
    monkeypatch.setattr(regions, "_PIXELS_OF_DISTANCES", 40_000)
    rig_points = tuple(RigPoint((9, 9), blots(200, 120), falloff=20.0) for _ in range(12))
    holds_of(Scene((Body(mesh),), rig_points=rig_points))
    assert coarseness_of(rig_points) == 3
    assert len(measured) == 12
    assert sum(measured) <= 1.1 * 40_000
    measured.clear()
    holds_of(Scene((Body(mesh),), rig_points=rig_points[:1]))
    assert measured == [200 * 120]  # few are as fine as they are


@pytest.mark.parametrize(
    ("build", "name"),
    [
        (lambda: Circle(0), "radius"),
        (lambda: Circle(math.nan), "radius"),
        (lambda: Polygon(((0, 0), (1, 1))), "points"),
        (lambda: Polygon(((0, 0), (1, 1), (math.nan, 0))), "points"),
        (lambda: MaskRegion(np.zeros(3)), "mask"),
        (lambda: KeyedPath((0,), ((0, 0),)), "points"),
        (lambda: KeyedPath((0, 1, 2), ((0, 0), (1, 1))), "times"),
        (lambda: KeyedPath((0, 0), ((0, 0), (1, 1))), "times"),
        (lambda: KeyedPath((-1, 0), ((0, 0), (1, 1))), "times"),
        (lambda: KeyedPath((0, math.inf), ((0, 0), (1, 1))), "times"),
        (lambda: Wave(period=0), "period"),
        (lambda: Wave(amplitude=math.inf), "amplitude"),
        (lambda: Wave(direction=(0, 0)), "direction"),
        (lambda: Wave(direction=(math.nan, 0)), "direction"),
        (lambda: RigPoint((math.inf, 0)), "position"),
        (lambda: RigPoint((0, 0), body=-1), "body"),
    ],
)
def test_bad_rig_values_are_named(build: object, name: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{name} must be .*Got: "):
        build()


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_a_direction_scaled_to_unit_length_stays_as_it_is(x: float, y: float) -> None:
    if math.hypot(x, y) >= 1e-9:
        direction = Wave(direction=(x, y)).direction
        assert math.hypot(*direction) == pytest.approx(1, abs=1e-15)
        assert Wave(direction=direction).direction == direction
