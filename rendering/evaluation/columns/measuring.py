"""All columns of a clip, and of all clips of a method."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from ....physics.progress import Progress
from .clip import ClipOfPicture
from .column import Column, Missing
from .statistics import Summary
from .table import COLUMNS
from .weights import NO_WEIGHTS, WANTED, ColumnWeights

__all__ = ["clip_values", "method_values"]


def clip_values(
    clip: ClipOfPicture,
    columns: Sequence[Column] = COLUMNS,
    weights: ColumnWeights = NO_WEIGHTS,
    *,
    progress: Progress | None = None,
) -> dict[str, float | Missing | None]:
    """The values of a clip, from one pass over its frames; networks are loaded once a process.

    Args:
        clip: what to measure.
        columns: those whose values belong to a clip are measured, the others left out.
        weights: of the columns that need some.
        progress: called after each frame; may raise to stop.

    Returns:
        By the columns' keys: a value, None where the clip does not allow one, or what is missing.

    Raises:
        InvalidInputError: frames or sketches do not fit, or weights are damaged.
    """
    wanted = [column for column in columns if column.begin is not None]
    found: dict[str, float | Missing | None] = {column.key: _missing(column, weights) for column in wanted}
    begins = dict.fromkeys(column.begin for column in wanted if found[column.key] is None)
    measurements = [begin(clip, weights) for begin in begins if begin is not None]
    count = len(clip.frames)
    for done, frame in enumerate(clip.sized_frames(), start=1):
        for measurement in measurements:
            measurement.add(frame)
        if progress is not None:
            progress(done, count)
    for measurement in measurements:
        found |= {key: value for key, value in measurement.values().items() if key in found}
    return found


def method_values(
    clips: Collection[ClipOfPicture],
    columns: Sequence[Column] = COLUMNS,
    weights: ColumnWeights = NO_WEIGHTS,
    *,
    progress: Progress | None = None,
) -> dict[str, Summary | Missing | None]:
    """The values that only all clips of a method have together.

    Args:
        clips: all samples of all pictures; read in turn, once for each such column.
        columns: those whose values belong to a method are measured, the others left out.
        weights: of the columns that need some.
        progress: called after each clip; may raise to stop.

    Returns:
        By the columns' keys: a value with its interval over pictures, None where the clips do not allow one, or what
        is missing.

    Raises:
        InvalidInputError: frames do not fit, or weights are damaged.
    """
    found: dict[str, Summary | Missing | None] = {}
    for column in columns:
        if column.compare is not None:
            missing = _missing(column, weights)
            found[column.key] = missing if missing is not None else column.compare(_counted(clips, progress), weights)
    return found


def _counted(clips: Collection[ClipOfPicture], progress: Progress | None) -> Iterator[ClipOfPicture]:
    for done, clip in enumerate(clips, start=1):
        yield clip
        if progress is not None:
            progress(done, len(clips))


def _missing(column: Column, weights: ColumnWeights) -> Missing | None:
    for key in column.weights:
        if weights.place(key) is None:
            wanted = WANTED[key]
            return Missing(wanted.name, wanted.missing(f"weights.{key}"))
    return None
