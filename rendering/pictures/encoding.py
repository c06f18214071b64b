"""Frames encoded by FFmpeg's libraries."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.interruption import checkpoint
from ...physics.threads import allowed_threads
from .container_formats import ContainerFormat
from .frame_conversion import converted

if TYPE_CHECKING:
    import av

__all__ = ["encode"]

_LOOKAHEAD = 20  # frames that x264 holds to choose between them: of 40 it is as good, and is waited for at the end
_LOOKAHEAD_PIXELS = 150_000_000  # of these frames together: it takes three bytes and more for each
_AVX512 = 256  # OpenCV's number of these instructions of a processor
_BT709 = 1
_LIMITED_RANGE = 1


@contextmanager
def _refusals(codec: str) -> Iterator[None]:
    """What the encoder does not take, as a sentence; a full disk and the like go on as they are."""
    import av

    try:
        yield
    except av.FFmpegError as error:
        if isinstance(error, OSError):
            raise
        raise InvalidInputError(f"frames must be such that FFmpeg's {codec} takes them. Got: {error}") from error


def encode(
    frames: Iterable[NDArray[np.uint8]],
    path: Path,
    chosen: ContainerFormat,
    shape: tuple[int, ...],
    rate: Fraction,
    *,
    exact: bool,
) -> None:
    """Write frames into a file; may be stopped at checkpoints.

    Args:
        frames: RGB or RGBA, shape [h, w, 3] or [h, w, 4].
        path: of the file.
        chosen: how it is written.
        shape: of every frame.
        rate: frames a second.
        exact: colours as they are, where the format can hold them.

    Raises:
        InvalidInputError: the encoder does not take the frames.
    """
    import av

    alpha = shape[2] == 4
    even = chosen.codec == "libx264"
    height, width = (size + size % 2 if even else size for size in shape[:2])
    with (
        _refusals(chosen.codec),
        av.open(str(path), "w", format=chosen.container, options=chosen.container_options) as container,
    ):
        options = chosen.options | (chosen.alpha_options if alpha else {}) | (chosen.exact_options if exact else {})
        if even:
            options |= _alike_everywhere() | {"rc-lookahead": str(_lookahead(width * height))}
        stream = container.add_stream(chosen.codec, rate=rate, options=options)
        if "threads" not in options:
            stream.codec_context.thread_count = allowed_threads()
        stream.width, stream.height = width, height
        stream.pix_fmt = (chosen.alpha_pixels if alpha else None) or chosen.pixels
        stream.codec_context.time_base = 1 / rate
        _describe(stream)
        for frame in _converted(frames, stream.pix_fmt, rate, even=even, exact=exact, folder=path.parent):
            checkpoint()
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))


def _alike_everywhere() -> dict[str, str]:
    """What x264 must be told to write the same bytes of the same frames each time, and on every machine.

    What it writes depends on its number of threads, which is the machine's unless it is given. With AVX-512 and
    macroblock trees, one clip of a thousand came out differently by chance where a row had 4 or 20 macroblocks; with
    AVX2, which every processor with AVX-512 has, none of 40,000.
    """
    options = {"threads": "1"}
    if cv2.checkHardwareSupport(_AVX512):
        options["x264-params"] = "asm=SSE2Fast,SSE4.2,FMA3,BMI2,AVX2"
    return options


def _lookahead(pixels: int) -> int:
    """How many frames of so many pixels x264 shall look ahead: of large pictures fewer, so that memory has a bound."""
    return max(1, min(_LOOKAHEAD, _LOOKAHEAD_PIXELS // pixels))


def _describe(stream: av.VideoStream) -> None:
    """Tell players what the numbers mean: without the tags they guess by the picture's size."""
    if not str(stream.pix_fmt).startswith("yuv"):
        return
    context = stream.codec_context
    context.colorspace = context.color_primaries = context.color_trc = _BT709
    context.color_range = _LIMITED_RANGE


def _converted(
    frames: Iterable[NDArray[np.uint8]], pixels: str, rate: Fraction, *, even: bool, exact: bool, folder: Path
) -> Iterator[av.VideoFrame]:
    """Numbered frames in a stream's pixel format."""
    if pixels == "pal8":
        from .gif import paletted

        yield from paletted(_numbered(frames, rate, even=even), rate, dithered=not exact, folder=folder)
        return
    for frame in _numbered(frames, rate, even=even):
        if pixels.startswith("yuv"):
            yield _tagged(converted(frame, format=pixels, dst_colorspace="ITU709", dst_color_range="MPEG"))
        else:
            yield converted(frame, format=pixels)


def _tagged(frame: av.VideoFrame) -> av.VideoFrame:
    """A frame that says itself what its numbers mean: ProRes has that in each frame, besides in the file's head."""
    for name in ("color_primaries", "color_trc"):
        if hasattr(frame, name):  # since PyAV 16
            setattr(frame, name, _BT709)
    return frame


def _numbered(frames: Iterable[NDArray[np.uint8]], rate: Fraction, *, even: bool) -> Iterator[av.VideoFrame]:
    import av

    for index, pixels in enumerate(frames):
        height, width, channels = pixels.shape
        if even and (height % 2 or width % 2):
            pixels = np.pad(pixels, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
        frame = av.VideoFrame.from_ndarray(pixels, format="rgba" if channels == 4 else "rgb24")
        frame.pts, frame.time_base = index, 1 / rate
        yield frame
