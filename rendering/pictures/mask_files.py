"""Masks from files, at the size of the illustration, with remarks on what may not be meant so."""

from __future__ import annotations

import os

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import ImageOps

from ...physics.errors import InvalidInputError
from ...physics.mesh import fitted, may_be_inverted
from .mask_rule import EMPTY, MaskFile, judged
from .picture_files import first_of_several, reading

__all__ = ["read_mask"]

StrPath = str | os.PathLike[str]
FloatPlane = NDArray[np.float32]

_SPECK, _MANY_SPECKS = 16, 1000  # areas of white below this are no parts [px^2]; so many are hardly painted


def read_mask(path: StrPath, *, width: int, height: int, name: str = "mask") -> MaskFile:
    """Read a mask: where a moving part is.

    White counts where there is white on black: on opaque pictures, and among what is visible of one with transparent
    areas. Where the colours do not decide, a picture with transparent areas counts by its opacity, so that a cut-out
    part serves as its own mask. An opaque picture of one colour on black or white counts where that colour is; so do
    the numbers 0 and 1, and a single grey. Edges stay as soft as they are painted. Several labels, several colours and
    photographs are refused with what was seen in them. A mask of the picture's proportions is scaled to its size.

    Args:
        path: a picture file of any mode.
        width: width of the illustration [px].
        height: height of the illustration [px].
        name: what the user calls the mask, for messages.

    Raises:
        InvalidInputError: the file cannot be read, has other proportions than the illustration, is empty, or does not
            say which of several parts is meant.
    """
    called = f"{name} {path}"
    with reading(path, "picture") as opened:
        several = first_of_several(opened, called)
        picture = ImageOps.exif_transpose(opened)
        found = judged(picture, called)
    coverage = fitted(found.coverage, width, height, name=called)
    if coverage.max() < 0.5:
        raise InvalidInputError(f"{called} must be {EMPTY}")
    notes = (*several, *found.notes)
    if may_be_inverted(coverage):
        share = 100 * float(coverage.mean())
        notes += (f"{called} covers {share:.0f} % of the picture: if white is what shall stay still, invert it",)
    if (specks := _specks(coverage)) > _MANY_SPECKS:
        notes += (f"{called} holds {specks} specks of white, as noise makes them: paint parts in even white",)
    return MaskFile(coverage, notes)


def _specks(coverage: FloatPlane) -> int:
    """How many separate areas of white there are that are too small to be parts."""
    _, _, statistics, _ = cv2.connectedComponentsWithStats((coverage > 0.5).astype(np.uint8), connectivity=4)
    return int(np.count_nonzero(statistics[1:, cv2.CC_STAT_AREA] < _SPECK))
