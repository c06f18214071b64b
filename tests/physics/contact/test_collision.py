"""Contact: what touches stays apart, momentum stays, energy does not grow, and without it nothing changes."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.assembly import assemble
from physanimator.physics.contact import TouchingBodies, contact_surface, touching_bodies
from physanimator.physics.contact.surface import CONTACTS
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.forces import EnergyStroke
from physanimator.physics.material import Material, energy
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask, signed_distances
from physanimator.physics.motion import Motion
from physanimator.physics.rig import Circle, KeyedPath, MaskRegion, Pinned, Polygon, RigPoint
from physanimator.physics.scene import Body, Collider, Contact, Scene
from physanimator.physics.simulation import simulate
from physanimator.physics.simulation.simulation import _solid
from physanimator.physics.solver import pace

Array = NDArray[np.float64]
SIZE = 512
SOFT = Material(youngs_modulus=200.0, damping=0.0)
CENTRES = ((130.0, 130.0), (380.0, 140.0), (140.0, 380.0), (370.0, 370.0))


def grid() -> tuple[Array, Array]:
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    return x, y


@lru_cache
def disc(x: float, y: float, radius: float = 70.0) -> TriangleMesh:
    gx, gy = grid()
    return mesh_from_mask((gx - x) ** 2 + (gy - y) ** 2 < radius**2, spacing=13)


@lru_cache
def box(left: float, top: float, right: float, bottom: float) -> TriangleMesh:
    x, y = grid()
    return mesh_from_mask((x > left) & (x < right) & (y > top) & (y < bottom), spacing=11)


@lru_cache
def curl() -> TriangleMesh:
    """An open ring, its gap at the right."""
    x, y = grid()
    radius, angle = np.hypot(x - 256, y - 256), np.arctan2(y - 256, x - 256)
    return mesh_from_mask((radius > 80) & (radius < 112) & (np.abs(angle) > 0.5), spacing=9)


def pinned(left: float, top: float, right: float, bottom: float) -> RigPoint:
    return RigPoint((left, top), Polygon(((left, top), (right, top), (right, bottom), (left, bottom))))


def pull(x: float, y: float, strength: float) -> EnergyStroke:
    return EnergyStroke(kind="attract", path=((x, y),), radius=400.0, speed=0.0, strength=strength)


def shapes(motion: Motion, frame: int) -> list[tuple[Array, Array, Array]]:
    """Vertices, and starts and ends of the boundary edges, of each body [px]."""
    ends = np.cumsum([len(body.mesh.vertices) for body in motion.bodies])[:-1]
    found = []
    for body, vertices in zip(motion.bodies, np.split(motion.positions[frame].astype(np.float64), ends), strict=True):
        edges = body.mesh.boundary_edges
        found.append((vertices, vertices[edges[:, 0]], vertices[edges[:, 1]]))
    return found


def deepest(motion: Motion, frame: int) -> float:
    """How deep a vertex is inside another body at most [px]; 0 where none is."""
    bodies = shapes(motion, frame)
    depths = [
        -signed_distances(vertices, starts, ends).min()
        for i, (vertices, _, _) in enumerate(bodies)
        for j, (_, starts, ends) in enumerate(bodies)
        if i != j
    ]
    return max(0.0, *depths)


def crossings(starts: Array, ends: Array) -> int:
    """Pairs of segments that cross, those that share an end left out."""

    def side(a: Array, b: Array, c: Array) -> Array:
        return (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])

    a, b, c, d = starts[:, None], ends[:, None], starts[None], ends[None]
    return int(((side(a, b, c) * side(a, b, d) < 0) & (side(c, d, a) * side(c, d, b) < 0)).sum()) // 2


def blobs(contact: Contact | None, *, strength: float = 6.0) -> Scene:
    strokes = (pull(256, 256, strength),) if strength else ()
    return Scene(tuple(Body(disc(*centre), SOFT) for centre in CENTRES), strokes, contact=contact)


@lru_cache
def pile() -> Motion:
    return simulate(blobs(Contact()), frames=240)


def test_four_blobs_at_high_speed_stay_out_of_each_other() -> None:
    assert np.linalg.norm(np.diff(pile().positions, axis=0), axis=2).max() > 10
    assert max(deepest(pile(), frame) for frame in range(240)) == 0


def test_without_contact_the_blobs_pass_through_each_other() -> None:
    motion = simulate(blobs(None), frames=24)
    assert max(deepest(motion, frame) for frame in range(24)) > 30


def test_the_same_scene_moves_the_same_way() -> None:
    np.testing.assert_array_equal(simulate(blobs(Contact()), frames=60).positions, pile().positions[:60])


@pytest.mark.parametrize("threads", [2, 3])
def test_the_motion_is_the_same_with_any_number_of_threads(threads: int, monkeypatch: pytest.MonkeyPatch) -> None:
    fine = mesh_from_mask(np.hypot(*(axis - 250.0 for axis in grid())) < 60, spacing=3.5)  # several pieces
    far = Body(box(20, 20, 70, 60), SOFT)  # touches nothing at first
    bodies = (Body(fine, SOFT), Body(disc(*CENTRES[0]), SOFT), Body(disc(*CENTRES[3]), SOFT), far)
    scene = Scene(bodies, (pull(256, 256, 6.0),), contact=Contact(), gravity=(0.0, 0.1))
    monkeypatch.setattr(pace.Pace, "share", lambda _: True)
    monkeypatch.setattr(touching_bodies, "most_threads", lambda *_: 1)
    alone = simulate(scene, frames=24)
    monkeypatch.setattr(touching_bodies, "most_threads", lambda *_: threads)
    shared = simulate(scene, frames=24)
    assert max(deepest(shared, frame) for frame in (12, 23)) == 0
    np.testing.assert_array_equal(shared.positions, alone.positions)


@pytest.mark.parametrize("speed", [0.3, 1.0])
def test_free_blobs_keep_their_momentum_and_gain_no_energy(speed: float) -> None:
    scene = blobs(Contact(friction=0.0), strength=0.0)
    system = assemble(scene)
    touching = TouchingBodies(scene, system, _solid(scene, system), Contact(friction=0.0))
    towards = np.array([256.0, 270.0]) - np.array(CENTRES)
    towards /= np.linalg.norm(towards, axis=1)[:, None]
    touching.state.velocity[:] = (np.array([[0.6], [1.0], [0.8], [0.9]]) * speed * towards)[system.bodies]
    momentum, energies = [], []
    for tick in range(0, 240, 5):
        v = touching.state.velocity.astype(np.float64)
        positions = system.rest.positions + touching.state.displacement
        momentum.append(system.masses @ v)
        energies.append(energy(system.rest, positions, *system.lame) + 0.5 * (system.masses @ v**2).sum())
        touching.advance(tick, tick + 5, block=5)
    scale = speed * system.masses.sum()
    np.testing.assert_allclose(momentum, np.tile(momentum[0], (len(momentum), 1)), atol=1e-6 * scale)
    assert energies[-1] < 0.97 * energies[0]  # they met
    assert max(energies) <= 1.001 * energies[0]
    assert np.diff(energies).max() < 0.02 * energies[0]


def test_what_jumps_inside_is_found_and_pushed_out_again() -> None:
    """A point may get behind an edge at once, farther than its speed tells; from then on it is looked at there."""
    left, right = disc(140, 256), disc(284, 256)
    softest = Material(youngs_modulus=5.0)  # one step in a tick, so that contacts are looked for before they push
    scene = Scene((Body(left, softest), Body(right, softest)), contact=Contact())
    system = assemble(scene)
    touching = TouchingBodies(scene, system, _solid(scene, system), Contact())
    surface, spacing, side, first = touching._touching.surface, 13.0, left.longest_side, len(left.vertices)

    def depths() -> Array:
        """Of the right disc's boundary in the left one [px], by the numbers of the surface's points."""
        positions = side * (system.rest.positions + touching.state.displacement)
        _, starts, ends = shapes(Motion(scene.bodies, positions[None], scene.frame_rate), 0)[0]
        points = surface.points
        return np.where(points >= first, -signed_distances(positions[points], starts, ends), 0.0)

    touching.advance(0, 2)
    jumped = touching.state.displacement.copy()
    jumped[first:, 0] -= (4.0 + 1.3 * spacing) / side  # more than an edge beyond the gap
    for tick in range(2, 6):
        touching.state.displacement[:], touching.state.velocity[:] = jumped, 0.0
        inside = np.flatnonzero(depths() > 0.1 * spacing)
        assert depths().max() > spacing
        touching.advance(tick, tick + 1)
        listed = surface.contacts[: int(surface.memory[CONTACTS]), 0]
        assert set(inside) <= set(listed)
    touching.advance(6, 66)
    assert depths().max() <= 0


def test_a_curl_does_not_fold_into_itself() -> None:
    body = Body(curl(), Material(youngs_modulus=300.0, damping=0.5))
    end = RigPoint((340.0, 302.0), Circle(24.0), KeyedPath((0.0, 0.5, 1.5), ((340, 302), (340, 220), (300, 170))))
    scene = Scene((body,), rig_points=(pinned(130, 240, 190, 270), end), contact=Contact(self_contact=True))
    folded = simulate(replace(scene, contact=Contact()), frames=60)
    assert max(crossings(*shapes(folded, frame)[0][1:]) for frame in range(0, 60, 4)) > 0
    motion = simulate(scene, frames=240)
    assert max(crossings(*shapes(motion, frame)[0][1:]) for frame in range(0, 240, 6)) == 0


def legs() -> tuple[Collider, ...]:
    x, y = grid()
    mask = (x > 320) & (x < 370) & (y > 120)
    return Collider(Polygon(((150, 120), (200, 120), (200, 512), (150, 512)))), Collider.from_mask(mask)


def skirt(contact: Contact | None, strength: float = 12.0) -> Scene:
    gusts = tuple(
        EnergyStroke(kind="wind", path=path, radius=250.0, speed=600.0, strength=strength, start=start, interval=1.0)
        for path, start in ((((100.0, 300.0), (500.0, 300.0)), 0.0), (((500.0, 330.0), (0.0, 330.0)), 0.5))
    )
    body = Body(box(225, 100, 300, 400), Material(sway_frequency=1.0, damping=1.0))
    return Scene((body,), gusts, (pinned(220, 95, 305, 112),), contact=contact, colliders=legs())


def depth_in_legs(motion: Motion, frame: int) -> float:
    vertices, starts, ends = shapes(motion, frame)[0]
    inside = [np.minimum(vertices[:, 0] - left, left + 50 - vertices[:, 0]) for left in (150, 320)]
    inside = [np.minimum(depth, vertices[:, 1] - 120) for depth in inside]
    corners = np.array([[150.0, 120], [200, 120], [320, 120], [370, 120]])
    return float(max(np.max(inside), -signed_distances(corners, starts, ends).min()))


def test_a_skirt_stays_out_of_the_legs() -> None:
    through = simulate(skirt(None), frames=48)
    assert max(depth_in_legs(through, frame) for frame in range(48)) > 5
    motion = simulate(skirt(Contact()), frames=240)
    assert max(depth_in_legs(motion, frame) for frame in range(240)) < 0
    nearest = min(320 - motion.positions[:, :, 0].max(), motion.positions[:, :, 0].min() - 200)
    assert nearest < 3  # it does reach them


def slid(friction: float) -> float:
    """How far a box goes down a slope [px]."""
    body = Body(box(100, 160, 180, 210), Material(youngs_modulus=400.0, damping=1.0))
    slope = Collider(Polygon(((0, 212), (512, 212), (512, 512), (0, 512))))
    scene = Scene((body,), gravity=(0.6, 1.2), contact=Contact(friction=friction), colliders=(slope,))
    motion = simulate(scene, frames=24)
    return float((motion.positions[-1] - motion.positions[0])[:, 0].mean())


def test_friction_slows_what_slides() -> None:
    free, rubbed, stuck = slid(0.0), slid(0.3), slid(1.0)
    time = 23 / 24
    fall = 0.6 * (time - (1 - np.exp(-time))) * SIZE  # under the damping of 1 a second
    assert free == pytest.approx(fall, rel=0.1)
    assert rubbed < 0.6 * free
    assert stuck < 0.1 * free


def overlapping(contact: Contact | None) -> Scene:
    bodies = (Body(box(150, 100, 250, 300), SOFT), Body(box(242, 150, 350, 350), SOFT))
    return Scene(bodies, contact=contact)


def test_what_overlaps_as_drawn_does_not_jump() -> None:
    motion = simulate(overlapping(Contact()), frames=12)
    assert np.abs(motion.positions - motion.positions[0]).max() < 0.05


def test_what_overlaps_as_drawn_gets_no_deeper_and_then_stays_apart() -> None:
    scene = overlapping(Contact(friction=0.0))
    lead = RigPoint((340.0, 250.0), Circle(60.0), KeyedPath((0, 0.5, 1, 1.5), ((0, 0), (-30, 0), (40, 0), (-8, 0))), 1)
    hold = replace(pinned(145, 95, 190, 305), body=0)
    motion = simulate(replace(scene, rig_points=(lead, hold)), frames=48)
    depth = [deepest(motion, frame) for frame in range(48)]
    assert max(depth[:12]) < 8 + 1.5
    assert depth[24] == 0
    assert max(depth[24:]) < 0.1


def test_contact_that_never_happens_changes_nothing_to_speak_of() -> None:
    apart = Scene((Body(disc(*CENTRES[0])), Body(disc(*CENTRES[3]))), gravity=(0.1, 0.3))
    without = simulate(apart, frames=12)
    np.testing.assert_allclose(
        simulate(replace(apart, contact=Contact()), frames=12).positions, without.positions, atol=1e-3
    )


def test_a_body_by_itself_moves_as_without_contact_while_others_touch() -> None:
    stiff = Material(youngs_modulus=2_000.0, damping=0.5)
    pair = (Body(box(150, 100, 250, 300), SOFT), Body(box(252, 150, 350, 350), SOFT))
    held = RigPoint((40.0, 60.0), Polygon(((20.0, 20.0), (70.0, 20.0), (70.0, 60.0), (20.0, 60.0))), Pinned(), 2)
    together = Scene((*pair, Body(box(20, 20, 70, 250), stiff)), (pull(256, 400, 5.0),), (held,))
    alone = simulate(together, frames=12).positions[:, -len(together.bodies[2].mesh.vertices) :]
    touching = simulate(replace(together, contact=Contact()), frames=12).positions[:, -alone.shape[1] :]
    assert np.abs(alone - alone[0]).max() > 0.5
    np.testing.assert_allclose(touching, alone, atol=1e-2)


def test_colliders_without_contact_do_nothing() -> None:
    scene = skirt(None)
    np.testing.assert_array_equal(
        simulate(scene, frames=12).positions, simulate(replace(scene, colliders=()), frames=12).positions
    )


def test_colliders_from_polygons_wind_as_bodies_do() -> None:
    ring = ((150.0, 120.0), (200.0, 120.0), (200.0, 512.0), (150.0, 512.0))
    for points in (ring, ring[::-1]):
        scene = Scene((Body(disc(*CENTRES[1])),), contact=Contact(), colliders=(Collider(Polygon(points)),))
        surface, still = contact_surface(scene, assemble(scene), Contact())
        a, b = still[
            surface.points[surface.edges[surface.edge_parts[:, 0] == 1, :2]] - len(scene.bodies[0].mesh.vertices)
        ].transpose(1, 0, 2)
        outward = np.column_stack([a[:, 1] - b[:, 1], b[:, 0] - a[:, 0]])
        assert (outward * ((a + b) / 2 - still.mean(axis=0))).sum(axis=1).min() > 0


def test_contact_survives_rescaling() -> None:
    scene = skirt(Contact(thickness=2.0)).rescaled(1024, 1024)
    assert scene.contact == Contact(thickness=4.0)
    region = scene.colliders[0].region
    assert isinstance(region, Polygon)
    assert region.points[0] == (300, 240)


@pytest.mark.parametrize("wrong", [{"friction": 1.5}, {"friction": -0.1}, {"thickness": 0.0}, {"thickness": np.nan}])
def test_unusable_contact_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(InvalidInputError, match=f"{next(iter(wrong))} must be"):
        Contact(**wrong)  # type: ignore[arg-type]


def test_an_empty_collider_is_no_obstacle() -> None:
    scene = Scene((Body(disc(*CENTRES[0])),), gravity=(0.0, 0.5), contact=Contact())
    empty = replace(scene, colliders=(Collider(MaskRegion(np.zeros((8, 8), dtype=bool))),))
    np.testing.assert_array_equal(simulate(empty, frames=6).positions, simulate(scene, frames=6).positions)


@pytest.mark.parametrize("strength", [1e6, -1e6])
def test_absurd_forces_stay_finite(strength: float) -> None:
    motion = simulate(replace(blobs(Contact(1.0, 20.0, True), strength=strength), colliders=legs()), frames=5)
    assert np.isfinite(motion.positions).all()


def test_a_body_led_into_a_collider_stays_finite() -> None:
    lead = RigPoint((260.0, 250.0), Circle(30.0), KeyedPath((0, 0.2, 0.4), ((260, 250), (160, 250), (5000, 250))))
    motion = simulate(replace(skirt(Contact()), rig_points=(lead,)), frames=12)
    assert np.isfinite(motion.positions).all()


def test_a_ground_and_a_wall_drawn_far_out_hold_bodies_up() -> None:
    thing = Body(box(100, 200, 160, 260), Material(youngs_modulus=200.0, damping=3.0))
    ground = Polygon(((-1e6, 300.0), (1e6, 300.0), (1e6, 1e6), (-1e6, 1e6)))
    wall = Polygon(((200.0, -1e6), (1e6, -1e6), (1e6, 1e6), (200.0, 1e6)))
    scene = Scene((thing,), gravity=(0.8, 1.0), contact=Contact(), colliders=(Collider(ground), Collider(wall)))
    x, y = np.moveaxis(simulate(scene, frames=60).positions, 2, 0)
    assert max(y.max() - 300.0, x.max() - 200.0) <= 0.0
    assert min(y[-1].max() - 300.0, x[-1].max() - 200.0) > -3.0  # it has come there
