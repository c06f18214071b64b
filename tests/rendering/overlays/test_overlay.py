"""Overlays put their colours where the things are."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.forces import EnergyStroke
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import Motion
from physanimator.physics.rig import Circle, KeyedPath, MaskRegion, Pinned, Polygon, RigPoint, Rotation, Wave
from physanimator.physics.scene import Body, Scene
from physanimator.rendering.overlays import draw_strokes, draw_wireframe, flow_to_color, preview
from physanimator.rendering.overlays.overlay import STROKE_COLOURS
from physanimator.rendering.overlays.rig_overlay import RIG_COLOURS, draw_rig

WIDTH, HEIGHT = 200, 120
GREY = np.full((HEIGHT, WIDTH, 3), 128, np.uint8)
MESH = TriangleMesh(
    np.array([[40, 30], [100, 30], [100, 90], [40, 90]]), np.array([[0, 2, 1], [0, 3, 2]]), WIDTH, HEIGHT
)


def changed(picture: NDArray[np.uint8]) -> NDArray[np.bool_]:
    return (picture != GREY).any(axis=2)


def has_colour(picture: NDArray[np.uint8], x: int, y: int, colour: tuple[int, int, int], reach: int = 2) -> bool:
    patch = picture[y - reach : y + reach + 1, x - reach : x + reach + 1].reshape(-1, 3).astype(int)
    return bool((np.abs(patch - colour).max(axis=1) < 60).any())


def test_a_wireframe_lies_on_its_edges_and_nowhere_else() -> None:
    picture = draw_wireframe(GREY, MESH)
    marks = changed(picture)
    assert picture.shape == GREY.shape
    assert marks[60, 39:42].any()  # boundary
    assert marks[59:62, 69:72].any()  # diagonal
    assert not marks[35:45, 80:95].any()
    assert not marks[:, 110:].any()
    assert (GREY == 128).all()


def test_a_wireframe_follows_positions_and_the_size_of_the_picture() -> None:
    moved = changed(draw_wireframe(GREY, MESH, MESH.vertices + np.array([50, 0])))
    assert moved[60, 89:92].any()
    assert not moved[60, 30:60].any()
    half = np.full((HEIGHT // 2, WIDTH // 2, 3), 128, np.uint8)
    drawn = (draw_wireframe(half, MESH) != 128).any(axis=2)
    assert drawn[30, 19:22].any()
    assert not drawn[:, 55:].any()


@pytest.mark.parametrize("shade", [0, 255])
def test_lines_can_be_read_on_black_and_on_white(shade: int) -> None:
    page = np.full((HEIGHT, WIDTH, 3), shade, np.uint8)
    for picture in (
        draw_wireframe(page, MESH),
        draw_strokes(page, [EnergyStroke(path=((20, 60), (180, 60)))], 0.0),
        draw_rig(page, [RigPoint((100, 60))], 0.0),
    ):
        assert np.abs(picture.astype(int) - shade).max() > 150


@pytest.mark.parametrize("kind", ["wind", "repel", "attract"])
def test_strokes_have_the_colour_of_their_kind_and_their_particles_travel(kind: str) -> None:
    stroke = EnergyStroke(kind, ((20, 60), (180, 60)), radius=15, speed=100, interval=10)
    colour = STROKE_COLOURS[kind]
    early, late = (draw_strokes(GREY, [stroke], t) for t in (0.0, 1.0))
    assert has_colour(early, 100, 60, colour)
    assert changed(early)[45:48, 20].any()
    assert not changed(early)[45:48, 120].any()
    assert changed(late)[45:48, 120].any()
    assert not changed(late)[45:48, 20].any()
    assert changed(early)[52:56, 160:172].any()  # a barb of the arrow


def test_a_stroke_of_one_point_is_drawn_without_an_arrow() -> None:
    picture = draw_strokes(GREY, [EnergyStroke("repel", ((100, 60),), radius=20)], 0.0)
    assert has_colour(picture, 100, 60, STROKE_COLOURS["repel"])
    assert changed(picture)[60, 80]


def test_rig_points_show_their_kind_their_region_and_their_motion() -> None:
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[80:100, 20:60] = True
    rig = [
        RigPoint((30, 30), Circle(12), Pinned()),
        RigPoint((100, 60), Circle(8), Wave(amplitude=30, period=4)),
        RigPoint((150, 30), Polygon(((140, 20), (160, 20), (150, 40))), KeyedPath((0, 1), ((0, 0), (0, 50)))),
        RigPoint((40, 90), MaskRegion(mask), Pinned()),
    ]
    start, later = draw_rig(GREY, rig, 0.0), draw_rig(GREY, rig, 1.0)
    assert has_colour(start, 30, 30, RIG_COLOURS["Pinned"])
    assert changed(start)[30, 41:44].any()
    assert has_colour(start, 100, 60, RIG_COLOURS["Wave"])
    assert has_colour(later, 130, 60, RIG_COLOURS["Wave"])
    assert has_colour(later, 150, 80, RIG_COLOURS["KeyedPath"])
    assert changed(later)[70:72, 141:159].any()
    assert changed(start)[85, 19:22].any()


def test_a_turned_region_is_drawn_turned() -> None:
    bar = Polygon(((100, 58), (140, 58), (140, 62), (100, 62)))
    rig_point = RigPoint((100, 60), bar, (Rotation((0, 1), (0, 90)), Wave(20, 4)))
    start, later = draw_rig(GREY, [rig_point], 0.0), draw_rig(GREY, [rig_point], 1.0)
    assert changed(start)[60, 130]
    assert not changed(start)[30, 120]
    assert changed(later)[30, 120]  # upright, above where the wave has led the point
    assert not changed(later)[60, 150]


def test_scale_carries_everything_to_another_size() -> None:
    double = np.full((2 * HEIGHT, 2 * WIDTH, 3), 128, np.uint8)
    assert has_colour(draw_rig(double, [RigPoint((30, 30))], 0.0, scale=2), 60, 60, RIG_COLOURS["Pinned"])
    stroke = EnergyStroke(path=((20, 60), (180, 60)), start=5)
    assert has_colour(draw_strokes(double, [stroke], 0.0, scale=(2, 2)), 200, 120, STROKE_COLOURS["wind"])


def test_a_preview_shows_bodies_strokes_and_rig_of_its_frame() -> None:
    body = Body(MESH)
    motion = Motion((body,), np.stack([MESH.vertices, MESH.vertices + np.array([50, 0])]), 24.0)
    scene = Scene((body,), (EnergyStroke(path=((20, 105), (180, 105)), radius=5),), (RigPoint((30, 15), Circle(5)),))
    picture = preview(GREY, motion, scene, 1)
    assert changed(picture)[60, 89:92].any()
    assert has_colour(picture, 100, 105, STROKE_COLOURS["wind"])
    assert has_colour(picture, 30, 15, RIG_COLOURS["Pinned"])
    bare = preview(GREY, motion, scene, 1, wireframe=False, rig=False, strokes=False)
    np.testing.assert_array_equal(bare, GREY)
    np.testing.assert_array_equal(preview(GREY, motion, None, 0), draw_wireframe(GREY, MESH))
    floats = preview(GREY.astype(np.float32) / 255, motion, scene, 1)
    assert floats.dtype == np.float32
    np.testing.assert_allclose(floats, picture / 255, atol=1e-6)


def test_a_preview_of_a_missing_frame_is_refused() -> None:
    motion = Motion((Body(MESH),), MESH.vertices[None], 24.0)
    with pytest.raises(InvalidInputError, match=r"frame must be 0 to 0\. Got: 3"):
        preview(GREY, motion, None, 3)


def test_flow_colours_are_the_usual_wheel() -> None:
    flow = np.zeros((1, 6, 2), np.float32)
    flow[0, :5] = [(10, 0), (-10, 0), (0, 10), (0, -10), (5, 0)]
    picture = flow_to_color(flow, np.array([[True] * 5 + [False]]))
    right, left, down, up, half, outside = picture[0].astype(int)
    assert tuple(right) == (255, 0, 0)
    assert left[2] > 200 > 100 > left[0]  # cyan to blue
    assert down[0] > 200 < down[1] + 60
    assert down[2] == 0  # yellow
    assert up[2] > 200 > 100 > up[1]  # blue to magenta
    assert tuple(half) == (255, 128, 128)
    assert tuple(outside) == (255, 255, 255)
    assert not flow_to_color(flow, np.zeros((1, 6), bool), outside="black").any()


def test_no_flow_is_white_and_too_much_is_darker() -> None:
    flow = np.zeros((2, 2, 2), np.float32)
    assert (flow_to_color(flow) == 255).all()
    flow[0, 0] = (20, 0)
    assert tuple(flow_to_color(flow, max_px=10)[0, 0]) == (191, 0, 0)


def test_bad_flow_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="displacement must be of shape"):
        flow_to_color(np.zeros((4, 4, 3)))
    with pytest.raises(InvalidInputError, match="max_px must be above 0"):
        flow_to_color(np.zeros((4, 4, 2)), max_px=0)
