"""Animations into files: MP4, WebM with alpha, GIF, animated WebP and PNG, or a folder of numbered pictures."""

from __future__ import annotations

import itertools
import math
import numbers
import os
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, require
from ..files import StrPath, check_file_place, is_folder_name, place_of, replacing, suffix_of
from .bleeding import bled
from .frame_folder import check_frame_folder, write_frame_folder
from .pixels import as_uint8

if TYPE_CHECKING:
    import av

__all__ = [
    "FORMATS",
    "FRAME_RATES",
    "ContainerFormat",
    "check_frame_rate",
    "check_output",
    "exact_frame_rate",
    "holds_alpha",
    "write_animation",
]

FRAME_RATES = (0.01, 240.0)
"""The slowest and the fastest clip that can be written [frames/s]; every format holds these."""


@dataclass(frozen=True)
class ContainerFormat:
    """How FFmpeg's libraries write one kind of file.

    Attributes:
        container: FFmpeg's name of the file format.
        codec: FFmpeg's name of the encoder.
        pixels: pixel format of opaque frames.
        alpha_pixels: pixel format of frames with alpha; None where the format has no alpha.
        mixes_neighbours: colours of neighbours are mixed, whatever their alpha.
        options: of the encoder.
        alpha_options: of the encoder, in addition, for frames with alpha.
        exact_options: of the encoder, in addition, where colours shall stay as they are.
        container_options: of the file format.
        longest_side: largest width and height that it holds [px].
    """

    container: str
    codec: str
    pixels: str
    alpha_pixels: str | None = None
    mixes_neighbours: bool = False
    options: dict[str, str] = field(default_factory=dict)
    alpha_options: dict[str, str] = field(default_factory=dict)
    exact_options: dict[str, str] = field(default_factory=dict)
    container_options: dict[str, str] = field(default_factory=dict)
    longest_side: int = 65_535


FORMATS = {
    ".mp4": ContainerFormat(
        "mp4",
        "libx264",
        "yuv420p",
        options={"crf": "17", "preset": "medium", "tune": "animation"},
        # The index stands in front, so that a browser starts to play before it has everything.
        container_options={"movflags": "+faststart"},
        longest_side=16_384,
    ),
    ".webm": ContainerFormat(
        "webm",
        "libvpx-vp9",
        "yuv420p",
        "yuva420p",
        mixes_neighbours=True,
        options={"crf": "22", "b": "0", "cpu-used": "3", "row-mt": "1"},
        # Alternate reference frames and alpha exclude each other in libvpx.
        alpha_options={"auto-alt-ref": "0"},
    ),
    ".gif": ContainerFormat("gif", "gif", "pal8", "pal8", container_options={"loop": "0"}),
    ".webp": ContainerFormat(
        "webp",
        "libwebp_anim",
        "bgra",
        "bgra",
        mixes_neighbours=True,
        options={"quality": "90"},
        exact_options={"lossless": "1"},
        container_options={"loop": "0"},
        longest_side=16_383,
    ),
    ".apng": ContainerFormat("apng", "apng", "rgb24", "rgba", container_options={"plays": "0"}),
}

_LOOKAHEAD = 40  # frames that x264 holds to choose between them, with the preset
_LOOKAHEAD_PIXELS = 150_000_000  # of these frames together: it takes three bytes and more for each
_BT709 = 1
_LIMITED_RANGE = 1


def check_output(
    path: StrPath, *, alpha: bool = False, size: tuple[int, int] | None = None, coming: Collection[Path] = ()
) -> Path:
    """Refuse a place that :func:`write_animation` could not write to, before any long work.

    Args:
        path: a file ending in one of ``FORMATS``, or a folder ending in ``/``.
        alpha: whether the frames will have an alpha channel.
        size: width and height of the frames [px], where they are known.
        coming: see :func:`~physanimator.rendering.files.check_file_place`.

    Returns:
        Where the file or folder really comes to lie.

    Raises:
        InvalidInputError: the ending is unknown, the format has no alpha or holds no frames of that size, nothing can
            be written there, or the folder holds frames that :func:`write_animation` did not write.
    """
    if is_folder_name(path):
        return check_frame_folder(path, coming=coming)
    suffix, kinds = suffix_of(path), ", ".join(FORMATS)
    if os.path.isdir(place_of(path)):
        raise InvalidInputError(f"output must end in '/' to fill the folder with numbered pictures. Got: {path}")
    if suffix not in FORMATS:
        raise InvalidInputError(f"output must end in {kinds}, or in '/' for a folder of pictures. Got: {path}")
    chosen = FORMATS[suffix]
    if alpha and chosen.alpha_pixels is None:
        able = ", ".join(suffix for suffix, each in FORMATS.items() if each.alpha_pixels)
        raise InvalidInputError(f"output with transparency must end in {able}, or in '/'. Got: {path}")
    if size is not None and max(size) > chosen.longest_side:
        raise InvalidInputError(
            f"frames in {suffix} must be at most {chosen.longest_side} px on a side. Got: {size[0]} x {size[1]} px"
        )
    _check_encoder(chosen)
    return check_file_place(path, coming=coming)


def check_frame_rate(frame_rate: float | Fraction) -> None:
    """Refuse a frame rate that the formats cannot hold, before any long work.

    Raises:
        InvalidInputError: it is no number from ``FRAME_RATES``.
    """
    slowest, fastest = FRAME_RATES
    number = isinstance(frame_rate, numbers.Real) and not isinstance(frame_rate, bool | np.bool_)
    held = number and math.isfinite(frame_rate) and slowest <= frame_rate <= fastest
    require("frame_rate", frame_rate, held, f"a number from {slowest:g} to {fastest:g} frames a second")


def holds_alpha(path: StrPath) -> bool:
    """Whether what :func:`write_animation` writes there can be transparent.

    Args:
        path: a file ending in one of ``FORMATS``, or a folder ending in ``/``.
    """
    chosen = None if is_folder_name(path) else FORMATS.get(suffix_of(path))
    return is_folder_name(path) or (chosen is not None and chosen.alpha_pixels is not None)


def write_animation(
    frames: Iterable[NDArray[Any]], path: StrPath, frame_rate: float | Fraction, *, exact: bool = False
) -> None:
    """Write frames as they come; the file or folder appears only when it is complete.

    A file of the same name is replaced at the end; in a folder the numbered frames of an earlier clip are, if this
    function wrote them and nobody has changed them since. A video of odd width or height gets its last column or row
    twice, because H.264 needs even sizes.

    Args:
        frames: RGB, RGBA or grey pictures of one size, uint8 or 0..1 float, shape [h, w, 3], [h, w, 4] or [h, w].
            Alpha is straight, not premultiplied.
        path: a file ending in one of ``FORMATS``, or a folder ending in ``/`` for ``frame_0000.png`` and so on.
        frame_rate: frames a second; 23.976, 29.97 and 59.94 are taken as the exact rates so called.
        exact: for pixel art: colours as they are wherever the format can hold them; a GIF of up to 255 colours and
            animated WebP can.

    Raises:
        InvalidInputError: see :func:`check_output`; or there is no frame, or they differ in size.

    Examples:
        >>> import tempfile
        >>> from pathlib import Path
        >>> import numpy as np
        >>> from physanimator.rendering.pictures import read_clip, write_animation
        >>> frames = [np.full((16, 16, 3), level, np.uint8) for level in (0, 128, 255)]
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     write_animation(frames, Path(folder, "clip.gif"), 12.0)
        ...     len(list(read_clip(Path(folder, "clip.gif"))))
        3
    """
    check_frame_rate(frame_rate)
    iterator = _uniform(frames)
    first = next(iterator, None)
    if first is None:
        raise InvalidInputError("an animation must have at least one frame. Got: none")
    check_output(path, alpha=first.shape[2] == 4, size=(first.shape[1], first.shape[0]))
    every: Iterable[NDArray[np.uint8]] = itertools.chain([first], iterator)
    if is_folder_name(path):
        write_frame_folder(every, path)
        return
    chosen = FORMATS[suffix_of(path)]
    if first.shape[2] == 4 and chosen.mixes_neighbours and not exact:
        every = map(bled, every)
    with replacing(path) as temporary:
        _encode(every, temporary, chosen, first.shape, exact_frame_rate(frame_rate), exact=exact)
        if first.shape[2] == 4 and chosen.container == "webp":
            _declare_alpha(temporary)


def _declare_alpha(path: StrPath) -> None:
    """Set the flag for transparency of an animated WebP, by which readers decide whether to look for any.

    The encoder keeps of each frame the box of what it changes. Where all of those are opaque, such as one that holds a
    rectangle, it takes the whole animation for opaque, and readers fill what lies around with the background's white.
    Source: WebP Container Specification, "Extended File Format".
    """
    with open(path, "r+b") as file:
        head = file.read(21)
        if head[:4] == b"RIFF" and head[8:16] == b"WEBPVP8X":
            file.seek(20)
            file.write(bytes([head[20] | 0x10]))


def exact_frame_rate(frame_rate: float | Fraction) -> Fraction:
    """A frame rate as a ratio; what television calls 23.976 is 24000/1001.

    Args:
        frame_rate: frames a second.
    """
    if isinstance(frame_rate, Fraction):
        return frame_rate.limit_denominator(100_000)
    for nominal in (24, 30, 48, 60, 120):
        if abs(frame_rate - nominal / 1.001) < 0.005:
            return Fraction(nominal * 1000, 1001)
    return Fraction(float(frame_rate)).limit_denominator(1000)


def _check_encoder(chosen: ContainerFormat) -> None:
    import av

    try:
        av.codec.Codec(chosen.codec, "w")
    except ValueError:
        raise InvalidInputError(
            f"output needs FFmpeg's encoder {chosen.codec}, which the installed PyAV lacks;"
            " install PyAV's own wheel: pip install --force-reinstall av"
        ) from None


def _uniform(frames: Iterable[NDArray[Any]]) -> Iterator[NDArray[np.uint8]]:
    """The frames as uint8 RGB or RGBA, each checked to be like the first."""
    shape: tuple[int, ...] | None = None
    for number, frame in enumerate(frames):
        pixels = as_uint8(frame, name=f"frame {number}")
        if pixels.ndim == 2:
            pixels = np.repeat(pixels[..., None], 3, axis=2)
        if pixels.ndim != 3 or pixels.shape[2] not in (3, 4) or pixels.size == 0:
            raise InvalidInputError(f"frame {number} must have shape [h, w, 3] or [h, w, 4]. Got: {pixels.shape}")
        shape = shape or pixels.shape
        if pixels.shape != shape:
            raise InvalidInputError(f"frame {number} must have the shape of the first, {shape}. Got: {pixels.shape}")
        yield np.ascontiguousarray(pixels)


def _encode(
    frames: Iterable[NDArray[np.uint8]],
    path: Path,
    chosen: ContainerFormat,
    shape: tuple[int, ...],
    rate: Fraction,
    *,
    exact: bool,
) -> None:
    import av

    try:
        _mux(frames, path, chosen, shape, rate, exact=exact)
    except av.FFmpegError as error:
        if isinstance(error, OSError):
            raise
        raise InvalidInputError(f"frames must be such that FFmpeg's {chosen.codec} takes them. Got: {error}") from error


def _mux(
    frames: Iterable[NDArray[np.uint8]],
    path: Path,
    chosen: ContainerFormat,
    shape: tuple[int, ...],
    rate: Fraction,
    *,
    exact: bool,
) -> None:
    import av

    alpha = shape[2] == 4
    even = chosen.codec == "libx264"
    height, width = (size + size % 2 if even else size for size in shape[:2])
    with av.open(str(path), "w", format=chosen.container, options=chosen.container_options) as container:
        options = chosen.options | (chosen.alpha_options if alpha else {}) | (chosen.exact_options if exact else {})
        if even:
            options |= {"rc-lookahead": str(_lookahead(width * height))}
        stream = container.add_stream(chosen.codec, rate=rate, options=options)
        stream.width, stream.height = width, height
        stream.pix_fmt = (chosen.alpha_pixels if alpha else None) or chosen.pixels
        stream.codec_context.time_base = 1 / rate
        _describe(stream)
        for frame in _converted(frames, stream.pix_fmt, rate, even=even, exact=exact, folder=path.parent):
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))


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
            yield frame.reformat(format=pixels, dst_colorspace="ITU709", dst_color_range="MPEG")
        else:
            yield frame.reformat(format=pixels)


def _numbered(frames: Iterable[NDArray[np.uint8]], rate: Fraction, *, even: bool) -> Iterator[av.VideoFrame]:
    import av

    for index, pixels in enumerate(frames):
        height, width, channels = pixels.shape
        if even and (height % 2 or width % 2):
            pixels = np.pad(pixels, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
        frame = av.VideoFrame.from_ndarray(pixels, format="rgba" if channels == 4 else "rgb24")
        frame.pts, frame.time_base = index, 1 / rate
        yield frame
