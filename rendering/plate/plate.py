"""The clean plate: the illustration without its moving parts, made once for a whole clip."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.beside import Beside
from ...physics.errors import InvalidInputError
from ...physics.interruption import checkpoint
from ...physics.linear_algebra import on_one_thread
from ...physics.mesh import coverage_of, fitted
from ..matting import regular_mask, with_outline
from ..pictures import as_dtype, as_float, as_picture, window_around
from .border_outlines import draw_outlines
from .flat_regions import flat_regions
from .flatness import flat_surroundings
from .ink import ink_lines
from .line_continuation import continue_lines
from .patch_synthesis import continue_texture
from .region_colours import paint_regions
from .smooth_fill import smooth_fill

__all__ = ["clean_plate", "fill_hole"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# A mask above this shows something of the part: 5 levels of 255.
_FAINT = 0.02
# A fill of patches alone looks best; half-way to the smooth fill it errs least. The share is a compromise. Deeper in
# the hole, patches are less and less likely to be the right ones: their share fades with this depth [px].
_TEXTURE = 0.6
_TEXTURE_DEPTH = 40.0
# A share that changes no colour by a level.
_UNSEEN = 1 / 255
# Colours, lines and patches come from within this of the hole [px].
_CONTEXT = 120
# Patches are matched down to the scale at which a hole has no more pixels than this.
_MATCHED_PIXELS = 30_000


def clean_plate(image: NDArray[Any], mask: ArrayLike) -> NDArray[Any]:
    """Remove what a mask shows and continue its surroundings in its place.

    Args:
        image: RGB in any form that :func:`as_picture` takes, shape [h, w, 3].
        mask: what to remove: bool, integers 0 to 255 or floats 0 to 1, shape [h, w]; everything above 0.02 goes.
            Should include the outlines that belong to it.

    Returns:
        The picture, uint8 or float32 as ``image`` is taken; outside the mask unchanged.

    Raises:
        InvalidInputError: the picture or mask has another form, or the mask leaves too little of the picture.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.plate import clean_plate
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> plate = clean_plate(picture, np.pad(np.ones((44, 44)), 8))
        >>> int(plate.min())
        230
    """
    image = as_picture(image)
    coverage = fitted(coverage_of(mask), image.shape[1], image.shape[0])
    hole = coverage > _FAINT
    if not hole.any():
        return image.copy()
    if hole.all():
        raise InvalidInputError("mask must leave some of the picture to fill the rest with. Got: all is white")
    picture = as_float(image)
    # An outline along the mask belongs to what is removed: it must not run on into the fill.
    with Beside(lambda: with_outline(picture, coverage)) as outlined:
        regular = regular_mask(picture, coverage)
    whole = hole | outlined.result()
    if (regular != coverage).any():
        whole |= with_outline(picture, regular)
    filled = fill_hole(picture, hole if whole.all() else whole)
    plate = image.copy()
    plate[hole] = as_dtype(filled[hole], image.dtype)
    return plate


@on_one_thread
def fill_hole(picture: FloatImage, hole: Mask) -> FloatImage:
    """Continue the surroundings of a hole into it: smooth colours, and texture from patches around.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: true where colours are to be found, shape [h, w]; some must be false.

    Returns:
        RGB in 0 to 1, shape [h, w, 3]; unchanged outside the hole.
    """
    window = window_around(hole, margin=_CONTEXT)
    around, inside = picture[window], hole[window]
    lined, lines = continue_lines(around, inside)
    checkpoint()
    flat = flat_surroundings(lined, inside & ~lines)
    unlined = np.where(lines[..., None], lined, flat.plain)
    unknown = inside & ~lines
    regions = flat_regions(lined, unknown, flat, lines)
    if regions is None:
        smooth = smooth_fill(unlined, unknown, continued=lines)
    else:
        smooth = smooth_fill(unlined, unknown, continued=lines, apart=regions.apart)
        smooth, contrast = paint_regions(lined, smooth, unknown, regions)
    # Fine scales take long in a large hole, and most of it stays hidden.
    finest = max(0, int(np.ceil(np.log2(inside.sum() / _MATCHED_PIXELS) / 2)))
    scales = tuple(range(max(3, finest + 2), finest - 1, -1))
    depth = cv2.distanceTransform(inside.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
    kind = None
    share = np.float32(_TEXTURE) * np.exp(-depth / np.float32(_TEXTURE_DEPTH))
    if regions is not None:
        kind = regions.flat_share
        share *= 1 - np.float32(flat.cleanness) * kind
    share[lines] = 0  # patches from elsewhere would break them up
    textured = continue_texture(around, inside, smooth, wanted=share > _UNSEEN, kind=kind, matched=scales)
    blended = np.where(inside[..., None], smooth + share[..., None] * (textured - smooth), around)
    if regions is not None:
        blended = draw_outlines(lined, blended, unknown, regions, contrast, ink_lines(lined, ~unknown, flat.noise))
    filled = picture.copy()
    filled[window] = blended
    return filled
