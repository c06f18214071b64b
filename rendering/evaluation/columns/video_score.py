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
    """Looks at 16 frames at most, in the size that their system gave them."""

    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        assert weights.video_score is not None  # else the columns are missing
        self._clip = clip
        self._model = _loaded(weights.video_score, weights.device)

    def add(self, frame: NDArray[np.uint8]) -> None:
        """Those of the picture's size are not looked at."""

    def values(self) -> Mapping[str, float | None]:
        from ...metrics.learned.videoscore import frames_looked_at

        chosen = set(frames_looked_at(len(self._clip.frames), self._clip.rate))
        kept = [frame for number, frame in enumerate(self._clip.frames) if number in chosen]
        grades = self._model.grades(kept, self._clip.description)
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
