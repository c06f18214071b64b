"""The step bound and the mass that slivers may gain."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.assembly import System, assemble
from physanimator.physics.material import (
    Material,
    RestShape,
    highest_eigenvalue,
    lame_parameters,
    lowest_eigenvalue,
    lumped_masses,
    stiffness_matrix,
)
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import Polygon, RigPoint
from physanimator.physics.scene import Body, Scene
from physanimator.physics.solver import SAFETY, TICK, frequency_limits, squared_frequencies, substeps
from physanimator.physics.solver.stepping import MASS_BUDGET


def shaken_strip(seed: int, *, amount: float) -> TriangleMesh:
    """A hanging strip of 24 x 120 px in 1,440 triangles, of which some are slivers."""
    columns, rows = 12, 60
    x, y = np.meshgrid(np.arange(columns + 1) * 2.0, np.arange(rows + 1) * 2.0)
    vertices = np.column_stack([x.ravel(), y.ravel()])
    vertices += np.random.default_rng(seed).uniform(-amount, amount, vertices.shape)
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            triangles += [(a, a + 1, a + columns + 2), (a, a + columns + 2, a + columns + 1)]
    return TriangleMesh(vertices, np.array(triangles), 400, 300)


def hanging(mesh: TriangleMesh) -> Scene:
    box = ((-9.0, -9.0), (40.0, -9.0), (40.0, 1.0), (-9.0, 1.0))
    return Scene((Body(mesh, Material(youngs_modulus=500.0)),), (), (RigPoint((12.0, 0.0), Polygon(box)),))


def free_system(system: System, masses: np.ndarray) -> tuple[object, np.ndarray]:
    free = np.repeat(system.free, 2)
    return stiffness_matrix(system.rest, *system.lame)[free][:, free], np.repeat(masses, 2)[free]


@pytest.mark.parametrize("poisson", [0.0, 0.3, 0.49])
def test_the_closed_form_is_the_largest_eigenvalue_of_each_triangle(poisson: float) -> None:
    corners = np.random.default_rng(0).normal(0, 0.1, (60, 2))
    rest = RestShape(corners, np.arange(60, dtype=np.int32).reshape(-1, 3))
    mu, lam = lame_parameters(np.linspace(10, 1000, 20), poisson)
    matrix, masses = stiffness_matrix(rest, mu, lam).toarray(), np.repeat(lumped_masses(rest, 2.0), 2)
    scaled = matrix / np.sqrt(np.outer(masses, masses))
    exact = [np.linalg.eigvalsh(scaled[6 * t : 6 * t + 6, 6 * t : 6 * t + 6])[-1] for t in range(20)]
    np.testing.assert_allclose(squared_frequencies(rest, mu, lam, 2.0), exact, rtol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_no_frequency_of_the_whole_exceeds_the_bound(seed: int) -> None:
    system = assemble(hanging(shaken_strip(seed, amount=0.7)))
    matrix, masses = free_system(system, system.masses)
    exact = np.linalg.eigvalsh(matrix.toarray() / np.sqrt(np.outer(masses, masses)))[-1]
    assert exact <= system.vertex_frequencies.max()
    assert exact <= squared_frequencies(system.rest, *system.lame, system.density)[system.active].max()
    assert exact <= system.highest[0] <= 1.02 * exact
    step = TICK / int(system.substeps[0])
    assert step <= SAFETY * 2 / np.sqrt(exact)


def test_mass_scaling_spends_its_budget_on_the_worst() -> None:
    rng = np.random.default_rng(0)
    squared, masses = rng.lognormal(0, 1, 500), rng.uniform(0.5, 2, 500)
    limits = frequency_limits(squared, masses, np.repeat([0, 1], 250))
    for part in (slice(0, 250), slice(250, 500)):
        limit = limits[part]
        assert (limit == limit[0]).all()
        added = (masses[part] * np.maximum(squared[part] / limit - 1, 0)).sum()
        assert added == pytest.approx(MASS_BUDGET * masses[part].sum())
        assert limit[0] < squared[part].max()


def test_one_triangle_has_its_own_limit() -> None:
    limit = frequency_limits(np.array([4.0]), np.array([2.0]), np.array([0]))
    assert limit[0] == pytest.approx(4.0 / (1 + MASS_BUDGET))


def test_slower_slivers_save_steps_and_hardly_change_the_sway() -> None:
    saved = []
    for seed in range(4):
        mesh = shaken_strip(seed, amount=0.7)
        system = assemble(hanging(mesh))
        plain = lumped_masses(system.rest, 1.0)
        assert plain.sum() < system.masses.sum() <= (1 + MASS_BUDGET) * plain.sum() * (1 + 1e-12)
        before, after = (lowest_eigenvalue(*free_system(system, masses)) for masses in (plain, system.masses))
        assert before is not None
        assert after is not None
        assert abs(np.sqrt(after / before) - 1) < 3e-3
        highest = highest_eigenvalue(*free_system(system, plain))
        assert highest is not None
        saved.append(substeps(highest) / int(system.substeps[0]))
    assert max(saved) > 1.2
    assert min(saved) >= 1


def test_substeps_are_whole_and_never_none() -> None:
    assert substeps(0.0) == 1
    assert substeps(1e-6) == 1
    limit = (2 * SAFETY / TICK) ** 2  # one substep a tick is just enough
    assert substeps(limit * 0.999) == 1
    assert substeps(limit * 1.001) == 2
