"""Who draws the lines of a picture: the extractor that is chosen."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..sketch import extract_sketch
from .options import NetworkOptions

__all__ = ["line_extractor"]

Extractor = Callable[[NDArray[Any]], NDArray[np.float32]]


def line_extractor(options: NetworkOptions) -> Extractor:
    """What makes the sketch, float32, shape [h, w], lines dark, of an RGB picture, shape [h, w, 3].

    Raises:
        CheckpointError: the file cannot be used.
        InvalidInputError: there is no such device.
    """
    if options.extractor == "gaussians" or options.lines is None:
        return extract_sketch
    from ..sketch.drawings.extractor import draw_sketch
    from ..sketch.drawings.models import load_drawer
    from .devices import device_of, dtype_of

    device = device_of(options.device)
    drawer = load_drawer(Path(options.lines), dtype=dtype_of(options.dtype, device)).to(device)
    return lambda picture: draw_sketch(picture, drawer, working_size=options.lines_size)
