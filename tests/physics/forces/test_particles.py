"""Flow particles against hand-computed places and accelerations."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.forces import STROKE_KINDS, EnergyStroke, acceleration, all_particles, most_alive, particles
from physanimator.physics.limits import MAX_PARTICLES_OF_STROKE

CORNER = ((0.0, 0.0), (100.0, 0.0), (100.0, 100.0))


def resting(kind: str, **options: object) -> EnergyStroke:
    """A particle that rests at (50, 50)."""
    return EnergyStroke(kind, ((50.0, 50.0), (60.0, 50.0)), speed=0.0, **options)


@pytest.mark.parametrize(
    ("t", "expected"),
    [
        (0.99, []),
        (1.0, [(0, 0)]),
        (1.25, [(25, 0)]),
        (1.5, [(50, 0), (0, 0)]),
        (2.2, [(100, 20), (70, 0), (20, 0)]),
        (2.5, [(100, 50), (100, 0), (50, 0)]),  # the stroke has ended: nothing leaves at 2.5 s
        (2.99, [(100, 99), (100, 49), (99, 0)]),
        (3.0, [(100, 50), (100, 0)]),  # the first has reached the last point and is gone
        (3.9, [(100, 90)]),
        (4.0, []),
    ],
)
def test_particles_leave_travel_and_vanish(t: float, expected: list[tuple[float, float]]) -> None:
    stroke = EnergyStroke(path=CORNER, speed=100.0, start=1.0, end=2.5, interval=0.5)
    positions, _ = particles(stroke, t)
    np.testing.assert_allclose(positions, np.reshape(expected, (-1, 2)), atol=1e-9)


def test_direction_is_that_of_the_segment_ahead() -> None:
    stroke = EnergyStroke(path=CORNER, speed=100.0, interval=0.5)
    positions, directions = particles(stroke, 1.5)
    np.testing.assert_allclose(positions, [(100, 50), (100, 0), (50, 0), (0, 0)], atol=1e-9)
    np.testing.assert_allclose(directions, [(0, 1), (0, 1), (1, 0), (1, 0)], atol=1e-12)


def test_repeated_points_change_nothing() -> None:
    plain = EnergyStroke(path=((0, 0), (30, 40), (30, 0)), speed=7.0)
    doubled = EnergyStroke(path=((0, 0), (0, 0), (30, 40), (30, 40), (30, 40), (30, 0), (30, 0)), speed=7.0)
    for t in (0.0, 0.3, 7.2, 12.0):
        for one, other in zip(particles(plain, t), particles(doubled, t), strict=True):
            np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(
    ("start", "end", "interval", "count"), [(0.2, 1.1, 0.3, 3), (0.0, 0.3, 0.1, 3), (0, 1, 0.4, 3)]
)
def test_end_excludes_whatever_rounding_does(start: float, end: float, interval: float, count: int) -> None:
    stroke = EnergyStroke(path=((0, 0), (1000, 0)), speed=1.0, start=start, end=end, interval=interval)
    assert len(particles(stroke, end + 50.0)[0]) == count


def test_particle_leaves_at_its_multiple_of_the_interval_whatever_rounding_does() -> None:
    stroke = EnergyStroke(path=((0, 0), (1000, 0)), speed=100.0, interval=0.1)
    for number in range(1, 60):
        assert len(particles(stroke, number * 0.1)[0]) == number + 1


def test_particle_vanishes_at_the_last_point_whatever_rounding_does() -> None:
    for number in range(1, 60):
        stroke = EnergyStroke(path=((0, 0), (10 * number, 0)), speed=100.0, start=0.7, interval=0.1)
        assert len(particles(stroke, 0.7 + number * 0.1)[0]) == number  # one has just gone, another has just left


@pytest.mark.parametrize("kind", ["repel", "attract"])
@pytest.mark.parametrize("path", [((5.0, 6.0),), ((5.0, 6.0), (5.0, 6.0))])
def test_single_point_is_one_resting_particle(kind: str, path: tuple[tuple[float, float], ...]) -> None:
    stroke = EnergyStroke(kind, path, speed=600.0, start=1.0, end=2.0, interval=0.1)
    assert [len(particles(stroke, t)[0]) for t in (0.9, 1.0, 1.5, 2.0)] == [0, 1, 1, 0]
    np.testing.assert_array_equal(particles(stroke, 1.5)[0], [(5.0, 6.0)])


def test_wind_at_rest_blows_along_its_first_segment_for_ever() -> None:
    positions, directions = particles(EnergyStroke(path=((1, 1), (1, 9), (7, 9)), speed=0.0), 1e5)
    np.testing.assert_array_equal(positions, [(1, 1)])
    np.testing.assert_array_equal(directions, [(0, 1)])


@pytest.mark.parametrize(
    ("kind", "point", "expected"),
    [
        ("wind", (50, 50), (2, 0)),
        ("wind", (56, 58), (1, 0)),  # 10 px away: half of the radius
        ("repel", (50, 50), (0, 0)),
        ("repel", (56, 58), (0.6, 0.8)),
        ("repel", (38, 34), (-1.2, -1.6)),  # exactly at the radius
        ("attract", (56, 58), (-0.6, -0.8)),
        ("attract", (50, 53), (0, -1.7)),
        ("attract", (50, 50), (0, 0)),  # no direction there
    ],
)
def test_formulas_by_hand(kind: str, point: tuple[float, float], expected: tuple[float, float]) -> None:
    result = acceleration(resting(kind, radius=20.0, strength=2.0), np.array([point]), 0.0)
    np.testing.assert_allclose(result, [expected], atol=1e-14)


@pytest.mark.parametrize("kind", STROKE_KINDS)
def test_nothing_beyond_the_radius(kind: str) -> None:
    stroke = resting(kind, radius=20.0, strength=2.0)
    beyond = np.nextafter(70.0, 100.0)
    outside = np.array([(beyond, 50.0), (50.0, beyond), (64.15, 64.15), (500.0, 500.0)])
    np.testing.assert_array_equal(acceleration(stroke, outside, 0.0), 0.0)
    within = acceleration(stroke, np.array([(69.999, 50.0)]), 0.0)
    assert np.hypot(*within.T) > 0


@pytest.mark.parametrize("kind", STROKE_KINDS)
def test_negative_strength_reverses(kind: str) -> None:
    points = np.random.default_rng(0).uniform(30, 70, (50, 2))
    forth = acceleration(resting(kind, radius=25.0, strength=3.0), points, 0.0)
    np.testing.assert_array_equal(acceleration(resting(kind, radius=25.0, strength=-3.0), points, 0.0), -forth)


def test_particles_add_up() -> None:
    stroke = EnergyStroke(path=((0, 0), (100, 0)), radius=100.0, speed=50.0, strength=1.0, interval=1.0)
    result = acceleration(stroke, np.array([(25.0, 0.0)]), 1.0)  # one particle 25 px ahead, one 25 px behind
    np.testing.assert_allclose(result, [(1.5, 0.0)])


def test_no_particle_no_acceleration() -> None:
    np.testing.assert_array_equal(acceleration(resting("repel", start=1.0), np.ones((3, 2)), 0.5), np.zeros((3, 2)))


def test_all_particles_keeps_each_with_its_stroke() -> None:
    travelling = EnergyStroke("attract", CORNER, radius=30.0, speed=100.0, strength=-4.0, interval=0.5)
    group = all_particles([resting("repel", radius=5.0), travelling, resting("wind", start=9.0)], 0.75)
    np.testing.assert_array_equal(group.kind, [1, 2, 2])
    assert group.kind.dtype == np.int32
    np.testing.assert_allclose(group.position, [(50, 50), (75, 0), (25, 0)])
    np.testing.assert_array_equal(group.direction, [(1, 0)] * 3)
    np.testing.assert_array_equal(group.radius, [5, 30, 30])
    np.testing.assert_array_equal(group.strength, [2, -4, -4])


def test_all_particles_of_nothing() -> None:
    group = all_particles([], 0.0)
    assert [array.shape for array in group] == [(0,), (0, 2), (0, 2), (0,), (0,)]


def test_acceleration_is_what_all_particles_describe() -> None:
    strokes = [EnergyStroke(kind, CORNER, radius=60.0, speed=90.0, interval=0.2) for kind in STROKE_KINDS]
    points = np.random.default_rng(1).uniform(-20, 120, (40, 2))
    group, t = all_particles(strokes, 0.77), 0.77
    expected = np.zeros_like(points)
    for kind, p, e, r, s in zip(*group, strict=True):
        for number, q in enumerate(points):
            d = math.dist(p, q)
            if d <= r:
                effect = ((1 - d / r) * e, (q - p) / r, (1 - d / r) * (p - q) / d)[kind]
                expected[number] += s * effect
    np.testing.assert_allclose(sum(acceleration(stroke, points, t) for stroke in strokes), expected, atol=1e-12)


@settings(deadline=None, max_examples=200)
@given(
    length=st.floats(1.0, 2000.0),
    speed=st.floats(1.0, 5000.0),
    interval=st.floats(0.01, 3.0),
    end=st.none() | st.floats(0.05, 20.0),
    t=st.floats(0.0, 30.0),
)
def test_most_alive_bounds_and_is_reached(
    length: float, speed: float, interval: float, end: float | None, t: float
) -> None:
    try:
        stroke = EnergyStroke(path=((0, 0), (length, 0)), speed=speed, interval=interval, end=end)
    except InvalidInputError:
        assert length / speed / interval > MAX_PARTICLES_OF_STROKE - 1
        return
    most = most_alive(stroke)
    assert len(particles(stroke, t)[0]) <= most
    assert len(particles(stroke, t)[0]) <= most_alive(stroke, horizon=t)
    assert len(particles(stroke, (most - 1) * interval)[0]) == most


def test_most_alive_before_a_horizon() -> None:
    stroke = EnergyStroke(path=((0, 0), (1000, 0)), speed=100.0, start=1.0, interval=0.5)
    assert [most_alive(stroke, horizon=t) for t in (0.9, 1.0, 1.6, 9.0)] == [0, 1, 2, 17]
    assert most_alive(stroke) == 20
    assert most_alive(resting("repel")) == 1


def test_crawl_is_refused_unless_it_ends() -> None:
    with pytest.raises(InvalidInputError, match=r"interval must be so long.*4096 particles.*path of 1000 px"):
        EnergyStroke(path=((0, 0), (1000, 0)), speed=0.1, interval=0.5)
    with pytest.raises(InvalidInputError, match="interval must be so long"):
        EnergyStroke(path=((0, 0), (1000, 0)), speed=5e-324)
    crawl = EnergyStroke(path=((0, 0), (1000, 0)), speed=5e-324, interval=0.5, end=1.5)
    assert len(particles(crawl, 1e4)[0]) == 3


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({"kind": "gust"}, "kind"),
        ({"path": ()}, "path"),
        ({"path": ((1, 1),)}, "path"),
        ({"path": ((1, 1), (1, 1))}, "path"),
        ({"path": ((0, 0), (math.nan, 0))}, "path"),
        ({"path": ((0, 0), (math.inf, 0))}, "path"),
        ({"path": ((0, 0), (2e6, 0))}, "path"),
        ({"path": tuple((k, 0) for k in range(10_001))}, "path"),
        ({"radius": 0}, "radius"),
        ({"radius": math.nan}, "radius"),
        ({"speed": -1}, "speed"),
        ({"strength": math.inf}, "strength"),
        ({"start": -0.1}, "start"),
        ({"end": 0.0}, "end"),
        ({"interval": 0.001}, "interval"),
    ],
)
def test_bad_strokes_name_the_value(options: dict[str, object], name: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{name} must be .*Got: "):
        EnergyStroke(**options)
