"""Random walks over a picture, which go on easily within like colours (Grady, 2006)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...physics.linear_algebra import on_one_thread
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


@on_one_thread
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
    from scipy.sparse import csr_matrix, diags
    from scipy.sparse.linalg import cg

    count = int(band.sum())
    number = np.full(band.shape, -1, dtype=np.int32)
    number[band] = np.arange(count)
    # With a border around, every pixel has all neighbours, and each lies as far from it in memory.
    numbers, known_core = np.pad(number, 1, constant_values=-1).ravel(), np.pad(core, 1).ravel()
    width = band.shape[1] + 2
    row, column = np.nonzero(band)
    place = (row + 1) * width + column + 1
    total = np.asarray(_COLOUR * _told(image, band), dtype=np.float64)
    target = total * said
    # One row of the system for each pixel of the band, its neighbours and itself in the order of their numbers.
    others, values = np.full((count, 9), -1, dtype=np.int32), np.zeros((count, 9))
    for (down, right, _), ease in zip(_NEIGHBOURS, _eases(image, mask), strict=True):
        step = down * width + right
        for way, at in ((step, place), (-step, place - step)):
            conductance, beside = ease.take(at), place + way
            entry = 4 + np.sign(way) * (3 * down + right)
            others[:, entry], values[:, entry] = numbers.take(beside), -conductance
            total += conductance
            target += np.where(known_core.take(beside), conductance, 0)
    others[:, 4], values[:, 4] = np.arange(count), total
    within = others >= 0
    starts = np.concatenate([[0], np.cumsum(within.sum(axis=1))])
    system = csr_matrix((values[within], others[within], starts), shape=(count, count))
    chance, _ = cg(system, target, x0=said, rtol=1e-3, M=diags(1 / total), maxiter=300)
    return np.asarray(chance)


def _told(image: FloatImage, band: Mask) -> NDArray[np.float32]:
    """How much what a pixel's colour tells counts, 0 to 1, shape [n].

    An area of one colour is one witness, however large: where something black lies about, each pixel of a black strand
    would say anew that it might be that, and outvote what the strand hangs together with.
    """
    region = like_regions(image, band, step=_STEP)
    return np.asarray(np.minimum(1, _TOLD / np.bincount(region.ravel())[region[band]]), dtype=np.float32)


def _eases(image: FloatImage, mask: FloatImage) -> list[NDArray[np.float32]]:
    """How easily a walk goes from each pixel to its neighbour on one side, for each of those sides.

    Flat, with a border of one pixel; 0 where there is no neighbour.
    """
    height, width = mask.shape
    eases = []
    for down, right, near in _NEIGHBOURS:
        one = slice(0, height - down), slice(max(0, -right), width - max(0, right))
        other = slice(down, height), slice(max(0, right), width + min(0, right))
        difference = image[one] - image[other]
        alike = np.exp(np.einsum("ijk,ijk->ij", difference, difference) / np.float32(-2 * _STEP**2))
        step = np.abs(mask[one] - mask[other]) > _MASK_STEP
        ease = np.zeros((height + 2, width + 2), dtype=np.float32)
        inner = ease[1:-1, 1:-1]
        inner[one] = np.float32(near) * (alike + _LEAK) * np.where(step, np.float32(_MASK_STEP), 1)
        eases.append(ease.ravel())
    return eases
