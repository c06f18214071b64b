"""A picture of a data folder: clips that are kept with their sketches, clips that are not and why, and histograms."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.checks import check_whole
from ...physics.errors import InvalidInputError
from ...physics.progress import Progress
from ..pictures import read_clip
from .data_folder import ClipRecord, clip_file, sketch_file
from .histograms import BLACK, GREY, WHITE, histogram, write
from .source_videos import frame_at

__all__ = ["contact_sheet"]

Picture = NDArray[np.uint8]

_COLUMNS, _TILE, _GAP, _LINE = 6, 192, 8, 16
_MOST = 600


def contact_sheet(
    data: Path, records: Sequence[ClipRecord], *, most: int = 24, progress: Progress | None = None
) -> Picture:
    """Draw what is in a data folder.

    Args:
        data: the folder.
        records: its clips, each once.
        most: kept clips that are shown, evenly spread; of the others half as many.
        progress: called after each clip; may raise to stop.

    Returns:
        RGB, uint8, shape [h, w, 3].

    Raises:
        InvalidInputError: ``most`` is out of range.
    """
    check_whole("clips", most, 1, _MOST)
    kept = [each for each in records if each.kept]
    dropped = [each for each in records if not each.kept]
    shown, others = _spread(kept, most), _spread(dropped, max(1, most // 2))
    tiles: list[Picture] = []
    other_tiles: list[Picture] = []
    for number, record in enumerate([*shown, *others], start=1):
        (tiles if record.kept else other_tiles).append(_kept_tile(data, record) if record.kept else _tile(record))
        if progress is not None:
            progress(number, len(shown) + len(others))
    wide = _COLUMNS * (_TILE + _GAP) + _GAP
    parts = [_heading(f"kept: {len(kept)} clips{_of_them(shown, kept)}, with their sketches", wide), _grid(tiles, wide)]
    parts += [_heading(f"dropped: {len(dropped)} clips{_of_them(others, dropped)}", wide), _grid(other_tiles, wide)]
    parts += [
        _heading("kept (blue) and dropped (grey) clips by", wide),
        _grid(
            [
                histogram("dynamics score", _values(kept, "score"), _values(dropped, "score"), least=1.0),
                histogram("frames", _values(kept, "frames"), _values(dropped, "frames")),
                histogram("frames a second", _values(kept, "fps"), _values(dropped, "fps")),
            ],
            wide,
        ),
    ]
    return np.concatenate(parts)


def _values(records: Sequence[ClipRecord], name: str) -> list[float]:
    return [float(getattr(each, name)) for each in records if each.frames]


def _of_them(shown: Sequence[ClipRecord], every: Sequence[ClipRecord]) -> str:
    return "" if len(shown) == len(every) else f", {len(shown)} of them here"


def _spread(records: Sequence[ClipRecord], most: int) -> list[ClipRecord]:
    if len(records) <= most:
        return list(records)
    return [records[round(number * (len(records) - 1) / max(1, most - 1))] for number in range(most)]


def _kept_tile(data: Path, record: ClipRecord) -> Picture:
    pictures = [_middle(file(data, record.name), record.frames // 2) for file in (clip_file, sketch_file)]
    told = f"{record.score:.3f}  {record.frames} fr  {record.fps:g} fps"
    return np.concatenate([*map(_fitted, pictures), _words(record.name), _words(told)])


def _tile(record: ClipRecord) -> Picture:
    try:
        picture = frame_at(Path(record.source), (record.start + record.end) / 2)
    except InvalidInputError:  # the video has gone since
        picture = None
    told = f"{record.score:.3f}  {record.frames} fr"
    return np.concatenate([_fitted(picture), _words(told), _words(record.why)])


def _middle(file: Path, number: int) -> Picture | None:
    try:
        return next(islice(read_clip(file), number, None), None)
    except InvalidInputError:
        return None


def _fitted(picture: Picture | None) -> Picture:
    """A picture as wide as a tile, or a cross where there is none."""
    if picture is None:
        empty = np.full((_TILE * 9 // 16, _TILE, 3), 235, np.uint8)
        cv2.line(empty, (0, 0), (_TILE - 1, len(empty) - 1), GREY, 1)
        cv2.line(empty, (0, len(empty) - 1), (_TILE - 1, 0), GREY, 1)
        return empty
    height = min(2 * _TILE, max(1, round(picture.shape[0] * _TILE / picture.shape[1])))
    return np.asarray(cv2.resize(picture, (_TILE, height), interpolation=cv2.INTER_AREA))


def _words(text: str) -> Picture:
    line = np.full((_LINE, _TILE, 3), WHITE, np.uint8)
    write(line, text, (0, 12), BLACK)
    return line


def _heading(text: str, wide: int) -> Picture:
    line = np.full((30, wide, 3), WHITE, np.uint8)
    write(line, text, (_GAP, 20), BLACK, scale=0.55)
    return line


def _grid(tiles: Sequence[Picture], wide: int) -> Picture:
    """Tiles in rows, each row as high as its highest tile."""
    rows = [np.full((_GAP, wide, 3), WHITE, np.uint8)]
    left: list[Picture] = list(tiles)
    while left:
        row: list[tuple[int, Picture]] = []
        x = 0
        while left and (not row or x + left[0].shape[1] + 2 * _GAP <= wide):
            tile = left.pop(0)
            row.append((x + _GAP, tile))
            x += tile.shape[1] + _GAP
        canvas = np.full((max(len(tile) for _, tile in row) + _GAP, wide, 3), WHITE, np.uint8)
        for x, tile in row:
            canvas[: len(tile), x : x + tile.shape[1]] = tile[:, : wide - x]
        rows.append(canvas)
    return np.concatenate(rows)
