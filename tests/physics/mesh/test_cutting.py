"""Slits: the two sides part, nothing else changes, and the mesh stays in one piece where a slit ends inside it."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.mesh import TriangleMesh, cut_along, mesh_from_mask


def square(seed: int = 0) -> TriangleMesh:
    return mesh_from_mask(np.pad(np.ones((80, 80)), 20), spacing=8 + seed)


def path_from_boundary(mesh: TriangleMesh, length: int, seed: int) -> list[int]:
    """Vertices of a walk from the boundary into the mesh that meets neither itself nor the boundary again."""
    random = np.random.default_rng(seed)
    border = set(mesh.boundary_edges.ravel().tolist())
    beside: dict[int, set[int]] = {}
    for a, b in mesh.edges.tolist():
        beside.setdefault(a, set()).add(b)
        beside.setdefault(b, set()).add(a)
    path = [int(random.choice(sorted(border)))]
    while len(path) < length:
        ahead = sorted(beside[path[-1]] - border - set(path))
        if not ahead:
            break
        path.append(int(random.choice(ahead)))
    return path


@pytest.mark.parametrize("seed", range(8))
def test_a_slit_doubles_its_vertices_but_the_last_and_keeps_the_mesh_whole(seed: int) -> None:
    mesh = square(seed % 3)
    path = path_from_boundary(mesh, 5, seed)
    slit = cut_along(mesh, np.stack([path[:-1], path[1:]], axis=1))
    assert len(slit.vertices) == len(mesh.vertices) + len(path) - 1
    assert (slit.vertices[: len(mesh.vertices)] == mesh.vertices).all()
    assert np.allclose(slit.vertices[slit.triangles], mesh.vertices[mesh.triangles])
    assert slit.components.max() == 0
    assert len(slit.boundary_edges) == len(mesh.boundary_edges) + 2 * (len(path) - 1)
    starts, times = np.unique(slit.boundary_edges[:, 0], return_counts=True)
    assert (times == 1).all(), "the boundary passes every vertex once"
    assert len(starts) == len(slit.boundary_edges)


def test_a_slit_from_side_to_side_makes_two_parts() -> None:
    mesh = TriangleMesh(
        [[0, 0], [8, 0], [16, 0], [0, 8], [8, 8], [16, 8]],
        [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]],
        width=16,
        height=8,
    )
    assert cut_along(mesh, np.array([[4, 1]])).components.max() == 1


def test_without_edges_a_mesh_stays_as_it_is() -> None:
    mesh = square()
    same = cut_along(mesh, np.zeros((0, 2), dtype=int))
    assert same.content_hash == mesh.content_hash
