"""TriangleMesh: winding, derived quantities, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh

SQUARE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]])
TWO = np.array([[0, 1, 2], [0, 2, 3]])


def signed_areas(mesh: TriangleMesh) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    u, v = b - a, c - a
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


@pytest.mark.parametrize("flip", [(), (0,), (1,), (0, 1)])
def test_winding_is_counter_clockwise_seen_with_y_up_whatever_was_given(flip: tuple[int, ...]) -> None:
    triangles = TWO.copy()
    for index in flip:
        triangles[index] = triangles[index][::-1]
    mesh = TriangleMesh(SQUARE, triangles, 10, 10)
    assert (signed_areas(mesh) < 0).all()
    np.testing.assert_allclose(mesh.areas, [6, 6])


def test_edges_and_boundary_of_a_square() -> None:
    mesh = TriangleMesh(SQUARE, TWO, 10, 10)
    assert {tuple(edge) for edge in mesh.edges.tolist()} == {(0, 1), (1, 2), (2, 3), (0, 3), (0, 2)}
    assert {tuple(sorted(edge)) for edge in mesh.boundary_edges.tolist()} == {(0, 1), (1, 2), (2, 3), (0, 3)}
    for (start, end), owner in zip(mesh.boundary_edges, mesh.boundary_triangles, strict=True):
        ring = mesh.triangles[owner].tolist()
        assert ring[(ring.index(start) + 1) % 3] == end


def test_boundary_edges_have_the_inside_on_one_hand() -> None:
    mesh = TriangleMesh(SQUARE, TWO, 10, 10)
    start, end = (mesh.vertices[mesh.boundary_edges[:, k]] for k in (0, 1))
    enclosed = 0.5 * np.sum(start[:, 0] * end[:, 1] - end[:, 0] * start[:, 1])
    assert enclosed == pytest.approx(-12)


def test_components_are_numbered_apart() -> None:
    vertices = np.concatenate([SQUARE, SQUARE + 10])
    mesh = TriangleMesh(vertices, np.concatenate([TWO, TWO + 4]), 20, 20)
    numbers = mesh.components
    assert set(numbers[:4].tolist()).isdisjoint(numbers[4:].tolist())
    assert len(set(numbers.tolist())) == 2


def test_rescaled_keeps_the_shape_in_units_of_the_picture() -> None:
    mesh = TriangleMesh(SQUARE, TWO, 10, 8)
    double = mesh.rescaled(20, 16)
    assert (double.width, double.height, double.longest_side) == (20, 16, 20.0)
    np.testing.assert_allclose(double.vertices / double.longest_side, mesh.vertices / mesh.longest_side)


def test_content_hash_follows_the_content() -> None:
    mesh = TriangleMesh(SQUARE, TWO, 10, 10)
    assert mesh.content_hash == TriangleMesh(SQUARE.copy(), TWO.astype(np.int64), 10, 10).content_hash
    assert mesh.content_hash != TriangleMesh(SQUARE + 1e-9, TWO, 10, 10).content_hash
    assert mesh.content_hash != TriangleMesh(SQUARE, TWO, 11, 10).content_hash


def test_arrays_are_copies_and_frozen() -> None:
    vertices = SQUARE.copy()
    mesh = TriangleMesh(vertices, TWO, 10, 10)
    vertices[0] = 99
    assert mesh.vertices[0, 0] == 0
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0, 0] = 1


@pytest.mark.parametrize(
    ("vertices", "triangles", "size", "message"),
    [
        (np.zeros((4, 3)), TWO, (9, 9), r"shape \[v, 2\]"),
        (SQUARE, np.zeros((0, 3), int), (9, 9), r"shape \[t, 3\]"),
        (np.where(SQUARE == 4, np.nan, SQUARE), TWO, (9, 9), "finite"),
        (SQUARE, TWO + 1, (9, 9), "must index"),
        (SQUARE, TWO - 1, (9, 9), "must index"),
        (SQUARE, TWO, (0, 9), "at least 1 px"),
        (SQUARE, np.array([[0, 1, 1]]), (9, 9), "must have an area"),
    ],
)
def test_unusable_meshes_are_refused(
    vertices: np.ndarray, triangles: np.ndarray, size: tuple[int, int], message: str
) -> None:
    with pytest.raises(InvalidInputError, match=message):
        TriangleMesh(vertices, triangles, *size)
