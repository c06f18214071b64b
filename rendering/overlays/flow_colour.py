"""Flow as colour: the direction is the hue, the length the saturation.

The wheel is the usual one of Baker et al., "A database and evaluation methodology for optical flow" (2011): red to
yellow, green, cyan, blue, magenta and back, with unequal steps so that equal turns look equally different.
"""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["flow_to_color"]

_STEPS = (15, 6, 4, 11, 13, 6)
_HUES = ((1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 1, 1), (0, 0, 1), (1, 0, 1), (1, 0, 0))


def flow_to_color(
    displacement: NDArray[Any],
    inside: NDArray[np.bool_] | None = None,
    *,
    max_px: float | None = None,
    outside: Literal["white", "black"] = "white",
) -> NDArray[np.uint8]:
    """Flow as a picture.

    Args:
        displacement: x right and y down [px], shape [h, w, 2].
        inside: where there is flow, bool, shape [h, w]; None means everywhere.
        max_px: length that is shown in full colour, longer flow is darker [px]; None means the longest.
        outside: colour of everything else.

    Returns:
        RGB, uint8, shape [h, w, 3].

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.overlays import flow_to_color
        >>> flow_to_color(np.full((2, 3, 2), (5.0, 0.0))).shape
        (2, 3, 3)
    """
    shape = displacement.shape
    require("displacement", f"shape {shape}", len(shape) == 3 and shape[2] == 2, "of shape [h, w, 2]")
    require("outside", outside, outside in ("white", "black"), "white or black")
    if max_px is not None:
        require("max_px", max_px, 0 < max_px < np.inf, "above 0 px")
    picture = np.full((*shape[:2], 3), 255 if outside == "white" else 0, dtype=np.uint8)
    where = np.ones(shape[:2], dtype=bool) if inside is None else inside
    u, v = displacement[where].astype(np.float64).T
    length = np.hypot(u, v)
    longest = max_px if max_px is not None else max(float(length.max(initial=0)), 1e-9)
    # Where each pixel stands on the wheel, 0 and 1 being red: flow to the right, and on clockwise as seen.
    place = np.mod(np.arctan2(v, u) / (2 * np.pi), 1)
    corners = np.concatenate([[0], np.cumsum(_STEPS)]) / sum(_STEPS)
    hue = np.stack([np.interp(place, corners, channel) for channel in zip(*_HUES, strict=True)], axis=1)
    part = (length / longest)[:, None]
    colour = np.where(part <= 1 + 1e-6, 1 - part * (1 - hue), 0.75 * hue)
    picture[where] = np.rint(np.clip(colour, 0, 1) * 255)
    return picture
