"""Layered artwork in the renderer: frame 0 is the artwork, movers pass between still layers, and nothing is guessed."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import FlowSequence, Motion, tracks
from physanimator.physics.scene import Body
from physanimator.rendering.artwork import ArtLayer, Artwork, flattened
from physanimator.rendering.composite import LayeredRenderer, hidden_by, mask_of_layer

SIZE = 120, 90


def disc(colour: tuple[int, int, int], x: float, y: float, radius: float, alpha: float = 1.0) -> np.ndarray:
    """A disc with a soft edge of one pixel, straight RGBA, as large as the canvas."""
    columns, rows = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    share = np.clip(radius + 0.5 - np.hypot(columns - x, rows - y), 0, 1) * alpha
    return np.dstack([np.broadcast_to(np.uint8(colour), (*SIZE[::-1], 3)), np.rint(share * 255).astype(np.uint8)])


def paper(colour: tuple[int, int, int] = (240, 230, 210)) -> ArtLayer:
    return ArtLayer(
        "paper", np.dstack([np.full((*SIZE[::-1], 3), colour, np.uint8), np.full(SIZE[::-1], 255)]).astype("u1")
    )


def shifted(artwork: Artwork, index: int, *ways: tuple[float, float], covered: bool = True) -> Motion:
    """One layer that moves as a whole."""
    mesh = mesh_from_mask(mask_of_layer(artwork, index), spacing=8)
    cover = hidden_by(artwork, index, moving=[index]) if covered else None
    positions = np.float32([mesh.vertices + way for way in ways])
    return Motion((Body(mesh, cover=cover),), positions, frame_rate=24.0)


def sandwich() -> Artwork:
    """Paper, a red disc that moves, and a blue one that stands still before its right half."""
    red, blue = disc((220, 40, 30), 50, 45, 22), disc((30, 60, 200), 75, 45, 18)
    return Artwork(*SIZE, (paper(), ArtLayer("red", red), ArtLayer("blue", blue)))


def test_a_mover_stays_behind_what_is_in_front_and_bares_what_was_drawn() -> None:
    artwork = sandwich()
    renderer = LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0, 0), (12, 0)))
    moved = ArtLayer("red", artwork.layers[1].pixels, left=12)
    wanted = flattened(Artwork(*SIZE, (artwork.layers[0], moved, artwork.layers[2])))[..., :3]
    frame = renderer.frame(1)
    assert frame[45, 75].tolist() == [30, 60, 200]
    assert frame[45, 30].tolist() == [240, 230, 210]
    assert np.abs(frame.astype(int) - wanted).max() <= 1


def test_at_rest_the_artwork_is_whole_and_still_pixels_stay_untouched() -> None:
    artwork = sandwich()
    renderer = LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0, 0), (-9, 3)))
    whole = flattened(artwork)[..., :3]
    assert (renderer.frame(0) == whole).all()
    changed = (renderer.frame(1) != whole).any(axis=2)
    assert changed.any()
    assert not changed[:, 100:].any()
    assert not changed[artwork.layers[2].pixels[..., 3] == 255].any()


def test_coverage_and_cutout_show_what_is_seen_of_the_movers() -> None:
    artwork = sandwich()
    renderer = LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0, 0), (12, 0)))
    alpha = renderer.alpha(1)
    assert alpha[45, 75] == 0
    assert alpha[45, 45] == pytest.approx(1)
    cutout = renderer.cutout(1)
    assert cutout[45, 75, 3] == 0
    assert cutout[45, 45].tolist() == [220, 40, 30, 255]
    over_plate = renderer.plate + (cutout[..., 3:] / 255) * (cutout[..., :3].astype(float) - renderer.plate)
    hard = np.isin(artwork.layers[2].pixels[..., 3], (0, 255))  # a soft edge in front of it is the plate's as well
    assert np.abs(over_plate - renderer.frame(1))[hard].max() <= 1.01


def test_flow_belongs_to_what_is_seen_and_tracks_know_what_is_hidden() -> None:
    artwork = sandwich()
    motion = shifted(artwork, 1, (0, 0), (12, 0))
    field = FlowSequence(motion).flow(1)
    assert field.displacement[45, 40].tolist() == [12, 0]
    assert not field.inside[45, 68]
    assert field.displacement[45, 68].tolist() == [0, 0]
    found = tracks(motion, points=40, static_points=0)
    assert found.visibility[0].all()
    under = np.hypot(found.path[1, :, 0] - 75, found.path[1, :, 1] - 45)
    assert (~found.visibility[1] == (under < 18)).mean() > 0.9
    assert (~found.visibility[1]).any()


@pytest.mark.parametrize("blend", ["multiply", "screen", "overlay", "add"])
def test_a_still_layer_of_any_mode_acts_on_what_passes_below_it(blend: str) -> None:
    shade = ArtLayer("shade", disc((90, 120, 200), 75, 45, 18, alpha=0.8), blend=blend)
    artwork = Artwork(*SIZE, (*sandwich().layers[:2], shade))
    renderer = LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0, 0), (12, 0)))
    moved = ArtLayer("red", artwork.layers[1].pixels, left=12)
    wanted = flattened(Artwork(*SIZE, (artwork.layers[0], moved, shade)))[..., :3]
    assert np.abs(renderer.frame(1).astype(int) - wanted).max() <= 1
    assert (renderer.frame(0) == flattened(artwork)[..., :3]).all()


def with_glow() -> np.ndarray:
    """A disc with a faint glow far wider than an apron, a thin wisp and specks, straight RGBA."""
    pixels = disc((220, 40, 30), 45, 45, 14)
    columns, rows = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    glow = (60 * np.clip(1 - (np.hypot(columns - 45, rows - 45) - 12) / 30, 0, 1)).astype(np.uint8)
    pixels[..., 3] = np.maximum(pixels[..., 3], glow)
    pixels[45, 58:100, 3] = 90
    for y, x in ((8, 20), (80, 70), (12, 84)):
        pixels[y, x] = (10, 200, 10, 255)
    return pixels


@pytest.mark.parametrize("way", [(5, 0), (-7, 3), (2, -6)])
def test_what_the_mesh_does_not_reach_goes_along(way: tuple[int, int]) -> None:
    artwork = Artwork(*SIZE, (paper(), ArtLayer("red", with_glow())))
    renderer = LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0, 0), way))
    assert (renderer.frame(0) == flattened(artwork)[..., :3]).all()
    moved = ArtLayer("red", artwork.layers[1].pixels, *way)
    wanted = flattened(Artwork(*SIZE, (paper(), moved)))[..., :3]
    assert np.abs(renderer.frame(1).astype(int) - wanted).max() <= 1


def test_a_glow_turns_with_what_it_surrounds() -> None:
    artwork = Artwork(*SIZE, (paper(), ArtLayer("red", with_glow())))
    motion = shifted(artwork, 1, (0, 0), (0, 0))
    mesh, angle = motion.bodies[0].mesh, np.deg2rad(20)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned = (mesh.vertices - 45) @ turn.T + 45
    renderer = LayeredRenderer.of_artwork(
        artwork, [1], Motion(motion.bodies, np.float32([mesh.vertices, turned]), frame_rate=24.0)
    )
    frame = renderer.frame(1).astype(int)
    for distance in (18, 24):  # the wisp, which lay level, far beyond the disc
        x, y = (turn @ (distance, 0.0) + 45).round().astype(int)
        beside = frame[y + 3 : y + 6, x - 1 : x + 2].mean()
        assert frame[y - 1 : y + 2, x - 1 : x + 2].min(axis=(0, 1)).mean() < beside - 15


def test_what_lies_beyond_the_canvas_comes_in() -> None:
    pixels = np.concatenate([disc((220, 40, 30), 30, 45, 26), disc((30, 160, 40), 90, 45, 26)], axis=1)
    artwork = Artwork(*SIZE, (paper(), ArtLayer("red", pixels, left=-40)))
    renderer = LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0, 0), (30, 0)))
    wanted = flattened(Artwork(*SIZE, (paper(), ArtLayer("red", pixels, left=-10))))[..., :3]
    assert (renderer.frame(0) == flattened(artwork)[..., :3]).all()
    assert np.abs(renderer.frame(1).astype(int) - wanted).max() <= 1


@pytest.mark.parametrize("alpha", [0.15, 0.3, 0.45])
def test_a_veil_that_is_nowhere_dense_moves_as_a_whole(alpha: float) -> None:
    """A few opaque stitches do not make the veil around them disappear from the mask."""
    pixels = disc((90, 120, 200), 50, 45, 25, alpha=alpha)
    pixels[30:34, 40:60] = (255, 255, 255, 255)
    artwork = Artwork(*SIZE, (paper(), ArtLayer("veil", pixels)))
    mask = mask_of_layer(artwork, 1) >= 0.5
    assert mask.sum() >= 0.9 * (pixels[..., 3] > 0).sum()


def test_an_opaque_shape_keeps_its_width_in_the_mask() -> None:
    artwork = Artwork(*SIZE, (paper(), ArtLayer("red", cv2.GaussianBlur(disc((9, 9, 9), 50, 45, 25), (0, 0), 2))))
    assert (mask_of_layer(artwork, 1) >= 0.5).sum() == pytest.approx(np.pi * 25**2, rel=0.08)


def test_places_between_pixels_are_sharp_and_do_not_overshoot() -> None:
    """A black bar on white that moves by half a pixel: its edge is half covered, and nothing rings beside it."""
    bar = np.zeros((*SIZE[::-1], 4), np.uint8)
    bar[20:70, 30:80] = (0, 0, 0, 255)
    artwork = Artwork(*SIZE, (paper((255, 255, 255)), ArtLayer("bar", bar)))
    renderer = LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0.5, 0), (0.25, 0)))
    half, quarter = renderer.frame(0)[45, :, 0].astype(int), renderer.frame(1)[45, :, 0].astype(int)
    assert half[28:33].tolist() == pytest.approx([255, 255, 128, 0, 0], abs=6)
    assert quarter[28:33].tolist() == pytest.approx([255, 255, 64, 0, 0], abs=6)


def test_what_is_held_is_no_larger_than_where_something_moves() -> None:
    """A small part that moves on a large canvas with many layers in front."""
    size = 1500, 1200
    whole = np.full((size[1], size[0], 4), 255, np.uint8)
    spot = np.full((60, 60, 4), (200, 30, 30, 255), np.uint8)
    veils = [ArtLayer(f"{k}", np.full((900, 900, 4), (0, 0, 9, 20), np.uint8), 100, 100) for k in range(10)]
    artwork = Artwork(*size, (ArtLayer("paper", whole), ArtLayer("spot", spot, 500, 500), *veils))
    renderer = LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0, 0), (30, 0)))
    held = renderer._planes.nbytes + sum(layer.texture.nbytes for layer in renderer._layers)
    assert held < 16 * 4 * 160 * 160
    assert (renderer.frame(0) == flattened(artwork)[..., :3]).all()


def test_too_much_to_hold_is_refused_in_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("physanimator.rendering.composite.artwork_pieces.MAX_HELD_GIB", 1e-5)
    artwork = sandwich()
    with pytest.raises(InvalidInputError, match=r"small enough that its 1 moving layers need at most .* Got: "):
        LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0, 0)))


def test_beyond_the_memory_for_finer_textures_frames_stay_right(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("physanimator.rendering.composite.artwork_pieces.MAX_FINE_PIXELS", 10)
    artwork = sandwich()
    renderer = LayeredRenderer.of_artwork(artwork, [1], shifted(artwork, 1, (0, 0), (12, 0)))
    assert not any(getattr(layer, "fine", False) for layer in renderer._layers)
    moved = ArtLayer("red", artwork.layers[1].pixels, left=12)
    wanted = flattened(Artwork(*SIZE, (artwork.layers[0], moved, artwork.layers[2])))[..., :3]
    assert np.abs(renderer.frame(1).astype(int) - wanted).max() <= 1


def test_artwork_without_paper_moves_on_transparency() -> None:
    artwork = Artwork(*SIZE, sandwich().layers[1:])
    renderer = LayeredRenderer.of_artwork(artwork, [0], shifted(artwork, 0, (0, 0), (12, 0)))
    assert np.abs(renderer.frame(0).astype(int) - flattened(artwork)).max() <= 1
    moved = Artwork(*SIZE, (ArtLayer("red", artwork.layers[0].pixels, left=12), artwork.layers[1]))
    wanted, frame = flattened(moved).astype(int), renderer.frame(1).astype(int)
    assert np.abs(frame[..., 3] - wanted[..., 3]).max() <= 1
    assert np.abs(frame - wanted)[wanted[..., 3] == 255].max() <= 1


@st.composite
def artworks(draw: st.DrawFn) -> tuple[Artwork, list[int]]:
    """Discs of any opacity, offset, mode, order and depth of bits over paper or nothing, and which of them move.

    Layers may reach beyond the canvas or lie outside it, be hidden or of opacity 0, and hidden ones may move.
    """
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    deep = draw(st.booleans())
    layers: list[ArtLayer] = [paper()] if draw(st.booleans()) else []
    first = len(layers)
    for number in range(draw(st.integers(1, 6))):
        x, y, radius = random.uniform(20, 100), random.uniform(20, 70), random.uniform(10, 25)
        blend = draw(st.sampled_from(["normal", "normal", "normal", "multiply", "screen", "add", "overlay"]))
        pixels = disc(tuple(random.integers(0, 256, 3)), x, y, radius, alpha=random.uniform(0.6, 1))
        offset = random.integers(-25, 26, 2) * draw(st.sampled_from([1, 1, 1, 8]))
        opacity = draw(st.sampled_from([0.0, 1.0, random.uniform(0.3, 1)]))
        visible = draw(st.booleans()) or number == 0
        layers.append(ArtLayer(f"{number}", pixels, *offset.tolist(), opacity=opacity, blend=blend, visible=visible))
    if deep:
        layers = [replace(layer, pixels=layer.pixels.astype(np.uint16) * np.uint16(257)) for layer in layers]
    artwork = Artwork(*SIZE, tuple(layers))
    candidates = [k for k in range(first, len(layers)) if (mask_of_layer(artwork, k) >= 0.5).sum() > 60]
    assume(candidates)
    moving = sorted(set(draw(st.lists(st.sampled_from(candidates), min_size=1, max_size=3))))
    return artwork, moving


def drawn(artwork: Artwork, moving: list[int], *ways: tuple[int, int]) -> LayeredRenderer:
    """The renderer of layers that are shifted as wholes, all of them alike."""
    meshes = [mesh_from_mask(mask_of_layer(artwork, index), spacing=8) for index in moving]
    bodies = tuple(Body(mesh, layer=rank) for rank, mesh in enumerate(meshes))
    rest = np.concatenate([mesh.vertices for mesh in meshes])
    return LayeredRenderer.of_artwork(artwork, moving, Motion(bodies, np.float32([rest + w for w in ways]), 24.0))


def assert_alike(frame: np.ndarray, wanted: Artwork) -> None:
    """The frame is the flattened artwork within a level of 255, and colours where these can be seen."""
    picture = flattened(wanted).astype(float)
    picture *= 255 / np.iinfo(wanted.dtype).max
    shown = frame.astype(float) * (255 if frame.dtype == np.float32 else 1)
    if frame.shape[2] == 3:
        assert picture[..., 3].min() >= 254
    both = [each[..., :3] * each[..., 3:] / 255 if each.shape[2] == 4 else each for each in (shown, picture)]
    assert np.abs(both[0][..., :3] - both[1][..., :3]).max() <= 1.51
    if frame.shape[2] == 4:
        assert np.abs(shown[..., 3] - picture[..., 3]).max() <= 1.01


@given(artworks())
@settings(max_examples=25, deadline=None)
def test_frame_0_of_any_artwork_is_the_flattened_artwork(case: tuple[Artwork, list[int]]) -> None:
    artwork, moving = case
    renderer = drawn(artwork, moving, (0, 0), (0, 0))
    # A hidden layer that is told to move is drawn.
    shown = [replace(layer, visible=True) if k in moving else layer for k, layer in enumerate(artwork.layers)]
    assert_alike(renderer.frame(0), replace(artwork, layers=tuple(shown)))
    assert cv2.absdiff(renderer.frame(0), renderer.frame(1)).max() == 0


@given(artworks(), st.integers(-20, 20), st.integers(-20, 20))
@settings(max_examples=25, deadline=None)
def test_layers_shifted_by_whole_pixels_are_the_artwork_with_these_offsets(
    case: tuple[Artwork, list[int]], across: int, down: int
) -> None:
    artwork, moving = case
    frame = drawn(artwork, moving, (0, 0), (across, down)).frame(1)
    layers = list(artwork.layers)
    for k in moving:
        layers[k] = replace(layers[k], visible=True, left=layers[k].left + across, top=layers[k].top + down)
    assert_alike(frame, replace(artwork, layers=tuple(layers)))


def test_the_edge_of_one_sheet_over_another_of_the_same_layer_has_no_steps() -> None:
    """Two tilted squares of one layer, black and white, of which one comes to lie half over the other."""
    squares = np.zeros((*SIZE[::-1], 4), np.uint8)
    for x, grey in ((35, 255), (85, 0)):
        turned = np.int32([(x - 22, 36), (x + 10, 22), (x + 22, 54), (x - 10, 68)])
        cv2.fillPoly(squares, [turned], (grey, grey, grey, 255))
    artwork = Artwork(*SIZE, (paper((255, 0, 0)), ArtLayer("squares", squares)))
    mesh = mesh_from_mask(mask_of_layer(artwork, 1), spacing=8)
    over = mesh.vertices + np.where(mesh.vertices[:, :1] > 60, (-25.3, 0.0), (0.0, 0.0))
    motion = Motion((Body(mesh),), np.float32([mesh.vertices, over]), 24.0)
    frame = LayeredRenderer.of_artwork(artwork, [1], motion).frame(1).astype(int)
    inner = frame[32:56, 40:56, 1]  # both squares are here
    assert {0, 255} <= set(inner.ravel().tolist())
    assert (((inner > 15) & (inner < 240)).sum(axis=1) >= 1).mean() > 0.6
