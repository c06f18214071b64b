"""Colours that a video model has let drift, brought back to those of the illustration's own moving pixels.

Each frame is matched by itself to the composite's frame of the same time, outside what that had to make up. So no step
is brought into a clip, not where segments meet nor where a loop begins again, and one that the model has made goes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from ..pictures.colour_matching import colours_of, common_weights, with_colours

__all__ = ["Reference", "own_colours", "without_drift"]

FloatImage = NDArray[np.float32]

Reference = tuple[FloatImage, FloatImage]
"""What a frame should look like, RGB 0..1, shape [h, w, 3], and how far each of its pixels is known, 0..1, [h, w]."""


def without_drift(frames: Iterable[FloatImage], references: Iterable[Reference], amount: float) -> Iterator[FloatImage]:
    """Frames with the colours of their references.

    Args:
        frames: as drawn, RGB, float32 in 0..1, shape [h, w, 3].
        references: one for each.
        amount: share of the difference that goes, 0..1.
    """
    for frame, (reference, known) in zip(frames, references, strict=True):
        weights = common_weights(frame, reference, weights=known)
        yield with_colours(frame, colours_of(frame, weights), colours_of(reference, weights), amount=amount)


def own_colours(picture: FloatImage) -> Reference:
    """A reference that is known everywhere."""
    return picture, np.ones(picture.shape[:2], np.float32)
