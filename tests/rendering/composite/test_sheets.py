"""Sheets of one mesh: strands end at the slits between them, and what is beneath shows through what lies over it."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.mesh import PixelBox, TriangleMesh, cut_along
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.artwork import ArtLayer, Artwork
from physanimator.rendering.composite import ApronedMesh, LayeredRenderer, layer
from physanimator.rendering.composite.boundary import Boundary
from physanimator.rendering.composite.sheets import sheets_at, sheets_in_tiles

SIZE = 96
DARK, RED = (60, 50, 40), (220, 30, 30)


def grid() -> tuple[TriangleMesh, np.ndarray]:
    """A grid of squares, 16 px wide, triangles from left to right; and the numbers of its vertices, shape [5, 5]."""
    count = 5
    x, y = np.meshgrid(np.linspace(16, 80, count), np.linspace(16, 80, count))
    number = np.arange(count * count).reshape(count, count)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]))
    triangles = np.concatenate([np.stack([a, c, b], axis=1), np.stack([b, c, d], axis=1)])
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    triangles = triangles[np.argsort(points[triangles][:, :, 0].mean(axis=1), kind="stable")]
    return TriangleMesh(points, triangles, SIZE, SIZE), number


def slit_mesh() -> TriangleMesh:
    """The grid slit along x = 48 from the lower edge up to y = 32; what is right of that lies over what is left."""
    mesh, number = grid()
    return cut_along(mesh, np.stack([number[1:-1, 2], number[2:, 2]], axis=1))


def artwork() -> Artwork:
    random = np.random.default_rng(0)
    pixels = np.zeros((SIZE, SIZE, 4), dtype=np.uint8)
    pixels[16:80, 16:80] = (*random.integers(40, 60, 3), 255)
    pixels[16:80, 16:80, :3] += random.integers(0, 20, (64, 64, 3)).astype(np.uint8)
    paper = np.full((SIZE, SIZE, 4), 255, dtype=np.uint8)
    return Artwork(SIZE, SIZE, (ArtLayer("paper", paper), ArtLayer("hair", pixels)))


def plain(pixels: np.ndarray) -> Artwork:
    paper = np.full((SIZE, SIZE, 4), 255, dtype=np.uint8)
    return Artwork(SIZE, SIZE, (ArtLayer("paper", paper), ArtLayer("hair", pixels)))


def dark() -> np.ndarray:
    pixels = np.zeros((SIZE, SIZE, 4), dtype=np.uint8)
    pixels[16:80, 16:80] = (*DARK, 255)
    return pixels


def right_of_slit(mesh: TriangleMesh) -> np.ndarray:
    """Vertices of what hangs right of the slit, which are moved."""
    rest = mesh.vertices
    centre = np.zeros(len(rest))
    np.add.at(centre, mesh.triangles.ravel(), np.repeat(rest[mesh.triangles][:, :, 0].mean(axis=1), 3))
    centre /= np.bincount(mesh.triangles.ravel(), minlength=len(rest))
    return (rest[:, 1] > 32) & ((rest[:, 0] > 48) | ((rest[:, 0] == 48) & (centre > 48)))


def motion_of(mesh: TriangleMesh, turn: float) -> Motion:
    """At rest, and with what is right of the slit moved away from it, the more the lower it is."""
    rest = mesh.vertices.astype(np.float32)
    moved = rest.copy()
    moved[:, 0] += np.where(right_of_slit(mesh), turn * (rest[:, 1] - 32), 0).astype(np.float32)
    return Motion((Body(mesh),), np.stack([rest, moved]), 24.0)


def paper_in(frame: np.ndarray) -> np.ndarray:
    """How much of each pixel is paper, where the rest is dark."""
    return (frame.astype(float) - DARK).mean(axis=2) / (255 - np.mean(DARK))


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


@pytest.mark.parametrize("turn", [0.01, 0.05, 0.2])
def test_an_open_slit_is_as_wide_as_its_sides_are_apart(turn: float) -> None:
    """Each side ends at its own edge: what is drawn beyond it, or too early, would close or widen the slit."""
    frame = LayeredRenderer.of_artwork(plain(dark()), [1], motion_of(slit_mesh(), turn)).frame(1)
    width = paper_in(frame)[40:78, 40:64].sum(axis=1)
    assert width == pytest.approx(turn * (np.arange(40, 78) + 0.5 - 32), abs=0.2)
    assert width.mean() == pytest.approx(turn * (59 - 32), abs=0.05)


@pytest.mark.parametrize("shift", [(0.5, 0.0), (3.3, 1.7)])
def test_a_slit_whose_sides_stay_together_shows_no_seam(shift: tuple[float, float]) -> None:
    frames = []
    for mesh in (slit_mesh(), grid()[0]):
        rest = mesh.vertices.astype(np.float32)
        motion = Motion((Body(mesh),), np.stack([rest, rest + np.float32(shift)]), 24.0)
        frames.append(LayeredRenderer.of_artwork(artwork(), [1], motion).frame(1).astype(int))
    assert np.abs(frames[0] - frames[1]).max() <= 1


def test_what_is_beneath_a_sheet_shows_through_what_of_it_is_transparent() -> None:
    """The right strand has a hole of which the left one lies beneath; the paper does not show there."""
    pixels = dark()
    pixels[56:72, 50:58] = 0
    mesh = slit_mesh()
    renderer = LayeredRenderer.of_artwork(plain(pixels), [1], motion_of(mesh, -0.5))
    assert paper_in(renderer.frame(0))[64, 54] > 0.99
    frame = renderer.frame(1)
    # The hole is now about x = 54 - 0.5 (64 - 32) = 38, where the left strand is.
    assert np.abs(frame[44:78, 20:46].astype(int) - DARK).max() <= 6


@pytest.mark.parametrize("flat", [False, True])
def test_the_rim_of_the_upper_strand_lies_over_the_lower_one(flat: bool) -> None:
    """What is drawn below the mesh belongs to the strand above it, and is seen where that lies over another."""
    pixels = dark()
    pixels[80:84, 16:80] = (*RED, 255)
    mesh = slit_mesh()
    rest = mesh.vertices.astype(np.float32)
    moved = rest + np.where(right_of_slit(mesh), np.float32([[-16.0], [-16.0]]), 0).T.astype(np.float32)
    motion = Motion((Body(mesh),), np.stack([rest, moved]), 24.0)
    whole = plain(pixels)
    if flat:
        over = np.where(pixels[..., 3:] > 0, pixels[..., :3], 255).astype(np.uint8)
        renderer = LayeredRenderer(over, [pixels[..., 3] > 0], motion, plate=whole.layers[0].pixels[..., :3])
    else:
        renderer = LayeredRenderer.of_artwork(whole, [1], motion)
    frame = renderer.frame(1).astype(int)
    assert np.abs(frame[65:67, 36:44] - RED).max() <= 8, "rim of the upper strand, over the lower one"
    assert np.abs(frame[70:78, 36:44] - DARK).max() <= 8, "the lower strand"
    assert np.abs(frame[81:83, 20:44] - RED).max() <= 8, "its own rim"


def test_no_apron_lies_along_a_slit_and_at_its_mouth_each_strand_has_its_own() -> None:
    mesh = slit_mesh()
    boundary, whole = Boundary(mesh), Boundary(grid()[0])
    assert len(boundary.edges) == len(whole.edges)
    assert mesh.vertices[boundary.edges[boundary.parted, 1]].tolist() == [[48, 80]]
    assert len(boundary.corners(np.ones(len(boundary.edges)))) == len(whole.edges) + 1


def test_tiles_show_what_the_picture_shows_there_at_one_place_a_pixel() -> None:
    mesh, box = slit_mesh(), PixelBox(0, 0, SIZE, SIZE)
    aproned = ApronedMesh.around(mesh, np.ones((SIZE, SIZE), np.float32), box, reach=4)
    points = aproned.positions(motion_of(mesh, -0.3).positions[1])
    whole = sheets_at(points, aproned.triangles, aproned.rest, box, box)
    tiles = np.array([[44, 60], [32, 72], [40, 68]])
    found = sheets_in_tiles(points, aproned.triangles, aproned.rest, tiles, box, side=4, scale=1)
    for number, (left, top) in enumerate(tiles):
        mine, its = found.shown[4 * number : 4 * number + 4], whole.shown[top : top + 4, left : left + 4]
        np.testing.assert_allclose(mine, its, atol=1e-3)
    there = {tuple(tiles[k // 16] + (k % 4, k % 16 // 4)) for k in found.double}
    inside = {(x, y) for left, top in tiles for x in range(left, left + 4) for y in range(top, top + 4)}
    assert there == {(k % SIZE, k // SIZE) for k in whole.double.tolist()} & inside
    assert len(there) > 10


def test_many_edges_are_read_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """OpenCV reads so many rows at once; more tiles and pixels than that make the same picture."""
    pixels = dark()
    pixels[56:72, 50:58] = 0
    motion = motion_of(slit_mesh(), -0.5)
    whole = LayeredRenderer.of_artwork(plain(pixels), [1], motion).frame(1)
    monkeypatch.setattr(layer, "_AT_ONCE", 3)
    assert np.array_equal(LayeredRenderer.of_artwork(plain(pixels), [1], motion).frame(1), whole)


def test_a_layer_longer_than_a_texture_at_twice_its_size_may_be() -> None:
    height, wide = 17_000, 24
    pixels = np.zeros((height, wide, 4), dtype=np.uint8)
    pixels[8:-8, 8:16] = (*DARK, 255)
    y = np.arange(8, height - 7, 16)
    left = np.arange(0, 2 * len(y) - 2, 2)
    triangles = np.concatenate([left[:, None] + (0, 1, 3), left[:, None] + (0, 3, 2)])
    mesh = TriangleMesh(np.stack([np.tile([8, 16], len(y)), np.repeat(y, 2)], axis=1), triangles, wide, height)
    rest = mesh.vertices.astype(np.float32)
    motion = Motion((Body(mesh),), np.stack([rest, rest + np.float32((4, 0))]), 24.0)
    paper = ArtLayer("paper", np.full((height, wide, 4), 255, dtype=np.uint8))
    whole = Artwork(wide, height, (paper, ArtLayer("hair", pixels)))
    frame = LayeredRenderer.of_artwork(whole, [1], motion).frame(1)
    assert np.abs(frame[100:-100, 13:19].astype(int) - DARK).max() <= 1
    assert frame[100:-100, 9:11].min() >= 254
