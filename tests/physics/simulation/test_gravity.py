"""Gravity: the drawing is how bodies hang, and gravity stiffens or softens their swing as it does a pendulum's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physanimator.physics.assembly import is_stable, prestressed, rest_shape_derivative
from physanimator.physics.document import scene_from_dict, scene_to_dict
from physanimator.physics.errors import SimulationError
from physanimator.physics.forces import EnergyStroke
from physanimator.physics.material import Material, RestShape, forces, lame_parameters, lumped_masses
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import Motion
from physanimator.physics.rig import Circle, Polygon, RigPoint
from physanimator.physics.scene import Body, Scene
from physanimator.physics.simulation import simulate

SIZE = 1000
RATE = 60.0


def strip(across: int = 2, *, lean: float = 0.0) -> TriangleMesh:
    """A strip of 60 x 300 px that hangs from y = 100, its end a little aside."""
    rows = across * 5
    x, y = np.meshgrid(np.linspace(400, 460, across + 1), np.linspace(100, 400, rows + 1))
    x = x + lean * (y - 100)
    triangles = []
    for row in range(rows):
        for column in range(across):
            a = row * (across + 1) + column
            b, c, d = a + 1, a + across + 1, a + across + 2
            triangles += [(a, b, d), (a, d, c)] if (row + column) % 2 else [(a, b, c), (b, d, c)]
    return TriangleMesh(np.column_stack([x.ravel(), y.ravel()]), np.array(triangles), SIZE, SIZE)


PIN = RigPoint((430.0, 100.0), Polygon(((395.0, 95.0), (465.0, 95.0), (465.0, 105.0), (395.0, 105.0))))
NUDGE = EnergyStroke(path=((0.0, 250.0), (1000.0, 250.0)), radius=600.0, speed=5000.0, strength=0.3, end=0.05)


def scene(gravity: tuple[float, float], *, frequency: float = 1.2, lean: float = 0.0, **others: object) -> Scene:
    body = Body(strip(lean=lean), Material(sway_frequency=frequency, damping=0.3))
    return Scene((body,), **{"rig_points": (PIN,), "frame_rate": RATE, "gravity": gravity, **others})  # type: ignore[arg-type]


def travel(motion: Motion) -> float:
    return float(np.linalg.norm(motion.positions - motion.positions[0], axis=2).max())


@pytest.mark.parametrize("gravity", [(0.0, 1.0), (0.0, 5.0), (0.7, 0.7), (0.0, -0.5)])
@pytest.mark.parametrize("lean", [0.0, 0.5])
def test_the_drawing_is_how_it_hangs(gravity: tuple[float, float], lean: float) -> None:
    still = scene(gravity, lean=lean)
    motion = simulate(still, frames=121)
    np.testing.assert_array_equal(motion.positions[0], strip(lean=lean).vertices.astype(np.float32))
    assert travel(motion) < 0.05
    assert travel(simulate(replace(still, sag=True), frames=31)) > 0.3


def sway(gravity: tuple[float, float]) -> float:
    motion = simulate(scene(gravity, strokes=(NUDGE,)), frames=601)
    tip = motion.positions[30:, -2, 0] - motion.positions[0, -2, 0]
    assert 1 < np.abs(tip).max() < 40
    spectrum = np.abs(np.fft.rfft((tip - tip.mean()) * np.hanning(len(tip)), 16384))
    return float(np.fft.rfftfreq(16384, 1 / RATE)[spectrum.argmax()])


def test_gravity_adds_what_it_adds_to_a_pendulum() -> None:
    """By Rayleigh: omega^2 = omega_0^2 + g (integral of (1 - s) w'^2) / (integral of w^2) over a cantilever's shape w.

    Measured along the strip, w = s^2 (6 - 4 s + s^2) gives 1.56 g / length.
    """
    s = np.linspace(0, 1, 2001)
    w = s**2 * (6 - 4 * s + s**2)
    added = float(((1 - s) * np.gradient(w, s) ** 2).mean() / (w**2).mean())
    assert added == pytest.approx(1.556, abs=0.002)
    free, hanging, standing = sway((0.0, 0.0)), sway((0.0, 3.0)), sway((0.0, -3.0))
    expected = added * 3.0 / 0.3 / (2 * np.pi) ** 2
    assert hanging**2 - free**2 == pytest.approx(expected, rel=0.1)
    assert standing**2 - free**2 == pytest.approx(-expected, rel=0.1)


@pytest.mark.parametrize("gravity", [(0.0, -40.0), (1e5, 0.0)])
def test_what_cannot_carry_itself_is_refused_with_remedies(gravity: tuple[float, float]) -> None:
    """The first would stand, but topple at a breath."""
    with pytest.raises(SimulationError, match=r"Body number 0 is too soft .* Weaken gravity.*or set sag"):
        simulate(scene(gravity), frames=3)


@pytest.mark.parametrize("rig_points", [(), (RigPoint((400.0, 100.0), Circle(1.0)),)])
def test_what_nothing_holds_falls(rig_points: tuple[RigPoint, ...]) -> None:
    motion = simulate(scene((0.0, 0.5), rig_points=rig_points), frames=31)
    assert travel(motion) > 10


def test_the_rest_shape_s_derivative_is_that_of_the_forces() -> None:
    random = np.random.default_rng(0)
    rest = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.12]])
    triangles = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
    positions = rest + random.normal(0, 0.02, rest.shape)
    mu, lam = np.array([100.0, 150.0]), np.array([80.0, 90.0])
    exact = rest_shape_derivative(RestShape(rest, triangles), positions, mu, lam).toarray()
    for column in range(8):
        sides = []
        for sign in (1, -1):
            moved = rest.copy()
            moved.reshape(-1)[column] += sign * 1e-7
            sides.append(forces(RestShape(moved, triangles), positions, mu, lam).ravel())
        np.testing.assert_allclose(exact[:, column], (sides[0] - sides[1]) / 2e-7, atol=1e-6 * np.abs(exact).max())


def test_the_loaded_rest_shape_is_in_equilibrium_with_the_drawing() -> None:
    mesh = strip(lean=0.3)
    drawn = RestShape(mesh.vertices / SIZE, mesh.triangles)
    mu, lam = lame_parameters(np.full(len(mesh.triangles), 30.0), 0.3)
    loads = lumped_masses(drawn, 1.0)[:, None] * [0.0, 1.0]
    held = mesh.vertices[:, 1] < 101
    rest, carried = prestressed(drawn, mu, lam, loads, held)
    assert carried == 1
    assert np.abs(rest.positions - drawn.positions).max() * SIZE > 10
    np.testing.assert_array_equal(rest.positions[held], drawn.positions[held])
    residual = (forces(rest, drawn.positions, mu, lam) + loads)[~held]
    assert np.abs(residual).max() < 1e-5 * loads.max()
    assert is_stable(rest, drawn.positions, mu, lam, held)


def test_the_document_keeps_sag() -> None:
    document = scene_to_dict(scene((0.0, 1.0), sag=True))
    assert document["sag"] is True
    assert scene_from_dict(document).sag is True
    assert scene_from_dict(scene_to_dict(scene((0.0, 1.0)))).sag is False
