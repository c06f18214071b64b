"""Layered artwork in the renderer: frame 0 is the artwork, movers pass between still layers, and nothing is guessed."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
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


def test_what_the_mesh_does_not_reach_stands_still_instead_of_being_lost() -> None:
    """A speck far off and a faint glow belong to the layer."""
    pixels = disc((220, 40, 30), 45, 45, 20)
    pixels[5, 110] = (10, 200, 10, 255)
    artwork = Artwork(*SIZE, (paper(), ArtLayer("red", pixels)))
    motion = shifted(artwork, 1, (0, 0), (5, 0))
    renderer = LayeredRenderer.of_artwork(artwork, [1], motion)
    assert (renderer.frame(0) == flattened(artwork)[..., :3]).all()
    assert renderer.frame(1)[5, 110].tolist() in ([10, 200, 10], [240, 230, 210])


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
    """Discs of any opacity, offset, mode and order over paper or nothing, and which of them move."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    layers: list[ArtLayer] = [paper()] if draw(st.booleans()) else []
    first = len(layers)
    for number in range(draw(st.integers(1, 5))):
        x, y, radius = random.uniform(20, 100), random.uniform(20, 70), random.uniform(10, 25)
        blend = draw(st.sampled_from(["normal", "normal", "normal", "multiply", "screen", "add", "overlay"]))
        pixels = disc(tuple(random.integers(0, 256, 3)), x, y, radius, alpha=random.uniform(0.6, 1))
        offset = random.integers(-15, 16, 2)
        visible = draw(st.booleans()) or number == 0
        layers.append(
            ArtLayer(
                f"{number}", pixels, *offset.tolist(), opacity=random.uniform(0.3, 1), blend=blend, visible=visible
            )
        )
    candidates = [k for k in range(first, len(layers)) if layers[k].visible]
    moving = sorted(set(draw(st.lists(st.sampled_from(candidates), min_size=1, max_size=3))))
    return Artwork(*SIZE, tuple(layers)), moving


@given(artworks())
@settings(max_examples=25, deadline=None)
def test_frame_0_of_any_artwork_is_the_flattened_artwork(case: tuple[Artwork, list[int]]) -> None:
    artwork, moving = case
    meshes = [mesh_from_mask(mask_of_layer(artwork, index), spacing=8) for index in moving]
    bodies = tuple(Body(mesh, layer=rank) for rank, mesh in enumerate(meshes))
    rest = np.concatenate([mesh.vertices for mesh in meshes])
    renderer = LayeredRenderer.of_artwork(artwork, moving, Motion(bodies, np.float32([rest, rest]), frame_rate=24.0))
    wanted, frame = flattened(artwork), renderer.frame(0)
    if frame.shape[2] == 3:
        assert wanted[..., 3].min() == 255
        wanted = wanted[..., :3]
    seen = np.ones(SIZE[::-1], bool) if frame.shape[2] == 3 else wanted[..., 3] > 25
    assert np.abs(frame.astype(int) - wanted)[seen].max(initial=0) <= 1
    assert cv2.absdiff(frame, renderer.frame(1)).max() == 0
