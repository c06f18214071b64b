"""The paper's own integrator, and what strokes are in it, against its equations written down once more in NumPy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physanimator.physics.assembly import assemble, plan
from physanimator.physics.document import scene_from_dict, scene_to_dict
from physanimator.physics.errors import InvalidInputError, SimulationError
from physanimator.physics.forces import EnergyStroke
from physanimator.physics.material import Material
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import Motion
from physanimator.physics.rig import Polygon, RigPoint
from physanimator.physics.scene import Body, Contact, Scene, StrokesAs
from physanimator.physics.simulation import simulate

STEP = 0.001  # "The timestep size is set to 0.001 in our experiments."
SIZE = 1024  # side of the picture [px]
LAME = Material(mu=60.0, lambda_=90.0, damping=0.0)
GUST = EnergyStroke("wind", ((100.0, 150.0), (900.0, 380.0)), radius=260.0, speed=600.0, strength=3.0, interval=0.5)
PUSH = EnergyStroke("repel", ((300.0, 420.0), (600.0, 330.0)), radius=150.0, speed=200.0, strength=4.0, interval=5.0)
PULL = EnergyStroke("attract", ((700.0, 520.0), (650.0, 200.0)), radius=400.0, speed=300.0, strength=1.0, interval=5.0)
FORCES = (GUST, PUSH, PULL)


def strip(across: int = 2) -> TriangleMesh:
    """60 x 300 px, its upper end at y = 100."""
    rows = 5 * across
    x, y = np.meshgrid(np.linspace(400, 460, across + 1), np.linspace(100, 400, rows + 1))
    corners = np.arange((across + 1) * (rows + 1)).reshape(rows + 1, across + 1)
    a, b, c, d = corners[:-1, :-1], corners[:-1, 1:], corners[1:, :-1], corners[1:, 1:]
    triangles = np.stack([np.stack([a, b, d], axis=-1), np.stack([a, d, c], axis=-1)]).reshape(-1, 3)
    return TriangleMesh(np.column_stack([x.ravel(), y.ravel()]), triangles, SIZE, SIZE)


def scene(material: Material = LAME, *, across: int = 2, **others: object) -> Scene:
    end = Polygon(((390.0, 90.0), (470.0, 90.0), (470.0, 110.0), (390.0, 110.0)))
    options = {"strokes": FORCES, "time_step": STEP, "frame_rate": 25.0, **others}
    return Scene((Body(strip(across), material),), rig_points=(RigPoint((430.0, 100.0), end),), **options)  # type: ignore[arg-type]


def stroke_force(stroke: EnergyStroke, q: np.ndarray, t: float) -> np.ndarray:
    """f(p, q) of Appendix "Details of Interactive Animation", of particles that leave in turn along a line."""
    start, end = np.array(stroke.path, dtype=float)
    length = np.linalg.norm(end - start)
    d = (end - start) / length
    total = np.zeros_like(q)
    left = 0.0
    while left <= t:
        way = (t - left) * stroke.speed
        left += stroke.interval
        if way > length:
            continue
        away = q - (start + way * d)
        distance = np.linalg.norm(away, axis=1, keepdims=True)
        w = distance / stroke.radius
        force = {"wind": (1 - w) * d, "repel": away / stroke.radius, "attract": (1 - w) * -away / distance}[stroke.kind]
        total += np.where(w <= 1, stroke.strength * force, 0.0)
    return total


def as_the_paper_writes(
    acting: Scene, seconds: float, *, strokes_as: StrokesAs = "acceleration", every: int = 40
) -> np.ndarray:
    """Positions after every so many steps [px], shape [f, v, 2]: Appendix "Motion Equation", line by line."""
    (body,) = acting.bodies
    material, triangles, side = body.material, body.mesh.triangles, float(SIZE)
    mu, lam, rho = material.mu, material.lambda_, material.density
    X = body.mesh.vertices / side
    held = body.mesh.vertices[:, 1] < 110

    def edges(x: np.ndarray) -> np.ndarray:
        return np.stack([x[triangles[:, 1]] - x[triangles[:, 0]], x[triangles[:, 2]] - x[triangles[:, 0]]], axis=-1)

    inverse = np.linalg.inv(edges(X))
    V = np.abs(np.linalg.det(edges(X))) / 2
    area, mass = np.zeros(len(X)), np.zeros(len(X))
    for corner in range(3):
        np.add.at(mass, triangles[:, corner], rho * V / 3)
        np.add.at(area, triangles[:, corner], V / 3)
    per_strength = {"acceleration": mass, "force": area, "vertex_force": np.ones(len(X))}[strokes_as]

    def internal(x: np.ndarray) -> np.ndarray:
        F = edges(x) @ inverse
        U, _, Vt = np.linalg.svd(F)
        R = U @ Vt
        J = np.linalg.det(F)
        P = 2 * mu * (F - R) + lam * ((J - 1) * J)[:, None, None] * np.linalg.inv(F).swapaxes(1, 2)
        forces = -V[:, None, None] * P @ inverse.swapaxes(1, 2)  # on the second and third corner of each
        f = np.zeros_like(x)
        np.add.at(f, triangles[:, 1], forces[:, :, 0])
        np.add.at(f, triangles[:, 2], forces[:, :, 1])
        np.add.at(f, triangles[:, 0], -forces.sum(axis=2))
        return f

    x, v, frames = X.copy(), np.zeros_like(X), [X * side]
    for n in range(round(seconds / STEP)):
        external = sum(stroke_force(stroke, x * side, n * STEP) for stroke in acting.strokes)
        f = internal(x) + per_strength[:, None] * external + mass[:, None] * np.array(acting.gravity)
        v = np.where(held[:, None], 0.0, v + STEP * f / mass[:, None])
        x = x + STEP * v
        if (n + 1) % every == 0:
            frames.append(x * side)
    return np.array(frames)


def deviation(motion: Motion, exact: np.ndarray) -> float:
    """The largest distance from the exact motion, as a share of the largest way that anything goes."""
    way = np.linalg.norm(exact - exact[0], axis=2).max()
    assert way > 20  # px
    return float(np.linalg.norm(motion.positions - exact, axis=2).max() / way)


@pytest.mark.parametrize(
    "material",
    [LAME, replace(LAME, lambda_=0.0), Material(youngs_modulus=150.0, poisson_ratio=0.3, damping=0.0)],
    ids=["lame", "lambda 0", "young"],
)
def test_motion_is_that_of_plain_semi_implicit_euler(material: Material) -> None:
    mu, lam = material.lame
    written = replace(scene(material), bodies=(Body(strip(), replace(material, mu=mu, lambda_=lam)),))
    exact = as_the_paper_writes(written, 1.6)
    assert deviation(simulate(scene(material), frames=41), exact) < 1e-4


@pytest.mark.parametrize("strokes_as", ["acceleration", "force", "vertex_force"])
def test_strokes_are_what_they_are_said_to_be(strokes_as: StrokesAs) -> None:
    heavy = replace(LAME, density=4.0)
    scale = {"acceleration": 1.0, "force": 4.0, "vertex_force": 3e-3}[strokes_as]
    strokes = tuple(replace(stroke, strength=scale * stroke.strength) for stroke in FORCES)
    acting = scene(heavy, strokes=strokes, strokes_as=strokes_as)
    exact = as_the_paper_writes(acting, 0.8, strokes_as=strokes_as)
    assert deviation(simulate(acting, frames=21), exact) < 1e-4


@pytest.mark.parametrize("time_step", [None, STEP])
def test_force_moves_what_is_four_times_as_heavy_a_quarter_as_far(time_step: float | None) -> None:
    """Of free bodies, and at density 1 a force is an acceleration."""

    def way(strokes_as: StrokesAs, density: float) -> float:
        blow = EnergyStroke("wind", ((0.0, 250.0), (1000.0, 250.0)), radius=5000.0, speed=100.0, falloff="constant")
        material = Material(youngs_modulus=100.0 * density, density=density, damping=0.0)
        acting = scene(material, strokes=(blow,), time_step=time_step, strokes_as=strokes_as)
        motion = simulate(replace(acting, rig_points=()), frames=13)
        return float((motion.positions[-1] - motion.positions[0])[:, 0].mean())

    assert way("force", 4.0) == pytest.approx(way("force", 1.0) / 4, rel=1e-3)
    assert way("acceleration", 4.0) == pytest.approx(way("acceleration", 1.0), rel=1e-3)
    assert way("force", 1.0) == pytest.approx(way("acceleration", 1.0), rel=1e-3)
    assert way("acceleration", 1.0) > 50


def test_finer_mesh_moves_farther_under_a_force_on_each_vertex_only() -> None:
    ways: dict[str, list[float]] = {}
    for strokes_as, strength in (("force", 1.0), ("vertex_force", 1e-3)):
        blow = EnergyStroke("wind", ((0.0, 250.0), (1000.0, 250.0)), radius=5000.0, speed=100.0, strength=strength)
        for across in (2, 4):
            acting = scene(replace(LAME, mu=20.0, lambda_=10.0), across=across, strokes=(blow,), strokes_as=strokes_as)
            motion = simulate(replace(acting, rig_points=()), frames=9)
            ways.setdefault(strokes_as, []).append(float((motion.positions[-1] - motion.positions[0])[:, 0].mean()))
    assert ways["force"][1] == pytest.approx(ways["force"][0], rel=0.02)
    assert ways["vertex_force"][1] > 2.5 * ways["vertex_force"][0]


def test_frames_between_two_steps_lie_between_them() -> None:
    """24 frames a second are 41.67 steps apart."""
    whole = simulate(scene(frame_rate=200.0), frames=241).positions[::25]
    between = simulate(scene(frame_rate=24.0), frames=28).positions[::3]
    np.testing.assert_allclose(between, whole, atol=0.05)


def test_step_that_is_not_asked_for_leads_to_the_same_motion() -> None:
    """Both go to the same limit: their difference is that of the step, some 1 / 1000."""
    asked = simulate(scene(), frames=41)
    automatic = simulate(scene(time_step=None), frames=41)
    assert 1e-4 < deviation(automatic, asked.positions.astype(float)) < 0.02


def test_unstable_step_is_refused_with_the_limit_which_is_stable() -> None:
    stiff = replace(LAME, mu=6000.0, lambda_=9000.0)
    with pytest.raises(SimulationError, match=r"^time_step must be at most (0\.000\d+) s for body number 0") as caught:
        simulate(scene(stiff), frames=3)
    assert "Got: 0.001 s" in str(caught.value)
    limit = float(str(caught.value).split("at most ")[1].split(" s")[0])
    highest = assemble(scene(stiff)).highest.max()
    assert 0.8 * 2 / np.sqrt(highest) < limit <= 2 / np.sqrt(highest)
    at_limit = simulate(scene(stiff, time_step=limit), frames=26)
    assert np.abs(at_limit.positions - at_limit.positions[0]).max() < 100
    with pytest.raises(SimulationError, match="time_step must be at most"):
        plan(scene(stiff), frames=3)


def test_motion_that_gets_out_of_hand_is_refused() -> None:
    """So far deformed, triangles are stiffer than at rest, for which the step was short enough."""
    limit = 0.97 * 2 / np.sqrt(assemble(scene()).highest.max())
    storm = tuple(replace(stroke, strength=3000.0 * stroke.strength) for stroke in FORCES)
    with pytest.raises(SimulationError, match=r"out of hand in frame \d+.*Lower it"):
        simulate(scene(strokes=storm, time_step=min(limit, 1 / 240)), frames=41)
    with pytest.raises(SimulationError, match=r"out of hand in frame \d+ of cycle"):
        simulate(scene(strokes=storm, time_step=min(limit, 1 / 240), loop=2.0), frames=41)


@pytest.mark.parametrize("step", [0.0, -1.0, 1e-6, 0.0042, np.nan, "x"])
def test_step_that_is_none_is_refused(step: object) -> None:
    with pytest.raises(InvalidInputError, match=r"^time_step must be 1e-05 to 0.0041\d+ s. Got: "):
        scene(time_step=step)


def test_masses_are_those_of_the_triangles() -> None:
    system = assemble(scene())
    (body,) = scene().bodies
    assert system.masses.sum() == pytest.approx(body.mesh.areas.sum() / SIZE**2, rel=1e-12)
    assert (system.substeps == 1).all()


def test_work_is_planned_by_the_steps() -> None:
    assert plan(scene(), frames=26).step == STEP
    assert plan(scene(), frames=26).substeps_per_frame == pytest.approx(40)
    assert plan(scene(time_step=1e-4), frames=26).work == pytest.approx(10 * plan(scene(), frames=26).work, rel=0.01)
    with pytest.raises(SimulationError, match=r"raise time_step or set it to 0 \(now 1e-05 s\)"):
        simulate(scene(across=8, time_step=1e-5), frames=2500, max_minutes=0.1)


def test_loop_closes_at_a_step_that_does_not_divide_it() -> None:
    damped = replace(LAME, damping=4.0)
    motion = simulate(scene(damped, strokes=(replace(GUST, interval=0.7),), loop=1.4, time_step=0.0013))
    assert motion.loop is not None
    assert motion.loop.closed_residual < 0.2
    assert np.abs(motion.positions - motion.positions[0]).max() > 1


def test_bodies_that_touch_keep_out_of_each_other_at_a_step_of_ones_own() -> None:
    mesh = strip()
    beside = TriangleMesh(mesh.vertices + (80.0, 0.0), mesh.triangles, SIZE, SIZE)
    blow = EnergyStroke("wind", ((0.0, 250.0), (1000.0, 250.0)), radius=300.0, speed=500.0, strength=6.0, interval=0.4)
    both = replace(scene(strokes=(blow,)), bodies=(Body(mesh, LAME), Body(beside, replace(LAME, mu=150.0))))
    wall = Polygon(((470.0, 90.0), (550.0, 90.0), (550.0, 110.0), (470.0, 110.0)))
    both = replace(both, rig_points=(*both.rig_points, RigPoint((510.0, 100.0), wall)))

    def overlap(acting: Scene) -> float:
        motion = simulate(acting, frames=26)
        ours, theirs = motion.positions[:, : len(mesh.vertices)], motion.positions[:, len(mesh.vertices) :]
        return float((ours[:, 2::3, 0] - theirs[:, ::3, 0]).max())  # right edge of one, left edge of the other

    assert overlap(both) > 10
    assert overlap(replace(both, contact=Contact())) < 1


def test_document_keeps_both() -> None:
    document = scene_to_dict(scene(strokes_as="force"))
    assert (document["time_step"], document["strokes_as"]) == (STEP, "force")
    read = scene_from_dict(document)
    assert (read.time_step, read.strokes_as) == (STEP, "force")
    assert not {"time_step", "strokes_as"} & scene_to_dict(scene(time_step=None)).keys()
