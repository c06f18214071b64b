"""Animations into files: MP4, WebM with alpha, GIF, animated WebP and PNG, or a folder of numbered pictures."""

from __future__ import annotations

import itertools
import os
import re
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..physics.errors import InvalidInputError, require
from .atomic import replacing
from .bleeding import bled
from .images import save_image, to_uint8

if TYPE_CHECKING:
    import av

__all__ = ["FORMATS", "VideoFormat", "check_output", "exact_frame_rate", "holds_alpha", "write_animation"]

StrPath = str | os.PathLike[str]


@dataclass(frozen=True)
class VideoFormat:
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


FORMATS = {
    ".mp4": VideoFormat(
        "mp4",
        "libx264",
        "yuv420p",
        options={"crf": "17", "preset": "medium", "tune": "animation"},
        # The index stands in front, so that a browser starts to play before it has everything.
        container_options={"movflags": "+faststart"},
    ),
    ".webm": VideoFormat(
        "webm",
        "libvpx-vp9",
        "yuv420p",
        "yuva420p",
        mixes_neighbours=True,
        options={"crf": "22", "b": "0", "cpu-used": "3", "row-mt": "1"},
        # Alternate reference frames and alpha exclude each other in libvpx.
        alpha_options={"auto-alt-ref": "0"},
    ),
    ".gif": VideoFormat("gif", "gif", "pal8", "pal8", container_options={"loop": "0"}),
    ".webp": VideoFormat(
        "webp",
        "libwebp_anim",
        "bgra",
        "bgra",
        mixes_neighbours=True,
        options={"quality": "90"},
        exact_options={"lossless": "1"},
        container_options={"loop": "0"},
    ),
    ".apng": VideoFormat("apng", "apng", "rgb24", "rgba", container_options={"plays": "0"}),
}

_FRAME_NAME = "frame_{:04d}.png"
_FRAME_PATTERN = re.compile(r"frame_\d{4,}\.png")
_BT709 = 1
_LIMITED_RANGE = 1


def check_output(path: StrPath, *, alpha: bool = False) -> None:
    """Refuse a place that :func:`write_animation` could not write to, before any long work.

    Args:
        path: a file ending in one of ``FORMATS``, or a folder ending in ``/``.
        alpha: whether the frames will have an alpha channel.

    Raises:
        InvalidInputError: the ending is unknown, the format has no alpha, or the folder is missing or read-only.
    """
    target = Path(path)
    if not _is_folder(path):
        kinds = ", ".join(FORMATS)
        if target.is_dir():
            raise InvalidInputError(f"output must end in '/' to fill the folder with numbered pictures. Got: {path}")
        if target.suffix.lower() not in FORMATS:
            raise InvalidInputError(f"output must end in {kinds}, or in '/' for a folder of pictures. Got: {path}")
        chosen = FORMATS[target.suffix.lower()]
        if alpha and chosen.alpha_pixels is None:
            able = ", ".join(suffix for suffix, each in FORMATS.items() if each.alpha_pixels)
            raise InvalidInputError(f"output with transparency must end in {able}, or in '/'. Got: {path}")
        _check_encoder(chosen)
    elif target.exists() and not target.is_dir():
        raise InvalidInputError(f"output {path} must be a folder. Got: a file")
    _check_writable(target if target.is_dir() else target.parent, path)


def holds_alpha(path: StrPath) -> bool:
    """Whether what :func:`write_animation` writes there can be transparent.

    Args:
        path: a file ending in one of ``FORMATS``, or a folder ending in ``/``.
    """
    chosen = FORMATS.get(Path(path).suffix.lower())
    return _is_folder(path) or (chosen is not None and chosen.alpha_pixels is not None)


def write_animation(
    frames: Iterable[NDArray[Any]], path: StrPath, frame_rate: float | Fraction, *, exact: bool = False
) -> None:
    """Write frames as they come; the file or folder appears only when it is complete.

    A file of the same name is replaced at the end; in a folder the numbered frames of an earlier clip are. A video
    of odd width or height gets its last column or row twice, because H.264 needs even sizes.

    Args:
        frames: RGB, RGBA or grey pictures of one size, uint8 or 0..1 float, shape [h, w, 3], [h, w, 4] or [h, w].
            Alpha is straight, not premultiplied.
        path: a file ending in one of ``FORMATS``, or a folder ending in ``/`` for ``frame_0000.png`` and so on.
        frame_rate: frames a second; 23.976, 29.97 and 59.94 are taken as the exact rates so called.
        exact: for pixel art: colours as they are wherever the format can hold them; a GIF of up to 255 colours and
            animated WebP can.

    Raises:
        InvalidInputError: see :func:`check_output`; or there is no frame, or they differ in size.
    """
    require("frame_rate", frame_rate, 0 < frame_rate <= 240, "above 0 and at most 240 frames a second")
    iterator = _uniform(frames)
    first = next(iterator, None)
    if first is None:
        raise InvalidInputError("an animation must have at least one frame. Got: none")
    check_output(path, alpha=first.shape[2] == 4)
    every: Iterable[NDArray[np.uint8]] = itertools.chain([first], iterator)
    if _is_folder(path):
        _write_folder(every, Path(path))
        return
    target = Path(path)
    with replacing(target) as temporary:
        chosen = FORMATS[target.suffix.lower()]
        if first.shape[2] == 4 and chosen.mixes_neighbours and not exact:
            every = map(bled, every)
        _encode(every, temporary, chosen, first.shape, exact_frame_rate(frame_rate), exact=exact)


def exact_frame_rate(frame_rate: float | Fraction) -> Fraction:
    """A frame rate as a ratio; what television calls 23.976 is 24000/1001.

    Args:
        frame_rate: frames a second.
    """
    if isinstance(frame_rate, Fraction):
        return frame_rate
    for nominal in (24, 30, 48, 60, 120):
        if abs(frame_rate - nominal / 1.001) < 0.005:
            return Fraction(nominal * 1000, 1001)
    return Fraction(frame_rate).limit_denominator(1000)


def _is_folder(path: StrPath) -> bool:
    return os.fspath(path).endswith(("/", os.sep))


def _check_encoder(chosen: VideoFormat) -> None:
    import av

    try:
        av.codec.Codec(chosen.codec, "w")
    except ValueError:
        raise InvalidInputError(
            f"output needs FFmpeg's encoder {chosen.codec}, which the installed PyAV lacks;"
            " install PyAV's own wheel: pip install --force-reinstall av"
        ) from None


def _check_writable(folder: Path, path: StrPath) -> None:
    if not folder.is_dir():
        raise InvalidInputError(f"the folder for {path} must exist. Got: no folder {folder}")
    try:
        # Asking the system for permissions is not reliable on Windows and network drives; trying is.
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise InvalidInputError(f"the folder for {path} must be writable. Got: {error.strerror}") from None


def _uniform(frames: Iterable[NDArray[Any]]) -> Iterator[NDArray[np.uint8]]:
    """The frames as uint8 RGB or RGBA, each checked to be like the first."""
    shape: tuple[int, ...] | None = None
    for number, frame in enumerate(frames):
        pixels = to_uint8(np.asarray(frame))
        if pixels.ndim == 2:
            pixels = np.repeat(pixels[..., None], 3, axis=2)
        if pixels.ndim != 3 or pixels.shape[2] not in (3, 4) or pixels.size == 0:
            raise InvalidInputError(f"frame {number} must have shape [h, w, 3] or [h, w, 4]. Got: {pixels.shape}")
        shape = shape or pixels.shape
        if pixels.shape != shape:
            raise InvalidInputError(f"frame {number} must have the shape of the first, {shape}. Got: {pixels.shape}")
        yield np.ascontiguousarray(pixels)


def _write_folder(frames: Iterable[NDArray[np.uint8]], folder: Path) -> None:
    created = not folder.exists()
    staging = folder.with_name(f".{folder.name}.partial") if created else folder / ".partial"
    shutil.rmtree(staging, ignore_errors=True)
    staging.mkdir()
    try:
        for index, frame in enumerate(frames):
            save_image(staging / _FRAME_NAME.format(index), frame)
        if created:
            staging.rename(folder)
            return
        for earlier in [entry for entry in folder.iterdir() if _FRAME_PATTERN.fullmatch(entry.name)]:
            earlier.unlink()
        for picture in sorted(staging.iterdir()):
            picture.rename(folder / picture.name)
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def _encode(
    frames: Iterable[NDArray[np.uint8]],
    path: Path,
    chosen: VideoFormat,
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
        stream = container.add_stream(chosen.codec, rate=rate, options=options)
        stream.width, stream.height = width, height
        stream.pix_fmt = (chosen.alpha_pixels if alpha else None) or chosen.pixels
        stream.codec_context.time_base = 1 / rate
        _describe(stream)
        for frame in _converted(frames, stream.pix_fmt, rate, even=even, exact=exact):
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))


def _describe(stream: av.VideoStream) -> None:
    """Tell players what the numbers mean: without the tags they guess by the picture's size."""
    if not str(stream.pix_fmt).startswith("yuv"):
        return
    context = stream.codec_context
    context.colorspace = context.color_primaries = context.color_trc = _BT709
    context.color_range = _LIMITED_RANGE


def _converted(
    frames: Iterable[NDArray[np.uint8]], pixels: str, rate: Fraction, *, even: bool, exact: bool
) -> Iterator[av.VideoFrame]:
    """Numbered frames in a stream's pixel format."""
    if pixels == "pal8":
        from .gif import paletted

        yield from paletted(_numbered(frames, rate, even=even), rate, dithered=not exact)
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
