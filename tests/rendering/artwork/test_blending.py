"""Blend modes against their definition with straight colours and alpha."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.artwork import ArtLayer, Artwork, flattened, lay_over

MIXED = {
    "normal": lambda below, above: above,
    "multiply": lambda below, above: below * above,
    "screen": lambda below, above: below + above - below * above,
    "overlay": lambda below, above: np.where(below <= 0.5, 2 * below * above, 1 - 2 * (1 - below) * (1 - above)),
    "add": lambda below, above: np.minimum(1, below + above),
}
RGBA = st.lists(st.integers(0, 255), min_size=4, max_size=4).map(lambda each: np.array(each) / 255)


@given(RGBA, RGBA, st.sampled_from(sorted(MIXED)))
def test_modes_follow_their_definition(below: np.ndarray, above: np.ndarray, mode: str) -> None:
    (cb, ab), (cs, a) = (below[:3], below[3]), (above[:3], above[3])
    wanted = (1 - a) * ab * cb + (1 - ab) * a * cs + a * ab * MIXED[mode](cb, cs)
    planes = np.float32([[[*(cb * ab), ab]]])
    lay_over(planes, np.float32([[[*(cs * a), a]]]), mode)  # type: ignore[arg-type]
    assert np.allclose(planes[0, 0], [*wanted, a + ab - a * ab], atol=2e-6)


def test_what_lies_beyond_the_canvas_is_not_drawn_and_hidden_layers_neither() -> None:
    full = np.full((4, 4, 4), 255, np.uint8)
    layers = (ArtLayer("a", full, left=-3, top=3), ArtLayer("b", full, left=99), ArtLayer("c", full, visible=False))
    picture = flattened(Artwork(6, 5, layers))
    assert np.argwhere(picture[..., 3]).tolist() == [[3, 0], [4, 0]]
    assert flattened(Artwork(6, 5, layers), layers[1:]).max() == 0


def test_wrong_artworks() -> None:
    full = np.full((4, 4, 4), 255, np.uint8)
    with pytest.raises(InvalidInputError, match="layer a: pixels must be uint8 or uint16"):
        ArtLayer("a", full[..., :3])
    with pytest.raises(InvalidInputError, match=r"layer a: opacity must be from 0 to 1. Got: 2"):
        ArtLayer("a", full, opacity=2)
    with pytest.raises(InvalidInputError, match="layer a: blend must be of"):
        ArtLayer("a", full, blend="dodge")  # type: ignore[arg-type]
    with pytest.raises(InvalidInputError, match="layers must be of one dtype"):
        Artwork(4, 4, (ArtLayer("a", full), ArtLayer("b", full.astype(np.uint16))))
    with pytest.raises(InvalidInputError, match="canvas must have from 1 to 67 million pixels"):
        Artwork(10**9, 10**9, ())
