"""The automatic scene holds bodies where they are attached and lets a wind pass that reaches all of them."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.forces import acceleration
from physanimator.physics.material import preset
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import vertices_of
from physanimator.physics.scene import Body, automatic_scene
from physanimator.physics.scene.attachment import attachment_of


def grid(x0: float, y0: float, x1: float, y1: float, *, columns: int = 6, rows: int = 12) -> TriangleMesh:
    """A rectangle cut into triangles on a picture of 1000x800."""
    x, y = np.meshgrid(np.linspace(x0, x1, columns), np.linspace(y0, y1, rows))
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.reshape(-1) for part in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return TriangleMesh(np.stack([x.reshape(-1), y.reshape(-1)], 1), triangles, 1000, 800)


def body_of(mesh: TriangleMesh) -> Body:
    return Body(mesh, preset("hair"))


def two_parts() -> TriangleMesh:
    left, right = grid(100, 100, 200, 400), grid(300, 250, 340, 380)
    vertices = np.concatenate([left.vertices, right.vertices])
    triangles = np.concatenate([left.triangles, right.triangles + len(left.vertices)])
    return TriangleMesh(vertices, triangles, 1000, 800)


def test_each_part_is_held_at_its_top() -> None:
    mesh = two_parts()
    scene = automatic_scene([body_of(mesh)])
    held = np.zeros(len(mesh.vertices), dtype=bool)
    for point in scene.rig_points:
        held |= vertices_of(point, mesh)
    for component in (0, 1):
        part = mesh.vertices[mesh.components == component]
        below = part[held[mesh.components == component], 1].max()
        assert held[mesh.components == component].sum() >= 3
        assert below <= part[:, 1].min() + 0.3 * np.ptp(part[:, 1])


def test_a_narrow_neck_on_the_border_is_the_root() -> None:
    stalk = np.array([[480.0, 820], [520, 820], [490, 500], [510, 500], [380, 300], [620, 300], [500, 200]])
    assert attachment_of(stalk, 1000, 800) == "bottom"


def test_a_wide_hem_on_the_border_still_hangs_from_the_top() -> None:
    skirt = np.array([[450.0, 400], [550, 400], [300, 830], [700, 830], [350, 600], [650, 600]])
    assert attachment_of(skirt, 1000, 800) == "top"


@pytest.mark.parametrize(("side", "axis", "extreme"), [("left", 0, min), ("right", 0, max), ("bottom", 1, max)])
def test_the_side_can_be_chosen(side: str, axis: int, extreme: object) -> None:
    mesh = grid(100, 100, 300, 500)
    (point,) = automatic_scene([body_of(mesh)], attach=side).rig_points
    held = vertices_of(point, mesh)
    assert held.any()
    assert not held.all()
    assert extreme(mesh.vertices[held, axis]) == extreme(mesh.vertices[:, axis])
    assert np.ptp(mesh.vertices[held, axis]) < 0.3 * np.ptp(mesh.vertices[:, axis])


@pytest.mark.parametrize("angle", [0.0, 90.0, 180.0])
def test_the_wind_is_at_the_last_of_many_small_bodies_in_little_more_than_a_second(angle: float) -> None:
    along = np.arange(12) * 75.0
    places = [(40.0, x) for x in along] if angle == 90.0 else [(x, 40.0) for x in along]
    meshes = [grid(x, y, x + 30, y + 30) for x, y in places]
    strokes = automatic_scene([body_of(mesh) for mesh in meshes], wind_angle=angle).strokes
    for mesh in meshes:
        pushes = [sum(acceleration(stroke, mesh.vertices, t) for stroke in strokes) for t in np.arange(0, 1.2, 1 / 24)]
        assert np.abs(pushes).max() > 0.1 * strokes[0].strength


@pytest.mark.parametrize("angle", [0.0, 90.0, 180.0, 215.0])
def test_the_wind_reaches_every_vertex_and_blows_where_it_should(angle: float) -> None:
    mesh = grid(100, 100, 300, 500)
    scene = automatic_scene([body_of(mesh)], wind_angle=angle)
    total = np.zeros((len(mesh.vertices), 2))
    for t in np.arange(0, 3, 1 / 24):
        total += sum(acceleration(stroke, mesh.vertices, t) for stroke in scene.strokes)
    direction = np.array([np.cos(np.deg2rad(angle)), -np.sin(np.deg2rad(angle))])
    assert (total @ direction > 0).all()
    assert abs(total.mean(0) @ direction) > 0.8 * np.linalg.norm(total.mean(0))


def test_calm_has_no_strokes() -> None:
    assert automatic_scene([body_of(grid(100, 100, 300, 500))], wind_strength=0).strokes == ()


def test_sides_are_one_or_one_each() -> None:
    bodies = [body_of(grid(100, 100, 300, 500)), body_of(grid(500, 100, 700, 500))]
    first, second = automatic_scene(bodies, attach=["left", "bottom"]).rig_points
    assert vertices_of(first, bodies[0].mesh)[0]
    assert not vertices_of(second, bodies[1].mesh)[0]
    assert vertices_of(second, bodies[1].mesh)[-1]
    with pytest.raises(InvalidInputError, match=r"attach must be one side, or one for each of 2 bodies. Got: 3"):
        automatic_scene(bodies, attach=["left", "bottom", "top"])
    with pytest.raises(InvalidInputError, match=r"attach must be one of auto, top, bottom, left, right. Got: inside"):
        automatic_scene(bodies, attach="inside")
    with pytest.raises(InvalidInputError, match="bodies must be at least one"):
        automatic_scene([])


def test_smaller_bodies_sway_faster_unless_told_otherwise() -> None:
    bodies = [Body(grid(0, 0, 180, 240), preset("cloth")), Body(grid(0, 0, 45, 60), preset("cloth"))]
    large, small = automatic_scene(bodies).bodies
    usual = preset("cloth").sway_frequency
    # The larger one is taken for as large as a head of hair usually is, wherever it is and on whatever picture.
    assert large.material.sway_frequency == pytest.approx(usual * np.sqrt(0.3 / 0.46))
    assert small.material.sway_frequency == pytest.approx(2 * large.material.sway_frequency)
    as_given = automatic_scene(bodies, sway_by_size=False).bodies
    assert [body.material.sway_frequency for body in as_given] == [usual, usual]


@pytest.mark.parametrize("strength", [1e6, -1e6, float("inf"), float("nan")])
@pytest.mark.parametrize("turbulence", [None, 0.5])
def test_wind_beyond_what_acts_is_refused_by_its_own_name(strength: float, turbulence: float | None) -> None:
    body = body_of(grid(0, 0, 900, 1200))
    with pytest.raises(
        InvalidInputError, match=r"wind_strength must be -100000 to 100000 \(1 is gentle, 3 a storm\)\. Got: "
    ):
        automatic_scene([body], wind_strength=strength, turbulence=turbulence)
    assert automatic_scene([body], wind_strength=1e5, turbulence=turbulence).bodies


@pytest.mark.parametrize(("bottom", "calmer"), [(240, True), (700, False)])
def test_hair_on_the_face_answers_the_wind_less(bottom: float, calmer: bool) -> None:
    """A fringe that ends above the chin of a head 200 px wide, and hair that hangs far below it."""
    body = body_of(grid(300, 50, 500, bottom, columns=12, rows=24))
    behind = body_of(grid(280, 50, 520, 750, columns=12, rows=24))
    bodies = automatic_scene([behind, body], attach=["head", "crown"]).bodies
    same = automatic_scene([behind, body], attach=["head", "head"]).bodies
    material, usual = bodies[1].material, same[1].material
    assert bodies[0].material.wind_response == same[0].material.wind_response
    assert material.sway_frequency is not None
    if calmer:
        assert material.wind_response < 0.7 * usual.wind_response
    else:
        assert material.wind_response == usual.wind_response
    steady = automatic_scene([behind, body], attach=["head", "crown"], sway_by_size=False).bodies[1].material
    assert steady.sway_frequency == body.material.sway_frequency
    assert steady.wind_response == material.wind_response
