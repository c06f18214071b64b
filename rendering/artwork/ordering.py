"""Layers of an artwork in another order than that of the file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from .artwork import Artwork

__all__ = ["in_order"]


def in_order(artwork: Artwork, names: Sequence[str]) -> Artwork:
    """The artwork with some layers in another order: they change places among themselves, the others stay.

    Args:
        artwork: the layers, whose names stay what they are.
        names: of layers from back to front, as ``Artwork.names`` has them; those that no layer has do not count.

    Returns:
        The same artwork where nothing changes.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import ArtLayer, Artwork, in_order
        >>> pixels = np.full((4, 4, 4), 255, np.uint8)
        >>> art = Artwork(4, 4, tuple(ArtLayer(name, pixels) for name in ("paper", "hair", "face", "hand")))
        >>> in_order(art, ["face", "hair"]).names
        ('paper', 'face', 'hair', 'hand')
    """
    own = artwork.names
    places = {name: index for index, name in enumerate(own)}
    wanted = [places[name] for name in dict.fromkeys(names) if name in places]
    if wanted == sorted(wanted):
        return artwork
    order = list(range(len(own)))
    for place, index in zip(sorted(wanted), wanted, strict=True):
        order[place] = index
    # Of two layers of one name, each keeps the one by which it is told from the other.
    return replace(artwork, layers=tuple(replace(artwork.layers[index], name=own[index]) for index in order))
