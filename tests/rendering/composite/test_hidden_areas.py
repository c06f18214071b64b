"""What stands still before something that moves: triangles wholly behind it are left out, and nobody sees that."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.mesh import PixelBox, TriangleMesh, cut_along
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.artwork import ArtLayer, Artwork, Blend
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.composite.hidden_areas import HiddenArea, hidden_areas
from physanimator.rendering.composite.still_layers import StillLayer

WIDTH, HEIGHT = 101, 98


def grid(spacing: int = 4) -> tuple[TriangleMesh, np.ndarray]:
    """A grid over most of the picture and the numbers of its vertices."""
    x, y = np.meshgrid(np.arange(8, 89, spacing), np.arange(8, 89, spacing))
    number = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]))
    triangles = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    return TriangleMesh(np.stack([x.ravel(), y.ravel()], axis=1), triangles, WIDTH, HEIGHT), number


def painted(random: np.random.Generator, alpha: np.ndarray) -> np.ndarray:
    pixels = random.integers(0, 256, (HEIGHT, WIDTH, 4), dtype=np.uint8)
    pixels[..., 3] = alpha
    return pixels


def artwork(seed: int, blend: Blend = "normal") -> Artwork:
    """Paper, something that moves, and before it a still shape with a soft edge, a hole, and a veil."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    centre, across = random.uniform(35, 65, 2), random.uniform(20, 40)
    distance = np.hypot(x - centre[0], y - centre[1])
    shape = np.clip((across - distance) * 64, 0, 255) * (np.hypot(x - 50, y - 50) > 6)
    shape[:, 60:70] *= 0.99
    layers = (
        ArtLayer("paper", painted(random, np.full((HEIGHT, WIDTH), 255))),
        ArtLayer("hair", painted(random, np.full((HEIGHT, WIDTH), 255))[8:89, 8:89], 8, 8),
        ArtLayer("body", painted(random, shape), blend=blend),
    )
    return Artwork(WIDTH, HEIGHT, layers)


def motion(seed: int, *, slit: bool) -> Motion:
    mesh, number = grid()
    if slit:
        mesh = cut_along(mesh, np.stack([number[8:-1, 10], number[9:, 10]], axis=1))
    random = np.random.default_rng(seed)
    rest = mesh.vertices.astype(np.float32)
    frames = [rest, *(rest + random.normal(0, much, rest.shape).astype(np.float32) for much in (0.3, 1.5, 6))]
    return Motion((Body(mesh),), np.stack(frames), 24.0)


@pytest.mark.parametrize("slit", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_frames_are_the_same_to_the_bit(seed: int, slit: bool) -> None:
    moved, whole = motion(seed, slit=slit), artwork(seed)
    renderer, plain = (LayeredRenderer.of_artwork(whole, [1], moved) for _ in range(2))
    plain.__dict__["_hidden"] = [None] * len(plain._layers)
    assert renderer._hidden[0] is not None
    for t in range(len(moved)):
        assert np.array_equal(renderer.frame(t), plain.frame(t))
        assert np.array_equal(renderer.alpha(t), plain.alpha(t))
        assert np.array_equal(renderer.cutout(t), plain.cutout(t))


def test_most_of_what_is_hidden_is_left_out_and_nothing_else() -> None:
    mesh, _ = grid()
    hidden = np.zeros((HEIGHT, WIDTH), dtype=bool)
    hidden[20:80, 24:72] = True
    area = HiddenArea.of(hidden)
    assert area is not None
    kept = {tuple(triangle) for triangle in area.seen(mesh.vertices, mesh.triangles).tolist()}
    corners = mesh.vertices[mesh.triangles]
    inside = ((corners > (24, 20)) & (corners < (72, 80))).all(axis=(1, 2))
    left_out = np.array([tuple(triangle) not in kept for triangle in mesh.triangles.tolist()])
    assert not left_out[~inside].any()
    assert left_out.sum() > 0.7 * inside.sum()


def test_what_is_beyond_the_picture_is_not_seen() -> None:
    hidden = np.zeros((HEIGHT, WIDTH), dtype=bool)
    hidden[:, 40:] = True
    area = HiddenArea.of(hidden)
    assert area is not None
    points = np.array([[90.0, 90], [300, 95], [90, 300], [10, 90]])
    assert area.seen(points, np.array([[0, 1, 2], [0, 1, 3]])).tolist() == [[0, 1, 3]]


@pytest.mark.parametrize("blend", ["multiply", "screen"])
def test_only_opaque_normal_layers_in_front_hide(blend: Blend) -> None:
    assert LayeredRenderer.of_artwork(artwork(0, blend), [1], motion(0, slit=False))._hidden == [None, None]
    box, channels = PixelBox(0, 0, 16, 16), np.ones((16, 16, 4), np.float32)
    faint = StillLayer(box, channels * np.float32(0.999))
    assert hidden_areas([None, faint], 16, 16) == [None, None]
    behind, _, before = hidden_areas([None, StillLayer(box, channels), None], 16, 16)
    assert behind is not None
    assert before is None
