"""Masks painted onto a body's material, and what the solver makes of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physanimator.physics.assembly import assemble
from physanimator.physics.document import dumps, loads
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import Material, mask_means, painted
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import Polygon, RigPoint
from physanimator.physics.scene import Body, Scene
from physanimator.physics.simulation import simulate

SIZE = 200


def strip(columns: int = 3, rows: int = 12, *, x: float = 90.0, width: float = 24.0) -> TriangleMesh:
    """A strip that hangs from y = 20 to y = 140."""
    xs, ys = np.meshgrid(np.linspace(x, x + width, columns + 1), np.linspace(20, 140, rows + 1))
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            triangles += [(a, b, c), (a, c, d)]
    return TriangleMesh(np.column_stack([xs.ravel(), ys.ravel()]), np.array(triangles), SIZE, SIZE)


TOP = RigPoint((100, 20), Polygon(((0, 0), (200, 0), (200, 21), (0, 21))))


def blown(material: Material, mesh: TriangleMesh, *, frames: int = 25) -> np.ndarray:
    """Positions under a sideways pull."""
    scene = Scene((Body(mesh, material),), rig_points=(TOP,), gravity=(0.6, 0.0), sag=True)
    return simulate(scene, frames=frames).positions


def lower_half() -> np.ndarray:
    return np.arange(SIZE)[:, None] + np.zeros(SIZE) >= 80


def test_means_are_those_of_the_triangles_areas() -> None:
    mesh = TriangleMesh(np.array([[0.0, 0], [160, 0], [0, 160]]), np.array([[0, 1, 2]]), SIZE, SIZE)
    left = np.zeros((SIZE, SIZE))
    left[:, :80] = 1  # all but the right corner, a quarter of the triangle
    np.testing.assert_allclose(mask_means(left, mesh), 0.75)
    slope = np.broadcast_to((np.arange(SIZE) + 0.5) / SIZE, (SIZE, SIZE))
    np.testing.assert_allclose(mask_means(slope, mesh), 160 / 3 / SIZE, atol=0.003)
    coarse = np.kron(np.eye(2), np.ones((4, 4)))
    np.testing.assert_array_equal(mask_means(coarse, mesh), mask_means(np.kron(coarse, np.ones((25, 25))), mesh))


def test_beyond_the_border_the_nearest_pixel_counts() -> None:
    mesh = TriangleMesh(np.array([[210.0, 0], [260, 0], [230, 90]]), np.array([[0, 1, 2]]), SIZE, SIZE)
    mask = np.zeros((SIZE, SIZE), dtype=np.uint8)
    mask[:, -1] = 255
    assert mask_means(mask, mesh) == 1


def test_factors_run_evenly_in_powers_and_multiply() -> None:
    mesh = strip()
    half = painted(Material(), mesh, stiffness=np.full((5, 5), 0.5), low=0.25, high=16.0)
    np.testing.assert_allclose(half.stiffness_scale, 2.0)
    assert half.damping_scale is None
    both = painted(half, mesh, stiffness=np.ones((2, 2), dtype=bool), density=lower_half(), low=1.0, high=3.0)
    np.testing.assert_allclose(both.stiffness_scale, 6.0)
    assert set(np.round(both.density_scale, 9)) == {1.0, 3.0}


def test_stiff_paint_bends_less() -> None:
    mesh = strip()
    plain = Material(youngs_modulus=30.0)
    stiff = painted(plain, mesh, stiffness=~lower_half(), low=1.0, high=20.0)
    tip = [np.ptp(blown(material, mesh)[:, -1, 0]) for material in (plain, stiff)]
    assert 0 < tip[1] < 0.4 * tip[0]


def test_mass_is_that_of_the_paint() -> None:
    mesh = strip()
    heavy = painted(Material(density=2.0), mesh, density=lower_half(), high=5.0)
    system = assemble(Scene((Body(mesh, heavy),), rig_points=(TOP,)))
    painted_area = 24 * 60 / SIZE**2
    np.testing.assert_allclose(system.masses.sum(), 2 * painted_area * (1 + 5), rtol=2e-3)
    assert set(np.round(system.density, 9)) == {2.0, 10.0}


def test_a_heavy_tip_sways_more_slowly() -> None:
    mesh = strip()
    light, heavy = (Material(youngs_modulus=60.0, damping=0.1), lower_half())
    laden = painted(light, mesh, density=heavy, high=6.0)
    swings = [blown(material, mesh, frames=60)[:, -1, 0] for material in (light, laden)]
    first_turn = [int(np.argmax(np.diff(swing) < -0.01)) for swing in swings]
    assert first_turn[1] > 1.3 * first_turn[0] > 0


def test_damping_is_the_mean_by_mass() -> None:
    mesh = strip()
    material = painted(Material(damping=2.0), mesh, damping=lower_half(), low=0.5, high=4.0)
    damping = assemble(Scene((Body(mesh, material),))).damping
    height = mesh.vertices[assemble(Scene((Body(mesh, material),))).order, 1]
    np.testing.assert_allclose(damping[height < 79], 1.0)
    np.testing.assert_allclose(damping[height > 81], 8.0)
    between = damping[np.abs(height - 80) < 1]
    assert ((between > 1.5) & (between < 7.5)).all()


def test_damping_by_mass_leans_to_the_heavier_side() -> None:
    mesh = strip()
    material = painted(Material(damping=2.0), mesh, damping=lower_half(), low=0.5, high=4.0)
    heavy = painted(material, mesh, density=lower_half(), high=9.0)
    middle = [
        assemble(Scene((Body(mesh, each),))).damping[np.abs(mesh.vertices[:, 1] - 80) < 1] for each in (material, heavy)
    ]
    assert (middle[1] > middle[0] + 0.5).all()


def test_paint_of_one_everywhere_changes_nothing() -> None:
    mesh = strip()
    plain = Material(damping=1.3)
    one = replace(plain, **{name: np.ones(len(mesh.triangles)) for name in ("damping_scale", "density_scale")})
    np.testing.assert_array_equal(blown(plain, mesh, frames=8), blown(one, mesh, frames=8))


def test_a_sway_frequency_holds_for_the_painted_body() -> None:
    mesh = strip()
    material = painted(Material(sway_frequency=1.2), mesh, stiffness=lower_half(), density=lower_half())
    (part,) = assemble(Scene((Body(mesh, material),), rig_points=(TOP,))).sway
    assert part.achieved == pytest.approx(1.2)
    unpainted = assemble(Scene((Body(mesh, Material(sway_frequency=1.2)),), rig_points=(TOP,))).sway[0]
    assert part.youngs_modulus > 1.5 * unpainted.youngs_modulus  # the heavy tip asks for a stiffer strip


def test_paint_is_kept_in_the_document() -> None:
    mesh = strip()
    material = painted(Material(), mesh, damping=lower_half(), density=~lower_half())
    read = loads(dumps(Scene((Body(mesh, material),)))).bodies[0].material
    np.testing.assert_array_equal(read.damping_scale, material.damping_scale)
    np.testing.assert_array_equal(read.density_scale, material.density_scale)
    assert read.stiffness_scale is None


@pytest.mark.parametrize("factor", [0.001, 1000.0])
def test_extreme_paint_stays_finite(factor: float) -> None:
    mesh = strip(2, 6)
    everything = {"stiffness": lower_half(), "damping": lower_half(), "density": ~lower_half()}
    material = painted(Material(youngs_modulus=1.0), mesh, **everything, low=1.0, high=factor)
    assert np.isfinite(blown(material, mesh, frames=6)).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"stiffness": np.zeros(4)}, r"mask must be one plane"),
        ({"stiffness": np.full((2, 2), np.nan)}, r"mask must hold finite"),
        ({"stiffness": np.full((2, 2), 3.0)}, r"mask must hold floating-point numbers from 0 to 1"),
        ({"high": 0.0}, r"high must be 0.001 to 1000. Got: 0"),
        ({"low": 1e5}, r"low must be 0.001 to 1000"),
    ],
)
def test_unusable_paint_is_refused(options: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        painted(Material(), strip(), **options)


def test_paint_for_another_mesh_is_refused() -> None:
    material = painted(Material(), strip(2, 6), density=np.ones((2, 2)))
    with pytest.raises(InvalidInputError, match=r"mesh must be the one that density has been painted for"):
        painted(material, strip(), density=np.ones((2, 2)))
    with pytest.raises(InvalidInputError, match=r"density_scale must have one factor for each of the 72 triangles"):
        Body(strip(), material)
