"""The kernels against the float64 reference, and what they promise beyond it."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.forces import EnergyStroke, acceleration, all_particles
from physanimator.physics.material import (
    RestShape,
    deformation_gradients,
    energy,
    forces,
    highest_eigenvalue,
    lame_parameters,
    lumped_masses,
    semi_implicit_euler,
    stiffness_matrix,
)
from physanimator.physics.runtime import aligned, taichi_runtime
from physanimator.physics.solver import (
    SPEED_FLOOR,
    TICK,
    Drive,
    Solid,
    State,
    advance,
    pace,
    solver,
    squared_frequencies,
    substeps,
)
from physanimator.physics.solver.solver import internal_forces

YOUNG, POISSON, DAMPING = 500.0, 0.3, 1.5
SIDE = 1000.0


def strip(columns: int = 4, rows: int = 16, *, width: float = 0.06, height: float = 0.3) -> RestShape:
    """A hanging strip, a little irregular; vertices 0 to ``columns`` are its top."""
    x, y = np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, height, rows + 1))
    positions = np.column_stack([x.ravel(), y.ravel()]) + [0.4, 0.2]
    positions += np.random.default_rng(0).uniform(-0.001, 0.001, positions.shape)
    triangles = []
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            triangles += [(a, a + 1, a + columns + 2), (a, a + columns + 2, a + columns + 1)]
    return RestShape(positions, np.array(triangles, dtype=np.int32))


def material(rest: RestShape) -> tuple[np.ndarray, np.ndarray]:
    return lame_parameters(np.full(len(rest.triangles), YOUNG), POISSON)


def solid_of(rest: RestShape, *, led: tuple[int, ...] = (), reach: float = np.inf) -> Solid:
    mu, lam = material(rest)
    inverse_mass = 1 / lumped_masses(rest, 1.0)
    inverse_mass[list(led)] = 0
    squared = squared_frequencies(rest, mu, lam, 1.0)
    count = len(rest.positions)
    leaders = np.full(count, -1, dtype=np.int32)
    leaders[list(led)] = 0
    return Solid.of_triangles(
        starts=np.array([[0, 0], [count, len(rest.triangles)]], dtype=np.int32),
        substeps=np.array([planned(rest)], dtype=np.int32),
        vertices=np.column_stack([rest.positions, inverse_mass, np.full(count, DAMPING)]).astype(np.float32),
        step_limits=np.full(count, reach, dtype=np.float32),
        handles=leaders,
        grips=np.zeros(count, dtype=np.float32),
        triangles=rest.triangles,
        inverse_edges=rest.inverse_edges.reshape(-1, 4).astype(np.float32),
        stiffness=np.column_stack([2 * mu * rest.areas, lam * rest.areas, squared]).astype(np.float32),
    )


def planned(rest: RestShape) -> int:
    return substeps(float(squared_frequencies(rest, *material(rest), 1.0).max()))


def highest_frequency(rest: RestShape) -> float:
    """The highest omega^2 of the whole shape."""
    found = highest_eigenvalue(stiffness_matrix(rest, *material(rest)), np.repeat(lumped_masses(rest, 1.0), 2))
    assert found is not None
    return found


def still(ticks: int, gravity: tuple[float, float] = (0.0, 0.0)) -> Drive:
    """Nothing but gravity."""
    zeros = np.zeros((ticks + 1, 1, 6), dtype=np.float32)
    nothing = np.zeros((0, 6), dtype=np.float32), np.zeros(0, dtype=np.int32)
    return Drive(zeros, zeros, np.zeros(ticks + 1, dtype=np.int32), *nothing, gravity)


def blown(strokes: list[EnergyStroke], *times: float) -> Drive:
    """Flow particles of one tick for each time."""
    groups = [all_particles(strokes, time) for time in times]
    rows = [np.column_stack([g.position / SIDE, g.direction, g.radius / SIDE, g.strength]) for g in groups]
    firsts = np.cumsum([0] + [len(g.kind) for g in groups])
    return still(len(times))._replace(
        first_particles=firsts.astype(np.int32),
        particles=np.concatenate(rows).astype(np.float32),
        kinds=np.concatenate([g.kind for g in groups]),
    )


@pytest.mark.parametrize("size", [1e-4, 0.003, 0.02, 0.2])
def test_forces_match_the_reference_also_for_inverted_triangles(size: float) -> None:
    rest = strip()
    displacement = np.random.default_rng(1).normal(0, size, rest.positions.shape).astype(np.float32)
    positions = rest.positions + displacement.astype(np.float64)
    assert (np.linalg.det(deformation_gradients(rest, positions)) < 0).any() == (size >= 0.02)
    exact = forces(rest, positions, *material(rest))
    got = internal_forces(solid_of(rest), displacement)
    assert got.dtype == np.float32
    assert np.abs(got - exact).max() < 1e-5 * np.abs(exact).max() + 1e-6


def test_a_collapsed_triangle_has_a_finite_force() -> None:
    rest = RestShape(np.array([[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]]), np.array([[0, 1, 2]], dtype=np.int32))
    collapsed = (-rest.positions).astype(np.float32)
    exact = forces(rest, np.zeros((3, 2)), *material(rest))
    np.testing.assert_allclose(internal_forces(solid_of(rest), collapsed), exact, rtol=1e-5)


def test_nothing_moves_at_rest() -> None:
    rest = strip()
    solid = solid_of(rest)
    state = State.at_rest(solid)
    advance(solid, state, still(50))
    assert not state.displacement.any()
    assert not state.velocity.any()


def reference(rest: RestShape, push: np.ndarray, held: np.ndarray, *, ticks: int, count: int) -> np.ndarray:
    """Displacements after each tick by the float64 reference under one acceleration."""
    masses, step = lumped_masses(rest, 1.0)[:, None], TICK / count
    x, v = rest.positions.copy(), np.zeros_like(rest.positions)
    frames = []
    for _ in range(ticks):
        for _ in range(count):
            total = np.where(held[:, None], 0.0, forces(rest, x, *material(rest)) / masses + push)
            x, v = semi_implicit_euler(x, v, total, step=step, damping=DAMPING)
        frames.append(x - rest.positions)
    return np.array(frames)


def test_the_float32_motion_stays_with_the_float64_reference() -> None:
    """0.001 px of a 1024 px picture after a swing of some 60 px over 0.75 s."""
    rest, count, ticks = strip(), planned(strip()), 180
    top = tuple(range(5))
    held = np.isin(np.arange(len(rest.positions)), top)
    gravity = np.array([6.0, 0.5])
    exact = reference(rest, gravity, held, ticks=ticks, count=count)
    worst, solid = 0.0, solid_of(rest, led=top)
    state = State.at_rest(solid)
    for tick in range(ticks):
        advance(solid, state, still(1, gravity=(6.0, 0.5)))
        worst = max(worst, float(np.abs(state.displacement - exact[tick]).max()))
    assert np.abs(exact).max() * 1024 > 50
    assert worst * 1024 < 1e-3


def test_ticks_may_be_launched_together_or_one_by_one() -> None:
    rest = strip()
    solid = solid_of(rest, led=(0, 1, 2, 3, 4))
    together, single = State.at_rest(solid), State.at_rest(solid)
    advance(solid, together, still(30, gravity=(2.0, 0.0)))
    for _ in range(30):
        advance(solid, single, still(1, gravity=(2.0, 0.0)))
    assert np.abs(together.displacement).max() > 1e-3
    np.testing.assert_array_equal(together.displacement, single.displacement)


# More threads than a machine has processors: those that begin late find their shares done by others.
@pytest.mark.parametrize("threads", [2, 3, 40])
def test_threads_that_share_a_part_find_the_same_to_the_last_bit(threads: int, monkeypatch: pytest.MonkeyPatch) -> None:
    rest = strip(24, 96)
    solid = solid_of(rest, led=tuple(range(25)))
    alone, shared = State.at_rest(solid), State.at_rest(solid)
    advance(solid, alone, still(12, gravity=(40.0, 0.0)))
    launched: list[int] = []
    original = solver._advance_shared
    monkeypatch.setattr(solver, "_advance_shared", lambda *given: launched.append(given[2]) or original(*given))
    monkeypatch.setattr(solver, "most_threads", lambda *_: threads)
    monkeypatch.setattr(pace.Pace, "share", lambda _: True)
    for _ in range(3):
        advance(solid, shared, still(4, gravity=(40.0, 0.0)))
    assert launched == [threads] * 3
    assert np.abs(alone.displacement).max() > 1e-3
    np.testing.assert_array_equal(shared.displacement, alone.displacement)
    np.testing.assert_array_equal(shared.velocity, alone.velocity)


def test_beside_other_work_two_processors_are_left_to_it(monkeypatch: pytest.MonkeyPatch) -> None:
    rest = strip(24, 96)
    solid, launched = solid_of(rest, led=tuple(range(25))), list[int]()
    monkeypatch.setattr(solver, "_advance_shared", lambda *given: launched.append(given[2]))
    monkeypatch.setattr(pace.Pace, "share", lambda _: True)
    for processors in (2, 4):
        monkeypatch.setattr(pace, "allowed_threads", lambda processors=processors: processors)
        for beside in (False, True):
            with taichi_runtime.aside(False, beside=beside):
                advance(solid, State.at_rest(solid), still(1))
    assert launched == [2, 4, 2]


@pytest.mark.parametrize("kind", ["wind", "repel", "attract"])
def test_flow_particles_push_as_the_reference_says(kind: str) -> None:
    """One tick of free vertices without stiffness: the velocity is the acceleration times the time."""
    rest = strip()
    solid = solid_of(rest)
    elements = aligned(solid.elements.shape)
    elements[:, 4] = 1e-20
    loose = solid._replace(
        substeps=np.array([2], dtype=np.int32),
        elements=elements,
        vertices=solid.vertices * np.float32([1, 1, 1, 0]),
    )
    path = ((300.0, 350.0), (700.0, 380.0)) if kind == "wind" else ((430.0, 330.0),)
    strokes = [
        EnergyStroke(kind=kind, path=path, radius=90.0, strength=7.0, speed=500.0, interval=0.1),
        EnergyStroke(kind=kind, path=((600.0, 200.0), (400.0, 450.0)), radius=60.0, strength=-3.0, speed=900.0),
    ]
    time = 0.3
    state = State.at_rest(loose)
    advance(loose, state, blown(strokes, time))
    exact = sum(acceleration(stroke, rest.positions * SIDE, time) for stroke in strokes)
    moved = np.abs(exact).max(axis=1) > 0
    assert moved.any()
    assert not moved.all()  # some vertices are beyond every radius
    np.testing.assert_allclose(state.velocity / TICK, exact, atol=2e-4)
    assert np.abs(state.velocity[~moved]).max() < 1e-9


def test_attraction_at_the_particle_itself_is_finite() -> None:
    rest = strip()
    point = tuple(rest.positions[7].astype(np.float32).astype(np.float64) * SIDE)
    solid = solid_of(rest)
    state = State.at_rest(solid)
    stroke = EnergyStroke(kind="attract", path=(point,), radius=100.0, strength=5.0)
    advance(solid, state, blown([stroke], 0.0))
    assert np.isfinite(state.displacement).all()
    assert np.abs(state.velocity).max() > 1e-4


def test_led_vertices_follow_the_cubic_and_hold_their_velocity() -> None:
    rest = strip()
    solid = solid_of(rest, led=(0, 1, 2, 3, 4))
    start, end = np.array([0.0, 0.0]), np.array([0.01, -0.02])
    v_start, v_end = np.array([1.0, 0.5]), np.array([-2.0, 3.0])
    drive = still(1)._replace(
        rig_leads=np.array([[[0, 0, 0, 0, *start]], [[0, 0, 0, 0, *end]]], dtype=np.float32),
        rig_rates=np.array([[[0, 0, 0, 0, *v_start]], [[0, 0, 0, 0, *v_end]]], dtype=np.float32),
    )
    state = State.at_rest(solid)
    advance(solid, state, drive)
    np.testing.assert_allclose(state.displacement[:5], np.tile(end, (5, 1)), atol=1e-7)
    np.testing.assert_allclose(state.velocity[:5], np.tile(v_end, (5, 1)), atol=1e-6)
    assert np.abs(state.displacement[5:10]).max() > 1e-3  # drags its neighbours along
    assert np.abs(state.displacement[-5:]).max() < 1e-4  # the far end has not heard of it yet


def test_a_very_fast_vertex_is_held_back() -> None:
    rest, gravity = strip(), (1e9, 0.0)
    for reach, speed in ((1e-5, SPEED_FLOOR), (1e-2, 1e-2 * 30 / TICK)):
        solid = solid_of(rest, reach=reach)._replace(substeps=np.array([30], dtype=np.int32))
        state = State.at_rest(solid)
        advance(solid, state, still(1, gravity=gravity))
        np.testing.assert_allclose(np.linalg.norm(state.velocity, axis=1), speed, rtol=1e-5)


def test_large_stretch_refines_the_step() -> None:
    """A body stretched by half vibrates faster than the planned step can follow: its energy would explode."""
    rest = strip()
    masses, highest = lumped_masses(rest, 1.0)[:, None], highest_frequency(rest)
    undamped = solid_of(rest)._replace(
        vertices=solid_of(rest).vertices * np.float32([1, 1, 1, 0]),
        substeps=np.array([substeps(highest)], dtype=np.int32),
    )

    def energies(solid: Solid) -> list[float]:
        state, found = State.at_rest(solid), []
        state.displacement[:] = (rest.positions - rest.positions.mean(axis=0)) / 2
        for _ in range(60):
            moved, kinetic = rest.positions + state.displacement, (masses * state.velocity**2).sum() / 2
            found.append(energy(rest, moved, *material(rest)) + float(kinetic))
            advance(solid, state, still(1))
        return found

    undamped.elements[:, 6] = np.minimum(undamped.elements[:, 6], highest)
    refined = energies(undamped)
    assert max(refined) < 1.5 * refined[0]
    undamped.elements[:, 6] = 0
    never_refined = energies(undamped)
    assert not max(never_refined) < 3 * never_refined[0]


def test_bodies_without_triangles_that_move_are_fine() -> None:
    rest = strip()
    solid = solid_of(rest)
    empty = solid._replace(
        starts=np.array([[0, 0], [len(rest.positions), 0]], dtype=np.int32),
        corners=solid.corners[:0],
        elements=solid.elements[:0],
        first_slots=np.zeros_like(solid.first_slots),
        slots=solid.slots[:0],
    )
    state = State.at_rest(empty)
    advance(empty, state, still(3))
    assert not state.displacement.any()


def test_arrays_that_would_crash_the_kernel_are_refused() -> None:
    rest = strip()
    solid = solid_of(rest)
    elsewhere = aligned((solid.elements.size + 1,))[1:].reshape(solid.elements.shape)
    with pytest.raises(ValueError, match="aligned"):
        advance(solid._replace(elements=elsewhere), State.at_rest(solid), still(1))
