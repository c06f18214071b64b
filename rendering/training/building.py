"""Clips of one video: found, judged, and those that are kept written with their sketches."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.checks import check_number, check_whole
from ...physics.errors import InvalidInputError
from ..pictures import read_clip
from .clip_writing import write_clip
from .data_folder import ClipRecord, clip_file, sketch_file
from .framing import Window, framed, size_of, window_of
from .score_column import ScoredSpan, score_between
from .selection import Bounds
from .shots import Shot, shots_of
from .sketching import Sketcher
from .source_videos import TimedFrame, decoded, facts_of

__all__ = ["BuildOptions", "clips_of", "file_names", "write_sketches"]

Tick = Callable[[], None]


@dataclass(frozen=True)
class BuildOptions:
    """How clips are made.

    Attributes:
        size: width and height, such as ``512x320`` (ToonCrafter's; LVCD's is 576x320).
        fps: highest frames a second; 0: those of the video, without repeated drawings.
        longest: frames of the video in a clip; longer shots become several.
        bounds: which clips are kept.

    Raises:
        InvalidInputError: a value is out of range.
    """

    size: str = "512x320"
    fps: float = 0.0
    longest: int = 240
    bounds: Bounds = field(default_factory=Bounds)

    def __post_init__(self) -> None:
        size_of(self.size)
        check_number("fps", self.fps, 0, 240, unit=" frames/s")
        check_whole("longest", self.longest, self.bounds.least_frames, 2000)

    def as_record(self) -> dict[str, Any]:
        """What the data folder remembers."""
        told = asdict(self)
        return told | told.pop("bounds")


def file_names(source: Path, identity: str) -> str:
    """What the names of a video's clips begin with: its own name, as far as every system takes it."""
    readable = re.sub(r"[^\w-]+", "_", source.stem, flags=re.ASCII).strip("_")[:40]
    return f"{readable or 'video'}_{identity}"


def clips_of(
    source: Path,
    names: str,
    options: BuildOptions,
    *,
    data: Path | None,
    sketcher: tuple[str, Sketcher] = ("", lambda frame: frame[..., 0]),
    scores: Sequence[ScoredSpan] | None = None,
    licence: str = "",
    tick: Tick | None = None,
) -> list[ClipRecord]:
    """Find the clips of a video, and write those that are kept.

    Args:
        source: the video.
        names: see :func:`file_names`.
        options: how.
        data: the data folder; None writes nothing.
        sketcher: see :func:`~physanimator.rendering.training.sketching.sketcher_of`.
        scores: of an index, which stand instead of our own; None: our own.
        licence: for the record.
        tick: called with each frame that is read; may raise to stop.

    Returns:
        A record of every clip, and one of what could not be read.

    Raises:
        InvalidInputError: a result cannot be put in its place.
    """
    found: list[tuple[ClipRecord, Shot, Window | None]] = []
    unread: list[ClipRecord] = []
    size = size_of(options.size)

    def record(number: int, **told: Any) -> ClipRecord:
        usual: dict[str, Any] = {
            "start": 0.0,
            "end": 0.0,
            "frames": 0,
            "fps": 0.0,
            "score": 0.0,
            "kept": False,
            "licence": licence,
        }
        wide, high = size
        return ClipRecord(f"{names}_{number:04d}", str(source.absolute()), width=wide, height=high, **(usual | told))

    try:
        facts = facts_of(source)
        for number, shot in enumerate(shots_of(source, facts, longest=options.longest, fps=options.fps, tick=tick)):
            window = window_of(facts.width, facts.height, shot.box, size, pixel_aspect=facts.pixel_aspect)
            score = shot.score if scores is None else score_between(scores, shot.start, shot.end)
            why = options.bounds.why_not(len(shot.frames), score or 0.0)
            why = "no score in the index" if score is None else "smaller than half the size" if not window else why
            told: dict[str, Any] = {
                "start": round(shot.start, 4),
                "end": round(shot.end, 4),
                "frames": len(shot.frames),
            }
            told |= {"fps": round(shot.fps, 3), "score": round(score or 0.0, 6), "kept": not why, "why": why}
            found.append((record(number, sketches="" if why else sketcher[0], **told), shot, window))
    except InvalidInputError as error:
        unread.append(record(len(found), why=f"cannot be read: {error}"[:300]))
    if data is not None:
        _write(source, data, found, size, sketcher[1], tick)
    return [each for each, _, _ in found] + unread


def _write(
    source: Path,
    data: Path,
    found: Sequence[tuple[ClipRecord, Shot, Window | None]],
    size: tuple[int, int],
    sketch: Sketcher,
    tick: Tick | None,
) -> None:
    kept = [(record, shot, window) for record, shot, window in found if record.kept and window]
    frames = decoded(source) if kept else iter(())
    for record, shot, window in kept:
        pictures = (framed(each.pixels, window, size) for each in _numbered(frames, shot.frames, tick))
        write_clip(pictures, clip_file(data, record.name), record.fps)
        write_sketches(data, record, sketch, tick)


def write_sketches(data: Path, record: ClipRecord, sketch: Sketcher, tick: Tick | None = None) -> None:
    """Draw the sketches of a clip that is written."""

    def drawn() -> Iterator[NDArray[np.uint8]]:
        for frame in read_clip(clip_file(data, record.name)):
            if tick is not None:
                tick()
            yield sketch(frame)

    write_clip(drawn(), sketch_file(data, record.name), record.fps)


def _numbered(frames: Iterator[TimedFrame], numbers: Sequence[int], tick: Tick | None) -> Iterator[TimedFrame]:
    """The frames of these numbers; the iterator is left behind the last."""
    wanted = iter(numbers)
    number = next(wanted, None)
    while number is not None:
        frame = next(frames, None)
        if frame is None:
            raise InvalidInputError(f"VIDEO must stay as it is while it is read. Got: frame {number} is gone")
        if tick is not None:
            tick()
        if frame.number == number:
            yield frame
            number = next(wanted, None)
