"""Where bodies are held: hair on its head, what hangs behind a head, and ends that touch what stands still."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.rig import Circle, Polygon, RigPoint, vertices_of
from physanimator.physics.scene import Body, Scene, automatic_scene, held_where_said, pins

SIZE = (600, 500)


def painted(*shapes: np.ndarray) -> np.ndarray:
    mask = np.zeros(SIZE, dtype=np.uint8)
    for shape in shapes:
        cv2.fillPoly(mask, [np.array(shape, dtype=np.int32)], 1)
    return mask > 0


def ellipse(x: int, y: int, across: int, down: int) -> np.ndarray:
    return cv2.ellipse2Poly((x, y), (across, down), 0, 0, 360, 4)


def held_of(mask: np.ndarray, attach: str, material: str = "hair", **places: np.ndarray) -> tuple[np.ndarray, Body]:
    body = Body(mesh_from_mask(mask), preset(material), **places)
    held = np.zeros(len(body.mesh.vertices), dtype=bool)
    for point in pins(body, 0, attach=attach):
        held |= vertices_of(point, body.mesh)
    return held, body


def long_hair() -> np.ndarray:
    """Hair that frames a face of 120 px: a dome of radius 90 about (250, 150), and two locks down to 500."""
    hair = painted(ellipse(250, 150, 90, 90), [(160, 150), (215, 150), (190, 500), (120, 500)])
    hair |= painted([(340, 150), (285, 150), (310, 500), (380, 500)])
    return hair & ~painted(ellipse(250, 190, 60, 80))


def test_hair_is_held_down_to_the_middle_of_the_head_that_it_frames() -> None:
    held, body = held_of(long_hair(), "auto")
    y = body.mesh.vertices[:, 1]
    assert 140 < y[held].max() < 175
    assert held[y < 135].all()
    assert not held[y > 180].any()


def short_hair() -> np.ndarray:
    return long_hair() & (np.arange(SIZE[0])[:, None] < 260)


def bundle() -> np.ndarray:
    """Strands that are blown to the right from a root of 200 px at 100 px from the left."""
    tips = [(450, 130), (480, 200), (470, 270), (410, 350)]
    return np.logical_or.reduce([painted([(100, y - 90), (100, y - 30), (x, y)]) for x, y in tips])


def rough(mask: np.ndarray, seed: int) -> np.ndarray:
    """The mask as a hand draws it: too wide or too narrow, with a trembling edge."""
    rng = np.random.default_rng(seed)
    wide = cv2.GaussianBlur(mask.astype(np.float32), (0, 0), 6)
    tremble = cv2.GaussianBlur(rng.normal(size=mask.shape).astype(np.float32), (0, 0), 5)
    return wide > 0.4 + 0.2 * rng.random() + tremble


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("damaged", [None, 0, 1, 2])
def test_hair_that_is_blown_aside_is_held_at_its_thick_end(mirrored: bool, damaged: int | None) -> None:
    mask = bundle() if damaged is None else rough(bundle(), damaged)
    held, body = held_of(mask[:, ::-1] if mirrored else mask, "auto")
    x = body.mesh.vertices[:, 0]
    along = (body.mesh.width - x if mirrored else x) - 100
    rooted = np.isin(body.mesh.components, np.unique(body.mesh.components[along < 20]))  # no tip that has come off
    assert held[rooted & (along < 50)].all()
    assert not held[rooted & (along > 120)].any(), "the tips of the upper strands are free, too"


@pytest.mark.parametrize(
    "mask",
    [
        pytest.param(short_hair, id="short hair"),
        pytest.param(lambda: long_hair() | painted(ellipse(175, 60, 45, 45), ellipse(325, 60, 45, 45)), id="two buns"),
        pytest.param(
            lambda: np.logical_or.reduce(
                [painted([(x, 100), (x + 65, 100), (x + 30 + x // 20, 220)]) for x in range(100, 380, 50)]
            ),
            id="fringe of locks",
        ),
        pytest.param(lambda: painted(ellipse(250, 200, 180, 110)), id="wide hair"),
        pytest.param(lambda: short_hair() | painted([(300, 90), (330, 160), (490, 190)]), id="a strand in the wind"),
    ],
)
def test_hair_wider_than_tall_is_held_on_top_where_it_is_not_blown_aside(mask: Any) -> None:
    held, body = held_of(mask(), "auto")
    y = body.mesh.vertices[:, 1]
    top = y < y.min() + 0.12 * np.ptp(y)
    assert held[top].all()
    assert not held[y > y.max() - 0.2 * np.ptp(y)].any()


def test_a_fringe_over_a_drawn_face_is_held_above_the_forehead() -> None:
    held, body = held_of(long_hair(), "crown")
    y = body.mesh.vertices[:, 1]
    assert held[y < 90].all()
    assert not held[y > 140].any()


def test_hair_behind_a_head_is_held_where_the_head_is_and_hangs_free_below() -> None:
    """The body covers the hair, too: its strands beside the shoulders are nevertheless free."""
    back = painted(ellipse(250, 160, 110, 110), [(140, 160), (360, 160), (400, 560), (100, 560)])
    still = painted(ellipse(250, 170, 70, 90), [(150, 320), (350, 320), (360, 599), (140, 599)])
    still |= painted([(230, 240), (270, 240), (270, 330), (230, 330)])
    held, body = held_of(back, "covered", cover=still)
    x, y = body.mesh.vertices.T
    face = (np.hypot(x - 250, (y - 170) * 7 / 9) < 60) & (y < 210)
    assert held[face].all()
    assert held[(y < 120)].all()
    assert not held[y > 290].any()


def test_a_raised_tail_is_held_where_the_body_covers_its_end() -> None:
    tail = painted([(200, 480), (360, 470), (430, 300), (440, 150), (460, 150), (470, 320), (400, 510), (200, 520)])
    still = painted([(150, 300), (270, 300), (270, 560), (150, 560)])
    held, body = held_of(tail, "end", cover=still)
    x, y = body.mesh.vertices.T
    assert held.sum() >= 3
    assert x[held].max() < 270
    assert not held[y < 400].any()


def test_a_cape_hangs_from_the_shoulders_that_cover_its_top() -> None:
    cape = painted([(180, 200), (320, 200), (420, 560), (80, 560)])
    still = painted([(190, 150), (310, 150), (320, 580), (180, 580)])
    held, body = held_of(cape, "end", "cloth", cover=still)
    y = body.mesh.vertices[:, 1]
    assert held.any()
    assert y[held].max() < 200 + 0.3 * 360


def test_a_scarf_is_held_by_what_it_lies_on() -> None:
    scarf = painted([(180, 300), (420, 300), (420, 340), (180, 340)])
    neck = painted([(150, 200), (250, 200), (250, 400), (150, 400)])
    held, body = held_of(scarf, "end", "ribbon", rests_on=neck)
    x = body.mesh.vertices[:, 0]
    assert held.any()
    assert x[held].max() < 250


def test_a_bow_that_touches_nothing_is_held_at_its_knot() -> None:
    bow = painted(ellipse(150, 300, 45, 40), [(150, 280), (450, 240), (450, 262), (150, 310)])
    held, body = held_of(bow, "end", "ribbon")
    x = body.mesh.vertices[:, 0]
    assert held.any()
    assert x[held].max() < 200


@pytest.mark.parametrize("attach", ["covered", "end", "crown", "head"])
def test_without_anything_that_touches_it_a_part_hangs_from_its_top(attach: str) -> None:
    held, body = held_of(painted([(200, 100), (240, 100), (240, 500), (200, 500)]), attach)
    y = body.mesh.vertices[:, 1]
    assert held[y < 105].all()
    assert not held[y > 100 + 0.5 * 400].any()


@pytest.mark.parametrize("attach", ["auto", "crown", "covered", "end"])
@pytest.mark.parametrize("seed", range(4))
def test_every_part_of_any_shape_is_held_and_moves(seed: int, attach: str) -> None:
    """Random blobs with random things before and behind them: each connected part is held by some of its vertices."""
    random = np.random.default_rng(seed)

    def blobs(share: float) -> np.ndarray:
        noise = cv2.GaussianBlur(random.normal(size=(150, 200)), (0, 0), float(random.uniform(4, 12)))
        return noise > np.quantile(noise, 1 - share)

    mesh = mesh_from_mask(blobs(0.4))
    body = Body(mesh, preset("hair"), cover=blobs(0.5), rests_on=blobs(0.3))
    scene = automatic_scene([body], attach=attach)
    held = np.logical_or.reduce([vertices_of(point, mesh) for point in scene.rig_points])
    for part in range(int(mesh.components.max()) + 1):
        own = held[mesh.components == part]
        assert own.sum() >= 3
        assert not own.all() or len(own) < 12


def test_only_known_sides_are_taken() -> None:
    with pytest.raises(InvalidInputError, match="attach must be one of auto, top, bottom, left, right"):
        held_of(painted([(200, 100), (240, 100), (240, 500)]), "waist")


def test_bodies_that_say_where_are_held_unless_a_rig_point_is_for_them_alone() -> None:
    mesh = mesh_from_mask(np.pad(np.ones((60, 30)), 20), spacing=6)
    bodies = tuple(Body(mesh, preset("cloth"), attach=side) for side in ("top", "none", "bottom", "left"))
    drawn = RigPoint((35.0, 50.0), Circle(5.0)), RigPoint((35.0, 75.0), Circle(5.0), body=2)
    scene = held_where_said(Scene(bodies, rig_points=drawn))
    assert scene.rig_points[-2:] == drawn, "what was drawn comes last, so that it leads"
    assert [point.body for point in scene.rig_points] == [0, 3, None, 2]
    top = scene.rig_points[0].region
    assert isinstance(top, Polygon)
    assert max(y for _, y in top.points) < 32
    free = Scene(bodies[1:3], rig_points=(replace(drawn[1], body=1),))
    assert held_where_said(free) is free
    assert pins(bodies[0], 0, attach="none") == []


def test_scenes_of_bodies_that_nothing_holds_can_be_made() -> None:
    mesh = mesh_from_mask(np.pad(np.ones((60, 30)), 20), spacing=6)
    scene = automatic_scene([Body(mesh, preset("hair")), Body(mesh, preset("hair"))], attach=["none", "top"])
    assert {point.body for point in scene.rig_points} == {1}
