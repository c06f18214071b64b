"""A picture in pieces that move on meshes: what programs for 2D and 3D animation can go on with."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ..artwork import Blend

__all__ = ["MovingMesh", "Puppet", "PuppetPiece"]

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class MovingMesh:
    """How a piece is bent. Coordinates are pixels of the picture, x right and y down.

    Attributes:
        rest: vertices as drawn [px], shape [v, 2].
        places: where each vertex is in the piece's pixels, 0 to 1 across and down, shape [v, 2].
        triangles: shape [t, 3], counter-clockwise as drawn with y up; later ones lie over earlier ones.
        positions: vertices in every frame [px], shape [frames, v, 2].
    """

    rest: FloatArray
    places: FloatArray
    triangles: IndexArray
    positions: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class PuppetPiece:
    """One layer or part.

    Attributes:
        name: as the artist knows it; no two pieces have the same.
        pixels: straight RGBA, uint8, shape [h, w, 4]. Visible colours go on under alpha 0.
        box: left, top, width and height of what the pixels cover as drawn [px]; they may be of another resolution.
        blend: how it is laid over what is behind it; normal, multiply, screen or add.
        mesh: how it moves; None where it stands still.
    """

    name: str
    pixels: NDArray[np.uint8]
    box: tuple[float, float, float, float]
    blend: Blend
    mesh: MovingMesh | None = None

    @cached_property
    def opaque(self) -> bool:
        """Whether nothing shows through."""
        return bool(self.pixels[..., 3].min() == 255)


@dataclass(frozen=True, eq=False)
class Puppet:
    """Pieces and their motion.

    Attributes:
        width: of the picture [px].
        height: of the picture [px].
        frame_rate: frames a second.
        frames: how many there are.
        loops: whether the first frame follows the last one.
        pieces: from back to front.
    """

    width: int
    height: int
    frame_rate: float
    frames: int
    loops: bool
    pieces: tuple[PuppetPiece, ...]

    def upright(self, points: NDArray[np.floating]) -> FloatArray:
        """Points of the picture as they are told where y goes up: from the middle of its lower edge [px]."""
        return np.stack([points[..., 0] - self.width / 2, self.height - points[..., 1]], axis=-1).astype(np.float64)

    def times(self) -> FloatArray:
        """When each row of :meth:`played` is shown [s]."""
        return np.arange(self.frames + self.loops) / self.frame_rate

    def played(self, mesh: MovingMesh) -> NDArray[np.float32]:
        """A piece's frames; a loop ends with its first frame once more, shape [frames (+ 1), v, 2]."""
        return np.concatenate([mesh.positions, mesh.positions[:1]]) if self.loops else mesh.positions
