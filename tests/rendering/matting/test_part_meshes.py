"""Meshes of parts as the picture shows them: what is drawn moves with the mesh."""

from __future__ import annotations

import cv2
import numpy as np
from physanimator.physics.mesh import PixelBox, mesh_from_mask, triangle_ids
from physanimator.rendering.matting import part_mesh
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.pipeline import animate

WIDTH, HEIGHT, FINE = 230, 170, 4
SKY, RED, INK = np.float32((0.62, 0.77, 0.9)), np.float32((0.8, 0.3, 0.25)), np.float32((0.12, 0.06, 0.1))


def drawn() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A picture of an outlined part with a long strand, uint8; the part's coverage, and that of the strand alone."""
    fine = np.zeros((HEIGHT * FINE, WIDTH * FINE), np.uint8)
    cv2.fillPoly(fine, [np.int32([(30, 40), (90, 30), (110, 80), (95, 140), (40, 150)]) * FINE], 1)
    body = fine.copy()
    cv2.polylines(fine, [np.int32([(95, 70), (150, 72), (200, 100)]) * FINE], False, 1, 16)
    away = cv2.distanceTransform(1 - fine, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    inner, outer, alone = (
        cv2.resize(each.astype(np.float32), (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
        for each in (fine, away <= 1.5 * FINE, fine - body)
    )
    picture = SKY + outer[..., None] * (INK - SKY)
    picture = picture + inner[..., None] * (RED - picture)
    return np.rint(picture * 255).astype(np.uint8), outer, alone


def shrunk(mask: np.ndarray) -> np.ndarray:
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (9, 9))
    return cv2.erode((mask > 0.5).astype(np.float32), disc)


def test_the_mesh_covers_what_a_shrunk_mask_has_lost() -> None:
    picture, part, strand = drawn()
    mesh = part_mesh(picture, shrunk(part))
    covered = triangle_ids(mesh.vertices, mesh.triangles, PixelBox(0, 0, WIDTH, HEIGHT)) >= 0
    assert covered[strand > 0.5].mean() > 0.9
    assert covered[part < 0.02].sum() < 0.03 * (part > 0.5).sum()


def test_masks_that_fit_give_the_mesh_that_they_gave() -> None:
    picture, part, _ = drawn()
    for mask in (part, (part > 0.5).astype(np.float32)):
        with_picture, without = part_mesh(picture, mask), mesh_from_mask(mask)
        assert np.array_equal(with_picture.vertices, without.vertices)
        assert np.array_equal(with_picture.triangles, without.triangles)


def test_strands_get_as_many_triangles_across_with_a_picture_as_without() -> None:
    picture, part, _ = drawn()
    few, many = (part_mesh(picture, shrunk(part), spacing=14, elements_across=across) for across in (1, 8))
    assert len(many.triangles) > 2 * len(few.triangles)


def test_transparency_bounds_the_mesh() -> None:
    """A white part of a sprite over white: the colours have no edge, the silhouette has."""
    inside = np.clip(40.5 - np.hypot(np.arange(WIDTH) - 100, np.arange(HEIGHT)[:, None] - 80), 0, 1)
    sprite = np.dstack([np.full((HEIGHT, WIDTH, 3), 255), inside * 255]).astype(np.uint8)
    sprite[:60, :, :3] = (150, 90, 60)
    grown = cv2.dilate((inside > 0.5).astype(np.float32), np.ones((13, 13), np.uint8))
    mesh = part_mesh(sprite, grown)
    assert np.hypot(*(mesh.vertices - (100, 80)).T).max() < 44
    assert np.hypot(*(mesh_from_mask(grown).vertices - (100, 80)).T).max() > 45


def test_animations_leave_no_strand_behind() -> None:
    picture, part, strand = drawn()
    animation = animate(picture, [shrunk(part)], timing=Timing(frames=2))
    left = np.abs(animation.renderer.plate / 255 - SKY).mean(axis=2)[strand > 0.5] > 0.12
    assert left.mean() < 0.05


def test_in_betweens_show_the_part_as_the_keyframes_do() -> None:
    """A blurred mask must not make the part translucent between the keyframes."""
    picture, part, _ = drawn()
    blurred = cv2.GaussianBlur((part > 0.5).astype(np.float32), (0, 0), 3)
    errors = []
    for mask in (part, blurred):
        animation = animate(picture, [mask], timing=Timing(frames=5), wind=AutomaticWind(strength=3))
        between = list(animation.frames(every=4))[2].astype(int)
        errors.append(np.abs(between - animation.renderer.frame(2)).mean())
    assert errors[1] < 1.5 * errors[0] + 0.1
