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

# Matching and voting alternate so often at full size, and once more at each coarser scale: what a finer one takes over
# is found already, and one round there costs four times as much.
_ROUNDS = 3
_LEAST_WEIGHT = 1e-12
# Fewer pixels than this are not worth a thread.
_PIECE = 4096


def continue_texture(
    picture: FloatImage,
    hole: Mask,
    guide: FloatImage,
    *,
    wanted: Mask | None = None,
    kind: FloatImage | None = None,
    matched: tuple[int, ...] = (3, 2, 1),
    seed: int = 0,
) -> FloatImage:
    """Fill a hole with patches from around it.

    Args:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: true where colours are unknown, shape [h, w]; its surroundings should contain whole patches.
        guide: smooth colours for the hole, shape [h, w, 3].
        wanted: where in the hole patches are wanted, shape [h, w]; elsewhere it keeps the guide's colours. None: all.
        kind: 0..1, shape [h, w]; patches are taken from what is of the same kind, if anything fits. None: from all.
        matched: scales at which patches are matched, from coarse to fine; scale k is 2^-k of the size.
        seed: of the random guesses.

    Returns:
        RGB in 0 to 1, shape [h, w, 3]; equal to ``picture`` outside the hole.
    """
    filled = np.where(hole[..., None], guide, picture)
    levels = [
        Level(
            picture, hole, hole if wanted is None else hole & wanted, guide, cv2.GaussianBlur(filled, (0, 0), 3.0), kind
        )
    ]
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
        if scale in matched and level.wanted.any() and usable_sources(level.hole).any():
            current, finds = _matched(level, current, finds, random, rounds=_ROUNDS + scale)
    return current if finds is not None else filled


def _matched(
    level: Level, current: FloatImage, finds: Finds | None, random: np.random.Generator, *, rounds: int
) -> tuple[FloatImage, Finds]:
    """Alternate between matching patches and voting for colours."""
    search = PatchSearch(level, finds, random)
    for _ in range(rounds):
        checkpoint()
        found = search.round(current)
        current = _voted(level, current, found)
    return current, found


def _voted(level: Level, current: FloatImage, finds: Finds) -> FloatImage:
    """The hole filled with the weighted mean of what all patches around each of its pixels propose."""
    width = level.hole.shape[1] + 2 * RADIUS
    # Around the picture there is room for patches of no trust, so that none has to be looked for.
    trust, source = (np.pad(each, RADIUS).ravel() for each in (finds.trust, finds.source))
    colours = [plane.ravel() for plane in cv2.split(level.picture)]

    def vote(start: FloatImage, at: NDArray[np.int64]) -> FloatImage:
        # Where no patch is to be trusted at all, a pixel stays as it is.
        weights = np.full(len(at), _LEAST_WEIGHT, dtype=np.float32)
        total = np.ascontiguousarray(start.T) * np.float32(_LEAST_WEIGHT)
        for down in range(-RADIUS, RADIUS + 1):
            for right in range(-RADIUS, RADIUS + 1):
                patch = at - (down * width + right)
                proposed, weight = source.take(patch), trust.take(patch)
                proposed += down * level.hole.shape[1] + right
                weights += weight
                for summed, plane in zip(total, colours, strict=True):
                    summed += plane.take(proposed, mode="clip") * weight
        return np.asarray((total / weights).T)

    unknown, across = level.unknown, level.hole.shape[1]
    pixels = (unknown // across + RADIUS) * width + unknown % across + RADIUS
    filled = current.copy()
    flat = filled.reshape(-1, 3)
    flat[unknown] = np.concatenate(list(side_by_side(vote, *_divided(flat.take(unknown, axis=0), pixels))))
    return filled


def _divided(*arrays: NDArray[Any]) -> Iterator[list[NDArray[Any]]]:
    """Arrays of one length in pieces, one for each thread where there is enough for all."""
    return (np.array_split(each, min(allowed_threads(), 1 + len(each) // _PIECE)) for each in arrays)
