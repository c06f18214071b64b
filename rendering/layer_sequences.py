"""Where the layers of an artwork are written as sequences of pictures."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .artwork import Artwork

__all__ = ["check_layer_sequences", "layer_folders"]


def layer_folders(artwork: Artwork, folder: str | os.PathLike[str]) -> list[Path]:
    """The folder of each layer's frames, from back to front."""
    from .artwork import png_names

    return [Path(folder) / Path(name).stem for name in png_names(artwork)]


def check_layer_sequences(artwork: Artwork, folder: str | os.PathLike[str]) -> None:
    """Refuse places that layers could not be written to, before any work.

    Args:
        artwork: whose layers.
        folder: in which each gets a folder of its own.

    Raises:
        InvalidInputError: nothing can be written there, or a folder holds frames that PhysAnimator did not write.
    """
    from .files import check_folder_place
    from .pictures import check_output

    place = check_folder_place(folder)
    for each in layer_folders(artwork, folder):
        check_output(f"{each}/", alpha=True, coming=(place,))
