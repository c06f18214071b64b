"""Warnings about scenes that probably do something else than meant."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.motion import Motion, stillness
from physanimator.physics.rig import Circle, RigPoint
from physanimator.physics.scene import Body, Scene, advice, mask_advice
from physanimator.physics.scene.advising import inverted_masks


def two_triangles() -> TriangleMesh:
    """Separate parts whose tops are (10, 5) and (60, 45)."""
    vertices = np.array([[10.0, 5], [20, 30], [5, 30], [60, 45], [70, 80], [50, 80]])
    return TriangleMesh(vertices, np.array([[0, 1, 2], [3, 4, 5]], dtype=np.int32), 100, 100)


def test_a_part_that_nothing_holds_is_named_with_its_top() -> None:
    scene = Scene((Body(two_triangles(), name="hair"),), rig_points=(RigPoint((10, 5), Circle(3)),))
    (sentence,) = advice(scene)
    assert sentence.startswith("bodies[0] (hair) has one separate part that no rig point holds")
    assert "(60, 45)" in sentence
    assert "(10, 5)" not in sentence


def test_held_parts_and_bodies_that_are_free_on_purpose_need_no_word() -> None:
    mesh = two_triangles()
    held = (RigPoint((10, 5), Circle(3)), RigPoint((60, 45), Circle(3)))
    assert advice(Scene((Body(mesh),), rig_points=held)) == []
    assert advice(Scene((Body(mesh),))) == []


def test_a_rig_point_beside_everything_is_reported() -> None:
    (sentence,) = advice(Scene((Body(two_triangles()),), rig_points=(RigPoint((90, 10), Circle(3)),)))
    assert sentence.startswith("rig_points[0] touches no body")


@pytest.mark.parametrize(("inverted", "held"), [(True, "bodies[0] (hair) covers 93 % of the picture"), (False, "")])
def test_what_covers_most_of_the_picture_may_be_inverted(inverted: bool, held: str) -> None:
    part = np.zeros((90, 120), bool)
    part[20:45, 30:60] = True
    sentences = inverted_masks(Scene((Body(mesh_from_mask(part != inverted), name="hair"),)))
    assert len(sentences) == inverted
    assert all(each.startswith(held) and each.endswith("invert it") for each in sentences)


def test_a_large_part_that_leaves_the_border_free_is_meant() -> None:
    part = np.zeros((90, 120), bool)
    part[8:82, 10:110] = True
    assert part.mean() > 0.6
    assert advice(Scene((Body(mesh_from_mask(part)),))) == []


def test_a_clip_in_which_nothing_moves_is_reported() -> None:
    body = Body(two_triangles())
    rest = np.repeat(body.mesh.vertices[None].astype(np.float32), 12, axis=0)
    (sentence,) = stillness(Motion((body,), rest, 24.0))
    assert sentence.startswith("nothing moves at all in 12 frames")
    moving = rest.copy()
    moving[2, 0, 0] += 1
    assert stillness(Motion((body,), moving, 24.0)) == []
    assert stillness(Motion((body,), rest[:11], 24.0)) == []


def test_tiny_and_inverted_masks_are_reported() -> None:
    mask = np.zeros((60, 80))
    assert mask_advice(mask) == []
    mask[5:8, 5:9] = 1
    assert mask_advice(mask) == ["the mask covers 12 px only: is it the whole part that shall move?"]
    assert "inverted" in mask_advice(1 - mask)[0]
    mask[5:25, 5:35] = 1
    assert mask_advice(mask) == []
