"""Stiff roots and soft tips: distances along the shape, the ratio of stiffness, and how it makes a strand move."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from physanimator.physics.assembly import assemble
from physanimator.physics.assembly.roots import distances_from_root, root_factors
from physanimator.physics.assembly.sway import first_frequency
from physanimator.physics.assembly.widths import local_widths
from physanimator.physics.forces import Wind
from physanimator.physics.material import Material, preset
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.rig import Polygon, RigPoint
from physanimator.physics.scene import Body, Scene
from physanimator.physics.simulation import simulate

STRAND = (180, 40, 220, 380)


def mask_of(*boxes: tuple[int, int, int, int]) -> np.ndarray:
    mask = np.zeros((400, 400), dtype=np.float32)
    for left, top, right, bottom in boxes:
        mask[top:bottom, left:right] = 1
    return mask


def strand(material: Material) -> tuple[Scene, np.ndarray]:
    """A strand held at its top in a gust that passes, and the distance of its vertices from the top [px]."""
    mesh = mesh_from_mask(mask_of(STRAND), spacing=12)
    hold = RigPoint((200, 45), Polygon(((170, 30), (230, 30), (230, 70), (170, 70))))
    scene = Scene((Body(mesh, material),), rig_points=(hold,), wind=Wind(0.6))
    return scene, mesh.vertices[:, 1] - 70


def test_distances_go_along_the_shape_and_not_through_the_air() -> None:
    """A hook: its end is near what is held, and yet the farthest."""
    mesh = mesh_from_mask(mask_of((50, 50, 90, 350), (50, 310, 300, 350), (260, 50, 300, 350)), spacing=12)
    held = mesh.vertices[:, 1] < 60
    held &= mesh.vertices[:, 0] < 100
    distances = distances_from_root(mesh, held)
    end = (mesh.vertices[:, 1] < 60) & (mesh.vertices[:, 0] > 250)
    corner = (mesh.vertices[:, 1] > 330) & (mesh.vertices[:, 0] < 70)
    assert distances[held].max() == 0
    assert distances[end].min() > 0.95
    assert distances.max() == 1
    assert 0.3 < distances[corner].mean() < 0.45


def test_the_root_is_as_much_stiffer_as_the_material_says_and_sways_as_often() -> None:
    stiffness = []
    for ratio in (1.0, 20.0):
        material = Material(sway_frequency=0.8, root_stiffness=ratio)
        scene, below = strand(material)
        system = assemble(scene)
        centre = below[system.order][system.rest.triangles].mean(axis=1)
        tip, root = (np.median(system.youngs_modulus[chosen]) for chosen in (centre > 295, centre < 5))
        stiffness.append(root / tip)
        found = first_frequency(system.rest, *system.lame, system.density, system.leaders >= 0)
        assert found == pytest.approx(0.8, rel=1e-3)
    assert stiffness[0] == pytest.approx(1)
    assert stiffness[1] == pytest.approx(20, rel=0.15)


def test_without_a_sway_frequency_the_tip_has_the_modulus_of_the_material() -> None:
    scene, below = strand(Material(youngs_modulus=300.0, root_stiffness=8.0))
    system = assemble(scene)
    centre = below[system.order][system.rest.triangles].mean(axis=1)
    assert np.median(system.youngs_modulus[centre > 300]) == pytest.approx(300, rel=0.1)
    assert np.median(system.youngs_modulus[centre < -10]) == pytest.approx(2400, rel=0.01)


def test_a_stiff_root_stays_while_the_tip_swings() -> None:
    """Near the root the strand leaves its place less, in shares of what its tip does; what is held does not move."""
    shares = []
    for ratio in (1.0, 30.0):
        scene, below = strand(replace(preset("hair"), root_stiffness=ratio))
        moves = np.linalg.norm(np.diff(simulate(scene, frames=40).positions[[0, -1]], axis=0)[0], axis=1)
        assert moves[below < -5].max() < 1e-3
        tip, third = moves[below > 300].mean(), moves[(below > 80) & (below < 110)].mean()
        assert tip > 15
        shares.append(third / tip)
    assert shares[1] < 0.6 * shares[0]


def test_parts_that_nothing_holds_keep_their_stiffness() -> None:
    mesh = mesh_from_mask(mask_of(STRAND, (20, 60, 60, 300)), spacing=12)
    held = (mesh.vertices[:, 1] < 60) & (mesh.vertices[:, 0] > 100)
    loose = mesh.vertices[mesh.triangles][:, 0, 0] < 100
    assert root_factors(mesh, held, 16.0)[loose].max() < 2
    assert np.median(root_factors(mesh, held, 16.0)[loose]) == 1
    assert root_factors(mesh, held, 16.0)[~loose].max() > 12
    assert (root_factors(mesh, np.zeros_like(held), 16.0) == 1).all()
    assert (root_factors(mesh, held, 1.0) == 1).all()


def test_thin_ends_are_stiffer_and_widths_are_those_of_the_shape() -> None:
    mesh = mesh_from_mask(mask_of((100, 40, 180, 250), (135, 250, 145, 390)), spacing=12)
    widths = local_widths(mesh)
    centre = mesh.vertices[mesh.triangles].mean(axis=1)
    assert np.median(widths[centre[:, 1] < 200]) == pytest.approx(80, rel=0.25)
    assert np.median(widths[centre[:, 1] > 280]) == pytest.approx(10, rel=0.3)


@pytest.mark.parametrize("seed", range(6))
def test_any_shape_is_borne(seed: int) -> None:
    """Random blobs, held anywhere: factors are finite, at least 1 and within their bounds."""
    random = np.random.default_rng(seed)
    mask = cv2.GaussianBlur(random.normal(size=(120, 160)), (0, 0), float(random.uniform(2, 9)))
    mesh = mesh_from_mask(mask > np.quantile(mask, 0.7))
    held = random.random(len(mesh.vertices)) < random.choice([0.002, 0.1, 0.9])
    factors = root_factors(mesh, held, 50.0)
    assert np.isfinite(factors).all()
    assert factors.min() >= 1 - 1e-9
    assert factors.max() <= 50 * 16 * (1 + 1e-9)


def test_one_triangle_has_a_root() -> None:
    mesh = TriangleMesh([[1, 1], [9, 1], [5, 9]], [[0, 1, 2]], width=10, height=10)
    assert root_factors(mesh, np.array([True, False, False]), 9.0).shape == (1,)
