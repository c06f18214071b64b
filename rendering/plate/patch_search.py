"""The search for the patches that a hole is filled with (PatchMatch)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

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
# Cost of a match of the other kind.
_OTHER_KIND = 0.1
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
        wanted: where of that patches are to be found, shape [h, w].
        guide: smooth colours for the hole, shape [h, w, 3].
        smooth: the picture as blurred as the guide, shape [h, w, 3].
        kind: 0..1, shape [h, w]: patches are of one kind if they have the same. None: all are.
    """

    picture: FloatImage
    hole: Mask
    wanted: Mask
    guide: FloatImage
    smooth: FloatImage
    kind: FloatImage | None = None

    @cached_property
    def unknown(self) -> IndexArray:
        """Flat indices of the pixels that are wanted, shape [n]."""
        return np.flatnonzero(self.wanted)

    def halved(self) -> Level:
        """Half the size; a pixel is known if most of it was."""
        size = (self.hole.shape[1] + 1) // 2, (self.hole.shape[0] + 1) // 2
        weight = (~self.hole).astype(np.float32)
        known = cv2.resize(weight, size, interpolation=cv2.INTER_AREA)
        total = cv2.resize(self.picture * weight[..., None], size, interpolation=cv2.INTER_AREA)
        guide, smooth = (cv2.resize(image, size, interpolation=cv2.INTER_AREA) for image in (self.guide, self.smooth))
        hole = known < 0.6
        wanted = hole & (cv2.resize(self.wanted.astype(np.float32), size, interpolation=cv2.INTER_AREA) > 0)
        kind = None if self.kind is None else cv2.resize(self.kind, size, interpolation=cv2.INTER_AREA)
        return Level(total / np.maximum(known, 1e-6)[..., None], hole, wanted, guide, smooth, kind)


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
    """Nearest neighbours of the patches that touch what is wanted of the hole, at one level."""

    def __init__(self, level: Level, finds: Finds | None, random: np.random.Generator) -> None:
        self.level, self.random = level, random
        self.shape = level.hole.shape
        self.usable = usable_sources(level.hole).reshape(-1)
        self.targets = np.flatnonzero(cv2.dilate(level.wanted.astype(np.uint8), _SQUARE))
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
        self.features = np.zeros((self.usable.size, _COMPONENTS + 3 + (level.kind is not None)), dtype=np.float32)
        self.features[sources] = self._described(patches, level.smooth, sources)
        depth = cv2.distanceTransform(level.hole.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)
        self.fading = (_FADING ** -depth.reshape(-1)[self.targets]).astype(np.float32)
        steps = list(self._neighbours())
        self.near = [self._away(step, 1) for step in steps]
        self.far = [self._away(step, stride) for stride in (4, 2) for step in steps]

    def round(self, current: FloatImage) -> Finds:
        """Match all patches of the current fill."""
        self.wanted = self._described(_patches(current, self.targets), self.level.guide, self.targets)
        self.cost = self._differing(self.source, np.arange(len(self.targets))) + self._aside(self.source)
        for sweep in range(_SWEEPS):
            for other, moved in self.near if sweep else self.far + self.near:
                self._propagate(other, moved)
            self._guess()
        # As in Wexler et al.: the squared spread of the weights is the 75th percentile of all costs.
        scale = 2 * np.percentile(self.cost, 75) + 1e-9
        trust = np.zeros(self.usable.size, dtype=np.float32)
        trust[self.targets] = np.exp(-self.cost / scale) * self.fading
        source = np.zeros(self.usable.size, dtype=np.int64)
        source[self.targets] = self.source
        return Finds(source.reshape(self.shape), trust.reshape(self.shape))

    def _described(self, patches: FloatImage, smooth: FloatImage, at: IndexArray) -> FloatImage:
        """What patches are compared by, shape [n, features]; overwrites them."""
        weight = np.float32(np.sqrt(_GUIDE_WEIGHT) * _SIDE)
        patches -= self.mean
        features = [patches @ self.axes, smooth.reshape(-1, 3)[at] * weight]
        if self.level.kind is not None:
            features.append(self.level.kind.reshape(-1, 1)[at] * np.float32(np.sqrt(_OTHER_KIND)))
        return np.concatenate(features, axis=1)

    def _differing(self, source: IndexArray, of: IndexArray) -> FloatImage:
        """How much patches differ from those of some targets, given by their numbers."""
        difference = self.features.take(source, axis=0)
        difference -= self.wanted.take(of, axis=0)
        return np.asarray(np.einsum("ij,ij->i", difference, difference))

    def _aside(self, source: IndexArray, of: IndexArray | None = None) -> FloatImage:
        """What it costs that matches lie away from some targets, given by their numbers, or from all."""
        row = source // self.shape[1]
        column = source - row * self.shape[1]
        row -= self.row if of is None else self.row.take(of)
        column -= self.column if of is None else self.column.take(of)
        return _cost_of_distance(row, column)

    def _neighbours(self) -> Iterator[IndexArray]:
        """Number of the target to the right, below, left, above of each, or its own where there is none."""
        number = np.full(self.shape, -1, dtype=np.int64)
        number[self.row, self.column] = np.arange(len(self.targets))
        for down, right in ((0, 1), (1, 0), (0, -1), (-1, 0)):
            row = np.clip(self.row + down, 0, self.shape[0] - 1)
            column = np.clip(self.column + right, 0, self.shape[1] - 1)
            beside = number[row, column]
            yield np.where(beside < 0, np.arange(len(self.targets)), beside)

    def _away(self, neighbour: IndexArray, stride: int) -> tuple[IndexArray, IndexArray]:
        """Numbers of the targets some steps away, and how far away that is as a difference of flat indices."""
        other = neighbour
        for _ in range(stride - 1):
            other = neighbour[other]
        return other, self.targets[other] - self.targets

    def _propagate(self, other: IndexArray, moved: IndexArray) -> None:
        """Try the finds of the targets some steps away, moved back by as much; mostly they have been found already."""
        source = self.source.take(other)
        source -= moved
        new = (source != self.source).nonzero()[0]
        source = source.take(new)
        self._try(source, new, self._aside(source, new))

    def _guess(self) -> None:
        """Try random sources around the present ones, ever closer."""
        radius = max(self.shape) / 2
        while radius >= 1:
            row = self.source // self.shape[1]
            column = self.source - row * self.shape[1]
            shift = np.rint(self.random.uniform(-radius, radius, (2, len(row)))).astype(np.int64)
            for place, along, length in zip((row, column), shift, self.shape, strict=True):
                place += along
                np.minimum(np.maximum(place, RADIUS, out=place), length - 1 - RADIUS, out=place)
            aside = _cost_of_distance(row - self.row, column - self.column)
            row *= self.shape[1]
            row += column
            self._try(row, None, aside)
            radius /= 2.5  # PatchMatch halves it; this needs a quarter fewer guesses

    def _try(self, source: IndexArray, of: IndexArray | None, aside: FloatImage) -> None:
        """Take other sources where they match better.

        Args:
            source: flat indices, which may lie beyond the picture, whose corners are never usable.
            of: numbers of the targets they are for; None for all.
            aside: what their distance costs. Most cost more by that alone than what has been found.
        """
        likely = aside < (self.cost if of is None else self.cost.take(of))
        likely &= self.usable.take(source, mode="clip")
        tried = likely.nonzero()[0]
        source, of = source.take(tried), tried if of is None else of.take(tried)
        cost = self._differing(source, of)
        cost += aside.take(tried)
        better = (cost < self.cost.take(of)).nonzero()[0]
        improved = of.take(better)
        self.source[improved], self.cost[improved] = source.take(better), cost.take(better)


def _cost_of_distance(down: IndexArray, right: IndexArray) -> FloatImage:
    """What it costs that a match lies that far away [px]; overwrites both."""
    down *= down
    right *= right
    down += right
    return np.float32(_NEARNESS) * down.astype(np.float32)


def _patches(picture: FloatImage, at: IndexArray) -> FloatImage:
    """The patch around each pixel, one row each, shape [n, 3 * side^2]."""
    height, width = picture.shape[:2]
    padded = cv2.copyMakeBorder(picture, *[RADIUS] * 4, cv2.BORDER_REFLECT_101)
    # Each row of a patch lies in one piece.
    down, right, channel = padded.strides
    rows = np.ndarray((height, width, _SIDE, 3 * _SIDE), padded.dtype, padded, strides=(down, right, down, channel))
    row = at // width
    return rows[row, at - row * width].reshape(len(at), -1)
