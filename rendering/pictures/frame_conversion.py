"""Frames of FFmpeg's libraries in other pixel formats."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import av

__all__ = ["converted", "rgb_of"]


def converted(frame: av.VideoFrame, **options: Any) -> av.VideoFrame:
    """A frame in another size or pixel format, by one thread.

    FFmpeg's scaler writes some pixels past the end of a row whose width is no multiple of eight, and then the next row
    over them. Of several threads, which PyAV takes otherwise, one may write them over another's first row.

    Args:
        frame: to be converted; not changed.
        options: of ``VideoFrame.reformat``.
    """
    try:
        return frame.reformat(**options, threads=1)
    except TypeError:  # an older PyAV, which knows one thread only
        return frame.reformat(**options)


def rgb_of(frame: av.VideoFrame, **options: Any) -> NDArray[np.uint8]:
    """A frame's colours, shape [h, w, 3].

    Args:
        frame: of any pixel format.
        options: of ``VideoFrame.reformat``, such as a size.
    """
    return np.ascontiguousarray(converted(frame, format="rgb24", **options).to_ndarray())
