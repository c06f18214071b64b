"""Wind: the field's promises, and the kernel against it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physanimator.physics.assembly import drive
from physanimator.physics.document import scene_from_dict, scene_to_dict
from physanimator.physics.errors import InvalidInputError, SceneError
from physanimator.physics.forces import Wind, eddies, uniform
from physanimator.physics.forces.wind import wind_acceleration
from physanimator.physics.material import Material
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import Polygon, RigPoint
from physanimator.physics.scene import Body, Scene
from physanimator.physics.simulation import simulate
from physanimator.physics.solver import TICK, Solid, State, advance

SIZE = 1000
POINTS = np.random.default_rng(4).uniform(0, SIZE, (40, 2))


def strip(left: float = 400.0, *, scale: float = 1.0) -> TriangleMesh:
    x, y = np.meshgrid(np.linspace(left, left + 60, 3), np.linspace(100, 400, 11))
    triangles = []
    for row in range(10):
        for column in range(2):
            a = row * 3 + column
            b, c, d = a + 1, a + 3, a + 4
            triangles += [(a, b, d), (a, d, c)] if (row + column) % 2 else [(a, b, c), (b, d, c)]
    size = round(SIZE * scale)
    return TriangleMesh(np.column_stack([x.ravel(), y.ravel()]) * scale, np.array(triangles), size, size)


def scene(wind: Wind | None, *, left: float = 400.0, scale: float = 1.0, **others: object) -> Scene:
    body = Body(strip(left, scale=scale), Material(sway_frequency=1.5))
    corners = np.array([[left - 5, 95], [left + 65, 95], [left + 65, 105], [left - 5, 105]]) * scale
    pin = RigPoint((left * scale, 100 * scale), Polygon(tuple(map(tuple, corners))))
    return Scene((body,), rig_points=(pin,), wind=wind, **others)  # type: ignore[arg-type]


def test_a_steady_wind_is_the_same_everywhere_and_always() -> None:
    steady = Wind(2.0, 90.0, gust=0.0, turbulence=0.0)
    for t in (0.0, 1.7):
        np.testing.assert_allclose(wind_acceleration(steady, POINTS, t), np.tile([0.0, -2.0], (40, 1)), atol=1e-12)
    np.testing.assert_allclose(replace(steady, angle=0.0, strength=-3.0).direction, [1, 0])


def test_gusts_come_and_go_within_their_share() -> None:
    times = np.linspace(0, 200, 20001)
    level = uniform(Wind(2.0, 0.0, gust=0.75, gust_period=2.0), times)[:, 0]
    assert 0.5 <= level.min() < 0.6
    assert 1.9 < level.max() <= 2.0
    rising = ((level[1:] > 1.25) & (level[:-1] <= 1.25)).sum()
    assert 90 <= rising <= 190  # one in two seconds, and those between


def test_eddies_have_the_strength_that_was_asked_for_and_no_mean() -> None:
    blown = Wind(2.0, 0.0, gust=0.0, turbulence=0.4, turbulence_size=80.0)
    grid = np.random.default_rng(0).uniform(0, 40_000, (200_000, 2))
    swirl = wind_acceleration(blown, grid, 0.3) - [2.0, 0.0]
    assert np.sqrt((swirl**2).sum(axis=1).mean()) == pytest.approx(0.8, rel=0.01)
    np.testing.assert_allclose(swirl.mean(axis=0), 0, atol=0.01)


@pytest.mark.parametrize("seed", [0, 7])
def test_eddies_are_free_of_divergence(seed: float) -> None:
    blown = Wind(1.0, 30.0, turbulence=1.0, turbulence_size=60.0, seed=int(seed))
    h = 1e-3
    right, left = (wind_acceleration(blown, POINTS + [d, 0], 0.4)[:, 0] for d in (h, -h))
    down, up = (wind_acceleration(blown, POINTS + [0, d], 0.4)[:, 1] for d in (h, -h))
    gradient = np.abs(right - left).max() / (2 * h)
    assert gradient > 1e-3
    assert np.abs((right - left + down - up) / (2 * h)).max() < 1e-6 * gradient


def test_seeds_differ_and_repeat() -> None:
    fields = [wind_acceleration(Wind(seed=seed), POINTS, 0.4) for seed in (1, 2, 1)]
    assert np.abs(fields[0] - fields[1]).max() > 0.1
    np.testing.assert_array_equal(fields[0], fields[2])


@pytest.mark.parametrize("loop", [0.5, 3.0, 7.3])
def test_in_a_loop_the_wind_repeats(loop: float) -> None:
    blown = Wind(2.0, 20.0, gust=1.0, gust_period=1.3, turbulence=0.5)
    now = wind_acceleration(blown, POINTS, 0.37, loop=loop)
    np.testing.assert_allclose(wind_acceleration(blown, POINTS, 0.37 + loop, loop=loop), now, atol=1e-9)
    half = wind_acceleration(blown, POINTS, 0.37 + loop * 0.4, loop=loop)
    assert np.abs(half - now).max() > 0.05


def test_eddies_drift_with_the_wind() -> None:
    """Seen by an eye that is blown along, the field changes less than for one that stands still."""
    blown = Wind(1.0, 0.0, gust=0.0, turbulence=1.0, turbulence_size=100.0, gust_period=1.0)
    t, speed = 0.4, 200.0
    start = wind_acceleration(blown, POINTS, 0.0)
    along = wind_acceleration(blown, POINTS + [speed * t, 0], t)
    against = wind_acceleration(blown, POINTS - [speed * t, 0], t)
    assert np.square(along - start).mean() < 0.6 * np.square(against - start).mean()


@pytest.mark.parametrize("turbulence", [0.0, 0.7])
@pytest.mark.parametrize("tick", [0, 100_003])
def test_the_kernel_blows_as_the_reference(tick: int, turbulence: float) -> None:
    """Free vertices without triangles: a velocity after a tick of one step is the acceleration times the tick."""
    made = scene(Wind(3.0, 40.0, gust=0.5, turbulence=turbulence, turbulence_size=90.0, seed=3))
    count = len(POINTS)
    nothing = np.zeros((0, 4), np.float32)
    solid = Solid.of_triangles(
        starts=np.array([[0, 0], [count, 0]], np.int32),
        substeps=np.array([1], np.int32),
        vertices=np.column_stack([POINTS / SIZE, np.ones(count), np.zeros(count)]).astype(np.float32),
        step_limits=np.full(count, np.inf, np.float32),
        handles=np.full(count, -1, np.int32),
        grips=np.zeros(count, np.float32),
        triangles=np.zeros((0, 3), np.int32),
        inverse_edges=nothing,
        stiffness=nothing[:, :3],
    )
    state = State.at_rest(solid)
    advance(solid, state, drive(made, tick, 1))
    assert made.wind is not None
    exact = wind_acceleration(made.wind, POINTS, (tick + 0.5) * TICK)
    assert np.abs(state.velocity / TICK - exact).max() < 2e-5 * np.abs(exact).max()


def test_a_strip_leans_downwind_and_two_sway_differently() -> None:
    motion = simulate(scene(Wind(1.5, 180.0, turbulence=0.0)), frames=49)
    assert (motion.positions[-1] - motion.positions[0])[-3:, 0].max() < -5
    blown = Wind(1.5, 0.0, turbulence=0.8, turbulence_size=120.0)
    one, other = (simulate(scene(blown, left=left), frames=37) for left in (300.0, 700.0))
    tips = [motion.positions[:, -2] - motion.positions[0, -2] for motion in (one, other)]
    assert np.abs(tips[0] - tips[1]).max() > 3


def test_the_motion_does_not_depend_on_the_picture_s_size() -> None:
    small, large = scene(Wind()), scene(Wind()).rescaled(2 * SIZE, 2 * SIZE)
    assert large.wind is not None
    assert large.wind.turbulence_size == 2 * small.wind.turbulence_size  # type: ignore[union-attr]
    one, other = simulate(small, frames=25).positions, simulate(large, frames=25).positions
    assert np.abs(one[-1] - one[0]).max() > 2
    assert np.abs(one * 2 - other).max() < 0.05


def test_calm_is_no_wind() -> None:
    for none in (None, Wind(0.0)):
        motion = simulate(scene(none), frames=9)
        assert (motion.positions == motion.positions[0]).all()
    assert len(eddies(Wind(0.0)).rate) == 0


def test_wind_loops() -> None:
    motion = simulate(scene(Wind(2.0), loop=2.0))
    assert motion.loop is not None
    assert motion.loop.residual < 0.1
    assert np.ptp(motion.positions, axis=0).max() > 3


def test_the_pattern_of_eddies_is_laid_from_its_origin() -> None:
    blown, shift = Wind(1.0, 20.0, turbulence=0.9, turbulence_size=70.0), np.array([300.0, 4000.0])
    laid = replace(blown, origin=(300.0, 4000.0))
    for t in (0.0, 1.3):
        here = wind_acceleration(blown, POINTS, t)
        np.testing.assert_allclose(wind_acceleration(laid, POINTS + shift, t), here, atol=1e-9)
        assert np.abs(wind_acceleration(laid, POINTS, t) - here).max() > 0.1
    assert "origin" not in scene_to_dict(scene(blown))["wind"]


def test_the_document_keeps_the_wind() -> None:
    blown = Wind(2.0, 30.0, 0.2, 3.0, 0.4, 120.0, 9, (40.0, 12.5))
    document = scene_to_dict(scene(blown))
    assert scene_from_dict(document).wind == blown
    twice = scene_from_dict(scene_to_dict(scene(blown), meshes=False), meshes=[strip(scale=2.0)])
    assert twice.wind == replace(blown, turbulence_size=240.0, origin=(80.0, 25.0))
    assert "wind" not in scene_to_dict(scene(None))
    assert scene_from_dict(scene_to_dict(scene(None)) | {"wind": None}).wind is None
    document["wind"]["gust"] = 1.5
    with pytest.raises(SceneError, match=r"wind.gust: must be at most 1"):
        scene_from_dict(document)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("strength", np.nan),
        ("gust", 1.1),
        ("gust_period", 0.0),
        ("turbulence", -0.1),
        ("turbulence_size", 0.0),
        ("seed", -1),
        ("origin", (0.0, np.inf)),
        ("origin", 3.0),
    ],
)
def test_unusable_values_are_refused(field: str, value: float) -> None:
    with pytest.raises(InvalidInputError, match=f"{field} must be"):
        Wind(**{field: value})  # type: ignore[arg-type]
