"""Sway frequencies: eigenfrequencies against beam theory, and the stiffness that follows from them."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.assembly import assemble
from physanimator.physics.assembly.sway import SWAY_SUBSTEPS, first_frequency, resolve_stiffness
from physanimator.physics.material import Material, RestShape, lame_parameters
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.scene import Body

Grid = tuple[np.ndarray, np.ndarray]


def grid(columns: int, rows: int, *, width: float, height: float, left: float = 0.0) -> Grid:
    """Vertices [px] and triangles of a rectangle that hangs from y = 0."""
    x, y = np.meshgrid(np.linspace(left, left + width, columns + 1), np.linspace(0, height, rows + 1))
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b, c, d = a + 1, a + columns + 1, a + columns + 2
            triangles += [(a, b, d), (a, d, c)] if (row + column) % 2 else [(a, b, c), (b, d, c)]
    return np.column_stack([x.ravel(), y.ravel()]), np.array(triangles, dtype=np.int32)


def joined(*grids: Grid) -> TriangleMesh:
    """Several rectangles as one mesh over a picture of 1024 x 768."""
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in grids])
    vertices = np.concatenate([vertices for vertices, _ in grids])
    triangles = np.concatenate([t + start for (_, t), start in zip(grids, starts, strict=False)])
    return TriangleMesh(vertices, triangles, 1024, 768)


def frequency(mesh: TriangleMesh, modulus: np.ndarray | float, held: np.ndarray, poisson: float = 0.3) -> float | None:
    rest = RestShape(mesh.vertices / 1024, mesh.triangles)
    mu, lam = lame_parameters(np.broadcast_to(modulus, len(mesh.triangles)), poisson)
    return first_frequency(rest, mu, lam, 1.0, held)


def top(mesh: TriangleMesh) -> np.ndarray:
    return mesh.vertices[:, 1] < 1e-6


@pytest.mark.parametrize(("across", "low", "high"), [(2, 1.8, 2.0), (4, 1.5, 1.62), (12, 1.46, 1.50)])
def test_a_strand_sways_as_beam_theory_says(across: int, low: float, high: float) -> None:
    """60 x 400 px at E = 530: 1.5 Hz by Euler-Bernoulli in plane strain; coarse meshes are too stiff."""
    mesh = joined(grid(across, round(across * 400 / 60), width=60, height=400))
    theory = 1.8751**2 / (2 * np.pi) * np.sqrt(530 / (1 - 0.3**2) / 12) * (60 / 1024) / (400 / 1024) ** 2
    assert theory == pytest.approx(1.5, abs=0.01)
    found = frequency(mesh, 530.0, top(mesh))
    assert found is not None
    assert low < found < high


def test_a_very_slender_strand_keeps_its_bending_mode() -> None:
    mesh = joined(grid(4, 600, width=4, height=600))
    theory = 1.8751**2 / (2 * np.pi) * np.sqrt(530 / (1 - 0.3**2) / 12) * (4 / 1024) / (600 / 1024) ** 2
    assert frequency(mesh, 530.0, top(mesh)) == pytest.approx(theory, rel=0.1)


def test_turning_about_a_single_pin_does_not_count() -> None:
    """Hinged and free: the first mode that bends has beta L = 3.9266, 4.386 times the clamped strand's frequency."""
    mesh = joined(grid(4, 40, width=20, height=400))
    clamped = frequency(mesh, 500.0, top(mesh))
    hinged = frequency(mesh, 500.0, np.arange(len(mesh.vertices)) == 2)
    assert clamped is not None
    assert hinged is not None
    assert hinged / clamped == pytest.approx((3.9266 / 1.8751) ** 2, rel=0.05)


def test_without_anything_held_or_free_there_is_no_sway() -> None:
    mesh = joined(grid(2, 4, width=40, height=80))
    assert frequency(mesh, 500.0, np.zeros(len(mesh.vertices), dtype=bool)) is None
    assert frequency(mesh, 500.0, np.ones(len(mesh.vertices), dtype=bool)) is None


def test_each_part_gets_the_stiffness_that_its_sway_needs() -> None:
    """A wide and a narrow strand sway alike, a short one faster; one that nothing holds keeps its material."""
    mesh = joined(
        grid(4, 20, width=60, height=300),
        grid(4, 40, width=25, height=float(np.sqrt(60**2 + 300**2 - 25**2)), left=200),
        grid(4, 10, width=15, height=75, left=300),
        grid(4, 10, width=60, height=150, left=400),
    )
    held = top(mesh) & (mesh.vertices[:, 0] < 350)
    material = Material(youngs_modulus=321.0, sway_frequency=1.2)
    modulus, report = resolve_stiffness(Body(mesh, material), held, 7)
    part = mesh.components[mesh.triangles[:, 0]]
    for number, wanted in enumerate((1.2, 1.2, 2.4)):
        own = joined(*[(mesh.vertices, mesh.triangles[part == number])])
        only = np.unique(own.triangles)
        rest = RestShape(own.vertices[only] / 1024, np.searchsorted(only, own.triangles).astype(np.int32))
        found = first_frequency(rest, *lame_parameters(modulus[part == number], 0.3), 1.0, held[only])
        assert found == pytest.approx(wanted, rel=1e-6)
    assert modulus[part == 1][0] > 3 * modulus[part == 0][0]
    assert (modulus[part == 3] == 321.0).all()
    assert [(entry.body, entry.part) for entry in report] == [(7, 0), (7, 1), (7, 2)]
    assert [entry.achieved for entry in report] == pytest.approx([1.2, 1.2, 2.4])


def test_a_stiffness_painted_on_keeps_its_ratios() -> None:
    mesh = joined(grid(4, 20, width=60, height=300))
    scale = np.linspace(1, 3, len(mesh.triangles))
    material = Material(sway_frequency=0.8, stiffness_scale=scale)
    modulus, _ = resolve_stiffness(Body(mesh, material), top(mesh))
    np.testing.assert_allclose(modulus / modulus[0], scale / scale[0])
    assert frequency(mesh, modulus, top(mesh)) == pytest.approx(0.8, rel=1e-6)


def test_density_does_not_change_the_sway() -> None:
    mesh = joined(grid(4, 20, width=60, height=300))
    light, _ = resolve_stiffness(Body(mesh, Material(sway_frequency=1.0)), top(mesh))
    heavy, _ = resolve_stiffness(Body(mesh, Material(sway_frequency=1.0, density=5.0)), top(mesh))
    np.testing.assert_allclose(heavy, 5 * light, rtol=1e-9)


def test_three_vertices_can_sway() -> None:
    mesh = TriangleMesh(np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]]), np.array([[0, 1, 2]]), 100, 100)
    for held in ([True, True, False], [True, False, False]):
        modulus, report = resolve_stiffness(Body(mesh, Material(sway_frequency=2.0)), np.array(held))
        assert report[0].achieved == pytest.approx(2.0)
        assert np.isfinite(modulus).all()
        assert modulus[0] > 0


def test_everything_pinned_keeps_the_material() -> None:
    mesh = joined(grid(2, 4, width=40, height=80))
    modulus, report = resolve_stiffness(
        Body(mesh, Material(youngs_modulus=9.0, sway_frequency=2.0)), mesh.vertices[:, 0] >= 0
    )
    assert (modulus == 9.0).all()
    assert report == []


def test_an_eigenvalue_that_cannot_be_found_leaves_the_material(monkeypatch: pytest.MonkeyPatch) -> None:
    import scipy.sparse.linalg

    def fails(*_args: object, **_options: object) -> None:
        raise RuntimeError("Factor is exactly singular")

    monkeypatch.setattr(scipy.sparse.linalg, "eigsh", fails)
    mesh = joined(grid(4, 20, width=60, height=300))
    modulus, report = resolve_stiffness(Body(mesh, Material(youngs_modulus=9.0, sway_frequency=2.0)), top(mesh))
    assert (modulus == 9.0).all()
    assert report == []


def test_a_sway_out_of_reach_is_bounded_and_reported() -> None:
    from physanimator.physics.assembly import plan
    from physanimator.physics.rig import Polygon, RigPoint
    from physanimator.physics.scene import Scene

    mesh = joined(grid(4, 200, width=8, height=400))
    pin = RigPoint((4.0, 0.0), Polygon(((-1.0, -1.0), (9.0, -1.0), (9.0, 1.0), (-1.0, 1.0))))
    scene = Scene((Body(mesh, Material(sway_frequency=100.0)),), (), (pin,))
    planned = plan(scene, frames=2)
    assert planned.substeps <= SWAY_SUBSTEPS
    assert planned.substeps > SWAY_SUBSTEPS / 2
    (part,) = planned.sway
    assert part.wanted == 100.0
    assert 0.5 < part.achieved < 10.0
    assert frequency(mesh, assemble(scene).youngs_modulus[0], top(mesh)) == pytest.approx(part.achieved, rel=1e-6)
