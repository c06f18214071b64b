"""The float64 reference against physics: invariances, balance, energy, beam theory, convergence."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from functools import partial

import numpy as np
import pytest
from physanimator.physics.material import (
    RestShape,
    deformation_gradients,
    energy,
    forces,
    lame_parameters,
    lumped_masses,
    rest_shape,
    rotations,
    semi_implicit_euler,
    stiffness_matrix,
    stress,
)
from physanimator.physics.material.elasticity import energy_densities
from physanimator.physics.mesh import TriangleMesh
from scipy.sparse.linalg import spsolve

YOUNG, POISSON = 500.0, 0.3

State = tuple[np.ndarray, np.ndarray]


def grid(columns: int, rows: int, *, width: float, height: float) -> RestShape:
    """A rectangle from the origin, cut into triangles with alternating diagonals."""
    x, y = np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, height, rows + 1))
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b, c, d = a + 1, a + columns + 1, a + columns + 2
            triangles += [(a, b, d), (a, d, c)] if (row + column) % 2 else [(a, b, c), (b, d, c)]
    return RestShape(np.column_stack([x.ravel(), y.ravel()]), np.array(triangles, dtype=np.int32))


def lame(rest: RestShape, young: float = YOUNG, poisson: float = POISSON) -> tuple[np.ndarray, np.ndarray]:
    return lame_parameters(np.full(len(rest.triangles), young), poisson)


def rotation(angle: float) -> np.ndarray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


@pytest.fixture
def body() -> RestShape:
    """An irregular body about 0.1 sides wide."""
    regular = grid(4, 3, width=0.12, height=0.09)
    shaken = regular.positions + np.random.default_rng(0).normal(0, 0.003, regular.positions.shape)
    return RestShape(shaken, regular.triangles)


@pytest.fixture
def deformed(body: RestShape) -> np.ndarray:
    """Large strains, some triangles inverted."""
    positions = body.positions + np.random.default_rng(1).normal(0, 0.02, body.positions.shape)
    assert (np.linalg.det(deformation_gradients(body, positions)) < 0).any()
    return positions


def turning(positions: np.ndarray, vectors: np.ndarray) -> float:
    """Sum of the moments x cross f about the origin."""
    return float((positions[:, 0] * vectors[:, 1] - positions[:, 1] * vectors[:, 0]).sum())


def test_a_body_at_rest_feels_no_force(body: RestShape) -> None:
    assert np.abs(forces(body, body.positions, *lame(body))).max() < 1e-12
    assert energy(body, body.positions, *lame(body)) < 1e-24


def test_rigid_motion_costs_nothing(body: RestShape) -> None:
    moved = body.positions @ rotation(2.5).T + [3.0, -1.0]
    assert np.abs(forces(body, moved, *lame(body))).max() < 1e-11


def test_forces_turn_with_the_body(body: RestShape, deformed: np.ndarray) -> None:
    turn = rotation(-1.2)
    turned = forces(body, deformed @ turn.T, *lame(body))
    np.testing.assert_allclose(turned, forces(body, deformed, *lame(body)) @ turn.T, atol=1e-11)


def test_internal_forces_sum_to_nothing(body: RestShape, deformed: np.ndarray) -> None:
    internal = forces(body, deformed, *lame(body))
    assert np.abs(internal).max() > 1
    assert np.abs(internal.sum(axis=0)).max() < 1e-13
    assert abs(turning(deformed, internal)) < 1e-13


def test_the_force_is_the_negative_gradient_of_the_energy(body: RestShape, deformed: np.ndarray) -> None:
    constants, step = lame(body), 1e-6
    numeric = np.zeros_like(deformed)
    for index in np.ndindex(deformed.shape):
        offset = np.zeros_like(deformed)
        offset[index] = step
        difference = energy(body, deformed + offset, *constants) - energy(body, deformed - offset, *constants)
        numeric[index] = -difference / (2 * step)
    exact = forces(body, deformed, *constants)
    assert np.abs(numeric - exact).max() < 1e-7 * np.abs(exact).max()


def test_patch_of_a_homogeneous_deformation_is_in_balance(body: RestShape) -> None:
    row, column = np.divmod(np.arange(len(body.positions)), 5)
    inside = (row > 0) & (row < 3) & (column > 0) & (column < 4)
    homogeneous = np.array([[1.2, 0.3], [-0.1, 0.8]])
    internal = forces(body, body.positions @ homogeneous.T, *lame(body))
    np.testing.assert_allclose(deformation_gradients(body, body.positions @ homogeneous.T), [homogeneous] * 24)
    assert inside.sum() == 6
    assert np.abs(internal[inside]).max() < 1e-11
    assert np.abs(internal[~inside]).max() > 1e-2


def test_uniaxial_stress_follows_from_the_modulus() -> None:
    """In plane strain a free lateral contraction is nu / (1 - nu), and the stiffness E / (1 - nu^2)."""
    strain = 1e-6
    lateral = -POISSON / (1 - POISSON) * strain
    f = np.array([[[1 + strain, 0.0], [0.0, 1 + lateral]]])
    mu, lam = lame_parameters(np.array([YOUNG]), POISSON)
    piola = stress(f, mu, lam)[0]
    assert piola[0, 0] == pytest.approx(YOUNG / (1 - POISSON**2) * strain, rel=1e-5)
    assert abs(piola[1, 1]) < 1e-5 * piola[0, 0]


def test_rotation_stays_proper_through_inversion() -> None:
    f = np.array([np.diag([1.0, -0.3]), np.diag([-2.0, 1.0]), np.zeros((2, 2)), -np.eye(2), [[1.0, 2.0], [-1.0, 0.5]]])
    r = rotations(f)
    np.testing.assert_allclose(np.linalg.det(r), 1.0)
    np.testing.assert_allclose(r @ r.transpose(0, 2, 1), [np.eye(2)] * 5, atol=1e-15)
    mu, lam = lame_parameters(np.full(5, YOUNG), POISSON)
    for angle in np.linspace(0, 2 * np.pi, 37):
        other = np.broadcast_to(rotation(angle), f.shape)
        assert (((f - r) ** 2).sum(axis=(1, 2)) <= ((f - other) ** 2).sum(axis=(1, 2)) + 1e-12).all()
    assert np.isfinite(stress(f, mu, lam)).all()
    assert (energy_densities(f[:3], mu[:3], lam[:3]) > YOUNG / 10).all()
    assert energy_densities(f, mu, lam)[3] < 1e-12  # half a turn is no deformation


def test_a_mesh_becomes_sides() -> None:
    vertices = np.array([[0.0, 0.0], [400.0, 0.0], [0.0, 200.0]])
    shape = rest_shape(TriangleMesh(vertices, np.array([[0, 1, 2]]), 800, 500))
    assert shape.areas[0] == pytest.approx(0.5 * 0.5 * 0.25)
    assert shape.smallest_altitudes[0] == pytest.approx(0.5 * 0.25 / np.hypot(0.5, 0.25))
    np.testing.assert_allclose(shape.shape_gradients.sum(axis=1), 0, atol=1e-15)


def test_masses_add_up(body: RestShape) -> None:
    masses = lumped_masses(body, 2.5)
    assert masses.sum() == pytest.approx(2.5 * body.areas.sum())
    assert masses[0] == pytest.approx(2.5 * body.areas[(body.triangles == 0).any(axis=1)].sum() / 3)


def test_the_stiffness_matrix_is_the_force_s_derivative_at_rest(body: RestShape) -> None:
    mu, lam = lame(body)
    mu = mu * np.linspace(0.5, 2, len(mu))  # every triangle with a stiffness of its own
    matrix = stiffness_matrix(body, mu, lam).toarray()
    displacement = np.random.default_rng(2).normal(0, 1e-7, body.positions.shape)
    difference = forces(body, body.positions + displacement, mu, lam)
    difference -= forces(body, body.positions - displacement, mu, lam)
    np.testing.assert_allclose(matrix @ displacement.ravel(), -difference.ravel() / 2, rtol=0, atol=1e-11)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12)
    turned = body.positions @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    for rigid in (np.tile([1.0, 0.0], len(turned)), np.tile([0.0, 1.0], len(turned)), turned.ravel()):
        assert np.abs(matrix @ rigid).max() < 1e-10


def swing(body: RestShape, step: float, count: int, *, velocity: np.ndarray, damping: float = 0.0) -> Iterator[State]:
    """Free motion; yields positions and velocities after each step."""
    constants, masses = lame(body), lumped_masses(body, 1.0)[:, None]
    positions = body.positions.copy()
    for _ in range(count):
        acceleration = forces(body, positions, *constants) / masses
        positions, velocity = semi_implicit_euler(positions, velocity, acceleration, step=step, damping=damping)
        yield positions, velocity


def test_momentum_is_kept_over_ten_thousand_steps() -> None:
    body = grid(2, 1, width=0.1, height=0.05)
    masses = lumped_masses(body, 1.0)[:, None]
    velocity = np.random.default_rng(3).normal(0, 0.5, body.positions.shape)
    momentum = (masses * velocity).sum(axis=0)
    angular = turning(body.positions, masses * velocity)
    positions, latest = deque(swing(body, 2e-4, 10_000, velocity=velocity), maxlen=1).pop()
    np.testing.assert_allclose((masses * latest).sum(axis=0), momentum, rtol=1e-11)
    assert turning(positions, masses * latest) == pytest.approx(angular, rel=1e-9)


def test_energy_stays_in_a_band_without_drift() -> None:
    body = grid(2, 1, width=0.1, height=0.05)
    constants, masses = lame(body), lumped_masses(body, 1.0)[:, None]
    velocity = np.random.default_rng(3).normal(0, 0.2, body.positions.shape)
    start = float((masses * velocity**2).sum() / 2)
    total = np.array(
        [
            energy(body, positions, *constants) + float((masses * v**2).sum() / 2)
            for positions, v in swing(body, 2e-5, 10_000, velocity=velocity)
        ]
    )
    assert np.ptp(total) < 0.02 * start
    drift = np.polyfit(np.arange(len(total)), total, 1)[0]
    assert abs(drift) < 5e-7 * start


def test_damping_takes_the_velocity_away_at_its_rate_whatever_the_step() -> None:
    velocities = np.array([[2.0, -1.0]])
    for step, count in ((0.1, 10), (0.01, 100)):
        positions, velocity = np.zeros((1, 2)), velocities
        for _ in range(count):
            positions, velocity = semi_implicit_euler(positions, velocity, np.zeros((1, 2)), step=step, damping=1.5)
        np.testing.assert_allclose(velocity, velocities * np.exp(-1.5))


def test_the_integrator_is_of_first_order_at_least() -> None:
    body = grid(2, 1, width=0.1, height=0.05)
    velocity = np.random.default_rng(4).normal(0, 0.3, body.positions.shape)

    def after(steps: int) -> np.ndarray:
        return deque(swing(body, 0.004 / steps, steps, velocity=velocity, damping=1.5), maxlen=1).pop()[0]

    exact = after(6400)
    errors = [np.abs(after(steps) - exact).max() for steps in (50, 100, 200)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 0.95).all()


@pytest.mark.parametrize(("across", "low", "high"), [(4, 0.85, 0.89), (8, 0.955, 0.975), (16, 0.98, 0.995)])
def test_cantilever_bends_as_timoshenko_says(across: int, low: float, high: float) -> None:
    """Tip deflection under a shear load at the end, plane strain; linear triangles come from the stiff side."""
    length, depth, load = 0.4, 0.06, 1e-3
    body = grid(across, round(across * length / depth), width=depth, height=length)
    matrix = stiffness_matrix(body, *lame(body))
    tip, free = body.positions[:, 1] > length - 1e-9, np.repeat(body.positions[:, 1] > 1e-9, 2)
    shares = np.where(np.isin(body.positions[:, 0], [0.0, body.positions[:, 0].max()]), 0.5, 1.0) * tip
    pull = np.zeros((len(body.positions), 2))
    pull[:, 0] = load * shares / shares.sum()
    solution = np.zeros(2 * len(body.positions))
    solution[free] = spsolve(matrix[free][:, free].tocsc(), pull.ravel()[free])
    deflection = solution.reshape(-1, 2)[tip, 0].mean()
    modulus, inertia = YOUNG / (1 - POISSON**2), depth**3 / 12
    shear_modulus, shear_factor = YOUNG / (2 * (1 + POISSON)), 5 / 6
    theory = load * length**3 / (3 * modulus * inertia) + load * length / (shear_factor * shear_modulus * depth)
    assert low < deflection / theory < high


def test_inverted_triangles_turn_back() -> None:
    """Released from a mirror image, a damped triangle comes to rest with its own orientation."""
    body = RestShape(np.array([[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]]), np.array([[0, 1, 2]], dtype=np.int32))
    constants, masses = lame(body), lumped_masses(body, 1.0)[:, None]
    positions, velocity = body.positions * [1.0, -0.8] + [[0.0, 0.0], [0.0, 0.004], [0.002, 0.0]], np.zeros((3, 2))
    step = partial(semi_implicit_euler, step=2e-4, damping=20.0)
    for _ in range(5000):
        positions, velocity = step(positions, velocity, forces(body, positions, *constants) / masses)
    gradient = deformation_gradients(body, positions)
    assert np.linalg.det(gradient[0]) == pytest.approx(1.0, abs=1e-3)
    np.testing.assert_allclose(gradient, rotations(gradient), atol=1e-3)
