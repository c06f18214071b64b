"""Locks of one part: what is short sways faster than what is long, and does not turn over."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.physics.assembly.joints import free_system
from physanimator.physics.assembly.locks import lock_factors
from physanimator.physics.assembly.sway import resolve_stiffness
from physanimator.physics.material import (
    Material,
    deformation_gradients,
    lame_parameters,
    lowest_modes,
    preset,
    rest_shape,
    rotations,
)
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask, ways_from
from physanimator.physics.scene import Body, automatic_scene
from physanimator.physics.simulation import simulate

CROWN, LONG, SHORT = (40, 20, 260, 60), (130, 40, 250, 340), (60, 40, 74, 180)


def drawn(*rectangles: tuple[int, int, int, int]) -> TriangleMesh:
    """Mesh of rectangles (left, top, right, bottom) [px] in a picture of 300 x 400."""
    mask = np.zeros((400, 300))
    for left, top, right, bottom in rectangles:
        mask[top:bottom, left:right] = 1
    return mesh_from_mask(mask, spacing=10)


def held(mesh: TriangleMesh) -> np.ndarray:
    return mesh.vertices[:, 1] < 45


def factors_of(mesh: TriangleMesh) -> np.ndarray:
    even, own = np.ones(len(mesh.triangles)), held(mesh)
    return lock_factors(rest_shape(mesh), even, 0.3, 1.0, own, ways_from(mesh, own))


def frequencies(mesh: TriangleMesh, modulus: np.ndarray) -> dict[str, float]:
    """Of the slowest motion of the short lock and of the long one [1/s], from which side most of it is on."""
    stiffness, masses = free_system(rest_shape(mesh), *lame_parameters(modulus, 0.3), 1.0, held(mesh))
    left, found = np.repeat(mesh.vertices[~held(mesh), 0] < 100, 2), {}
    for mode in lowest_modes(stiffness, masses, most=8, within=10):
        energy = masses * mode**2
        name = "short" if energy[left].sum() > energy.sum() / 2 else "long"
        found.setdefault(name, float(np.sqrt(mode @ (stiffness @ mode) / energy.sum())))
    return found


def test_a_short_thin_lock_is_stiffened_until_it_sways_as_its_length_lets_expect() -> None:
    mesh = drawn(CROWN, LONG, SHORT)
    factors = factors_of(mesh)
    before, after = frequencies(mesh, np.ones(len(factors))), frequencies(mesh, factors)
    assert before["short"] < before["long"]
    assert 0.75 < after["short"] / before["short"] / (300 / 140) < 1.1  # of the ratio of their lengths
    assert after["long"] == pytest.approx(before["long"], rel=0.01)
    assert (mesh.vertices[mesh.triangles].mean(axis=1)[factors > 1, 0] < 100).all()


@pytest.mark.parametrize(
    "rectangles", [(LONG,), (LONG, (60, 40, 110, 340)), (LONG, (50, 40, 120, 170)), ((90, 40, 102, 300),)]
)
def test_locks_that_are_as_stiff_as_their_length_lets_expect_stay_as_they_are(
    rectangles: tuple[tuple[int, int, int, int], ...],
) -> None:
    assert (factors_of(drawn(CROWN, *rectangles)) == 1).all()


def test_the_rest_of_the_part_sways_as_it_did_and_paint_is_left_alone() -> None:
    mesh = drawn(CROWN, LONG, SHORT)
    own, factors = held(mesh), factors_of(mesh)
    modulus, _ = resolve_stiffness(Body(mesh, Material(sway_frequency=1.0)), own)
    np.testing.assert_allclose(modulus / modulus[factors == 1][0], factors)
    soft = np.where(mesh.vertices[mesh.triangles].mean(axis=1)[:, 0] < 100, 0.1, 1.0)
    painted, _ = resolve_stiffness(Body(mesh, Material(sway_frequency=1.0, stiffness_scale=soft)), own)
    np.testing.assert_allclose(painted / painted[factors == 1].max(), factors * soft)


def pointed_locks() -> TriangleMesh:
    """Hair on a head with two long pointed locks below, and a short one on a neck between them."""
    mask = np.zeros((420, 360), np.uint8)
    cv2.ellipse(mask, (180, 120), (90, 80), 0, 180, 360, 1, -1)
    neck = [(170, 118), (180, 118), (180, 135), (185, 175), (172, 240), (165, 175), (170, 135)]
    long = [(95, 118), (155, 118), (108, 380), (92, 380)], [(200, 118), (260, 118), (242, 390), (258, 390)]
    for outline in (neck, *long):
        cv2.fillPoly(mask, [np.array(outline)], 1)
    return mesh_from_mask(mask > 0)


def test_in_a_storm_tips_stream_aside_but_neither_they_nor_any_triangle_are_turned_over() -> None:
    mesh = pointed_locks()
    motion = simulate(automatic_scene([Body(mesh, preset("hair"))], wind_strength=3), frames=36)
    rest, farthest = rest_shape(mesh), 0.0
    for positions in motion.positions.astype(np.float64) / mesh.longest_side:
        gradients = deformation_gradients(rest, positions)
        assert np.linalg.det(gradients).min() > 0.5
        turned = rotations(gradients)
        farthest = max(farthest, np.abs(np.degrees(np.arctan2(turned[:, 1, 0], turned[:, 0, 0]))).max())
    assert 45 < farthest < 85
