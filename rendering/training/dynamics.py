"""How much a clip moves: one number, by which clips that stand still and clips that tear past are left out."""

from __future__ import annotations

import math
from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import optical_flow

__all__ = ["SCORED_WIDTH", "dynamics_score", "score_of_speed"]

SCORED_WIDTH = 256
"""Width at which motion is measured [px], so that the score does not depend on how large a film was kept."""


def score_of_speed(speed: float) -> float:
    """The dynamics score of a mean speed.

    Args:
        speed: of a picture's points, in percent of its diagonal a frame.

    Returns:
        1 - exp(-speed), from 0 (nothing moves) towards 1.
    """
    return 1 - math.exp(-max(speed, 0.0))


def dynamics_score(frames: Sequence[NDArray[np.uint8]]) -> float:
    """How fast the points of a picture move on average, as a number from 0 to 1.

    The optical flow (dense inverse search) from each frame to the next is averaged over all pixels and all frames of
    the clip as it is trained on, that is, without repeated drawings. As a percentage v of the picture's diagonal a
    frame it gives the score 1 - exp(-v): 0 for a still picture, and for small v nearly v itself. So the paper's bounds
    "0.05 to 0.7" are v = 0.05 and v = 1.2. A mouth and eyes (a fortieth of the picture) that move by 2 % of the
    diagonal a frame in an otherwise still picture give 0.05; a whole picture that crosses its own diagonal in 3.5 s at
    24 frames a second gives 0.7. Below, there is hardly any motion to learn; above, lines of one frame say little about
    the next. The paper took its scores from an index that does not say how they were computed; ``--score-column``
    takes such scores as they are.

    Args:
        frames: RGB or grey, uint8, shape [h, w, 3] or [h, w] each, all of one size; wider ones than ``SCORED_WIDTH``
            are made smaller.

    Returns:
        The score; 0 for fewer than two frames.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.training.dynamics import dynamics_score
        >>> still = np.random.default_rng(0).integers(0, 255, (64, 64, 3), np.uint8)
        >>> dynamics_score([still, still, still])
        0.0
    """
    speeds = []
    earlier: NDArray[np.uint8] | None = None
    for frame in frames:
        grey = _small(frame)
        if earlier is not None:
            speeds.append(0.0 if np.array_equal(grey, earlier) else _speed(earlier, grey))
        earlier = grey
    return score_of_speed(float(np.mean(speeds))) if speeds else 0.0


def _speed(first: NDArray[np.uint8], second: NDArray[np.uint8]) -> float:
    flow = optical_flow(first, second)
    return 100 * float(np.linalg.norm(flow, axis=2).mean()) / math.hypot(*first.shape)


def _small(frame: NDArray[np.uint8]) -> NDArray[np.uint8]:
    grey = cv2.cvtColor(frame, cv2.COLOR_RGB2GRAY) if frame.ndim == 3 else frame
    height, width = grey.shape
    if width <= SCORED_WIDTH:
        return np.asarray(grey)
    size = (SCORED_WIDTH, max(1, round(height * SCORED_WIDTH / width)))
    return np.asarray(cv2.resize(grey, size, interpolation=cv2.INTER_AREA))
