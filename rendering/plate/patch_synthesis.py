"""Fill a hole with patches of the rest of the picture, so that texture and lines run on into it.

From coarse to fine, every patch that touches the hole looks for its nearest neighbour among the whole patches
outside (PatchMatch: neighbours propose their finds, random guesses refine them), and every pixel of the hole becomes
the weighted mean of what the patches around it propose. A smooth guide keeps the large forms.

Sources: Barnes et al., "PatchMatch" (2009); Wexler et al., "Space-Time Completion of Video" (2007).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.beside import side_by_side
from ...physics.interruption import checkpoint
from ...physics.threads import allowed_threads
from .patch_search import RADIUS, Finds, Level, PatchSearch, usable_sources

__all__ = ["continue_texture"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]

# Matching and voting alternate so often at each scale.
_ROUNDS = 6
_LEAST_WEIGHT = 1e-12
# Fewer pixels than this are not worth a thread.
_PIECE = 4096


def continue_texture(
    picture: FloatImage, hole: Mask, guide: FloatImage, *, matched: tuple[int, ...] = (3, 2, 1), seed: int = 0
) -> FloatImage:
    """Fill a hole with patches from around it.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: true where colours are unknown, shape [h, w]; its surroundings should contain whole patches.
        guide: smooth colours for the hole, shape [h, w, 3].
        matched: scales at which patches are matched, from coarse to fine; scale k is 2^-k of the size.
        seed: of the random guesses.

    Returns:
        RGB in 0 to 1, shape [h, w, 3]; equal to ``picture`` outside the hole.
    """
    filled = np.where(hole[..., None], guide, picture)
    levels = [Level(picture, hole, guide, cv2.GaussianBlur(filled, (0, 0), 3.0))]
    while len(levels) <= matched[0]:
        levels.append(levels[-1].halved())
    random = np.random.default_rng(seed)
    finds: Finds | None = None
    for scale in range(matched[0], -1, -1):
        level = levels[scale]
        current = np.where(level.hole[..., None], level.guide, level.picture)
        if finds is not None:
            finds = finds.doubled(level.hole.shape)
            current = _voted(level, current, finds)
        if scale in matched and level.hole.any() and usable_sources(level.hole).any():
            current, finds = _matched(level, current, finds, random)
    return current if finds is not None else filled


def _matched(
    level: Level, current: FloatImage, finds: Finds | None, random: np.random.Generator
) -> tuple[FloatImage, Finds]:
    """Alternate between matching patches and voting for colours."""
    search = PatchSearch(level, finds, random)
    for _ in range(_ROUNDS):
        checkpoint()
        found = search.round(current)
        current = _voted(level, current, found)
    return current, found


def _voted(level: Level, current: FloatImage, finds: Finds) -> FloatImage:
    """The hole filled with the weighted mean of what all patches around each of its pixels propose."""
    width = level.hole.shape[1] + 2 * RADIUS
    # Around the picture there is room for patches of no trust, so that none has to be looked for.
    trust, source = (
        cv2.copyMakeBorder(each, *[RADIUS] * 4, cv2.BORDER_CONSTANT, value=0).ravel()
        for each in (finds.trust, finds.source.astype(np.int32))
    )
    # The last channel sums the weights.
    colours = np.column_stack([level.picture.reshape(-1, 3), np.ones(level.hole.size, np.float32)])

    def vote(start: FloatImage, at: NDArray[np.int64]) -> FloatImage:
        # Where no patch is to be trusted at all, a pixel stays as it is.
        total = np.column_stack([start, np.ones(len(at), np.float32)]) * np.float32(_LEAST_WEIGHT)
        for down in range(-RADIUS, RADIUS + 1):
            for right in range(-RADIUS, RADIUS + 1):
                patch = at - (down * width + right)
                proposed = colours.take(source.take(patch) + (down * level.hole.shape[1] + right), axis=0, mode="clip")
                proposed *= trust.take(patch)[:, None]
                total += proposed
        return total[:, :3] / total[:, 3:]

    row, column = np.nonzero(level.hole)
    pixels = (row + RADIUS) * width + column + RADIUS
    filled = current.copy()
    filled[level.hole] = np.concatenate(list(side_by_side(vote, *_divided(current[level.hole], pixels))))
    return filled


def _divided(*arrays: NDArray[Any]) -> Iterator[list[NDArray[Any]]]:
    """Arrays of one length in pieces, one for each thread where there is enough for all."""
    return (np.array_split(each, min(allowed_threads(), 1 + len(each) // _PIECE)) for each in arrays)
