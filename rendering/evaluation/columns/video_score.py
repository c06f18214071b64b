"""VideoScore's four grades that the paper reports; the fifth asks how well a clip fits a text, which nobody gave."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

if TYPE_CHECKING:
    from ...metrics.learned.videoscore import VideoScore

__all__ = ["VIDEO_SCORES"]

_KEYS = {
    "vsvq": "visual_quality",
    "vstc": "temporal_consistency",
    "vsdd": "dynamic_degree",
    "vsfc": "factual_consistency",
}


class _Grades:
    """Keeps the 16 frames at most that are looked at, and grades them at the end."""

    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        from ...metrics.learned.videoscore import frames_looked_at

        assert weights.video_score is not None  # else the columns are missing
        self._model = _loaded(weights.video_score, weights.device)
        self._description = clip.description
        self._chosen = set(frames_looked_at(len(clip.frames), clip.rate))
        self._number, self._kept = 0, list[NDArray[np.uint8]]()

    def add(self, frame: NDArray[np.uint8]) -> None:
        if self._number in self._chosen:
            self._kept.append(frame)
        self._number += 1

    def values(self) -> Mapping[str, float | None]:
        grades = self._model.grades(self._kept, self._description)
        return {key: grades[name] for key, name in _KEYS.items()}


@lru_cache(maxsize=1)
def _loaded(folder: Path, device: str) -> VideoScore:
    from ...metrics.learned.videoscore import VideoScore
    from ...neural.devices import device_of

    return VideoScore.load(folder, device_of(device))


VIDEO_SCORES = tuple(
    Column(key, title, meaning, better="higher", begin=_Grades, weights=("video_score",))
    for key, title, meaning in (
        (
            "vsvq",
            "VideoScore visual quality",
            "How clear, bright and rich in colour VideoScore finds the clip, 1 to 4.",
        ),
        ("vstc", "VideoScore temporal consistency", "How consistent and smooth VideoScore finds the clip, 1 to 4."),
        ("vsdd", "VideoScore dynamic degree", "How much VideoScore sees the clip change, 1 to 4."),
        (
            "vsfc",
            "VideoScore factual consistency",
            "How well the clip fits what VideoScore knows of the world, 1 to 4.",
        ),
    )
)
"""The question names the clip's description, on which the grades may depend: give all clips of a picture the same."""
