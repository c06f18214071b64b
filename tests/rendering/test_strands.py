"""Strands: slits where lines are drawn between tips, none where nothing is drawn, and strands that swing apart."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.scene import Body, Contact
from physanimator.rendering.options import AutomaticWind, Timing, Touching
from physanimator.rendering.pipeline import animate
from physanimator.rendering.strands import split_into_strands

HAIR, LINE, PAPER = (150, 90, 60), (50, 25, 20), (235, 240, 245)
NOTCHES = ((170, 320), (230, 320))


def hair(*, lines: bool = True, noise: float = 0.0, inner: int = 390) -> tuple[np.ndarray, np.ndarray]:
    """A lock 180 px wide that ends in three tips, on paper, and its mask; lines run up from both notches.

    The tip in the middle ends in the row ``inner``.
    """
    outline = np.array([(110, 40), (290, 40), (290, 330), (260, 390), *NOTCHES[::-1][:1], (200, inner), NOTCHES[0],
                        (140, 390), (110, 330)])  # fmt: skip
    picture = np.full((420, 400, 3), PAPER, dtype=np.uint8)
    cv2.fillPoly(picture, [outline], HAIR, cv2.LINE_AA)
    if lines:
        for x, y in NOTCHES:
            cv2.line(picture, (x, y), (x, 120), LINE, 3, cv2.LINE_AA)
    mask = cv2.fillPoly(np.zeros((420, 400), np.uint8), [outline], 255, cv2.LINE_AA) / 255
    if noise:
        random = np.random.default_rng(0)
        picture = np.clip(picture + random.normal(0, noise, picture.shape), 0, 255).astype(np.uint8)
    return picture, mask.astype(np.float32)


def split(picture: np.ndarray, mask: np.ndarray) -> tuple[Body, Body]:
    body = Body(mesh_from_mask(mask, spacing=14), preset("hair"))
    return body, Body(split_into_strands(picture, body), body.material)


def slit_edges(before: Body, after: Body) -> np.ndarray:
    """Where both ends of each edge of a slit are [px], shape [e, 2, 2]."""
    places = {tuple(sorted(map(tuple, edge))) for edge in before.mesh.vertices[before.mesh.boundary_edges].tolist()}
    edges = after.mesh.vertices[after.mesh.boundary_edges]
    return np.array([edge for edge in edges if tuple(sorted(map(tuple, edge.tolist()))) not in places])


@pytest.mark.parametrize("noise", [0.0, 6.0])
def test_slits_run_along_the_lines_and_end_before_the_root(noise: float) -> None:
    before, after = split(*hair(noise=noise))
    edges = slit_edges(before, after)
    for x, y in NOTCHES:
        own = edges[np.abs(edges[:, :, 0].mean(axis=1) - x) < 20]
        inside = own[own[:, :, 1].max(axis=1) < y - 10]
        assert len(inside) >= 6
        assert np.abs(inside[:, :, 0] - x).max() < 4, "on the line"
        assert 120 < inside[:, :, 1].min() < 220
    assert after.mesh.components.max() == 0
    assert after.mesh.areas.min() > 0
    assert after.mesh.areas.sum() == pytest.approx(before.mesh.areas.sum())


def test_beside_a_tip_that_hardly_sticks_out_slits_are_short() -> None:
    """It would else flap on all its length between the locks that it lies among."""
    before, after = split(*hair(inner=355))
    for x, y in NOTCHES:
        own = slit_edges(before, after)
        own = own[np.abs(own[:, :, 0].mean(axis=1) - x) < 20]
        assert y - 95 < own[:, :, 1].min() < y - 45


@pytest.mark.parametrize("noise", [0.0, 6.0])
def test_where_nothing_is_drawn_there_is_no_slit(noise: float) -> None:
    before, after = split(*hair(lines=False, noise=noise))
    assert after.mesh is before.mesh


def test_lines_on_what_covers_a_part_are_not_those_of_its_strands() -> None:
    picture, mask = hair()
    cover = np.zeros(mask.shape, dtype=bool)
    cover[150:320] = True
    body = Body(mesh_from_mask(mask, spacing=14), preset("hair"), cover=cover)
    assert split_into_strands(picture, body, attach="top") is body.mesh
    assert len(split_into_strands(picture, body, attach="top", alone=True).vertices) > len(body.mesh.vertices)


def test_strands_swing_apart_and_the_drawing_stays_as_it_is() -> None:
    picture, mask = hair()
    gaps, wholes = [], []
    for strands in (None, False):
        animation = animate(
            picture, [mask], strands=strands, wind=AutomaticWind(2.0), timing=Timing(frames=30), spacing=14
        )
        assert animation.scene.bodies[0].strands == (strands is None)
        assert np.abs(animation.renderer.frame(0).astype(int) - picture).max() <= 1
        motion = animation.motion.of_body(0)
        rest = motion[0]
        left, right = (np.linalg.norm(rest - (x, 380), axis=1).argmin() for x in (140, 200))
        apart = np.linalg.norm(motion[:, left] - motion[:, right], axis=1)
        gaps.append(float(np.ptp(apart)))
        wholes.append(len(animation.scene.bodies[0].mesh.vertices))
    assert wholes[0] > wholes[1]
    assert gaps[0] > 1.25 * gaps[1]


def test_cloth_is_not_split_unless_asked_and_a_scene_is_as_it_says() -> None:
    picture, mask = hair()
    document = {"version": 2, "width": 400, "height": 420, "bodies": [{"strands": True}]}
    options = {"timing": Timing(frames=2), "spacing": 14}

    def count(**more: object) -> int:
        return len(animate(picture, [mask], **options, **more).scene.bodies[0].mesh.vertices)

    whole = count(strands=False)
    assert count(preset="cloth") == whole
    assert count(scene={**document, "bodies": [{}]}) == whole
    assert count(scene=document) > whole
    assert count(scene=document, strands=False) == whole
    assert count(scene={**document, "bodies": [{}]}, strands=True) > whole


def test_parts_that_touch_are_split_and_pixel_art_is_not() -> None:
    picture, mask = hair()
    options = {"timing": Timing(frames=2), "spacing": 14}
    whole = len(animate(picture, [mask], strands=False, **options).scene.bodies[0].mesh.vertices)
    touching = Touching(contact=Contact())
    document = {"version": 2, "width": 400, "height": 420, "bodies": [{"strands": True}], "contact": {}}
    for more in ({"touching": touching}, {"scene": document}):
        assert len(animate(picture, [mask], **options, **more).scene.bodies[0].mesh.vertices) > whole
    drawn = animate(picture, [mask], pixel_art=True, **options).scene.bodies[0]
    assert not drawn.strands
    with pytest.raises(InvalidInputError, match=r"strands must be left out, or off, with pixel_art\. Got: both"):
        animate(picture, [mask], strands=True, pixel_art=True, **options)


def test_slits_in_hair_behind_a_head_stay_near_the_tips() -> None:
    picture, mask = hair()
    body = Body(mesh_from_mask(mask, spacing=14), preset("hair"))
    lengths = {}
    for attach in ("crown", "covered"):
        after = Body(split_into_strands(picture, body, attach=attach), body.material)
        lengths[attach] = float(np.ptp(slit_edges(body, after)[..., 1]))
    assert lengths["crown"] > 120
    assert 40 < lengths["covered"] < 0.8 * lengths["crown"]


@pytest.mark.parametrize("seed", range(6))
def test_any_drawing_is_borne(seed: int) -> None:
    """Random blobs under random scribbles: the mesh keeps its parts, its area and its outline."""
    random = np.random.default_rng(seed)
    noise = cv2.GaussianBlur(random.normal(size=(200, 240)), (0, 0), float(random.uniform(5, 14)))
    mask = (noise > np.quantile(noise, 0.6)).astype(np.float32)
    picture = np.full((200, 240, 3), 200, dtype=np.uint8)
    for _ in range(60):
        start, end = random.integers(0, (240, 200), size=(2, 2))
        cv2.line(picture, start.tolist(), end.tolist(), (20, 20, 20), int(random.integers(1, 4)), cv2.LINE_AA)
    before, after = split(picture, mask)
    assert after.mesh.components.max() == before.mesh.components.max()
    assert after.mesh.areas.min() > 0
    assert after.mesh.areas.sum() == pytest.approx(before.mesh.areas.sum())
    assert len(after.mesh.triangles) == len(before.mesh.triangles)
