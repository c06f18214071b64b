"""How differently the frames look from the illustration, by a classifier's features."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...pictures import as_float
from .clip import ClipOfPicture
from .column import Column
from .weights import ColumnWeights

if TYPE_CHECKING:
    import torch

__all__ = ["LPIPS"]


class _Distance:
    def __init__(self, clip: ClipOfPicture, weights: ColumnWeights) -> None:
        from ...metrics.learned.lpips import LEAST_SIDE

        assert weights.lpips is not None  # else the column is missing
        self._distances: list[float] = []
        self._large = min(clip.picture.shape[:2]) >= LEAST_SIDE
        self._network = _loaded(weights.lpips, weights.device)
        self._of_picture = self._layers(clip.picture) if self._large else []

    def add(self, frame: NDArray[np.uint8]) -> None:
        if self._large:
            distance = self._network.distance(self._of_picture, self._layers(frame))
            self._distances.append(float(distance.item()))

    def values(self) -> Mapping[str, float | None]:
        return {LPIPS.key: float(np.mean(self._distances)) if self._distances else None}

    def _layers(self, picture: NDArray[np.uint8]) -> list[torch.Tensor]:
        import torch

        device = next(self._network.parameters()).device
        with torch.inference_mode():
            pixels = torch.from_numpy(as_float(picture)).to(device)
            layers: list[torch.Tensor] = self._network.layers(pixels.permute(2, 0, 1)[None])
            return layers


@lru_cache(maxsize=1)
def _loaded(folder: Path, device: str) -> Any:
    from ...metrics.learned.lpips import load_lpips
    from ...neural.devices import device_of

    return load_lpips(folder).to(device_of(device))


LPIPS = Column(
    "lpips",
    "LPIPS to the illustration",
    "Mean perceptual distance of the frames to the illustration; a clip that stands still has none.",
    better="lower",
    begin=_Distance,
    weights=("lpips",),
)
"""Zhang et al. (CVPR 2018), AlexNet or VGG-16 as the folder holds. Like FID it favours clips that hardly move."""
