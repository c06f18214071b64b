"""Whatever an artist may set, a motion stays finite or is refused with a sentence: never a crash, never a NaN."""

from __future__ import annotations

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import PRESETS, Material
from physanimator.physics.meshing import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.rig import Circle, KeyedPath, MaskRegion, Pinned, Polygon, RigPoint, Wave
from physanimator.physics.scene import Body, Scene
from physanimator.physics.scene_json import dumps, loads
from physanimator.physics.simulation import simulate
from physanimator.physics.strokes import EnergyStroke

WIDTH, HEIGHT = 96, 72
FRAMES = 6

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
    return Material(
        youngs_modulus=10.0 ** draw(st.floats(-9, 12)),
        poisson_ratio=draw(st.floats(0, 0.4999)),
        density=10.0 ** draw(st.floats(-4, 4)),
        damping=draw(st.one_of(st.just(0.0), wide)),
        sway_frequency=draw(st.one_of(st.none(), st.floats(0.001, 1000))),
    )


@st.composite
def strokes(draw: st.DrawFn) -> EnergyStroke:
    kind = draw(st.sampled_from(["wind", "repel", "attract"]))
    path = draw(st.lists(points, min_size=2, max_size=4, unique=True))
    return EnergyStroke(
        kind,
        tuple(path),
        radius=draw(wide),
        speed=draw(st.one_of(st.just(0.0), wide)),
        strength=draw(st.one_of(st.just(0.0), st.floats(-1e6, 1e6))),
        start=draw(st.floats(0, 0.2)),
        interval=draw(st.floats(0.01, 2)),
    )


@st.composite
def rig_points(draw: st.DrawFn) -> RigPoint:
    regions = st.one_of(
        st.builds(Circle, st.floats(1, 200)),
        st.builds(Polygon, st.lists(points, min_size=3, max_size=5).map(tuple)),
        st.just(MaskRegion(np.ones((4, 4), dtype=bool))),
    )
    motions = st.one_of(
        st.just(Pinned()),
        st.builds(Wave, st.floats(-1e4, 1e4), st.floats(0.01, 10), st.just((0.6, -0.8))),
        st.lists(points, min_size=2, max_size=3).map(
            lambda keys: KeyedPath(tuple(0.05 * number for number in range(len(keys))), tuple(keys))
        ),
    )
    return RigPoint(draw(points), draw(regions), draw(motions))


@st.composite
def scenes(draw: st.DrawFn) -> Scene | str:
    """A scene, or the sentence with which it is refused."""
    try:
        mesh = mesh_from_mask(draw(masks()), spacing=draw(st.floats(4, 30)))
        held = draw(st.lists(rig_points(), max_size=3))
        return Scene(
            (Body(mesh, draw(materials())),),
            tuple(draw(st.lists(strokes(), max_size=3))),
            tuple(held + held[:1]),  # duplicate pins must be harmless
            draw(st.sampled_from([(0.0, 0.0), (0.0, 1.0), (-1e6, 1e6)])),
            draw(st.sampled_from([12.0, 24.0, 23.976])),
        )
    except InvalidInputError as error:
        return str(error)


def simulated(scene: Scene) -> Motion | str:
    """The motion, or the sentence with which it is refused."""
    try:
        return simulate(scene, frames=FRAMES, max_work=3e7)
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
    rest = np.concatenate([body.mesh.vertices for body in outcome.bodies]).astype(np.float32)
    np.testing.assert_array_equal(outcome.positions[0], rest)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(scenes())
def test_every_scene_survives_its_document(scene: Scene | str) -> None:
    if isinstance(scene, Scene):
        assert dumps(loads(dumps(scene))) == dumps(scene)
