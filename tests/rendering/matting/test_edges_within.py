"""Masks that end within one colour are told from those that end at a line or another colour."""

from __future__ import annotations

import cv2
import numpy as np
import painted_art
import pytest
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.rig import KeyedPath, MaskRegion, RigPoint
from physanimator.physics.scene import Body, Scene
from physanimator.rendering.edge_advice import edge_advice, edges_in_words
from physanimator.rendering.matting import open_edges
from physanimator.rendering.options import Timing, Watch
from physanimator.rendering.pipeline import animate

SIZE = 240


def drawing(line: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """A banner before a backdrop of the same lightness, and where it is; with an outline, or without."""
    picture = np.full((SIZE, SIZE, 3), (120, 160, 170), np.uint8)
    picture[::8] = (110, 150, 165)
    part = np.zeros((SIZE, SIZE), np.uint8)
    cv2.fillPoly(part, [np.array([[60, 30], [180, 30], [200, 190], [120, 215], [50, 190]])], 1)
    shade = np.linspace(190, 225, SIZE)[None, :, None] * np.array([1, 0.7, 0.5])
    picture = np.where(part[..., None] > 0, shade, picture).astype(np.uint8)
    if line:
        outline, _ = cv2.findContours(part, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        cv2.polylines(picture, outline, True, (50, 25, 40), line, cv2.LINE_AA)
    return picture, part.astype(np.float32)


def torn(part: np.ndarray) -> np.ndarray:
    """The part without its lower right corner."""
    mask = part.copy()
    cv2.fillPoly(mask, [np.array([[100, 239], [239, 90], [239, 239]])], 0)
    return mask


def damaged(picture: np.ndarray, how: str) -> np.ndarray:
    if how == "noise":
        picture = np.clip(picture + np.random.default_rng(0).normal(0, 4, picture.shape), 0, 255).astype(np.uint8)
    if how == "jpeg":
        picture = cv2.imdecode(cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 50])[1], cv2.IMREAD_COLOR)
    if how == "blur":
        picture = cv2.GaussianBlur(picture, (0, 0), 1)
    if how == "float":
        return picture.astype(np.float32) / 255
    return picture


@pytest.mark.parametrize("line", [0, 2, 4])
@pytest.mark.parametrize("how", ["clean", "noise", "jpeg", "blur", "float"])
def test_a_part_that_is_cut_short_is_found_where_it_is(line: int, how: str) -> None:
    picture, part = drawing(line)
    picture = damaged(picture, how)
    assert open_edges(picture, part) == []
    (edge,) = open_edges(picture, torn(part))
    assert np.abs(edge.points.mean(axis=0) - (159, 174)).max() < 15
    assert 50 < edge.length < 110


@pytest.mark.parametrize("radius", [2, 4])
@pytest.mark.parametrize("how", ["grown", "shrunk", "blurred"])
def test_a_mask_that_is_only_inexact_is_not_meant(how: str, radius: int) -> None:
    picture, part = drawing()
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1,) * 2)
    changes = {
        "grown": lambda: cv2.dilate(part, disc),
        "shrunk": lambda: cv2.erode(part, disc),
        "blurred": lambda: cv2.GaussianBlur(part, (0, 0), radius),
    }
    assert open_edges(picture, changes[how]()) == []


def test_the_border_of_the_picture_is_no_edge_and_a_larger_picture_says_its_own_pixels() -> None:
    picture, part = drawing()
    assert open_edges(picture[:, :150], part[:, :150]) == []
    large = cv2.resize(picture, None, fx=7, fy=7, interpolation=cv2.INTER_CUBIC)
    (edge,) = open_edges(large, cv2.resize(torn(part), None, fx=7, fy=7, interpolation=cv2.INTER_LINEAR))
    assert np.abs(edge.points.mean(axis=0) - (1113, 1218)).max() < 150


@pytest.mark.parametrize("line", [8, 16, 24])
@pytest.mark.parametrize("within", [-0.5, 0, 0.5])
def test_a_mask_may_end_anywhere_within_a_bold_outline(line: int, within: float) -> None:
    picture, part = drawing(line)
    radius = round(abs(within) * line)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1,) * 2)
    assert open_edges(picture, (cv2.dilate if within > 0 else cv2.erode)(part, disc)) == []


def test_black_on_black_says_nothing() -> None:
    picture, part = drawing()
    picture[part > 0] = np.minimum(picture[part > 0], 20)
    picture[150:, 120:] = 12
    assert open_edges(picture, part) == []


def test_along_what_covers_the_part_nothing_is_said() -> None:
    picture, part = drawing()
    cover = (part > 0) & (torn(part) == 0)
    assert open_edges(picture, torn(part), elsewhere=cover) == []


def test_transparency_is_an_edge() -> None:
    picture, part = drawing(line=0)
    sprite = np.dstack([np.full_like(picture, 255), (part * 255).astype(np.uint8)])
    assert open_edges(sprite, part) == []
    assert len(open_edges(sprite, torn(part))) == 1


@pytest.mark.parametrize("technique", painted_art.TECHNIQUES)
@pytest.mark.parametrize("part", painted_art.PARTS)
def test_paint_without_lines_gives_no_alarm(technique: str, part: str) -> None:
    picture, mask = painted_art.painted(technique, part)
    assert open_edges(picture, mask.astype(np.float32)) == []


@pytest.mark.parametrize(("led", "said"), [("pinned", False), ("moved", True), ("elsewhere", True)])
def test_what_is_held_there_tears_nothing_off(led: str, said: bool) -> None:
    picture, part = drawing()
    mask = torn(part)
    region = np.zeros(mask.shape, bool)
    if led == "elsewhere":
        region[:60] = True
    else:
        region[120:, 100:] = True
    motion = {"motion": KeyedPath((0.0, 1.0), ((0.0, 0.0), (9.0, 0.0)))} if led == "moved" else {}
    pin = RigPoint((159, 174), MaskRegion(region), **motion)
    scene = Scene((Body(mesh_from_mask(mask, spacing=12), name="banner"),), rig_points=(pin,))
    told = edge_advice([open_edges(picture, mask)], scene)
    assert [each.startswith("bodies[0] (banner): its mask ends within one colour") for each in told] == [True] * said


def test_the_library_says_it_before_the_simulation() -> None:
    picture, part = drawing()
    notes: list[str] = []
    watch = Watch(on_note=notes.append, on_scene=lambda _scene: notes.append("scene"))
    animate(picture, [torn(part)], timing=Timing(frames=2), watch=watch)
    assert [each[:22] for each in notes] == ["bodies[0]: its mask en", "scene"]
    notes.clear()
    animate(picture, [part], timing=Timing(frames=2), watch=watch)
    assert notes == ["scene"]


def test_many_places_are_counted_and_none_says_nothing() -> None:
    picture, part = drawing()
    (edge,) = open_edges(picture, torn(part))
    (sentence,) = edges_in_words([edge] * 4)
    assert sentence.count(" px") == 3
    assert "and so on" in sentence
    assert edges_in_words([]) == []
