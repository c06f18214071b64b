"""A flat picture that was taken apart, as layered artwork: the background, each part, and what stands in front."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...physics.motion import Motion
from ..artwork import ArtLayer, Artwork
from ..pictures import straight
from .layer import Layer
from .still_layers import StillLayer

__all__ = ["artwork_of", "part_names"]

FloatImage = NDArray[np.float32]


def part_names(motion: Motion) -> list[str]:
    """What each body is called: by its own name, or by its number from the back."""
    return [body.name.strip() or f"part {number}" for number, body in enumerate(motion.bodies, 1)]


def artwork_of(
    background: FloatImage, pieces: Sequence[Layer | StillLayer], names: Sequence[str], dtype: np.dtype[np.generic]
) -> Artwork:
    """Layers that laid over one another give the picture again.

    Args:
        background: RGB in 0 to 1, or premultiplied RGBA, shape [h, w, 3] or [h, w, 4].
        pieces: what is over it, from back to front.
        names: of the pieces.
        dtype: uint8 or uint16.
    """
    if background.shape[2] == 3:
        background = np.dstack([background, np.ones(background.shape[:2], np.float32)])
    layers = [ArtLayer("background", _whole(background, dtype))]
    for piece, name in zip(pieces, names, strict=True):
        box = piece.canvas if isinstance(piece, Layer) else piece.box
        # Of a picture with transparency the fifth channel is how much is hidden behind, nearly always the alpha.
        layers.append(ArtLayer(name, _whole(piece.texture[..., :4], dtype), box.left, box.top))
    return Artwork(background.shape[1], background.shape[0], tuple(layers))


def _whole(premultiplied: FloatImage, dtype: np.dtype[np.generic]) -> NDArray[np.uint8] | NDArray[np.uint16]:
    shown = straight(np.clip(premultiplied, 0, 1)) * np.float32(np.iinfo(dtype).max)  # type: ignore[type-var]
    return np.rint(shown).astype(dtype)  # type: ignore[return-value]
