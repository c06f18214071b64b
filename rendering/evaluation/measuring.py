"""The measures of a clip that is on disk."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.progress import Progress
from .clip_files import KeptClip
from .columns import COLUMNS, ClipOfPicture, Column, ColumnWeights, Missing, clip_values
from .evaluation_set import EvaluationSet, PictureOfSet
from .loaded_pictures import loaded
from .methods import Method
from .motions import reference_of

__all__ = ["as_json", "clip_of", "measured_clip"]


def clip_of(which: EvaluationSet, picture: PictureOfSet, sample: int, method: Method, kept: KeptClip) -> ClipOfPicture:
    """A clip as the columns see it.

    All clips of a picture are measured by its true masks; those of other systems along our motion only where it is
    said that they follow it.

    Raises:
        InvalidInputError: the picture cannot be read any more.
    """
    shown = loaded(picture, which.size).flat
    truth = reference_of(which, picture, sample, contact=method.contact)
    known: dict[str, Any] = {}
    if not method.clips or (method.follows and len(kept) <= len(truth)):
        known = {"motion": truth.shown_motion, "sketches": _Sketches(truth, len(kept))}
    return ClipOfPicture(
        kept,
        kept.rate,
        shown,
        moving=_moving(which, picture, sample),
        loops=truth.scene.loop is not None and len(kept) == len(truth),
        description=picture.description,
        **known,
    )


@dataclass(frozen=True)
class _Sketches:
    """The drawings of an animation's first frames, as often as they are asked for."""

    animation: Any
    count: int

    def __iter__(self) -> Any:
        return (each for each, _ in zip(self.animation.sketches(), range(self.count), strict=False))


@lru_cache(maxsize=2)
def _moving(which: EvaluationSet, picture: PictureOfSet, sample: int) -> NDArray[np.bool_]:
    """Where a part comes in any frame of a sample, by the true masks, shape [h, w]."""
    truth = reference_of(which, picture, sample)
    renderer = truth.renderer
    found = np.zeros((truth.motion.height, truth.motion.width), dtype=bool)
    for mask in truth.masks:
        found |= np.asarray(mask) > 0
    for t in truth.shown:
        found |= renderer.alpha(t) > 0
    return found


def measured_clip(
    which: EvaluationSet,
    picture: PictureOfSet,
    sample: int,
    method: Method,
    kept: KeptClip,
    weights: ColumnWeights,
    *,
    columns: Sequence[Column] = COLUMNS,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """The values of a clip by column, as a JSON value: a number, None, or ``{"missing": file, "why": sentence}``.

    Raises:
        InvalidInputError: the clip does not fit its picture.
    """
    found = clip_values(clip_of(which, picture, sample, method, kept), columns, weights, progress=progress)
    return {key: as_json(value) for key, value in found.items()}


def as_json(value: Any) -> Any:
    """A value of a column as a JSON value."""
    if isinstance(value, Missing):
        return {"missing": value.name, "why": value.sentence}
    return None if value is None or not np.isfinite(value) else float(value)
