"""Animations into files: MP4, WebM and ProRes with alpha, GIF, animated WebP and PNG, or a folder of pictures."""

from __future__ import annotations

import itertools
import os
from collections.abc import Collection, Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ..files import StrPath, check_file_place, is_folder_name, place_of, replacing, suffix_of
from .bleeding import bled
from .container_formats import FORMATS, ContainerFormat
from .encoding import encode
from .frame_folder import check_frame_folder, write_frame_folder
from .frame_rates import check_frame_rate, exact_frame_rate
from .hand_over import consumed_beside
from .pixels import as_uint8

if TYPE_CHECKING:
    pass

__all__ = [
    "check_output",
    "write_animation",
]


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
        consumed_beside(every, lambda each: write_frame_folder(each, path))
        return
    chosen = FORMATS[suffix_of(path)]
    if first.shape[2] == 4 and chosen.mixes_neighbours and not exact:
        every = map(bled, every)
    with replacing(path) as temporary:
        rate = exact_frame_rate(frame_rate)
        consumed_beside(every, lambda each: encode(each, temporary, chosen, first.shape, rate, exact=exact))
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
