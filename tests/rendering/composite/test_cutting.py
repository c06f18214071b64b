"""Cutting a part out of its surroundings only: the same as of the whole picture."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.physics.mesh import mesh_from_mask
from physanimator.rendering.composite.cutting import _alpha, take_apart
from physanimator.rendering.composite.layer import Layer
from physanimator.rendering.matting import soft_alpha, with_outline

FloatImage = np.ndarray


def scene(seed: int, where: tuple[slice, slice]) -> tuple[FloatImage, FloatImage, FloatImage]:
    """A picture of noise on a ramp with a part of another colour, what is behind, and the part's mask."""
    random = np.random.default_rng(seed)
    ramp = np.linspace(0.3, 0.9, 260, dtype=np.float32)[None, :, None] * np.ones((240, 1, 3), np.float32)
    behind = ramp + 0.03 * random.random((240, 260, 3)).astype(np.float32)
    mask = np.zeros((240, 260), dtype=np.float32)
    mask[where] = 1
    picture = np.where(mask[..., None] > 0, np.float32((0.7, 0.2, 0.1)), behind)
    picture = (np.rint(picture * 255) / 255).astype(np.float32)
    return picture, behind, mask


PLACES = {
    "inside": (slice(90, 150), slice(100, 160)),
    "at a corner": (slice(0, 60), slice(200, 260)),
    "across": (slice(100, 140), slice(0, 260)),
}


@pytest.mark.parametrize("soft", [False, True])
@pytest.mark.parametrize("where", PLACES.values(), ids=PLACES)
def test_alpha_is_that_of_the_whole_picture(where: tuple[slice, slice], soft: bool) -> None:
    picture, behind, mask = scene(1, where)
    if soft:  # but on the right, where it stays hard
        mask[:, :130] = cv2.GaussianBlur(mask, (0, 0), 1.2)[:, :130]
    support = with_outline(picture, mask)
    np.testing.assert_allclose(
        _alpha(picture, behind, mask, support), soft_alpha(picture, behind, mask, support), atol=1e-6
    )


@pytest.mark.parametrize("where", PLACES.values(), ids=PLACES)
def test_a_part_over_what_is_behind_gives_the_picture(where: tuple[slice, slice]) -> None:
    picture, behind, mask = scene(2, where)
    background, (layer,) = take_apart(picture, [mask], [mesh_from_mask(mask, spacing=12)], plate=behind)
    assert isinstance(layer, Layer)
    whole, box = background.copy(), layer.canvas
    rows, columns = slice(max(box.top, 0), min(box.bottom, 240)), slice(max(box.left, 0), min(box.right, 260))
    texture = layer.texture[rows.start - box.top : rows.stop - box.top, columns.start - box.left :]
    texture = texture[:, : columns.stop - columns.start]
    whole[rows, columns] = texture[..., :3] + (1 - texture[..., 3:]) * whole[rows, columns]
    np.testing.assert_allclose(whole, picture, atol=1e-6)
    assert texture[..., 3].max() > 0.99
    far = np.ones(mask.shape, dtype=bool)
    far[rows, columns] = False
    np.testing.assert_array_equal(background[far], picture[far])
