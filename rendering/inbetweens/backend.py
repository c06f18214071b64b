"""What an in-betweening backend is: the clip it is given, the files it may need, and what it has to do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...physics.motion import Motion
from ..pictures import as_float

__all__ = ["Clip", "Interpolator", "ModelFile"]

FloatImage = NDArray[np.float32]


@dataclass(frozen=True)
class ModelFile:
    """A file that a backend cannot work without.

    Attributes:
        name: file name.
        folder: kind of model, which is the folder's name under ``models``.
        source: where people get it.
    """

    name: str
    folder: str
    source: str = ""

    def __str__(self) -> str:
        return f"models/{self.folder}/{self.name}" + (f" (from {self.source})" if self.source else "")


@dataclass(frozen=True, eq=False)
class Clip:
    """Keyframes and everything that is known about what happens between them.

    Attributes:
        keyframes: RGB, uint8 or float in 0..1, each of shape [h, w, 3]; or premultiplied RGBA, float32, [h, w, 4].
        indices: frame number of each keyframe, increasing.
        motion: positions of the bodies in every frame, if known.
        masks: soft mask of each body in the drawing, shape [h, w]; empty when unknown.
        files: path of each file that the backend requires, by its name.
        sketches: dark lines on white, one for each frame up to the last keyframe, shape [h, w] or [h, w, 3]; empty when
            there are none.
    """

    keyframes: Sequence[NDArray[Any]]
    indices: Sequence[int]
    motion: Motion | None = None
    masks: Sequence[NDArray[Any]] = ()
    files: Mapping[str, Path] = field(default_factory=dict)
    sketches: Sequence[NDArray[Any]] = ()

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the keyframes [px]."""
        height, width = self.keyframes[0].shape[:2]
        return width, height

    def keyframe(self, number: int) -> FloatImage:
        """A keyframe as float32 in 0..1."""
        return as_float(self.keyframes[number], exact=False)

    def times(self, number: int) -> list[tuple[int, float]]:
        """Frames between keyframe ``number`` and the next, each with its place between them in 0..1."""
        first, last = self.indices[number], self.indices[number + 1]
        return [(frame, (frame - first) / (last - first)) for frame in range(first + 1, last)]


class Interpolator(Protocol):
    """Draws in-betweens.

    Attributes:
        name: how people choose it.
        description: one sentence for people.
        requires: files without which it cannot work.
    """

    name: str
    description: str
    requires: tuple[ModelFile, ...]

    def in_betweens(self, clip: Clip, number: int) -> Iterator[NDArray[Any]]:
        """Yield the frames between keyframe ``number`` and the next, both excluded, in the keyframes' type."""
        ...
