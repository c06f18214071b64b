"""Tethers: their anchors and lengths, and that bodies held by them bend but do not stretch."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physanimator.physics.assembly import assemble, tethers
from physanimator.physics.forces import Wind
from physanimator.physics.material import Material, RestShape, energy, rest_shape
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.rig import KeyedPath, Pinned, Polygon, RigPoint
from physanimator.physics.scene import Body, Scene
from physanimator.physics.simulation import simulate
from physanimator.physics.simulation.simulation import _solid
from physanimator.physics.solver import Drive, State, advance

SIZE = 512
TOP = Polygon(((0, 0), (SIZE, 0), (SIZE, 60), (0, 60)))
HELD = RigPoint((256, 50), TOP, Pinned())
STORM = Wind(40.0, -90.0, gust=0.0, turbulence=0.3, seed=1)


def strand() -> TriangleMesh:
    mask = np.zeros((SIZE, SIZE), dtype=bool)
    mask[30:330, 236:276] = True
    return mesh_from_mask(mask, spacing=13.0)


def hook() -> TriangleMesh:
    """Down, to the right and up again."""
    mask = np.zeros((SIZE, SIZE), dtype=bool)
    mask[30:400, 100:150] = mask[350:400, 100:400] = mask[100:400, 350:400] = True
    return mesh_from_mask(mask, spacing=14.0)


def scene(material: Material, *, wind: Wind | None = STORM, motion: Pinned | KeyedPath | None = None) -> Scene:
    return Scene((Body(strand(), material),), (), (replace(HELD, motion=motion or Pinned()),), wind=wind)


def soft(limit: float | None) -> Material:
    return Material(sway_frequency=0.8, damping=1.0, stretch_limit=limit)


def reach(motion: Motion) -> float:
    """Largest distance of a vertex from its anchor in all frames, as a share of that in the drawing."""
    mesh = motion.bodies[0].mesh
    held = in_region(mesh)
    anchors, lengths = tethers(rest_shape(mesh), held, np.ones(len(held)))
    free = anchors >= 0
    x = motion.positions.astype(np.float64) / mesh.longest_side
    distances = np.linalg.norm(x[:, free] - x[:, anchors[free]], axis=2)
    return float((distances / lengths[free]).max())


def in_region(mesh: TriangleMesh) -> np.ndarray:
    return mesh.vertices[:, 1] <= 60


def test_the_way_goes_through_the_drawing_and_not_across_a_gap() -> None:
    mesh = hook()
    held = mesh.vertices[:, 1] < 60
    anchors, lengths = tethers(rest_shape(mesh), held, np.full(len(held), 1.5))
    assert ((anchors >= 0) == ~held).all()
    assert held[anchors[~held]].all()
    tip = int(np.argmin(np.hypot(*(mesh.vertices - [375, 100]).T)))
    straight = np.hypot(*(mesh.vertices[tip] - mesh.vertices[anchors[tip]]))
    # Round the inner corners: (150, 60) to (150, 350) to (350, 350) to (375, 100).
    way = (290 + 200 + np.hypot(25, 250)) * 1.5
    assert straight < 300
    assert way < lengths[tip] * SIZE < 1.06 * way


def test_along_a_straight_strand_the_way_is_the_straight_line() -> None:
    mesh = strand()
    held = in_region(mesh)
    anchors, lengths = tethers(rest_shape(mesh), held, np.full(len(held), 1.0))
    straight = np.linalg.norm(mesh.vertices - mesh.vertices[anchors], axis=1) / SIZE
    np.testing.assert_allclose(lengths[~held], straight[~held], rtol=1e-12)
    depth = mesh.vertices[:, 1] - mesh.vertices[held, 1].max()
    assert (np.abs(lengths * SIZE - depth)[~held] < 8).all()


def test_no_thread_without_a_limit_or_without_something_held() -> None:
    two = RestShape(
        np.array([[0, 0], [1, 0], [0, 1], [5, 0], [6, 0], [5, 1.0]]), np.array([[0, 1, 2], [3, 4, 5]], dtype=np.int32)
    )
    held = np.array([True, False, False, False, False, False])
    assert tethers(two, held, np.full(6, 1.1))[0].tolist() == [-1, 0, 0, -1, -1, -1]
    assert (tethers(two, held, np.full(6, np.inf))[0] == -1).all()
    assert len(_solid(*(lambda s: (s, assemble(s)))(scene(soft(None)))).anchors) == 0


@pytest.mark.parametrize("limit", [1.0, 1.05])
def test_a_strand_in_a_storm_gets_no_longer_than_its_limit(limit: float) -> None:
    free, tethered = (simulate(scene(soft(each)), frames=49) for each in (None, limit))
    assert reach(free) > 1.15
    assert limit - 0.01 < reach(tethered) < limit + 1e-4
    tip = np.argmax(tethered.positions[0, :, 1])
    swung = np.ptp(tethered.positions[:, tip, 0])
    assert swung > 20  # it hangs on threads but swings


def test_a_led_strand_follows_without_stretching() -> None:
    away = KeyedPath((0.0, 0.25, 1.0), ((0.0, 0.0), (120.0, -20.0), (120.0, -20.0)))
    free, tethered = (simulate(scene(soft(each), wind=None, motion=away), frames=25) for each in (None, 1.02))
    assert reach(free) > 1.08
    assert reach(tethered) < 1.0201
    moved = tethered.positions[-1] - tethered.positions[0]
    np.testing.assert_allclose(
        moved[in_region(strand())], np.broadcast_to([120, -20], (in_region(strand()).sum(), 2)), atol=0.01
    )


def test_tethers_only_take_energy() -> None:
    """An undamped strand thrown against its threads: kinetic and elastic energy never rise above the start's."""
    made = scene(Material(sway_frequency=0.8, damping=0.0, stretch_limit=1.02), wind=None)
    system = assemble(made)
    solid = _solid(made, system)
    state = State.at_rest(solid)
    depth = system.rest.positions[:, 1] - system.rest.positions[~system.free, 1].max()
    state.velocity[system.free] = (depth[:, None] * np.array([1.5, 2.5]))[system.free]
    zeros, nothing = np.zeros((2, 1, 6), np.float32), np.zeros((0, 6), np.float32)
    still = Drive(zeros, zeros, np.zeros(2, np.int32), nothing, np.zeros(0, np.int32), (0.0, 0.0))
    found = []
    for _ in range(480):
        kinetic = 0.5 * (system.masses[:, None] * state.velocity.astype(np.float64) ** 2).sum()
        found.append(kinetic + energy(system.rest, system.rest.positions + state.displacement, *system.lame))
        advance(solid, state, still)
    energies = np.array(found)
    assert energies.max() < 1.02 * energies[0]  # the integrator's own band
    assert energies[-1] < 0.9 * energies[0]
    assert (energies[240:].max()) < 1.02 * energies[200:240].max()


def test_wind_moves_in_proportion_to_the_response() -> None:
    gentle = Wind(0.02, 0.0, gust=0.0, turbulence=0.0)
    tips = []
    for response in (0.0, 1.0, 2.0):
        motion = simulate(scene(replace(soft(None), wind_response=response), wind=gentle), frames=13)
        tips.append(np.abs(motion.positions[-1] - motion.positions[0]).max())
    assert tips[0] == 0
    assert tips[2] / tips[1] == pytest.approx(2, rel=0.01)
