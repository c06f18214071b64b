"""Few keys and few shapes instead of all frames, pages of an atlas, and outlines."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.rendering.export.atlas import atlas_text, packed
from physanimator.rendering.export.key_frames import key_frames
from physanimator.rendering.export.morph_targets import morph_targets
from physanimator.rendering.export.outline import outline_first, outline_of


def moving(frames: int = 61) -> np.ndarray:
    """Two points: one goes to and fro along straight lines with corners at 0, 20, 45 and 60, the other stands."""
    x = np.interp(np.arange(frames), [0, 20, 45, 60], [0.0, 30.0, -10.0, 5.0])
    return np.stack([np.stack([x, 2 * x], axis=1), np.ones((frames, 2))], axis=1)


def test_straight_ways_need_keys_at_their_corners_alone() -> None:
    assert key_frames(moving(), moving(), tolerance=0.01) == [0, 20, 45, 60]
    assert key_frames(moving(), moving(), tolerance=100.0) == [0]
    assert key_frames(moving(1), moving(1), tolerance=0.01) == [0]


@pytest.mark.parametrize("tolerance", [0.05, 0.5, 3.0])
def test_no_vertex_is_farther_off_than_the_tolerance(tolerance: float) -> None:
    rng = np.random.default_rng(3)
    positions = np.cumsum(rng.normal(0, 1, (80, 7, 2)), axis=0)
    kept = key_frames(positions, positions.round(2), tolerance=tolerance)
    rows = positions.round(2)[kept].reshape(len(kept), -1)
    found = np.stack([np.interp(np.arange(80), kept, column) for column in rows.T], axis=1).reshape(positions.shape)
    assert np.linalg.norm(found - positions, axis=2).max() <= tolerance
    assert len(kept) < 80 or tolerance < 1


def test_as_few_shapes_as_the_motion_is_made_of() -> None:
    rng = np.random.default_rng(5)
    rest, shapes = rng.uniform(0, 100, (40, 2)), rng.normal(0, 6, (3, 40, 2))
    t = np.linspace(0, 4, 90)
    weights = np.stack([np.sin(3 * t), np.cos(2 * t), t], axis=1)
    positions = rest + np.einsum("fk,kvx->fvx", weights, shapes)
    found = morph_targets(rest, positions, tolerance=0.01)
    assert len(found.targets) == 3
    again = rest + np.einsum("fk,kvx->fvx", found.weights, found.targets)
    worst = np.linalg.norm(again - positions, axis=2).max()
    assert worst <= 0.01
    assert found.error == pytest.approx(worst, abs=1e-6)
    assert np.abs(found.weights).max(axis=0) == pytest.approx(np.ones(3))


def test_what_does_not_move_needs_no_shape_and_noise_needs_as_many_as_frames() -> None:
    rng = np.random.default_rng(6)
    rest = rng.uniform(0, 100, (30, 2))
    still = morph_targets(rest, np.repeat(rest[None], 9, axis=0), tolerance=0.01)
    assert (len(still.targets), still.error) == (0, 0)
    noise = morph_targets(rest, rest + rng.normal(0, 9, (9, 30, 2)), tolerance=0.01)
    assert len(noise.targets) == 9
    assert noise.error < 0.01


def test_pictures_lie_apart_on_pages_that_graphics_cards_take() -> None:
    rng = np.random.default_rng(7)
    sizes = [(3000, 2600), (2600, 3000), (1, 1), (5000, 40), (700, 900), (33, 2)]
    pictures = {f"p{k}": rng.integers(0, 256, (h, w, 4), dtype=np.uint8) for k, (w, h) in enumerate(sizes)}
    pages = packed(pictures)
    assert sorted(name for page in pages for name in page.boxes) == sorted(pictures)
    for page in pages:
        assert max(page.pixels.shape) <= 5004
        taken = np.zeros(page.pixels.shape[:2], np.int32)
        for name, (left, top, width, height) in page.boxes.items():
            assert (page.pixels[top : top + height, left : left + width] == pictures[name]).all()
            taken[top - 2 : top + height + 2, left - 2 : left + width + 2] += 1
        assert taken.max() == 1
    text = atlas_text(pages, [f"girl_{k}.png" for k in range(len(pages))])
    assert text.count("bounds:") == len(pictures)
    assert text.count("size:") == len(pages) > 1


def test_an_outline_goes_around_slits_and_past_holes() -> None:
    # A ring of eight triangles around a square hole, slit on its right where two places are doubled.
    rest = np.array([[0, 0], [3, 0], [3, 3], [0, 3], [1, 1], [2, 1], [2, 2], [1, 2]], dtype=float)
    ring = np.array([[0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]])
    assert sorted(outline_of(rest, ring).tolist()) == [0, 1, 2, 3]
    open_ring = np.where(np.isin(np.arange(8), [6, 7])[:, None] & (ring == 3), 8, ring)
    open_ring = np.where(np.isin(np.arange(8), [6, 7])[:, None] & (ring == 7), 9, open_ring)
    slit = np.concatenate([rest, rest[[3, 7]]])
    assert sorted(outline_of(slit, open_ring).tolist()) == list(range(10))
    order = outline_first(12, np.array([4, 7, 4, 2]))
    assert order[:3].tolist() == [4, 7, 2]
    assert sorted(order.tolist()) == list(range(12))
