"""The moving layers of an artwork as pictures of their own, made when they are looked at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, overload

from numpy.typing import NDArray

if TYPE_CHECKING:
    from .artwork import Artwork

__all__ = ["LayerPictures"]

Image = NDArray[Any]


class LayerPictures(Sequence[Image]):
    """Layers alone on the canvas, straight RGBA, uint8 or float32, shape [h, w, 4] each; none is kept."""

    def __init__(self, artwork: Artwork, indices: Sequence[int]) -> None:
        """
        Args:
            artwork: the layers.
            indices: which of them.
        """
        self._artwork = artwork
        self._indices = tuple(indices)

    def __len__(self) -> int:
        return len(self._indices)

    @overload
    def __getitem__(self, number: int) -> Image: ...

    @overload
    def __getitem__(self, number: slice) -> list[Image]: ...

    def __getitem__(self, number: int | slice) -> Image | list[Image]:
        from .artwork import flattened
        from .pictures import as_picture

        if isinstance(number, slice):
            return [self[each] for each in range(*number.indices(len(self)))]
        layer = self._artwork.layers[self._indices[number]]
        return as_picture(flattened(self._artwork, [replace(layer, blend="normal", visible=True)]), alpha=True)
