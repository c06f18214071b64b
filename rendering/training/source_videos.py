"""Videos that clips are cut from: found in folders, told apart by their content, and decoded without trust."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.limits import MAX_PICTURE_PIXELS
from ..files import check_regular
from ..pictures import rgb_of

__all__ = ["VIDEO_SUFFIXES", "TimedFrame", "VideoFacts", "decoded", "facts_of", "frame_at", "identity_of", "videos_in"]

VIDEO_SUFFIXES = (
    ".mp4",
    ".mkv",
    ".webm",
    ".mov",
    ".avi",
    ".m4v",
    ".mpg",
    ".mpeg",
    ".ts",
    ".wmv",
    ".flv",
    ".ogv",
    ".gif",
)
"""Endings by which videos are found in folders."""

_MOST_VIDEOS = 5_000_000
_MOST_FRAMES = 10_000_000  # four days at 24 a second: a damaged file may never end
_READ = 1 << 20
_OURS = {"dataset.json", "physanimator_export.json"}


@dataclass(frozen=True, eq=False)
class TimedFrame:
    """A frame of a video.

    Attributes:
        number: from 0.
        time: since the first frame [s].
        pixels: RGB, uint8, shape [h, w, 3].
    """

    number: int
    time: float
    pixels: NDArray[np.uint8]


@dataclass(frozen=True)
class VideoFacts:
    """What a video's header says.

    Attributes:
        width, height: of the frames [px].
        pixel_aspect: width of a pixel over its height.
        fps: average frames a second.
        frames: about how many there are; 0 where it is not said.
    """

    width: int
    height: int
    pixel_aspect: float
    fps: float
    frames: int


def videos_in(paths: Sequence[Path]) -> list[Path]:
    """The videos that are named, and those in folders and their folders, by name; data folders and exports are not.

    Raises:
        InvalidInputError: a path leads to nothing, to no file, or to a folder without videos.
    """
    found: list[Path] = []
    for path in paths:
        check_regular(path, "VIDEO")
        if path.is_dir():
            inside = sorted(_inside(path))
            if not inside:
                raise InvalidInputError(f"VIDEO must be a video or a folder that holds some. Got: none in {path}")
            found += inside
        elif path.is_file():
            found.append(path)
        else:
            raise InvalidInputError(f"VIDEO must be a video or a folder that holds some. Got: no {path}")
    if len(found) > _MOST_VIDEOS:
        raise InvalidInputError(f"VIDEO must be at most {_MOST_VIDEOS} videos at once. Got: {len(found)}")
    return list({os.path.realpath(each): each for each in found}.values())


def _inside(folder: Path) -> Iterator[Path]:
    for place, folders, names in os.walk(folder):
        if _OURS & set(names):  # what was made of videos is not cut once more
            folders.clear()
            continue
        folders[:] = sorted(each for each in folders if not each.startswith("."))
        for name in names:
            if name.lower().endswith(VIDEO_SUFFIXES) and not name.startswith("."):
                yield Path(place, name)


def identity_of(path: Path) -> str:
    """What a video is known by, wherever it lies: 12 hexadecimal digits of its size, begin and end."""
    digest = hashlib.sha256()
    with path.open("rb") as opened:
        size = opened.seek(0, os.SEEK_END)
        digest.update(f"{size}:".encode())
        opened.seek(0)
        digest.update(opened.read(_READ))
        opened.seek(max(0, size - _READ))
        digest.update(opened.read(_READ))
    return digest.hexdigest()[:12]


def facts_of(path: Path) -> VideoFacts:
    """What a video's header says.

    Raises:
        InvalidInputError: it cannot be read, or its frames are larger than pictures may be.
    """
    with _opened(path) as container:
        stream = _stream(container, path)
        context = stream.codec_context
        aspect = float(stream.sample_aspect_ratio or 1) or 1.0
        fps = float(stream.average_rate or stream.guessed_rate or 24)
        told = stream.frames or round(float(container.duration or 0) / 1e6 * fps)
        return VideoFacts(context.width, context.height, aspect if 0.1 < aspect < 10 else 1.0, fps, max(0, told))


def decoded(path: Path, size: tuple[int, int] | None = None) -> Iterator[TimedFrame]:
    """Frames in turn, one at a time.

    Args:
        path: the video.
        size: width and height to which frames are made smaller as they are decoded [px]; None: as they are.

    Raises:
        InvalidInputError: it cannot be read, changes its size, or is larger than pictures may be; on the way, where it
            is damaged there.
    """
    with _opened(path) as container:
        stream = _stream(container, path)
        stream.thread_type = "AUTO"
        scaled = {} if size is None else {"width": size[0], "height": size[1], "interpolation": "AREA"}
        rate = float(stream.average_rate or stream.guessed_rate or 24)
        first_time: float | None = None
        shape = (stream.codec_context.width, stream.codec_context.height)
        for number, frame in enumerate(_frames(container, stream, path)):
            if number >= _MOST_FRAMES:
                raise InvalidInputError(f"video {path} must have at most {_MOST_FRAMES} frames. Got: more")
            if (frame.width, frame.height) != shape:
                raise InvalidInputError(f"video {path} must keep its size. Got: another from frame {number}")
            time = float(frame.time) if frame.time is not None else number / rate
            first_time = time if first_time is None else first_time
            yield TimedFrame(number, time - first_time, rgb_of(frame, **scaled))


def frame_at(path: Path, time: float) -> NDArray[np.uint8]:
    """The frame that is shown at a time, found without decoding all before it.

    Args:
        path: the video.
        time: since the first frame [s].

    Raises:
        InvalidInputError: it cannot be read, or has no frame from then on.
    """
    with _opened(path) as container:
        stream = _stream(container, path)
        begin = (container.start_time or 0) / 1e6
        with suppress(Exception):  # what cannot be searched is decoded from its start
            container.seek(int((begin + time) * 1e6))
        for frame in _frames(container, stream, path):
            if frame.time is None or frame.time >= begin + time - 1e-3:
                return rgb_of(frame)
    raise InvalidInputError(f"video {path} must have a frame at {time:g} s. Got: none")


def _frames(container: Any, stream: Any, path: Path) -> Iterator[Any]:
    frames = container.decode(stream)
    while True:
        try:
            frame = next(frames)
        except StopIteration:
            return
        except Exception as error:  # a damaged file makes FFmpeg's readers raise nearly anything
            raise InvalidInputError(f"video {path} cannot be read on: {_reason(error)}") from error
        yield frame


def _opened(path: Path) -> Any:
    import av

    check_regular(path, "video")
    try:
        # A playlist may name other places; only files are read. A colon in a relative name would be read as a protocol.
        return av.open(str(path.absolute()), options={"protocol_whitelist": "file"})
    except Exception as error:
        raise InvalidInputError(f"video {path} cannot be read: {_reason(error)}") from error


def _stream(container: Any, path: Path) -> Any:
    from ..pictures.picture_files import check_size

    if not container.streams.video:
        raise InvalidInputError(f"video {path} must have a picture track. Got: none")
    stream = container.streams.video[0]
    check_size(path, (stream.codec_context.width, stream.codec_context.height), "video")
    stream.codec_context.options = {"max_pixels": str(MAX_PICTURE_PIXELS)}  # whatever its header says
    return stream


def _reason(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error or "it is damaged")
