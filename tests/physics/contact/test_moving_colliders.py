"""A body that a rig point leads pushes others in contact: a moving collider, such as a hand or a leg."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.material import Material
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask, signed_distances
from physanimator.physics.motion import Motion
from physanimator.physics.rig import KeyedPath, Polygon, RigMotion, RigPoint, Rotation
from physanimator.physics.scene import Body, Contact, Scene
from physanimator.physics.simulation import simulate

Array = NDArray[np.float64]
SIZE = 512
EVERYTHING = Polygon(((-600, -600), (1200, -600), (1200, 1200), (-600, 1200)))


def box(left: float, top: float, right: float, bottom: float) -> TriangleMesh:
    y, x = np.mgrid[:SIZE, :SIZE] + 0.5
    return mesh_from_mask((x > left) & (x < right) & (y > top) & (y < bottom), spacing=14)


def skirt_and_leg(motion: RigMotion, contact: Contact | None) -> Scene:
    """A hanging cloth, held at its top, and to its left a leg that is led as a whole about the hip."""
    cloth = Body(box(240, 100, 300, 400), Material(sway_frequency=1.0, damping=2.0))
    leg = Body(box(150, 220, 200, 450), layer=1)
    waist = RigPoint((270, 100), Polygon(((235, 95), (305, 95), (305, 115), (235, 115))), body=0)
    return Scene((cloth, leg), rig_points=(waist, RigPoint((175, 110), EVERYTHING, motion, body=1)), contact=contact)


def depths(motion: Motion, frame: int) -> float:
    """How deep a vertex of one body is inside the other [px]; negative where they are apart."""
    shapes = [motion.of_body(number)[frame].astype(np.float64) for number in (0, 1)]
    ends = [body.mesh.boundary_edges for body in motion.bodies]
    return max(
        float(-signed_distances(shapes[one], shapes[other][ends[other][:, 0]], shapes[other][ends[other][:, 1]]).min())
        for one, other in ((0, 1), (1, 0))
    )


MOTIONS: list[RigMotion] = [
    KeyedPath((0.2, 0.6, 1.2), ((0, 0), (120, 0), (0, 0)), easing="ease"),
    Rotation((0.2, 0.6, 1.2), (0, 30, 0), easing="ease"),
]


@pytest.mark.parametrize("motion", MOTIONS, ids=["moved", "turned"])
def test_a_led_leg_pushes_the_cloth_out_of_its_way(motion: RigMotion) -> None:
    through = simulate(skirt_and_leg(motion, None), frames=48)
    assert max(depths(through, frame) for frame in range(48)) > 20
    assert np.ptp(through.of_body(0), axis=0).max() == 0
    pushed = simulate(skirt_and_leg(motion, Contact()), frames=96)
    assert max(depths(pushed, frame) for frame in range(96)) < 0.1
    hem = pushed.of_body(0)[:, :, 0] - pushed.of_body(0)[0, :, 0]
    assert hem[14].max() > 50  # while the leg is at its farthest
    assert np.abs(hem[-1]).max() < 0.3 * hem[14].max()  # it falls back when the leg has gone


@pytest.mark.parametrize("motion", MOTIONS, ids=["moved", "turned"])
def test_what_is_led_is_not_pushed_back(motion: RigMotion) -> None:
    alone, touched = (simulate(skirt_and_leg(motion, contact), frames=30).of_body(1) for contact in (None, Contact()))
    np.testing.assert_allclose(touched, alone, atol=1e-3)


@pytest.mark.parametrize("thickness", [1.0, 6.0])
def test_bodies_keep_the_thickness_between_them_and_half_of_it_under_pressure(thickness: float) -> None:
    scene = skirt_and_leg(MOTIONS[0], Contact(thickness=thickness))
    motion = simulate(scene, frames=48)
    gaps = [-depths(motion, frame) for frame in range(48)]
    assert 0.45 * thickness < min(gaps) < 0.75 * thickness
