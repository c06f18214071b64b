"""Rig points that turn, squash, ease, combine and fade out."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import Material
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import (
    EASINGS,
    Circle,
    Combined,
    KeyedPath,
    MaskRegion,
    Pinned,
    Polygon,
    Pulse,
    RigMotion,
    RigPoint,
    Rotation,
    Squash,
    Swing,
    Wave,
    displacement,
    lead,
    leaders_of,
    linear_part,
)
from physanimator.physics.rig.easing import BLEND, eased, eased_rate
from physanimator.physics.rig.falloff import grips_of
from physanimator.physics.rig.regions import velocity
from physanimator.physics.scene import Body, Scene
from physanimator.physics.simulation import simulate

SIZE = 200
PLACE = (100.0, 30.0)
TOP = Polygon(((0, 0), (200, 0), (200, 41), (0, 41)))
EVERYTHING = Polygon(((-50, -50), (250, -50), (250, 250), (-50, 250)))

MOTIONS: list[RigMotion] = [
    KeyedPath((0.2, 1, 1.5), ((0, 0), (40, -10), (20, 30)), easing="ease"),
    KeyedPath((0.2, 1, 1.5), ((0, 0), (40, -10), (20, 30)), easing="linear"),
    KeyedPath((0.2, 1, 1.5), ((0, 0), (40, -10), (20, 30)), easing="hold"),
    Wave(20, 1.3, (3, 4), phase=70),
    Rotation((0, 1, 2), (10, 100, -30)),
    Rotation((0, 1, 2), (10, 100, -30), easing="smooth"),
    Swing(25, 1.1, 40),
    Squash((0, 0.7, 2), (1.2, 0.6, 2), 30),
    Squash((0, 0.7, 2), (1.2, 0.6, 2), 30, keep_area=False, easing="hold"),
    Pulse(1.5, 0.9, 20, 60, keep_area=False),
    Combined((Wave(9, 0.8), Pulse(1.4, 1.1, 0, 20), Swing(30, 1.7), Squash((0, 2), (1, 2)))),
]


def name_of(motion: object) -> str:
    return "-".join(str(part) for part in (type(motion).__name__, getattr(motion, "easing", "")) if part)


def strip(columns: int = 3, rows: int = 12, *, width: float = 24.0) -> TriangleMesh:
    """A strip that hangs from y = 20 to y = 140."""
    xs, ys = np.meshgrid(np.linspace(88, 88 + width, columns + 1), np.linspace(20, 140, rows + 1))
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            triangles += [(a, b, c), (a, c, d)]
    return TriangleMesh(np.column_stack([xs.ravel(), ys.ravel()]), np.array(triangles), SIZE, SIZE)


def moved(*rig_points: RigPoint, frames: int = 25, rate: float = 24.0, material: Material | None = None) -> np.ndarray:
    """Positions of the strip's vertices under rig points [px], shape [f, v, 2]."""
    body = Body(strip(), material or Material(youngs_modulus=100.0))
    return simulate(Scene((body,), rig_points=rig_points, frame_rate=rate), frames=frames).positions.astype(float)


def expected(motion: RigMotion, times: np.ndarray) -> np.ndarray:
    """c + d + L (X - c) for the strip's vertices, shape [f, v, 2]."""
    away = strip().vertices - PLACE
    linear, _ = linear_part(motion, times)
    return np.array(PLACE) + displacement(motion, times)[:, None] + np.einsum("fij,vj->fvi", linear, away)


def distances(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points[..., :, None, :] - points[..., None, :, :], axis=-1)


# ------------------------------------------------------------------ courses


@pytest.mark.parametrize("motion", MOTIONS, ids=name_of)
def test_every_motion_begins_where_it_was_drawn(motion: RigMotion) -> None:
    np.testing.assert_allclose(displacement(motion, 0.0), 0, atol=1e-12)
    np.testing.assert_allclose(linear_part(motion, 0.0)[0], np.eye(2), atol=1e-12)


@pytest.mark.parametrize("motion", MOTIONS, ids=name_of)
def test_rates_are_the_derivatives(motion: RigMotion) -> None:
    times, step = np.linspace(0.003, 2.5, 700), 1e-6
    before, after = (lead(motion, PLACE, times + shift).coefficients for shift in (-step, step))
    np.testing.assert_allclose(lead(motion, PLACE, times).rates, (after - before) / (2 * step), atol=2e-3)


@pytest.mark.parametrize("motion", MOTIONS, ids=name_of)
def test_times_together_or_one_by_one(motion: RigMotion) -> None:
    times = np.array([0.0, 0.3, 1.0, 1.55, 3.0])
    turn, turn_rate = (lambda *given, part=part: linear_part(*given)[part] for part in (0, 1))
    for function in (displacement, velocity, turn, turn_rate):
        np.testing.assert_allclose(function(motion, times), [function(motion, t) for t in times], atol=1e-15)


@pytest.mark.parametrize("easing", EASINGS)
def test_keys_are_met_and_ends_are_at_rest(easing: str) -> None:
    times, values = (0.5, 1.0, 2.0, 2.5), (3.0, 7.0, -2.0, -2.0)
    np.testing.assert_allclose(eased(times, values, easing, np.array(times)), values, atol=1e-12)
    assert eased(times, values, easing, np.array([0.0, 9.0])).tolist() == [3, -2]
    assert eased_rate(times, values, easing, np.array([0.0, 2.5, 9.0])).tolist() == [0, 0, 0]
    course = eased(times, values, easing, np.linspace(0, 3, 500))
    assert (course.min(), course.max()) == (-2, pytest.approx(7, abs=0.02))


def test_easings_by_hand() -> None:
    def at(easing: str, t: float) -> float:
        return float(eased((0.0, 1.0, 2.0), (0.0, 10.0, 30.0), easing, np.array(t)))

    assert [at("linear", t) for t in (0.25, 1.5)] == [2.5, 20]
    assert [at("ease", t) for t in (0.25, 0.5, 1.5)] == [1.5625, 5, 20]
    assert [at("hold", t) for t in (0.5, 0.95, 1 - BLEND / 2, 1.0, 1.9)] == pytest.approx([0, 0, 5, 10, 10])
    keys = (0.0, 1.0, 2.0), (0.0, 10.0, 30.0)
    assert eased_rate(*keys, "ease", np.array([0.0, 1.0, 0.5])).tolist() == [0, 0, 15]
    assert eased_rate(*keys, "smooth", np.array(1.0)) > 5  # flows through its keys
    assert eased_rate(*keys, "linear", np.array([0.5, 1.0])).tolist() == [10, 20]


def test_a_hold_between_close_keys_takes_no_longer_than_they_leave() -> None:
    times = (0.0, 0.01)
    assert eased(times, (0.0, 1.0), "hold", np.array([0.0, 0.005, 0.01])).tolist() == pytest.approx([0, 0.5, 1])


def test_phases_shift_the_course() -> None:
    late, plain = Wave(10, 2, phase=90), Wave(10, 2)
    times = np.linspace(0, 3, 50)
    np.testing.assert_allclose(displacement(late, times), displacement(plain, times + 0.5) - [10, 0], atol=1e-12)
    np.testing.assert_allclose(velocity(Wave(10, 2, phase=-90), 0.0), 0, atol=1e-12)
    turned = linear_part(Swing(30, 2, 90), 1.0)[0]
    np.testing.assert_allclose(turned, linear_part(Rotation((0, 1), (0, -60)), 1.0)[0], atol=1e-12)


def test_turns_are_counterclockwise_as_seen() -> None:
    quarter = linear_part(Rotation((0, 1), (0, 90)), 1.0)[0]
    np.testing.assert_allclose(quarter @ [1, 0], [0, -1], atol=1e-15)  # right goes up


def test_squash_by_hand() -> None:
    tall = linear_part(Squash((0, 1), (1, 2)), 1.0)[0]
    np.testing.assert_allclose(tall, [[0.5, 0], [0, 2]], atol=1e-15)
    np.testing.assert_allclose(linear_part(Squash((0, 1), (1, 2)), 0.5)[0][1, 1], math.sqrt(2))
    alone = linear_part(Squash((0, 1), (2, 1), angle=0, keep_area=False), 1.0)[0]
    np.testing.assert_allclose(alone, [[0.5, 0], [0, 1]], atol=1e-15)  # relative to the first key
    along = np.array([math.cos(0.5), -math.sin(0.5)])
    slanted = linear_part(Squash((0, 1), (1, 3), angle=math.degrees(0.5)), 1.0)[0]
    np.testing.assert_allclose(slanted @ along, 3 * along, atol=1e-12)


def test_combined_motions_add_ways_and_chain_turns() -> None:
    tall, quarter = Squash((0, 1), (1, 2)), Rotation((0, 1), (0, 90))
    wide = linear_part(Combined((tall, quarter)), 1.0)[0]
    np.testing.assert_allclose(np.abs(wide), [[0, 2], [0.5, 0]], atol=1e-12)  # tall, then lying on its side
    np.testing.assert_allclose(np.abs(linear_part(Combined((quarter, tall)), 1.0)[0]), [[0, 0.5], [2, 0]], atol=1e-12)
    both = Combined((Wave(10, 2), quarter, Wave(4, 2, (0, 1))))
    np.testing.assert_allclose(displacement(both, 0.5), [10, 4])
    assert RigPoint(PLACE, motion=(Wave(), Swing())).motion == Combined((Wave(), Swing()))


def test_motions_at_another_size_of_picture() -> None:
    rig_point = RigPoint((10, 20), motion=(Wave(5, direction=(0, 1)), Swing(7)), falloff=3).rescaled((2, 2, 2))
    assert rig_point.motion == Combined((Wave(10, direction=(0, 1)), Swing(7)))
    assert rig_point.falloff == 6


# ------------------------------------------------------------------ in the solver


@pytest.mark.parametrize("motion", MOTIONS, ids=name_of)
@pytest.mark.parametrize("rate", [12.0, 50.0])
def test_led_vertices_are_where_the_motion_says(motion: RigMotion, rate: float) -> None:
    """Also at frames between two ticks, by the cubics."""
    got = moved(RigPoint(PLACE, EVERYTHING, motion), frames=20, rate=rate)
    tolerance = 0.02 if "hold" in name_of(motion) else 2e-3
    np.testing.assert_allclose(got, expected(motion, np.arange(20) / rate), atol=tolerance)


def test_a_turned_region_keeps_its_distances() -> None:
    got = moved(RigPoint(PLACE, EVERYTHING, Rotation((0, 0.5, 1), (0, 200, -90))))
    assert np.abs(got[12] - got[0]).max() > 100
    np.testing.assert_allclose(distances(got), np.broadcast_to(distances(got[0]), (25, 52, 52)), atol=2e-3)
    radii = np.linalg.norm(got - PLACE, axis=2)
    np.testing.assert_allclose(radii[24], radii[0], atol=2e-3)


def test_a_squash_keeps_the_area() -> None:
    got, triangles = moved(RigPoint(PLACE, EVERYTHING, Pulse(1.6, 0.7, 0, 20))), strip().triangles
    a, b, c = (got[:, triangles[:, k]] for k in range(3))
    areas = np.linalg.det(np.stack([b - a, c - a], axis=-1))
    np.testing.assert_allclose(areas, np.broadcast_to(areas[0], areas.shape), rtol=1e-3)
    assert np.ptp(np.ptp(got[..., 1], axis=1)) > 40


def test_root_motion_drags_the_tip_along_and_lets_it_settle() -> None:
    """The root turns and moves; the free end lags, overshoots and comes to rest turned with it."""
    motion = Combined((KeyedPath((0, 0.4), ((0, 0), (30, 0)), easing="ease"), Rotation((0, 0.4), (0, 40))))
    soft = Material(youngs_modulus=60.0, damping=2.5)
    got = moved(RigPoint(PLACE, TOP, motion), frames=24 * 6, material=soft)
    ideal = expected(motion, np.arange(24 * 6) / 24)
    behind = np.linalg.norm(got[:, -1] - ideal[:, -1], axis=1)
    assert behind[8] > 20  # lags while the root moves
    way = (got[:, -1] - got[0, -1]) @ (ideal[-1, -1] - ideal[0, -1]) / np.sum((ideal[-1, -1] - ideal[0, -1]) ** 2)
    assert way.max() > 1.05  # swings past
    assert behind[-1] < 0.5  # settles
    assert behind[72:].max() < behind[12:36].max()


def test_translations_are_led_as_by_a_table_of_ways() -> None:
    """A translation has no linear part, so that no digits are lost to it."""
    table = lead(Wave(20, 1.3), PLACE, np.linspace(0, 2, 9))
    assert not table.coefficients[:, :4].any()
    assert not table.rates[:, :4].any()
    np.testing.assert_array_equal(table.coefficients[:, 4:], displacement(Wave(20, 1.3), np.linspace(0, 2, 9)))


# ------------------------------------------------------------------ falloff


def test_grip_falls_from_the_region_outwards() -> None:
    mesh = strip()
    for region in (TOP, MaskRegion(np.arange(SIZE)[:, None] + np.zeros(SIZE) < 41)):
        grips, grippers = grips_of([RigPoint(PLACE, region, falloff=50)], mesh)
        below = np.maximum(mesh.vertices[:, 1] - 41, 0)
        np.testing.assert_allclose(grips, np.clip(1 - below / 50, 0, 1), atol=0.03)
        assert (grippers >= 0).tolist() == (grips > 0).tolist()
    circle, _ = grips_of([RigPoint(PLACE, Circle(20), falloff=40)], mesh)
    away = np.hypot(*(mesh.vertices - PLACE).T)
    np.testing.assert_allclose(circle, np.clip(1 - (away - 20) / 40, 0, 1))


def test_the_firmest_rig_point_pulls() -> None:
    mesh = strip()
    low = RigPoint((100, 140), Circle(10), falloff=100)
    high = RigPoint((100, 20), Circle(10), falloff=100)
    other = RigPoint((100, 20), Circle(10), falloff=300, body=1)
    _, grippers = grips_of([low, high, other], mesh)
    assert (grippers == (mesh.vertices[:, 1] <= 80)).all()
    assert not grips_of([other], mesh)[0].any()
    assert leaders_of([low], mesh).max() == 0  # inside the region it still leads


def test_no_falloff_is_the_motion_of_before() -> None:
    np.testing.assert_array_equal(
        moved(RigPoint(PLACE, TOP, Wave(20, 1))), moved(RigPoint(PLACE, TOP, Wave(20, 1), falloff=1e-9))
    )


def test_a_wider_falloff_takes_more_along() -> None:
    step = KeyedPath((0, 0.2), ((0, 0), (40, 0)), easing="ease")
    soft = Material(youngs_modulus=3.0, damping=1.0)
    tips, middles = [], []
    for falloff in (0.0, 30.0, 60.0, 120.0, 400.0):
        got = moved(RigPoint(PLACE, TOP, step, falloff=falloff), frames=6, material=soft)
        middles.append(got[5, 26, 0] - got[0, 26, 0])
        tips.append(got[5, -1, 0] - got[0, -1, 0])
    assert (np.diff(middles[:4]) > 0).all()
    assert np.abs(np.diff(middles[3:])).max() < 1  # it is there already
    assert tips[-1] > 30 > tips[0]
    assert middles[0] < 12


def test_within_a_falloff_what_is_nearer_follows_more() -> None:
    step = KeyedPath((0, 0.2), ((0, 0), (40, 0)), easing="ease")
    got = moved(RigPoint(PLACE, TOP, step, falloff=90), frames=5, material=Material(youngs_modulus=1.0))
    ways = (got[4] - got[0])[:, 0].reshape(13, 4).mean(axis=1)
    assert (np.diff(ways) < 0.5).all()
    assert ways[0] - ways[-1] > 20


def test_a_falloff_of_a_pin_holds_back() -> None:
    body = Body(strip(), Material(youngs_modulus=5.0))
    tips = []
    for falloff in (0.0, 80.0):
        held = (RigPoint(PLACE, TOP, Pinned(), falloff=falloff),)
        scene = Scene((body,), rig_points=held, gravity=(1.0, 0.0), sag=True)
        tips.append(np.ptp(simulate(scene, frames=20).positions[:, -1, 0]))
    assert 0 < tips[1] < 0.7 * tips[0]


@pytest.mark.parametrize("young", [1e-3, 1e5])
@pytest.mark.parametrize(
    "motion",
    [
        KeyedPath((0, 0.001), ((0, 0), (1e5, 0))),
        Wave(1e4, 0.01),
        Swing(36000, 0.05),
        Squash((0, 0.01), (0.05, 20)),
        Combined((Pulse(20, 0.02), Rotation((0, 0.1), (0, 36000)), Wave(500, 0.03))),
    ],
    ids=name_of,
)
def test_extreme_rigs_stay_finite(young: float, motion: RigMotion) -> None:
    got = moved(RigPoint(PLACE, TOP, motion, falloff=70), frames=5, material=Material(youngs_modulus=young))
    assert np.isfinite(got).all()


@settings(deadline=None, max_examples=15)
@given(falloff=st.floats(0, 1e6), young=st.floats(-2, 4), amplitude=st.floats(-200, 200), period=st.floats(0.05, 5))
def test_pulled_vertices_stay_near_their_goal(falloff: float, young: float, amplitude: float, period: float) -> None:
    """Whatever the step: no more energy comes in than the rig point gives, which is ten times as far in resonance."""
    rig_point = RigPoint(PLACE, TOP, Wave(amplitude, period), falloff=falloff)
    got = moved(rig_point, frames=8, material=Material(youngs_modulus=10**young))
    assert np.abs(got - got[0]).max() < 20 * abs(amplitude) + 1


@pytest.mark.parametrize("period", [0.0546875, 0.05])
def test_a_body_that_is_pulled_in_resonance_swings_no_farther_after_a_while(period: float) -> None:
    """What drag and damping take is what the rig point gives."""
    got = moved(RigPoint(PLACE, TOP, Wave(1, period), falloff=0), frames=48, material=Material(youngs_modulus=10**3.25))
    reach = np.abs(got - got[0]).max(axis=(1, 2))
    assert 6 < reach[:16].max() < 30
    assert reach[16:].max() < 1.05 * reach[:16].max()


@pytest.mark.parametrize(
    ("build", "name"),
    [
        (lambda: Rotation((0, 1), (0, math.inf)), "angles"),
        (lambda: Rotation((0,), (0,)), "angles"),
        (lambda: Rotation((0, 0), (0, 1)), "times"),
        (lambda: Rotation((0, 1), (0, 1), easing="soft"), "easing"),  # type: ignore[arg-type]
        (lambda: KeyedPath((0, 1), ((0, 0), (1, 1)), easing="soft"), "easing"),  # type: ignore[arg-type]
        (lambda: Wave(phase=math.nan), "phase"),
        (lambda: Swing(amplitude=math.nan), "amplitude"),
        (lambda: Swing(period=0), "period"),
        (lambda: Squash((0, 1), (1, 0)), "factors"),
        (lambda: Squash((0, 1), (1, 2), angle=math.inf), "angle"),
        (lambda: Pulse(stretch=0), "stretch"),
        (lambda: Pulse(phase=1e9), "phase"),
        (lambda: Combined(()), "motions"),
        (lambda: Combined((Combined((Wave(),)),)), "motions"),
        (lambda: RigPoint((0, 0), falloff=-1), "falloff"),
        (lambda: RigPoint((0, 0), falloff=math.nan), "falloff"),
    ],
)
def test_bad_values_are_named(build: object, name: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{name} must .*Got: "):
        build()  # type: ignore[operator]
