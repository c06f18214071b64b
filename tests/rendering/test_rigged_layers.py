"""Layers are held where such things are worn: hair on its head, a skirt at the waist, a tail behind the body."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.animation import Animation
from physanimator.rendering.artwork import ArtLayer, Artwork
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.pipeline import animate

WIDTH, HEIGHT = 400, 520


def layer(name: str, colour: tuple[int, int, int], *shapes: object) -> ArtLayer:
    pixels = np.zeros((HEIGHT, WIDTH, 4), dtype=np.uint8)
    for shape in shapes:
        cv2.fillPoly(pixels, [np.array(shape, dtype=np.int32)], (*colour, 255), cv2.LINE_AA)
    return ArtLayer(name, pixels)


def ellipse(x: int, y: int, across: int, down: int) -> np.ndarray:
    return cv2.ellipse2Poly((x, y), (across, down), 0, 0, 360, 4)


def figure() -> Artwork:
    """A figure from behind to before: tail, back hair, body, skirt, face, front hair, ribbon."""
    return Artwork(
        WIDTH,
        HEIGHT,
        (
            layer("background", (220, 230, 240), [(0, 0), (WIDTH, 0), (WIDTH, HEIGHT), (0, HEIGHT)]),
            layer("しっぽ", (200, 140, 80), [(200, 370), (290, 350), (330, 250), (345, 255), (310, 380), (200, 400)]),
            layer("後ろ髪", (90, 50, 40), ellipse(200, 100, 75, 75), [(125, 100), (275, 100), (285, 330), (115, 330)]),
            layer("体", (120, 130, 180), [(190, 150), (210, 150), (250, 210), (240, 420), (160, 420), (150, 210)]),
            layer("スカート", (60, 60, 120), [(160, 350), (240, 350), (290, 480), (110, 480)]),
            layer("顔", (245, 215, 195), ellipse(200, 105, 50, 60)),
            layer(
                "前髪",
                (110, 60, 50),
                [(145, 130), (150, 60), (200, 35), (250, 60), (255, 130), (230, 95), (200, 115), (170, 95)],
            ),
            layer("リボン", (220, 60, 60), ellipse(225, 55, 22, 18), [(235, 45), (370, 20), (372, 36), (235, 62)]),
        ),
    )


@pytest.fixture(scope="module")
def animation() -> Animation:
    return animate(figure(), wind=AutomaticWind(1.5), timing=Timing(frames=30))


def moves_of(animation: Animation, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Places at rest of a layer's vertices, shape [v, 2], and how far each goes [px], shape [v]."""
    number = [body.name for body in animation.scene.bodies].index(name)
    places = animation.motion.of_body(number)
    return places[0], np.linalg.norm(places - places[:1], axis=2).max(axis=0)


def test_front_hair_stays_on_the_forehead_and_its_tips_sway(animation: Animation) -> None:
    places, moves = moves_of(animation, "前髪")
    assert moves[places[:, 1] < 60].max() < 1e-3
    assert moves[places[:, 1] > 120].max() > 3


def test_back_hair_stays_behind_the_head_and_swings_below_the_neck(animation: Animation) -> None:
    """The body covers it down to its ends, and yet these are free."""
    places, moves = moves_of(animation, "後ろ髪")
    face = np.hypot((places[:, 0] - 200) / 45, (places[:, 1] - 105) / 50) < 1
    assert moves[face & (places[:, 1] < 140)].max() < 1e-3
    assert moves[places[:, 1] < 80].max() < 1e-3
    ends = moves[places[:, 1] > 310]
    assert np.median(ends) > 5
    assert np.median(moves[(places[:, 1] > 170) & (places[:, 1] < 200)]) < 0.35 * np.median(ends)


def test_a_skirt_hangs_from_its_waist_and_a_tail_from_where_the_body_covers_it(animation: Animation) -> None:
    places, moves = moves_of(animation, "スカート")
    assert moves[places[:, 1] < 355].max() < 1e-3
    assert moves[places[:, 1] > 470].max() > 2
    places, moves = moves_of(animation, "しっぽ")
    held = moves < 1e-3
    assert held.any()
    assert places[held, 0].max() < 245
    assert moves[places[:, 1] < 270].max() > 3


def test_a_ribbon_stays_tied_into_hair_that_is_held(animation: Animation) -> None:
    places, moves = moves_of(animation, "リボン")
    assert np.median(moves[places[:, 0] < 225]) < 0.5
    assert moves[places[:, 0] > 360].max() > 3


def test_what_is_found_is_in_the_scene_as_pins_that_can_be_changed(animation: Animation) -> None:
    bodies = animation.scene.bodies
    assert {point.body for point in animation.scene.rig_points} == set(range(len(bodies)))
    assert [body.material.root_stiffness > 1 for body in bodies] == [True] * 5
    assert all(3 <= len(point.region.points) < 80 for point in animation.scene.rig_points)


def test_a_ribbon_on_a_chest_hangs_from_its_knot_where_an_arm_passes_in_front_of_its_ends() -> None:
    whole = figure()
    tie = layer("ribbon", (30, 140, 140), [(190, 170), (210, 170), (215, 330), (185, 330)])
    arm = layer("腕", (245, 215, 195), [(170, 290), (230, 290), (230, 312), (170, 312)])
    artwork = Artwork(WIDTH, HEIGHT, (*whole.layers, tie, arm))
    made = animate(artwork, wind=AutomaticWind(1.5), timing=Timing(frames=12))
    places, moves = moves_of(made, "ribbon")
    assert moves[places[:, 1] < 180].max() < 1e-3
    assert moves[places[:, 1] > 320].min() > 1
