"""How near drawn frames come to the true ones."""

from __future__ import annotations

from dataclasses import dataclass, field

import cv2
import numpy as np
from layered_truth import TrueFrame

__all__ = ["BETTER", "Scores"]

BETTER = {
    "psnr": 1,
    "ssim": 1,
    "psnr_uncovered": 1,
    "ssim_uncovered": 1,
    "edge_halo": -1,
    "flicker_uncovered": -1,
}
"""1 where more is better, -1 where less is."""

# The edge of the moved part, to both sides [px].
_EDGE = 3
_LUMINANCE = np.array([0.299, 0.587, 0.114], dtype=np.float32)
_C1, _C2 = 0.01**2, 0.03**2


@dataclass
class _Mean:
    total: float = 0.0
    count: float = 0.0

    def add(self, values: np.ndarray) -> None:
        self.total += float(values.sum(dtype=np.float64))
        self.count += values.size

    def value(self) -> float | None:
        return self.total / self.count if self.count else None


@dataclass
class Scores:
    """The scores of one method, gathered frame after frame.

    Peak signal-to-noise ratio [dB] and structural similarity (of the luminance, Gaussian window of 1.5 px) over all
    judged pixels, and over those that the part has left. ``edge_halo``: mean difference from the truth within 3 px
    of the moved part's edge [levels of 255]. ``flicker_uncovered``: by how much the step from one frame to the next
    differs from the true step, where the part has left a pixel in either of them [levels of 255].
    """

    _squares: dict[str, _Mean] = field(default_factory=lambda: {"": _Mean(), "_uncovered": _Mean()})
    _similar: dict[str, _Mean] = field(default_factory=lambda: {"": _Mean(), "_uncovered": _Mean()})
    _halo: _Mean = field(default_factory=_Mean)
    _flicker: _Mean = field(default_factory=_Mean)
    _last: tuple[np.ndarray, TrueFrame] | None = None

    def add(self, frame: np.ndarray, truth: TrueFrame) -> None:
        """Take in the next frame, float32 RGB in 0 to 1, shape [h, w, 3]."""
        # What is not judged counts for nobody, not even in the windows of the similarity.
        frame = np.where(truth.judged[..., None], frame, truth.picture)
        squares = ((frame - truth.picture) ** 2).mean(axis=2)
        similarity = _similarity(frame @ _LUMINANCE, truth.picture @ _LUMINANCE)
        for name, where in (("", truth.judged), ("_uncovered", truth.uncovered)):
            self._squares[name].add(squares[where])
            self._similar[name].add(similarity[where])
        self._halo.add(np.abs(frame - truth.picture)[_edge(truth) & truth.judged] * 255)
        if self._last is not None:
            before, true_before = self._last
            judged = truth.judged & true_before.judged & (truth.uncovered | true_before.uncovered)
            step = (frame - before) - (truth.picture - true_before.picture)
            self._flicker.add(np.abs(step)[judged] * 255)
        self._last = frame, truth

    def table(self) -> dict[str, float | None]:
        """Every score by its name; None where no pixel was ever uncovered."""
        found: dict[str, float | None] = {}
        for name, mean in self._squares.items():
            square = mean.value()
            found[f"psnr{name}"] = None if square is None else float(-10 * np.log10(max(square, 1e-12)))
            found[f"ssim{name}"] = self._similar[name].value()
        found["edge_halo"], found["flicker_uncovered"] = self._halo.value(), self._flicker.value()
        return {name: found[name] for name in BETTER}


def _edge(truth: TrueFrame) -> np.ndarray:
    inside = (truth.alpha > 0.5).astype(np.uint8)
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * _EDGE + 1,) * 2)
    return cv2.dilate(inside, disc) != cv2.erode(inside, disc)


def _similarity(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Structural similarity at each pixel (Wang et al. 2004), shape [h, w]."""

    def blurred(values: np.ndarray) -> np.ndarray:
        return cv2.GaussianBlur(values, (11, 11), 1.5)

    mean_a, mean_b = blurred(a), blurred(b)
    variance_a, variance_b = blurred(a * a) - mean_a**2, blurred(b * b) - mean_b**2
    covariance = blurred(a * b) - mean_a * mean_b
    alike = (2 * mean_a * mean_b + _C1) * (2 * covariance + _C2)
    return alike / ((mean_a**2 + mean_b**2 + _C1) * (variance_a + variance_b + _C2))
