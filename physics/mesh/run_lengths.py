"""Run lengths: painted masks as short lists of numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..errors import require

__all__ = ["mask_of", "runs_of"]


def runs_of(mask: NDArray[np.bool_]) -> list[int]:
    """Lengths of the runs of equal pixels, row by row from the top left.

    The first run is of empty pixels (0 where the first pixel is painted); painted and empty then take turns.

    Args:
        mask: bool, shape [h, w].
    """
    flat = mask.reshape(-1)
    starts = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    lengths = np.diff(np.concatenate([[0], starts, [flat.size]])).tolist()
    return [0, *lengths] if flat[0] else lengths


def mask_of(runs: Sequence[int], *, width: int, height: int) -> NDArray[np.bool_]:
    """The mask whose run lengths are ``runs``, bool, shape [h, w], not to be written to.

    Raises:
        InvalidInputError: the runs do not fill the mask.
    """
    total = sum(runs)
    require("runs", total, total == width * height, f"lengths that add up to width x height ({width * height})")
    painted = np.arange(len(runs)) % 2 == 1
    mask = np.repeat(painted, np.array(runs, dtype=np.int64)).reshape(height, width)
    mask.setflags(write=False)  # so that who keeps it need not copy it
    return mask
