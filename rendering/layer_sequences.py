"""Where the layers of an artwork are written as sequences of pictures."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .artwork import Artwork

__all__ = ["check_layer_sequences", "check_part_sequences", "layer_folders"]

_NUMBERED = re.compile(r"[0-9]{2,} ")


def layer_folders(artwork: Artwork, folder: str | os.PathLike[str]) -> list[Path]:
    """The folder of each layer's frames, from back to front."""
    from .artwork import png_names

    return [Path(folder) / Path(name).stem for name in png_names(artwork)]


def check_part_sequences(folder: str | os.PathLike[str]) -> None:
    """Refuse a place for the parts of a flat picture, whose names are not known yet, before any work.

    Args:
        folder: in which each gets a folder of its own, such as ``01 part 1``.

    Raises:
        InvalidInputError: nothing can be written there, or a folder of such a name holds frames that PhysAnimator did
            not write.
    """
    from .files import check_folder_place
    from .pictures import check_output

    place = check_folder_place(folder)
    for each in place.iterdir() if place.is_dir() else ():
        if _NUMBERED.match(each.name):
            check_output(f"{each}/", alpha=True)


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
