"""Optical flow of a motion against deformations known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import FlowSequence, Motion, layer_order
from physanimator.physics.scene import Body

WIDTH, HEIGHT = 96, 72
CENTRES = np.stack(np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5), axis=-1)


def block(left: float, top: float, right: float, bottom: float, *, cells: int = 6) -> TriangleMesh:
    x, y = np.meshgrid(np.linspace(left, right, cells + 1), np.linspace(top, bottom, cells + 1))
    number = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (part.reshape(-1) for part in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriangleMesh(np.stack([x.reshape(-1), y.reshape(-1)], axis=1), triangles, WIDTH, HEIGHT)


def affine_motion(mesh: TriangleMesh, matrix: np.ndarray, shift: np.ndarray) -> Motion:
    moved = mesh.vertices @ matrix.T + shift
    return Motion((Body(mesh),), np.stack([mesh.vertices, moved]).astype(np.float32), 24.0)


ROTATION = np.array([[np.cos(0.4), -np.sin(0.4)], [np.sin(0.4), np.cos(0.4)]])
SHEAR = np.array([[1.0, 0.6], [0.0, 1.0]])


@pytest.mark.parametrize("matrix", [ROTATION, SHEAR], ids=["rotation", "shear"])
def test_flow_of_an_affine_motion_is_exact(matrix: np.ndarray) -> None:
    flow = FlowSequence(affine_motion(block(20.3, 15.2, 70.6, 55.9), matrix, np.array([4.0, -2.5]))).flow(1)
    expected = CENTRES @ matrix.T + (4.0, -2.5) - CENTRES
    assert np.abs(flow.displacement - expected)[flow.inside].max() < 0.01
    assert not flow.displacement[~flow.inside].any()
    inside = (np.abs(CENTRES - (45.45, 35.55)) < (25.15, 20.35)).all(axis=2)
    assert (flow.inside == inside).all()


def test_flow_at_rest_is_zero_inside_and_outside() -> None:
    flow = FlowSequence(affine_motion(block(20, 15, 70, 55), SHEAR, np.zeros(2))).flow(0)
    assert flow.inside.any()
    assert not flow.displacement.any()


def test_flow_is_piecewise_affine_for_a_bent_mesh() -> None:
    mesh = block(10, 10, 80, 60, cells=30)
    bent = mesh.vertices + np.stack([5 * np.sin(mesh.vertices[:, 1] / 15), np.zeros(len(mesh.vertices))], axis=1)
    motion = Motion((Body(mesh),), np.stack([mesh.vertices, bent]).astype(np.float32), 24.0)
    flow = FlowSequence(motion).flow(1)
    assert np.abs(flow.displacement[..., 0] - 5 * np.sin(CENTRES[..., 1] / 15))[flow.inside].max() < 0.02


@pytest.mark.parametrize(("layers", "front"), [((0, 0), 1), ((1, 0), 0), ((0, 1), 1)])
def test_the_body_in_front_owns_the_pixel(layers: tuple[int, int], front: int) -> None:
    meshes = block(10, 10, 50, 50), block(30, 20, 80, 60)
    bodies = tuple(Body(mesh, layer=layer) for mesh, layer in zip(meshes, layers, strict=True))
    rest = np.concatenate([mesh.vertices for mesh in meshes])
    moved = rest + np.repeat([[1.0, 0], [0, 2]], [len(mesh.vertices) for mesh in meshes], axis=0)
    sequence = FlowSequence(Motion(bodies, np.stack([rest, moved]).astype(np.float32), 24.0))
    assert layer_order(sequence.motion.bodies)[-1] == front
    assert sequence.body[30, 40] == front
    assert sequence.flow(1).displacement[30, 40] == pytest.approx([(1, 0), (0, 2)][front])
    assert sequence.body[12, 12] == 0
    assert sequence.body[55, 70] == 1
    assert sequence.body[5, 5] == -1


def test_a_mesh_beyond_the_border_is_clipped() -> None:
    flow = FlowSequence(affine_motion(block(-30, -20, 130, 40), SHEAR, np.zeros(2))).flow(1)
    assert flow.inside[:40].all()
    assert not flow.inside[40:].any()


def test_frames_are_computed_when_asked_for() -> None:
    motion = affine_motion(block(20, 15, 70, 55), ROTATION, np.zeros(2))
    sequence = FlowSequence(motion)
    assert len(sequence) == 2
    assert [flow.displacement.any() for flow in sequence] == [False, True]
    assert (FlowSequence(motion[1:]).flow(0).displacement == sequence.flow(1).displacement).all()
    with pytest.raises(InvalidInputError, match=r"frame must be 0 to 1\. Got: 2"):
        sequence.flow(2)
