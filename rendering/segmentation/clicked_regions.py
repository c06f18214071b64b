"""The region of a picture in which a click lies, on clean line art as well as on paint, paper grain and noise.

On clean art a region is what small steps of colour reach. On paint such a flood stays within one touch of the brush,
and over a blurred edge it leaks. So the picture is looked at in several coarsenesses: each averages away the texture
below it. The finest look that does not leak is taken, unless the next one finds a region many times larger: then the
finer one had only found a speck of the texture.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from .noise import LEAST_NOISE, noise_of, sharpness_of, without_noise

__all__ = ["Looks", "is_backdrop"]

Mask = NDArray[np.bool_]
Lab = NDArray[np.uint8]

# tests/benchmarks/thresholds.py measures half and twice of these on painted parts: _TEXTURE, _GROWTH, _SHORTEST, _LOOKS
# and _STROKES change no cut; _LARGEST_REGION, _SPREADS, _LEAST_CONTRAST and _BRIDGE decide single cuts, for better and
# for worse.

# A region that grows over more than this share of the picture has probably leaked: smaller steps are tried.
_LARGEST_REGION = 0.25
# A region of fewer pixels than the first of these may be bounded by texture, such as one touch of the brush, not by
# edges. It was, if the next coarser look finds one larger by more than the second: one halving quarters the pixels.
_TEXTURE, _GROWTH = 16, 4.0
# No look has a shorter side than this [px]; so many looks are taken, each at half the size of the one before.
_SHORTEST = 24
_LOOKS = 3
_STROKES = 7
"""Twice the width of the strokes that the coarsest look averages [px]."""
_SPREADS = (20, 16, 12, 9, 6)
"""Lightness around the click's in which a flood through texture is held, narrower where it leaks [8-bit Lab]. Light and
shade change it more than they change the two other channels, which are held to half as much."""
_LEAST_CONTRAST = 12.0
"""Where small steps lead over edges of so much contrast [8-bit Lab], they lead out of most parts."""
_BACKDROP = 0.25  # of the picture's border: a region along so much of it is what parts lie on
_BRIDGE = 5  # narrower ways than this may be of noise alone [px]


class Looks:
    """A picture in several coarsenesses, and the regions of clicks in it.

    Args:
        lab: 8-bit Lab, shape [h, w, 3].
    """

    def __init__(self, lab: Lab) -> None:
        self._lab = lab
        self._clean = cv2.bilateralFilter(lab, 5, 20, 3)
        self._sharpness = sharpness_of(lab)
        self._without: dict[float, Lab] = {}
        self._coarser: list[Lab] = []
        height, width = lab.shape[:2]
        for halvings in range(1, _LOOKS):
            size = (max(1, width >> halvings), max(1, height >> halvings))
            if min(size) < _SHORTEST:
                break
            small = cv2.resize(lab, size, interpolation=cv2.INTER_AREA)
            self._coarser.append(without_noise(small, noise_of(small)))

    def region(self, point: NDArray[np.int_], others: NDArray[np.int_], tolerance: int) -> Mask:
        """The pixels that belong to a click; none where every flood runs into a point of the other kind.

        Args:
            point: column and row of the click.
            others: columns and rows of the points of the other kind, shape [k, 2].
            tolerance: how much colour may change from pixel to pixel [8-bit Lab steps].

        Returns:
            mask, shape [h, w].
        """
        height, width = self._lab.shape[:2]
        chosen = self._finest(point, others, tolerance)
        leaked = chosen.mean() >= _LARGEST_REGION
        textured = _noise_around(self._lab, point, _STROKES) >= LEAST_NOISE
        for look in self._coarser:
            ratio = np.array([look.shape[1] / width, look.shape[0] / height])
            coarse = _held(look, (point * ratio).astype(int), (others * ratio).astype(int), tolerance)
            grown = cv2.resize(coarse.astype(np.uint8), (width, height), interpolation=cv2.INTER_NEAREST) > 0
            if grown[others[:, 1], others[:, 0]].any():
                continue
            small = chosen.sum() * (ratio.prod() if textured else 1) < _TEXTURE
            if coarse.sum() >= _TEXTURE and (leaked or (small and grown.sum() > _GROWTH * chosen.sum())):
                return grown
        return chosen

    def _finest(self, point: NDArray[np.int_], others: NDArray[np.int_], tolerance: int) -> Mask:
        noise = _noise_around(self._lab, point)
        soft = tolerance > self._sharpness * _LEAST_CONTRAST
        if noise < LEAST_NOISE:
            return (_held if soft else _flooded)(self._clean, point, others, tolerance)
        if noise not in self._without:
            self._without[noise] = without_noise(self._lab, noise)
        # The steps of noise lead anywhere: a flood that they carry stays near the click's own colour, or goes on over
        # no narrow bridges, and over smaller steps where light smoothing leaves some of the noise.
        look = self._without[noise]
        held = _held(look, point, others, tolerance)
        if soft:
            return held
        if _noise_around(self._clean, point) < LEAST_NOISE:
            return held | _broadly(_flooded(self._clean, point, others, tolerance), held)
        return held | _broadly(_flooded(look, point, others, max(1, tolerance // 2)), held)


def is_backdrop(region: Mask) -> bool:
    """Whether a region runs along so much of the picture's border that it is what parts lie on."""
    border = np.concatenate([region[0], region[-1], region[1:-1, 0], region[1:-1, -1]])
    return bool(border.mean() > _BACKDROP)


def _noise_around(lab: Lab, point: NDArray[np.int_], size: int = 3) -> float:
    # Noise is measured over a sixteenth of the picture around the click.
    reach = max(4, max(lab.shape) // 32)
    left, top = np.maximum(point - reach, 0)
    return noise_of(np.ascontiguousarray(lab[top : point[1] + reach + 1, left : point[0] + reach + 1]), size=size)


def _held(look: Lab, point: NDArray[np.int_], others: NDArray[np.int_], tolerance: int) -> Mask:
    """What small steps reach near the click's own colour; nothing where all of it leaks."""
    reached = _flooded(look, point, others, tolerance)
    for spread in _SPREADS:
        region = reached & _filled(look, point, (spread, spread // 2, spread // 2), cv2.FLOODFILL_FIXED_RANGE)
        if region.mean() < _LARGEST_REGION:
            return region
    return np.zeros(look.shape[:2], dtype=bool)


def _broadly(region: Mask, core: Mask) -> Mask:
    """The part of a region that hangs together with a core over more than narrow bridges."""
    square = np.ones((_BRIDGE, _BRIDGE), np.uint8)
    broad = cv2.erode(region.astype(np.uint8), square, borderValue=1)
    _, labels = cv2.connectedComponents(broad, connectivity=4)
    chosen = np.unique(labels[core & (broad > 0)])
    return region & (cv2.dilate(np.isin(labels, chosen[chosen > 0]).astype(np.uint8), square) > 0)


def _flooded(look: Lab, point: NDArray[np.int_], others: NDArray[np.int_], tolerance: int) -> Mask:
    """Pixels reached from a point over small steps of colour, fewer if that runs into a point of the other kind."""
    for step in range(tolerance, 0, -1):
        region = _filled(look, point, (step,) * 3, 0)
        trusted = step == 1 or region.mean() < _LARGEST_REGION
        if trusted and not region[others[:, 1], others[:, 0]].any():
            return region
    return np.zeros(look.shape[:2], dtype=bool)


def _filled(look: Lab, point: NDArray[np.int_], step: tuple[int, int, int], mode: int) -> Mask:
    height, width = look.shape[:2]
    reached = np.zeros((height + 2, width + 2), np.uint8)
    flags = 4 | cv2.FLOODFILL_MASK_ONLY | (1 << 8) | mode
    cv2.floodFill(look, reached, (int(point[0]), int(point[1])), (0, 0, 0), step, step, flags)
    return reached[1:-1, 1:-1] > 0
