"""Narrow joints: a lock of hair on a neck of a few pixels neither flaps nor decides how its whole part sways."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.physics.assembly.joints import joint_factors
from physanimator.physics.assembly.sway import first_frequency, resolve_stiffness
from physanimator.physics.material import Material, lame_parameters, preset, rest_shape
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.scene import Body, automatic_scene
from physanimator.physics.simulation import simulate


def drawn(*rectangles: tuple[int, int, int, int]) -> TriangleMesh:
    """Mesh of rectangles (left, top, right, bottom) [px] in a picture of 300 x 400."""
    mask = np.zeros((400, 300))
    for left, top, right, bottom in rectangles:
        mask[top:bottom, left:right] = 1
    return mesh_from_mask(mask, spacing=10)


STRAND = ((40, 20, 260, 60), (180, 40, 240, 340))  # a crown that is held, and a strand
LOCK = (60, 70, 110, 220)


def held(mesh: TriangleMesh) -> np.ndarray:
    return mesh.vertices[:, 1] < 45


def factors_of(mesh: TriangleMesh) -> np.ndarray:
    return joint_factors(rest_shape(mesh), 0.3, 1.0, held(mesh))


def test_shapes_that_bend_over_a_length_stay_as_they_are() -> None:
    assert (factors_of(drawn(*STRAND)) == 1).all()
    assert (factors_of(drawn(*STRAND, (60, 40, 110, 220))) == 1).all()
    assert (factors_of(drawn(*STRAND, (60, 40, 68, 220))) == 1).all()  # a thin strand is soft all along


def test_a_part_that_hangs_on_one_joint_as_a_whole_stays_as_it_is() -> None:
    """A plant on its stalk sways about the stalk."""
    assert (factors_of(drawn((140, 20, 160, 50), (147, 45, 153, 80), (80, 75, 220, 300))) == 1).all()


@pytest.mark.parametrize("neck", [3, 6])
def test_only_the_neck_of_a_lock_is_stiffened(neck: int) -> None:
    mesh = drawn(*STRAND, LOCK, (85, 50, 85 + neck, 80))
    stiffer = mesh.vertices[mesh.triangles].mean(axis=1)[factors_of(mesh) > 1]
    assert len(stiffer) > 0
    assert (np.abs(stiffer - (85 + neck / 2, 65)) < (15, 30)).all()


@pytest.mark.parametrize("bottom", [140, 180, 220])
def test_the_neck_of_a_lock_is_stiffened_beside_a_strand_that_sways_more_slowly(bottom: int) -> None:
    slow = (200, 40, 220, 380)
    mesh = drawn(STRAND[0], slow, (60, 75, 110, bottom), (82, 50, 88, 80))
    stiffer = mesh.vertices[mesh.triangles].mean(axis=1)[factors_of(mesh) > 1]
    assert len(stiffer) > 0
    assert (np.abs(stiffer - (85, 65)) < (18, 30)).all()
    assert (factors_of(drawn(STRAND[0], slow, (60, 40, 110, bottom))) == 1).all()


def test_a_mask_cut_too_tight_does_not_set_a_front_lock_flying() -> None:
    """Hair on a head, with long hair behind and a front lock that is two thirds as wide where it comes from the head.

    As painted, the lock's tip moves by 13 px in the gusts; a mask 4 px too small thins its neck to two fifths.
    """
    painted = np.zeros((400, 360), np.uint8)
    cv2.ellipse(painted, (180, 110), (90, 80), 0, 180, 360, 1, -1)
    painted[110:360, 225:270] = 1
    painted[105:140, 95:115] = painted[135:230, 90:120] = 1
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (9, 9))
    lock, long = [], []
    for mask in (painted, cv2.erode(painted, disc)):
        mesh = mesh_from_mask(mask > 0)
        motion = simulate(automatic_scene([Body(mesh, preset("hair"))], wind_strength=2), frames=36)
        farthest = np.linalg.norm(motion.positions - mesh.vertices, axis=2).max(axis=0)
        lock.append(farthest[(mesh.vertices[:, 0] < 140) & (mesh.vertices[:, 1] > 140)].max())
        long.append(farthest[mesh.vertices[:, 0] > 220].max())
    assert lock[1] < 1.2 * lock[0]
    assert long[1] > 0.8 * long[0] > 40  # while the wind blows the long hair as ever


@pytest.mark.parametrize("neck", [3, 6, 12])
def test_the_strand_sways_as_it_would_beside_a_lock_that_is_cut_wider(neck: int) -> None:
    """Without the stiffer neck, the lock on 3 px, which is much slower, would give the strand 11 times E."""
    material = Material(sway_frequency=1.0)
    wide, narrow = (drawn(*STRAND, LOCK, (85, 50, 85 + width, 80)) for width in (24, neck))
    softest = [np.median(resolve_stiffness(Body(each, material), held(each))[0]) for each in (wide, narrow)]
    assert softest[1] == pytest.approx(softest[0], rel=0.6)  # wider: the shape itself differs


def test_a_joint_that_was_painted_soft_stays_soft() -> None:
    mesh = drawn(*STRAND)
    inside = np.abs(mesh.vertices[mesh.triangles].mean(axis=1)[:, 1] - 80) < 12
    scale = np.where(inside, 1e-3, 1.0)
    modulus, _ = resolve_stiffness(Body(mesh, Material(sway_frequency=1.0, stiffness_scale=scale)), held(mesh))
    np.testing.assert_allclose(modulus / modulus.max(), scale)


def test_the_part_still_sways_as_often_as_it_is_asked_to() -> None:
    mesh = drawn(*STRAND, LOCK, (85, 50, 88, 80))
    modulus, report = resolve_stiffness(Body(mesh, Material(sway_frequency=1.0)), held(mesh))
    found = first_frequency(rest_shape(mesh), *lame_parameters(modulus, Material().poisson_ratio), 1.0, held(mesh))
    assert found == pytest.approx(report[0].achieved, rel=1e-6)
    assert report[0].achieved == pytest.approx(1.0, rel=1e-6)
