"""Whatever an artist may set, a motion stays finite or is refused with a sentence: never a crash, never a NaN."""

from __future__ import annotations

from typing import get_args

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from physanimator.physics.document import dumps, loads
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.forces import FALLOFFS, EnergyStroke, Wind
from physanimator.physics.material import PRESETS, Material
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.rig import (
    EASINGS,
    Circle,
    KeyedPath,
    MaskRegion,
    Pinned,
    Polygon,
    Pulse,
    RigPoint,
    Rotation,
    Squash,
    Swing,
    Wave,
)
from physanimator.physics.scene import Body, Collider, Contact, Scene, StrokesAs
from physanimator.physics.simulation import simulate

WIDTH, HEIGHT = 96, 72
FRAMES = 6
MOST_WORK = 3e7

coordinates = st.floats(-500, 600)
points = st.tuples(coordinates, coordinates)
wide = st.floats(1e-3, 1e6)


@st.composite
def masks(draw: st.DrawFn) -> np.ndarray:
    """A few discs and bars, some of them beyond the border or touching."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    mask = np.zeros((HEIGHT, WIDTH), dtype=bool)
    for _ in range(draw(st.integers(1, 4))):
        cx, cy = draw(st.integers(0, WIDTH)), draw(st.integers(0, HEIGHT))
        a, b = draw(st.integers(1, 30)), draw(st.integers(1, 30))
        inside = (
            np.abs(x - cx) / a + np.abs(y - cy) / b < 1
            if draw(st.booleans())
            else (((x - cx) / a) ** 2 + ((y - cy) / b) ** 2 < 1)
        )
        mask ^= inside
    return mask


@st.composite
def materials(draw: st.DrawFn) -> Material:
    if draw(st.booleans()):
        return draw(st.sampled_from(list(PRESETS.values())))
    if draw(st.booleans()):
        stiffness = {"mu": 10.0 ** draw(st.floats(-9, 11)), "lambda_": draw(st.one_of(st.just(0.0), wide))}
    else:
        stiffness = {
            "youngs_modulus": 10.0 ** draw(st.floats(-9, 12)),
            "poisson_ratio": draw(st.floats(0, 0.4999)),
            "sway_frequency": draw(st.one_of(st.none(), st.floats(0.001, 1000))),
        }
    return Material(
        **stiffness,
        density=10.0 ** draw(st.floats(-4, 4)),
        damping=draw(st.one_of(st.just(0.0), wide)),
    )


@st.composite
def strokes(draw: st.DrawFn) -> EnergyStroke:
    kind = draw(st.sampled_from(["wind", "repel", "attract"]))
    path = draw(st.lists(points, min_size=2, max_size=4, unique=True))
    start, window = draw(st.floats(0, 0.2)), draw(st.one_of(st.none(), st.floats(0.01, 1)))
    return EnergyStroke(
        kind,
        tuple(path),
        radius=draw(wide),
        speed=draw(st.one_of(st.just(0.0), wide)),
        strength=draw(st.one_of(st.just(0.0), st.floats(-1e6, 1e6))),
        start=start,
        end=None if window is None else start + window,
        interval=draw(st.floats(0.01, 2)),
        falloff=draw(st.sampled_from(FALLOFFS)),
        repeat=None if window is None or draw(st.booleans()) else 1.5 * window,
        strength_keys=draw(st.sampled_from([(), ((0.0, 0.0), (1.0, 3.0)), ((0.5, -1000.0), (0.6, 1000.0))])),
        speed_keys=draw(st.sampled_from([(), ((0.2, 0.001), (1.0, 1000.0))])),
    )


regions = st.one_of(
    st.builds(Circle, st.floats(1, 200)),
    st.builds(Polygon, st.lists(points, min_size=3, max_size=5).map(tuple)),
    st.just(MaskRegion(np.ones((4, 4), dtype=bool))),
)
easings = st.sampled_from(EASINGS)
keyed_times = st.just((0.0, 0.05, 0.1))


def three(values: st.SearchStrategy[float]) -> st.SearchStrategy[tuple[float, ...]]:
    return st.tuples(values, values, values)


motions = st.one_of(
    st.builds(Pinned),
    st.builds(Wave, st.floats(-1e4, 1e4), st.floats(0.01, 10), st.just((0.6, -0.8))),
    st.builds(KeyedPath, keyed_times, st.tuples(points, points, points), easings),
    st.builds(Rotation, keyed_times, three(st.floats(-36000, 36000)), easings),
    st.builds(Swing, st.floats(-3600, 3600), st.floats(0.01, 10)),
    st.builds(Squash, keyed_times, three(st.floats(0.05, 20)), st.floats(-90, 90), st.booleans(), easings),
    st.builds(Pulse, st.floats(0.05, 20), st.floats(0.01, 10)),
)


@st.composite
def rig_points(draw: st.DrawFn) -> RigPoint:
    moving = draw(st.one_of(motions, st.tuples(motions, motions)))
    falloff = draw(st.one_of(st.just(0.0), st.floats(0, 1e4)))
    return RigPoint(draw(points), draw(regions), moving, None, falloff)


winds = st.builds(
    Wind,
    strength=st.one_of(st.just(0.0), st.floats(-1e6, 1e6)),
    angle=st.floats(-1e3, 1e3),
    gust=st.floats(0, 1),
    gust_period=st.floats(0.05, 100),
    turbulence=st.floats(0, 1),
    turbulence_size=st.floats(1, 1e6),
    seed=st.integers(0, 2**31 - 1),
    origin=st.none() | points,
)
contacts = st.builds(Contact, st.floats(0, 1), st.floats(0.01, 100), st.booleans())
colliders = st.one_of(
    st.builds(Collider, st.lists(points, min_size=3, max_size=5).map(lambda ring: Polygon(tuple(ring)))),
    masks().map(Collider.from_mask),
)


@st.composite
def scenes(draw: st.DrawFn) -> Scene | str:
    """A scene, or the sentence with which it is refused."""
    try:
        meshes = [mesh_from_mask(draw(masks()), spacing=draw(st.floats(4, 30))) for _ in range(draw(st.integers(1, 2)))]
        held = draw(st.lists(rig_points(), max_size=3))
        everything = [RigPoint((0.0, 0.0), Circle(1e4))] if draw(st.integers(0, 9)) == 0 else []
        return Scene(
            tuple(Body(mesh, draw(materials())) for mesh in meshes),
            tuple(draw(st.lists(strokes(), max_size=3))),
            tuple(held + held[:1] + everything),  # duplicate pins must be harmless, and everything may be pinned
            draw(st.sampled_from([(0.0, 0.0), (0.0, 1.0), (-1e6, 1e6)])),
            draw(st.sampled_from([12.0, 24.0, 23.976])),
            sag=draw(st.booleans()),
            wind=draw(st.one_of(st.none(), winds)),
            loop=draw(st.one_of(st.none(), st.none(), st.floats(0.1, 0.6))),
            contact=draw(st.one_of(st.none(), contacts)),
            colliders=tuple(draw(st.lists(colliders, max_size=2))),
            time_step=draw(st.one_of(st.none(), st.none(), st.floats(1e-5, 1 / 240))),
            strokes_as=draw(st.sampled_from(get_args(StrokesAs))),
        )
    except InvalidInputError as error:
        return str(error)


def simulated(scene: Scene) -> Motion | str:
    """The motion, or the sentence with which it is refused."""
    try:
        return simulate(scene, frames=FRAMES, max_work=MOST_WORK)
    except InvalidInputError as error:
        return str(error)


@settings(max_examples=80, deadline=None, suppress_health_check=list(HealthCheck))
@given(scenes())
def test_a_motion_is_finite_or_refused(scene: Scene | str) -> None:
    outcome = scene if isinstance(scene, str) else simulated(scene)
    if isinstance(outcome, str):
        assert len(outcome) > 20
        assert " " in outcome
        return
    assert np.isfinite(outcome.positions).all()
    assert isinstance(scene, Scene)
    assert len(outcome) == FRAMES
    if scene.loop is None:
        rest = np.concatenate([body.mesh.vertices for body in outcome.bodies]).astype(np.float32)
        assert np.abs(outcome.positions[0] - rest).max() < 1e-3 * max(WIDTH, HEIGHT)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(scenes())
def test_every_scene_survives_its_document(scene: Scene | str) -> None:
    if isinstance(scene, Scene):
        assert dumps(loads(dumps(scene))) == dumps(scene)
