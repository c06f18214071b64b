"""Sketches of clips: by a line drawing network where its weights are given, else by our own extractor."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..sketch import extract_sketch

__all__ = ["Sketcher", "sketcher_of"]

Sketcher = Callable[[NDArray[np.uint8]], NDArray[np.uint8]]
"""From a frame, RGB, shape [h, w, 3], to its sketch, dark lines on white, shape [h, w]."""


def sketcher_of(lines: Path | None, device: str = "auto") -> tuple[str, Sketcher]:
    """What draws sketches, and its name for the record.

    Args:
        lines: weights of a line drawing network, such as informative drawings' (the paper's); None for our extractor.
        device: where the network computes.

    Raises:
        InvalidInputError: the file is unusable, or there is no such device.
    """
    if lines is None:
        return "difference of Gaussians", lambda frame: _levels(extract_sketch(frame))
    from ..neural.devices import device_of
    from ..sketch.drawings.extractor import draw_sketch
    from ..sketch.drawings.models import load_drawer

    drawer = load_drawer(lines).to(device_of(device))
    return f"network {lines.name}", lambda frame: _levels(draw_sketch(frame, drawer))


def _levels(sketch: NDArray[Any]) -> NDArray[np.uint8]:
    return np.asarray((255 * sketch + 0.5).astype(np.uint8))
