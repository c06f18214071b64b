"""Random walks over a picture, which go on easily within like colours (Grady, 2006)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .like_regions import like_regions

__all__ = ["chance_of_core"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Colours of neighbours that differ by this much are divided by an edge; what a wall of them still lets through; and
# what the step of a mask does. How much what a pixel's colour tells counts beside what its neighbours say.
_STEP = 0.05
_LEAK = 0.002
_MASK_STEP = 0.4
_COLOUR = 0.05
# All pixels of one colour that hang together tell the same; they count as so many.
_TOLD = 5
_NEIGHBOURS = ((0, 1, 1.0), (1, 0, 1.0), (1, 1, 0.7), (1, -1, 0.7))


def chance_of_core(
    image: FloatImage, mask: FloatImage, band: Mask, core: Mask, said: NDArray[np.float32]
) -> NDArray[np.float64]:
    """Chance of a walk from each pixel of a band to end in the core.

    Args:
        image: RGB in 0 to 1, shape [h, w, 3].
        mask: soft mask in 0 to 1, shape [h, w].
        band: the pixels asked, shape [h, w].
        core: where a walk ends well, shape [h, w]; outside of it and the band it ends badly.
        said: the chance that each pixel's own colour and place speak for, shape [n].

    Returns:
        Chances in 0 to 1, in the order of the band's pixels, shape [n].
    """
    from scipy.sparse import coo_matrix, diags
    from scipy.sparse.linalg import cg

    count = int(band.sum())
    number = np.full(band.shape, -1, dtype=np.int64)
    number[band] = np.arange(count)
    total = np.asarray(_COLOUR * _told(image, band), dtype=np.float64)
    target = total * said
    system = coo_matrix((count, count))
    for one, other, conductance in _pairs(image, mask):
        first, second, sure = number[one], number[other], core[one] | core[other]
        both = (first >= 0) & (second >= 0)
        joined = coo_matrix((-conductance[both], (first[both], second[both])), shape=(count, count))
        system = system + joined + joined.T
        for own in (first, second):
            total += np.bincount(own[own >= 0], conductance[own >= 0], count)
            ends = (own >= 0) & ~both & sure
            target += np.bincount(own[ends], conductance[ends], count)
    chance, _ = cg((system + diags(total)).tocsr(), target, x0=said, rtol=1e-3, M=diags(1 / total), maxiter=300)
    return np.asarray(chance)


def _told(image: FloatImage, band: Mask) -> NDArray[np.float32]:
    """How much what a pixel's colour tells counts, 0 to 1, shape [n].

    An area of one colour is one witness, however large: where something black lies about, each pixel of a black strand
    would say anew that it might be that, and outvote what the strand hangs together with.
    """
    region = like_regions(image, band, step=_STEP)
    return np.asarray(np.minimum(1, _TOLD / np.bincount(region.ravel())[region[band]]), dtype=np.float32)


def _pairs(
    image: FloatImage, mask: FloatImage
) -> list[tuple[tuple[slice, slice], tuple[slice, slice], NDArray[np.float32]]]:
    """Neighbouring pixels, as slices of either, with how easily a walk goes from one to the other."""
    height, width = mask.shape
    pairs = []
    for down, right, near in _NEIGHBOURS:
        one = slice(0, height - down), slice(max(0, -right), width - max(0, right))
        other = slice(down, height), slice(max(0, right), width + min(0, right))
        difference = image[one] - image[other]
        alike = np.exp(np.einsum("ijk,ijk->ij", difference, difference) / np.float32(-2 * _STEP**2))
        step = np.abs(mask[one] - mask[other]) > _MASK_STEP
        pairs.append((one, other, np.float32(near) * (alike + _LEAK) * np.where(step, np.float32(_MASK_STEP), 1)))
    return pairs
