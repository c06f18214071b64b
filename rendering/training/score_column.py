"""Dynamics scores that an index of videos brings along, instead of our own."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from ...physics.errors import InvalidInputError, require
from ..files import check_regular

__all__ = ["ScoredSpan", "read_scores", "score_between"]

FILE_COLUMNS = ("file", "filename", "file_name", "path", "video", "identifier", "name")
"""Columns that name a row's video; the first that is there is taken."""

_STARTS, _ENDS = ("start", "start_time", "begin"), ("end", "end_time")
_LONGEST_LINE = 1 << 20
_MOST_ROWS = 50_000_000


@dataclass(frozen=True)
class ScoredSpan:
    """A score of a part of a video.

    Attributes:
        start, end: of the part [s].
        score: as the index has it.
    """

    start: float
    end: float
    score: float


def read_scores(index: Path, column: str, videos: Sequence[Path]) -> dict[Path, list[ScoredSpan]]:
    """The scores of these videos.

    A row belongs to the video whose path ends in what it names, or whose name without ending is that. Where it also
    has ``start`` and ``end`` [s], its score is of that part alone.

    Args:
        index: a CSV file with a head line, UTF-8.
        column: name of the column of scores.
        videos: whose rows are kept; the others cost no memory.

    Raises:
        InvalidInputError: the file is unreadable, or lacks the column or one of ``FILE_COLUMNS``.
    """
    check_regular(index, "index")
    if not index.is_file():
        raise InvalidInputError(f"index must be a CSV file. Got: {index}, which is none")
    by_name: dict[str, list[Path]] = {}
    for video in videos:
        for name in (video.name, video.stem):
            by_name.setdefault(name, []).append(video)
    found: dict[Path, list[ScoredSpan]] = {}
    try:
        with index.open(encoding="utf-8-sig", newline="") as opened:
            rows = csv.DictReader(_lines(opened, index))
            names = _columns(rows.fieldnames or (), column, index)
            for number, row in enumerate(rows, start=1):
                require("index", f"{number} rows", number <= _MOST_ROWS, f"of at most {_MOST_ROWS} rows")
                for video in _videos_of(str(row.get(names["file"]) or ""), by_name):
                    if (span := _span(row, names)) is not None:
                        found.setdefault(video, []).append(span)
    except (UnicodeDecodeError, csv.Error, OSError) as error:
        raise InvalidInputError(f"index must be a readable CSV file. Got: {index}: {error}") from None
    return found


def score_between(spans: Sequence[ScoredSpan], start: float, end: float) -> float | None:
    """The score of the span that has most in common with a clip; None where none has anything."""
    shared = [(min(end, span.end) - max(start, span.start), span.score) for span in spans]
    best = max(shared, key=lambda each: each[0], default=(0.0, 0.0))
    return best[1] if best[0] > 0 else None


def _lines(opened: IO[str], index: Path) -> Iterator[str]:
    while line := opened.readline(_LONGEST_LINE + 1):
        require("index", f"a longer one in {index}", len(line) <= _LONGEST_LINE, f"of lines up to {_LONGEST_LINE}")
        yield line


def _columns(names: Sequence[str], column: str, index: Path) -> dict[str, str]:
    listed = ", ".join(names)[:200]
    if column not in names:
        raise InvalidInputError(f"score_column must be a column of {index}. Got: {column!r:.60}, not in {listed}")
    by_lower = {name.lower(): name for name in names}
    chosen = {"score": column}
    for what, known in (("file", FILE_COLUMNS), ("start", _STARTS), ("end", _ENDS)):
        if name := next((by_lower[each] for each in known if each in by_lower), None):
            chosen[what] = name
    if "file" not in chosen:
        raise InvalidInputError(f"index must have a column {' or '.join(FILE_COLUMNS)}. Got: {listed}")
    return chosen


def _videos_of(told: str, by_name: Mapping[str, Sequence[Path]]) -> Iterator[Path]:
    parts = [part for part in told.replace("\\", "/").split("/") if part not in ("", ".")]
    for video in dict.fromkeys(by_name.get(parts[-1], ()) if parts else ()):
        folders = video.absolute().parts[:-1]
        if len(parts) == 1 or folders[-(len(parts) - 1) :] == tuple(parts[:-1]):
            yield video


def _span(row: Mapping[str, str], names: Mapping[str, str]) -> ScoredSpan | None:
    try:
        score = float(row[names["score"]])
        start = float(row[names["start"]]) if "start" in names else 0.0
        end = float(row[names["end"]]) if "end" in names else math.inf
    except (TypeError, ValueError):  # a row without a score is as good as none
        return None
    return ScoredSpan(start, end, score) if math.isfinite(score) and end > start else None
