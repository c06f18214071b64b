"""Clips of training data as files: H.264 that keeps every pixel's own colour."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ..files import check_file_place, replacing
from ..pictures import FORMATS
from ..pictures.encoding import encode
from ..pictures.frame_rates import exact_frame_rate

__all__ = ["write_clip"]

_CRF = 12
# 4:4:4, as 4:2:0 lets the colours of drawn lines run: at 512 x 320 and CRF 17 it gave 34 dB of RGB, at any CRF at most
# 36; 4:4:4 and CRF 12 give 41 dB in 13 kB a frame (measured on the bundled example and on a painted background).
_PIXELS = "yuv444p"


def write_clip(frames: Iterable[NDArray[np.uint8]], path: Path, fps: float) -> None:
    """Write a clip; it appears only when it is complete.

    Args:
        frames: RGB or grey, uint8, of one even size, shape [h, w, 3] or [h, w].
        path: a name in .mp4.
        fps: frames a second.

    Raises:
        InvalidInputError: there is no frame, or the file cannot be put there.
    """
    mp4 = FORMATS[".mp4"]
    chosen = replace(mp4, pixels=_PIXELS, options=mp4.options | {"crf": str(_CRF)})
    coloured = _coloured(frames)
    first = next(coloured, None)
    if first is None:
        raise InvalidInputError("a clip must have at least one frame. Got: none")
    check_file_place(path)
    with replacing(path) as temporary:
        encode(chain([first], coloured), temporary, chosen, first.shape, exact_frame_rate(fps), exact=False)


def _coloured(frames: Iterable[NDArray[np.uint8]]) -> Iterator[NDArray[np.uint8]]:
    for frame in frames:
        rgb = np.repeat(frame[..., None], 3, axis=2) if frame.ndim == 2 else frame
        yield np.ascontiguousarray(rgb)
