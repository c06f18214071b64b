"""What a stroke can choose: falloff, repetition, strength and speed keyed along the path."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physanimator.physics.assembly import drive
from physanimator.physics.document import scene_from_dict, scene_to_dict
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.forces import (
    FALLOFFS,
    STROKE_KINDS,
    EnergyStroke,
    acceleration,
    all_particles,
    most_alive,
    particles,
)
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.scene import Body, Scene
from physanimator.physics.solver import TICK, Solid, State, advance

LINE = ((0.0, 0.0), (100.0, 0.0))


def resting(kind: str, falloff: str) -> EnergyStroke:
    return EnergyStroke(kind, ((50, 50), (70, 50)), 20.0, 0.0, 2.0, falloff=falloff)  # type: ignore[arg-type]


@pytest.mark.parametrize(("falloff", "share"), [("linear", 0.5), ("smooth", 0.5625), ("constant", 1.0)])
@pytest.mark.parametrize(("kind", "towards"), [("wind", (1.0, 0.0)), ("attract", (-0.6, -0.8)), ("repel", (0.6, 0.8))])
def test_falloffs_by_hand(kind: str, falloff: str, share: float, towards: tuple[float, float]) -> None:
    """10 px from a particle of radius 20 px and strength 2: (1 - 1/4)^2 is 0.5625."""
    result = acceleration(resting(kind, falloff), np.array([(56.0, 58.0)]), 0.0)
    np.testing.assert_allclose(result, [2 * share * np.array(towards)], atol=1e-14)


@pytest.mark.parametrize("falloff", FALLOFFS)
@pytest.mark.parametrize("kind", STROKE_KINDS)
def test_nothing_beyond_the_radius_and_a_finite_centre(kind: str, falloff: str) -> None:
    stroke = resting(kind, falloff)
    np.testing.assert_array_equal(acceleration(stroke, np.array([(70.01, 50.0), (500.0, 50.0)]), 0.0), 0.0)
    centre = acceleration(stroke, np.array([(50.0, 50.0)]), 0.0)
    np.testing.assert_array_equal(centre, [(2.0 if kind == "wind" else 0.0, 0.0)])


def test_the_kernel_knows_every_choice() -> None:
    points = np.random.default_rng(0).uniform(0, 120, (60, 2))
    strokes = tuple(
        EnergyStroke(
            kind,
            ((10, 60), (110, 50)),
            45.0,
            90.0,
            3.0,
            interval=0.2,
            falloff=falloff,
            strength_keys=((0.1, 0.5), (0.9, -2.0)),
            speed_keys=((0.0, 2.0), (1.0, 0.5)),
        )
        for kind in STROKE_KINDS
        for falloff in FALLOFFS
    )
    mesh = TriangleMesh(np.array([[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]]), np.array([[0, 1, 2]]), 128, 128)
    count, tick = len(points), 200
    solid = Solid.of_triangles(
        starts=np.array([[0, 0], [count, 0]], np.int32),
        substeps=np.array([1], np.int32),
        vertices=np.column_stack([points / 128, np.ones(count), np.zeros(count)]).astype(np.float32),
        step_limits=np.full(count, np.inf, np.float32),
        handles=np.full(count, -1, np.int32),
        grips=np.zeros(count, np.float32),
        triangles=np.zeros((0, 3), np.int32),
        inverse_edges=np.zeros((0, 4), np.float32),
        stiffness=np.zeros((0, 3), np.float32),
    )
    for stroke in strokes:
        state = State.at_rest(solid)
        advance(solid, state, drive(Scene((Body(mesh),), (stroke,)), tick, 1))
        exact = acceleration(stroke, points, (tick + 0.5) * TICK)
        assert np.abs(exact).max() > 0.5
        assert np.abs(state.velocity / TICK - exact).max() < 1e-4 * np.abs(exact).max(), (stroke.kind, stroke.falloff)


def test_repetitions_by_hand() -> None:
    """Two particles leave at 1.0 and 1.2 s, again from 2.0 s on, and take half a second."""
    stroke = EnergyStroke(path=LINE, speed=200.0, start=1.0, end=1.4, interval=0.2, repeat=1.0)
    for t, places in ((0.99, []), (1.1, [20]), (1.3, [60, 20]), (1.6, [80]), (1.75, []), (2.3, [60, 20]), (9.6, [80])):
        np.testing.assert_allclose(particles(stroke, t)[0][:, 0], places, atol=1e-9)
    slower = replace(stroke, speed=80.0)  # 1.25 s: those of two repetitions are under way together
    np.testing.assert_allclose(particles(slower, 2.22)[0][:, 0], [97.6, 81.6, 17.6, 1.6], atol=1e-9)
    assert most_alive(slower) >= 4
    assert stroke.most_particles >= 2


def test_a_resting_particle_comes_and_goes() -> None:
    stroke = EnergyStroke("repel", LINE, speed=0.0, start=0.5, end=0.8, repeat=1.0)
    alive = [len(particles(stroke, t)[0]) for t in (0.4, 0.5, 0.7, 0.81, 1.4, 1.5, 5.79, 5.81)]
    assert alive == [0, 1, 1, 0, 0, 1, 1, 0]
    always = replace(stroke, end=1.5)
    assert all(len(particles(always, t)[0]) for t in np.arange(0.5, 20, 0.1))


def test_most_alive_bounds_repetitions() -> None:
    random = np.random.default_rng(2)
    for _ in range(60):
        window = random.uniform(0.05, 1.0)
        stroke = EnergyStroke(
            path=LINE,
            speed=random.uniform(10, 400),
            start=random.uniform(0, 1),
            end=None,
            interval=random.uniform(0.02, 0.6),
        )
        stroke = replace(stroke, end=stroke.start + window, repeat=window + random.choice([0.0, random.uniform(0, 1)]))
        counts = [len(particles(stroke, t)[0]) for t in random.uniform(0, 20, 60)]
        assert max(counts) <= most_alive(stroke)


def test_strength_goes_by_its_keys() -> None:
    stroke = EnergyStroke(
        path=LINE, radius=50.0, speed=100.0, strength=3.0, end=0.1, strength_keys=((0.2, 0.0), (0.6, 2.0))
    )
    found = [all_particles([stroke], t).strength[0] for t in (0.1, 0.2, 0.3, 0.4, 0.6, 0.9)]
    np.testing.assert_allclose(found, [0, 0, 1.5, 3, 6, 6], atol=1e-12)
    np.testing.assert_allclose(acceleration(stroke, np.array([(40.0, 10.0)]), 0.4), [(3 * 0.8, 0)])


def test_speed_goes_by_its_keys() -> None:
    """From 1 to 3 times 100 px/s over 100 px: x' = 100 + 2 x, so x = 50 (exp(2 t) - 1), in ln(3) / 2 seconds."""
    stroke = EnergyStroke(path=LINE, speed=100.0, end=0.1, speed_keys=((0.0, 1.0), (1.0, 3.0)))
    assert stroke.travel.lifetime == pytest.approx(np.log(3) / 2)
    for t in (0.0, 0.2, 0.5):
        np.testing.assert_allclose(particles(stroke, t)[0], [(50 * np.expm1(2 * t), 0)], atol=1e-9)
    assert len(particles(stroke, 0.56)[0]) == 0
    plateau = replace(stroke, speed_keys=((0.25, 2.0), (0.75, 2.0)))
    np.testing.assert_allclose(particles(plateau, 0.3)[0], [(60.0, 0)])
    np.testing.assert_allclose(particles(replace(stroke, speed_keys=((0.5, 1.0),)), 0.3)[0], [(30.0, 0)])


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("falloff", "sharp"),
        ("repeat", 0.5),
        ("repeat", 0.0),
        ("repeat", np.nan),
        ("strength_keys", ((0.5, 1.0), (0.5, 2.0))),
        ("strength_keys", ((0.5, 1.0), (1.1, 2.0))),
        ("strength_keys", (0.5, 1.0)),
        ("strength_keys", ((0.5, np.inf),)),
        ("speed_keys", ((0.5, 0.0),)),
    ],
)
def test_unusable_choices_are_refused(field: str, value: object) -> None:
    with pytest.raises(InvalidInputError, match=field):
        EnergyStroke(path=LINE, end=1.0, **{field: value})  # type: ignore[arg-type]


def test_a_stroke_without_an_end_cannot_repeat() -> None:
    with pytest.raises(InvalidInputError, match="repeat must be left out where the stroke has no end"):
        EnergyStroke(path=LINE, repeat=1.0)


def test_the_document_keeps_the_choices() -> None:
    stroke = EnergyStroke(
        path=LINE,
        end=1.0,
        falloff="smooth",
        repeat=2.0,
        strength_keys=((0.0, 1.0), (1.0, 0.0)),
        speed_keys=((0.5, 2.0),),
    )
    mesh = TriangleMesh(np.array([[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]]), np.array([[0, 1, 2]]), 128, 128)
    assert scene_from_dict(scene_to_dict(Scene((Body(mesh),), (stroke,)))).strokes == (stroke,)
