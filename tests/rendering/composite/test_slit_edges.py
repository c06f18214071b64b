"""Edges of slits: smooth where strands part, and at rest no different from a mesh without a slit."""

from __future__ import annotations

import numpy as np
from physanimator.physics.mesh import TriangleMesh, cut_along
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.artwork import ArtLayer, Artwork
from physanimator.rendering.composite import LayeredRenderer

SIZE = 96


def slit_mesh() -> TriangleMesh:
    """A grid of squares, 16 px wide, slit along x = 48 from the lower edge up to y = 32."""
    count = 5
    x, y = np.meshgrid(np.linspace(16, 80, count), np.linspace(16, 80, count))
    number = np.arange(count * count).reshape(count, count)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]))
    triangles = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    mesh = TriangleMesh(np.stack([x.ravel(), y.ravel()], axis=1), triangles, SIZE, SIZE)
    return cut_along(mesh, np.stack([number[1:-1, 2], number[2:, 2]], axis=1))


def artwork() -> Artwork:
    random = np.random.default_rng(0)
    pixels = np.zeros((SIZE, SIZE, 4), dtype=np.uint8)
    pixels[16:80, 16:80] = (*random.integers(40, 60, 3), 255)
    pixels[16:80, 16:80, :3] += random.integers(0, 20, (64, 64, 3)).astype(np.uint8)
    paper = np.full((SIZE, SIZE, 4), 255, dtype=np.uint8)
    return Artwork(SIZE, SIZE, (ArtLayer("paper", paper), ArtLayer("hair", pixels)))


def motion_of(mesh: TriangleMesh, turn: float) -> Motion:
    """At rest, and with what is right of the slit moved away from it, the more the lower it is."""
    rest = mesh.vertices.astype(np.float32)
    centre = np.zeros(len(rest))
    np.add.at(centre, mesh.triangles.ravel(), np.repeat(rest[mesh.triangles][:, :, 0].mean(axis=1), 3))
    centre /= np.bincount(mesh.triangles.ravel(), minlength=len(rest))
    right = (rest[:, 0] > 48) | ((rest[:, 0] == 48) & (centre > 48))
    moved = rest.copy()
    moved[:, 0] += np.where(right, turn * np.maximum(rest[:, 1] - 32, 0), 0).astype(np.float32)
    return Motion((Body(mesh),), np.stack([rest, moved]), 24.0)


def test_at_rest_the_artwork_is_as_drawn() -> None:
    renderer = LayeredRenderer.of_artwork(artwork(), [1], motion_of(slit_mesh(), 0.2))
    expected = artwork().layers[1].pixels[16:80, 16:80, :3]
    assert np.abs(renderer.frame(0)[16:80, 16:80].astype(int) - expected).max() <= 1


def test_an_open_slit_shows_what_is_behind_with_smooth_sides() -> None:
    """Along a slanted side every share of a pixel occurs; a stepped one would have all or nothing."""
    renderer = LayeredRenderer.of_artwork(artwork(), [1], motion_of(slit_mesh(), 0.2))
    frame = renderer.frame(1).mean(axis=2)
    assert frame[70, 51] > 250, "the paper, within the open slit"
    mixed = 0
    for row in frame[50:76, 50:66]:
        mixed += int(((row > 90) & (row < 230)).any())
    assert mixed >= 15
