"""The search for the patches that a hole is filled with (PatchMatch)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["RADIUS", "Finds", "Level", "PatchSearch", "usable_sources"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]
IndexArray = NDArray[np.int64]

RADIUS = 2
"""Patches reach this far around their centre [px]."""

_SIDE = 2 * RADIUS + 1
_SQUARE = np.ones((_SIDE, _SIDE), np.uint8)
# Patches are compared by this many of their principal components.
_COMPONENTS = 12
# The components are found from so many patches, taken at random.
_SAMPLES = 4000
# How often all finds are handed to the neighbours in a round.
_SWEEPS = 2
# Weight of a deviation from the smooth guide's colour beside that of the patch's own pixels.
_GUIDE_WEIGHT = 0.1
# Cost of a match's squared distance [1/px^2] beside the patch's squared colour difference (colours in 0 to 1).
_NEARNESS = 1e-4
# The trust in a patch fades by this factor for each pixel that it lies deeper in the hole.
_FADING = 1.2


@dataclass(frozen=True, eq=False)
class Level:
    """The picture at one scale.

    Attributes:
        picture: RGB in 0 to 1, shape [h, w, 3].
        hole: true where colours are unknown, shape [h, w].
        guide: smooth colours for the hole, shape [h, w, 3].
        smooth: the picture as blurred as the guide, shape [h, w, 3].
    """

    picture: FloatImage
    hole: Mask
    guide: FloatImage
    smooth: FloatImage

    def halved(self) -> Level:
        """Half the size; a pixel is known if most of it was."""
        size = (self.hole.shape[1] + 1) // 2, (self.hole.shape[0] + 1) // 2
        weight = (~self.hole).astype(np.float32)
        known = cv2.resize(weight, size, interpolation=cv2.INTER_AREA)
        total = cv2.resize(self.picture * weight[..., None], size, interpolation=cv2.INTER_AREA)
        guide, smooth = (cv2.resize(image, size, interpolation=cv2.INTER_AREA) for image in (self.guide, self.smooth))
        return Level(total / np.maximum(known, 1e-6)[..., None], known < 0.6, guide, smooth)


@dataclass(frozen=True, eq=False)
class Finds:
    """The best match found so far for the patch around each pixel (the nearest-neighbour field of PatchMatch).

    Attributes:
        source: flat index of the centre of the matching patch, shape [h, w].
        trust: weight of that patch in the vote, 0 where there is none, shape [h, w].
    """

    source: IndexArray
    trust: FloatImage

    def doubled(self, shape: tuple[int, ...]) -> Finds:
        """The same at twice the size."""
        row, column = np.indices(shape)
        height, width = self.source.shape
        half = np.minimum(row // 2, height - 1), np.minimum(column // 2, width - 1)
        source_row, source_column = np.divmod(self.source[half], width)
        source_row = np.clip(2 * source_row + row - 2 * half[0], RADIUS, shape[0] - 1 - RADIUS)
        source_column = np.clip(2 * source_column + column - 2 * half[1], RADIUS, shape[1] - 1 - RADIUS)
        return Finds(source_row * shape[1] + source_column, self.trust[half])


def usable_sources(hole: Mask) -> Mask:
    """Centres of patches that lie wholly in the picture and outside the hole."""
    usable = np.zeros_like(hole)
    inner = slice(RADIUS, -RADIUS)
    usable[inner, inner] = (cv2.dilate(hole.astype(np.uint8), _SQUARE) == 0)[inner, inner]
    return usable


class PatchSearch:
    """Nearest neighbours of the patches that touch the hole, at one level."""

    def __init__(self, level: Level, finds: Finds | None, random: np.random.Generator) -> None:
        self.level, self.random = level, random
        self.shape = level.hole.shape
        self.usable = usable_sources(level.hole).reshape(-1)
        self.targets = np.flatnonzero(cv2.dilate(level.hole.astype(np.uint8), _SQUARE))
        self.row, self.column = np.divmod(self.targets, self.shape[1])
        sources = np.flatnonzero(self.usable)
        self.source = random.choice(sources, len(self.targets))
        if finds is not None:
            previous = finds.source.reshape(-1)[self.targets]
            self.source = np.where(self.usable[previous], previous, self.source)
        patches = _patches(level.picture, sources)
        self.mean = patches.mean(axis=0)
        sample = patches[random.integers(0, len(patches), _SAMPLES)] - self.mean
        self.axes = np.linalg.eigh(sample.T @ sample)[1][:, -_COMPONENTS:].astype(np.float32)
        self.features = np.zeros((self.usable.size, _COMPONENTS + 3), dtype=np.float32)
        self.features[sources] = self._described(patches, level.smooth, sources)
        depth = cv2.distanceTransform(level.hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
        self.fading = (_FADING ** -depth.reshape(-1)[self.targets]).astype(np.float32)
        self.steps = list(self._neighbours())

    def round(self, current: FloatImage) -> Finds:
        """Match all patches of the current fill."""
        self.wanted = self._described(_patches(current, self.targets), self.level.guide, self.targets)
        self.cost = self._cost(self.source, np.arange(len(self.targets)))
        for sweep in range(_SWEEPS):
            for stride in (1,) if sweep else (4, 2, 1):
                for neighbour in self.steps:
                    self._propagate(neighbour, stride)
            self._guess()
        # As in Wexler et al.: the squared spread of the weights is the 75th percentile of all costs.
        scale = 2 * np.percentile(self.cost, 75) + 1e-9
        trust = np.zeros(self.usable.size, dtype=np.float32)
        trust[self.targets] = np.exp(-self.cost / scale) * self.fading
        source = np.zeros(self.usable.size, dtype=np.int64)
        source[self.targets] = self.source
        return Finds(source.reshape(self.shape), trust.reshape(self.shape))

    def _described(self, patches: FloatImage, smooth: FloatImage, at: IndexArray) -> FloatImage:
        weight = np.float32(np.sqrt(_GUIDE_WEIGHT) * _SIDE)
        return np.concatenate([(patches - self.mean) @ self.axes, smooth.reshape(-1, 3)[at] * weight], axis=1)

    def _cost(self, source: IndexArray, of: IndexArray) -> FloatImage:
        """Cost of a match for each of some targets, given by their numbers."""
        difference = self.features.take(source, axis=0)
        difference -= self.wanted.take(of, axis=0)
        row = source // self.shape[1]
        away = (row - self.row.take(of)) ** 2 + (source - row * self.shape[1] - self.column.take(of)) ** 2
        return np.einsum("ij,ij->i", difference, difference) + np.float32(_NEARNESS) * away.astype(np.float32)

    def _neighbours(self) -> Iterator[IndexArray]:
        """Number of the target to the right, below, left, above of each, or its own where there is none."""
        number = np.full(self.shape, -1, dtype=np.int64)
        number[self.row, self.column] = np.arange(len(self.targets))
        for down, right in ((0, 1), (1, 0), (0, -1), (-1, 0)):
            row = np.clip(self.row + down, 0, self.shape[0] - 1)
            column = np.clip(self.column + right, 0, self.shape[1] - 1)
            beside = number[row, column]
            yield np.where(beside < 0, np.arange(len(self.targets)), beside)

    def _propagate(self, neighbour: IndexArray, stride: int) -> None:
        """Try the finds of the targets some steps away, moved back by as much."""
        other = neighbour
        for _ in range(stride - 1):
            other = neighbour[other]
        self._try(self.source[other] - (self.targets[other] - self.targets))

    def _guess(self) -> None:
        """Try random sources around the present ones, ever closer."""
        radius = max(self.shape) / 2
        while radius >= 1:
            row = self.source // self.shape[1]
            column = self.source - row * self.shape[1]
            shift = np.rint(self.random.uniform(-radius, radius, (2, len(row)))).astype(np.int64)
            row = np.clip(row + shift[0], RADIUS, self.shape[0] - 1 - RADIUS)
            column = np.clip(column + shift[1], RADIUS, self.shape[1] - 1 - RADIUS)
            self._try(row * self.shape[1] + column)
            radius /= 2.5  # PatchMatch halves it; this needs a quarter fewer guesses

    def _try(self, source: IndexArray) -> None:
        """Take other sources where they match better; neighbours mostly propose what has been found."""
        np.clip(source, 0, self.usable.size - 1, out=source)
        other = np.flatnonzero((source != self.source) & self.usable.take(source))
        source = source.take(other)
        cost = self._cost(source, other)
        better = np.flatnonzero(cost < self.cost.take(other))
        improved = other.take(better)
        self.source[improved], self.cost[improved] = source.take(better), cost.take(better)


def _patches(picture: FloatImage, at: IndexArray) -> FloatImage:
    """The patch around each pixel, one row each, shape [n, 3 * side^2]."""
    height, width = picture.shape[:2]
    padded = cv2.copyMakeBorder(picture, *[RADIUS] * 4, cv2.BORDER_REFLECT_101)
    # Each row of a patch lies in one piece.
    down, right, channel = padded.strides
    rows = np.ndarray((height, width, _SIDE, 3 * _SIDE), padded.dtype, padded, strides=(down, right, down, channel))
    row = at // width
    return rows[row, at - row * width].reshape(len(at), -1)
