"""The binary form of meshes and frames, read back."""

from __future__ import annotations

import json
import struct

import numpy as np
import pytest
from physanimator.nodes.preview import PreviewBodies, split_records
from physanimator.nodes.preview.limits import MAX_SHOWN_PARTICLES
from physanimator.nodes.preview.records import ERROR, FrameEncoder, encode_mesh, record
from physanimator.physics.forces import EnergyStroke
from physanimator.physics.material import preset
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import KeyedPath, RigPoint
from physanimator.physics.scene import Body, Scene


def square(x: float, *, layer: int = 0, name: str = "") -> Body:
    corners = np.array([(x, 0.0), (x + 10, 0.0), (x + 10, 10.0), (x, 10.0)])
    return Body(TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]]), 1600, 800), preset("hair"), layer, name)


def test_a_mesh_lies_in_drawing_order_over_positions_in_the_order_of_the_bodies() -> None:
    data = encode_mesh(PreviewBodies((square(0, layer=1, name="front"), square(50, name="back"), square(90))))
    length = struct.unpack_from("<I", data)[0]
    header = json.loads(data[4 : 4 + length])
    at, arrays = 4 + length + (-length % 4), {}
    for array in header["arrays"]:
        count = int(np.prod(array["shape"]))
        arrays[array["name"]] = np.frombuffer(data, array["dtype"], count, at).reshape(array["shape"])
        at += 4 * count
    assert at == len(data)
    assert (header["width"], header["height"], header["names"]) == (1600, 800, ["back", "", "front"])
    np.testing.assert_array_equal(arrays["positions"][:, 0].reshape(3, 4).min(axis=1), [0, 50, 90])
    np.testing.assert_array_equal(arrays["bodies"], [[0, 2], [2, 4], [4, 6]])
    first, end = arrays["bodies"][0]
    assert arrays["positions"][arrays["triangles"][first:end].ravel()][:, 0].min() == 50
    assert [array["dtype"] for array in header["arrays"]] == ["float32", "uint32", "uint32"]


def test_records_are_aligned_and_come_back() -> None:
    data = record(7, b"12345") + record(ERROR, {"error": "é"})
    assert len(data) % 4 == 0
    (kind, payload), (_, error) = split_records(data + b"\1\0\0")
    assert (kind, payload, json.loads(error)) == (7, b"12345", {"error": "é"})
    assert split_records(data[:-8])[-1][0] == 7, "what is cut off is left out"


def decoded(payload: bytes, vertices: int, rig_points: int) -> tuple[int, np.ndarray, np.ndarray, np.ndarray]:
    number = struct.unpack_from("<I", payload)[0]
    moved = np.frombuffer(payload, "<i2", 2 * vertices, 4).reshape(-1, 2)
    anchors = np.frombuffer(payload, "<i2", 2 * rig_points, 4 + 4 * vertices).reshape(-1, 2)
    at = 4 + 4 * (vertices + rig_points)
    count = struct.unpack_from("<I", payload, at)[0]
    particles = np.frombuffer(payload, "<i2", 4 * count, at + 4).reshape(-1, 4)
    assert at + 4 + 8 * count == len(payload)
    return number, moved, anchors, particles


def test_a_frame_holds_displacements_anchors_and_particles() -> None:
    stroke = EnergyStroke("repel", ((100.0, 50.0),), 80.0, speed=0.0)
    led = RigPoint((5.0, 5.0), motion=KeyedPath((0.0, 1.0), ((5.0, 5.0), (25.0, -5.0)), easing="linear"))
    scene = Scene((square(0), square(50)), (stroke,), (led,), frame_rate=10.0)
    encoder = FrameEncoder(scene, frames=11)
    positions = np.concatenate([body.mesh.vertices for body in scene.bodies]).astype(np.float32)
    positions[5] += (30, -40)
    payload, largest = encoder.frame(10, positions)
    number, moved, anchors, particles = decoded(payload, 8, 1)
    assert (number, largest) == (10, pytest.approx(40))
    expected = np.zeros((8, 2))
    expected[5] = (30, -40)
    np.testing.assert_allclose(moved * encoder.unit, expected, atol=encoder.unit / 2)
    np.testing.assert_allclose(anchors * encoder.unit, [[20, -10]], atol=encoder.unit / 2)
    np.testing.assert_allclose(particles[0, :3] * encoder.unit, [100, 50, 80], atol=encoder.unit / 2)
    assert particles[0, 3] == 1
    header = encoder.header(frames=11)
    assert (header["vertices"], header["rig_points"], header["unit"]) == (8, 1, 1600 / 16384)


def test_what_is_far_away_or_not_finite_is_clipped() -> None:
    scene = Scene((square(0),), (EnergyStroke("repel", ((900_000.0, 0.0),), 80.0, speed=0.0),))
    encoder = FrameEncoder(scene, frames=1)
    positions = np.array([[np.nan, 0], [np.inf, -np.inf], [1e9, -1e9], [0, 0]], dtype=np.float32)
    _, moved, _, particles = decoded(encoder.frame(0, positions)[0], 4, 0)
    np.testing.assert_array_equal(moved[:3], [[0, 0], [32767, -32767], [32767, -32767]])
    assert len(particles) == 0


def test_of_many_particles_some_are_shown() -> None:
    strokes = [EnergyStroke("wind", ((0.0, y), (1600.0, y)), 50.0, speed=4.0, interval=0.1) for y in range(3)]
    scene = Scene((square(0),), tuple(strokes), frame_rate=1.0)
    _, _, _, particles = decoded(FrameEncoder(scene, frames=400).frame(399, np.zeros((4, 2), np.float32))[0], 4, 0)
    assert MAX_SHOWN_PARTICLES / 2 < len(particles) <= MAX_SHOWN_PARTICLES
