"""Slits in contact: at rest nothing moves, strands rest against each other, and energy does not grow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.assembly import assemble
from physanimator.physics.contact import TouchingBodies
from physanimator.physics.forces import EnergyStroke, Wind
from physanimator.physics.material import Material, energy
from physanimator.physics.mesh import TriangleMesh, cut_along, mesh_from_mask, signed_distances
from physanimator.physics.motion import Motion
from physanimator.physics.rig import Polygon, RigPoint
from physanimator.physics.scene import Body, Collider, Contact, Scene
from physanimator.physics.simulation import simulate
from physanimator.physics.simulation.simulation import _solid

Array = NDArray[np.float64]
SIZE, CELL, COLUMNS, ROWS = 400, 10.0, 18, 26
LEFT, TOP = 110.0, 60.0
HAIR = Material(youngs_modulus=40.0, damping=0.3)
HELD = RigPoint((200, 70), Polygon(((100, 50), (300, 50), (300, 95), (100, 95))))


def hair(*slits: tuple[float, float], bend: float = 0.0) -> Body:
    """A sheet of hair with slits: the column of a grid at which each begins below, and by how many it leans per row."""
    x, y = np.meshgrid(LEFT + CELL * np.arange(COLUMNS + 1), TOP + CELL * np.arange(ROWS + 1))
    x = x + bend * np.sin((y - TOP) / 30)
    number = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (each.ravel() for each in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    triangles = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    mesh = TriangleMesh(np.column_stack([x.ravel(), y.ravel()]), triangles, SIZE, SIZE)
    for column, lean in slits:
        path = [number[ROWS - k, round(column - lean * k)] for k in range(18)]
        mesh = cut_along(mesh, np.column_stack([path[:-1], path[1:]]))
    return Body(mesh, HAIR, strands=True)


KINDS = [
    pytest.param(hair((9, 0)), id="one"),
    pytest.param(hair((5, 0), (9, 0), (13, 0), bend=14.0), id="curved"),
    pytest.param(hair((9, 0), (10, 0)), id="a thin strand"),
    pytest.param(hair((9, 0), (9, 0.5)), id="two from one notch"),
]
SELF = Contact(self_contact=True)


def squeezing(strength: float = 1.0) -> EnergyStroke:
    return EnergyStroke("attract", ((200.0, 330.0),), 500.0, 0.0, strength, 0.0, 0.5)


def strands(body: Body) -> list[Array]:
    """The outline of what hangs on each side of a slit at the ninth column, by vertex numbers in order."""
    following = dict(body.mesh.boundary_edges.tolist())
    first = vertex = next(iter(following))
    loop = [first]
    while (vertex := following[vertex]) != first:
        loop.append(vertex)
    at = body.mesh.vertices[loop]
    middle = LEFT + 9 * CELL
    end = int(np.argmin(np.hypot(at[:, 0] - middle, at[:, 1] - (TOP + 9 * CELL))))
    loop = [*loop[end:], *loop[:end]]
    low = [n for n in range(len(loop)) if body.mesh.vertices[loop[n], 1] >= TOP + 12 * CELL]
    halves = np.split(np.array(low), [k + 1 for k in range(len(low) - 1) if at_notch(body, loop, low, k)])
    return [np.array(loop)[half] for half in halves]


def at_notch(body: Body, loop: list[int], low: list[int], k: int) -> bool:
    one, other = body.mesh.vertices[loop[low[k]]], body.mesh.vertices[loop[low[k + 1]]]
    return bool(np.linalg.norm(one - other) > 1.5 * CELL) or (loop[low[k]] != loop[low[k + 1]] and np.all(one == other))


def overlap(motion: Motion, sides: list[Array]) -> float:
    """How deep a vertex of one strand is in the other at most [px]."""
    deepest = 0.0
    for vertices in motion.positions.astype(np.float64):
        for one, other in ((0, 1), (1, 0)):
            around = vertices[sides[one]]
            inside = -signed_distances(vertices[sides[other]], around, np.roll(around, -1, axis=0))
            deepest = max(deepest, float(inside.max()))
    return deepest


@pytest.mark.parametrize("thickness", [0.5, 1.5, 12.0])
@pytest.mark.parametrize("body", KINDS)
def test_a_slit_body_at_rest_stays_where_it_is(body: Body, thickness: float) -> None:
    contact = Contact(self_contact=True, thickness=thickness)
    positions = simulate(Scene((body,), rig_points=(HELD,), contact=contact), frames=12).positions
    np.testing.assert_array_equal(positions, np.broadcast_to(positions[0], positions.shape))


def test_narrow_gaps_stay_at_rest_and_hold() -> None:
    """Two prongs of a fork, 3 px apart where a contact of 6 px would have them."""
    mask = np.zeros((SIZE, SIZE))
    mask[60:340, 120:280] = 1
    mask[120:340, 199:202] = 0
    body = Body(mesh_from_mask(mask, spacing=9), HAIR)
    scene = Scene((body,), rig_points=(HELD,), contact=Contact(self_contact=True, thickness=6.0))
    positions = simulate(scene, frames=12).positions
    np.testing.assert_array_equal(positions, np.broadcast_to(positions[0], positions.shape))

    def least_gap(contact: Contact | None) -> float:
        motion = simulate(replace(scene, strokes=(squeezing(2.0),), contact=contact), frames=30)
        low = body.mesh.vertices[:, 1] > 320
        right = body.mesh.vertices[:, 0] > 200
        return float(
            (motion.positions[:, low & right, 0].min(axis=1) - motion.positions[:, low & ~right, 0].max(axis=1)).min()
        )

    assert least_gap(None) < -8
    assert least_gap(Contact(self_contact=True, thickness=6.0)) > -1


@pytest.mark.parametrize("body", KINDS)
def test_the_energy_of_a_closed_system_does_not_grow(body: Body) -> None:
    free = replace(body, material=replace(HAIR, damping=0.0))
    scene = Scene((free,), rig_points=(HELD,), contact=Contact(friction=0.0, self_contact=True))
    system = assemble(scene)
    touching = TouchingBodies(scene, system, _solid(scene, system), Contact(friction=0.0, self_contact=True))
    x, y = system.rest.positions.T * SIZE
    towards = np.where(x < LEFT + 9 * CELL, 1.0, -1.0) * np.clip((y - TOP - 90) / 170, 0, 1)
    touching.state.velocity[:, 0] = np.where(system.leaders < 0, 0.5 * towards, 0.0)
    energies = []
    for tick in range(0, 480, 5):
        v, moved = touching.state.velocity.astype(np.float64), system.rest.positions + touching.state.displacement
        energies.append(energy(system.rest, moved, *system.lame) + 0.5 * (system.masses @ v**2).sum())
        touching.advance(tick, tick + 5, block=5)
    assert max(energies) < 1.02 * energies[0]
    assert np.abs(touching.state.displacement).max() * SIZE > 1


@pytest.mark.parametrize("bend", [0.0, 14.0])
def test_strands_come_back_to_rest_against_each_other(bend: float) -> None:
    body = hair((9, 0), bend=bend)
    sides = strands(body)
    scene = Scene((body,), (squeezing(1.5),), (HELD,))
    assert overlap(simulate(scene, frames=48), sides) > 6
    motion = simulate(replace(scene, contact=SELF), frames=48)
    assert overlap(motion, sides) < 1.5
    last = simulate(replace(scene, contact=SELF), frames=240).positions[-1]
    assert np.linalg.norm(last - motion.positions[0], axis=1).max() < 1.0


@pytest.mark.parametrize("body", KINDS)
def test_slits_do_not_run_away_in_wind(body: Body) -> None:
    scene = Scene((body,), (), (HELD,), wind=Wind(1.0, 0, 1.0, 3, 0.5, 80, 0))
    alone = simulate(scene, frames=48).positions
    together = simulate(replace(scene, contact=SELF), frames=48).positions
    farthest = [float(np.linalg.norm(each - each[0], axis=2).max()) for each in (alone, together)]
    fastest = [float(np.linalg.norm(np.diff(each, axis=0), axis=2).max()) for each in (alone, together)]
    assert farthest[0] > 8
    assert farthest[1] < 1.5 * farthest[0]
    assert fastest[1] < 1.5 * fastest[0]


def test_without_self_contact_strands_overlap_as_without_contact() -> None:
    body = hair((5, 0), (9, 0), (13, 0))
    scene = Scene((body,), (squeezing(),), (HELD,))
    touching = simulate(replace(scene, contact=Contact()), frames=24).positions
    np.testing.assert_allclose(touching, simulate(scene, frames=24).positions, atol=0.05)


def test_what_lies_over_a_slit_is_not_caught_in_it() -> None:
    ribbon = np.zeros((SIZE, SIZE))
    ribbon[200:216, 140:262] = 1
    over = Body(mesh_from_mask(ribbon, spacing=6), HAIR, 1)
    tied = RigPoint((141, 208), Polygon(((130, 190), (150, 190), (150, 225), (130, 225))), body=1)
    scene = Scene((hair((7, 0), (9, 0)), over), (squeezing(),), (HELD, tied))
    free = simulate(scene, frames=24).positions
    for contact in (Contact(), SELF):
        moved = simulate(replace(scene, contact=contact), frames=24).positions
        ribbons = slice(len(scene.bodies[0].mesh.vertices), None)
        np.testing.assert_allclose(moved[:, ribbons], free[:, ribbons], atol=0.5)


def test_what_meets_a_slit_body_stays_out_of_it() -> None:
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    ball = Body(mesh_from_mask(np.hypot(x - 200, y - 358) < 30, spacing=8), Material(youngs_modulus=300.0))
    up = EnergyStroke("wind", ((200.0, 390.0), (200.0, 300.0)), 60.0, 300.0, 4.0, 0.0, 0.3)
    sheet = hair((9, 0))
    scene = Scene((sheet, ball), (up,), (HELD,))
    edges, count = sheet.mesh.boundary_edges, len(sheet.mesh.vertices)

    def deepest(motion: Motion) -> float:
        frames = motion.positions.astype(np.float64)
        return float(max(-signed_distances(at[count:], *at[edges.T]).min() for at in frames))

    assert deepest(simulate(scene, frames=36)) > 8
    for contact in (Contact(), SELF):
        assert deepest(simulate(replace(scene, contact=contact), frames=36)) < 1.5


def test_strands_stay_out_of_a_collider_beside_them() -> None:
    shoulder = Collider(Polygon(((296, 180), (400, 180), (400, 400), (296, 400))))
    gust = EnergyStroke("wind", ((100.0, 250.0), (300.0, 250.0)), 150.0, 400.0, 6.0, 0.0, 0.5)
    body = hair((5, 0), (9, 0), (13, 0))
    scene = Scene((body,), (gust,), (HELD,), colliders=(shoulder,))
    assert simulate(scene, frames=24).positions[..., 0].max() > 306
    for contact in (Contact(), SELF):
        moved = simulate(replace(scene, contact=contact), frames=24).positions
        assert moved[..., 0].max() < 298
