"""The renderer for pixel art: whole pixels change their places, and no colours are mixed.

Every frame is a choice among pixels of the illustration and of the plate, so that it holds no colour that they do not
hold. Where art has been enlarged, so that each of its pixels is a block, blocks are what moves.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import InvalidInputError, require
from ...physics.mesh import coverage_of, fitted
from ...physics.motion import Motion, layer_order
from ..pictures import check_picture, is_transparent, nearest_pixels
from .carried_pixels import CarriedPixels
from .pixel_blocks import block_size

__all__ = ["PixelArtRenderer", "pixel_plate"]

FloatImage = NDArray[np.float32]
Places = NDArray[np.int32]
Mask = NDArray[np.bool_]


class PixelArtRenderer:
    """Draws any frame of a motion with whole pixels; takes and gives what ``LayeredRenderer`` does.

    Attributes:
        motion: what is drawn.
        plate: the illustration without its bodies, in its dtype and channels, shape [h, w, 3] or [h, w, 4].
        block: width and height of what moves as one pixel [px].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.composite import PixelArtRenderer
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mask = np.pad(np.ones((40, 40)), 10)
        >>> mesh = mesh_from_mask(mask, spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> frame = PixelArtRenderer(picture, [mask], motion).frame(1)
        >>> len(np.unique(frame.reshape(-1, 3), axis=0))
        2
    """

    def __init__(
        self, image: NDArray[Any], masks: Sequence[ArrayLike], motion: Motion, *, plate: NDArray[Any] | None = None
    ) -> None:
        """Take the illustration apart.

        Args:
            image: RGB or straight RGBA, uint8 or float32 in 0 to 1, shape [h, w, 3] or [h, w, 4].
            masks: one for each body of the motion, in its order, shape [h, w]; a pixel is a body's from one half on.
            motion: of the bodies.
            plate: what is behind all bodies, of the image's shape and dtype; None puts in the nearest pixels.

        Raises:
            InvalidInputError: sizes, dtypes or the number of masks do not fit together.
        """
        check_picture(image[..., :3] if is_transparent(image) else image)
        height, width = image.shape[:2]
        expected = (motion.width, motion.height)
        require(
            "image", f"{width} x {height} px", (width, height) == expected, f"as large as the motion's, {expected} px"
        )
        require("masks", len(masks), len(masks) == len(motion.bodies), f"one for each of {len(motion.bodies)} bodies")
        self.motion, self.block = motion, block_size(image)
        self._order = layer_order(motion.bodies)
        self._image = self._blocks(image)
        wanted = {k: self._blocks(fitted(coverage_of(masks[k]), width, height)) > 0.5 for k in self._order}
        carried = {k: CarriedPixels(motion.bodies[k].mesh, wanted[k], self.block) for k in self._order}
        inside = [wanted[k] & carried[k].covered for k in self._order]
        if plate is None:
            self._behind = pixel_plate(self._image, np.logical_or.reduce(inside))
        else:
            self._behind = self._blocks(_in_channels_of(plate, image))
        self.plate = self._enlarged(self._behind)
        self._layers = []
        for number, k in enumerate(self._order):
            in_front = np.logical_or.reduce([np.zeros_like(inside[number]), *inside[number + 1 :]])
            self._layers.append((carried[k], _own_pixels(inside[number], inside[number] & ~in_front)))

    def __len__(self) -> int:
        """Number of frames."""
        return len(self.motion)

    def frame(self, t: int) -> NDArray[Any]:
        """Frame ``t`` in the dtype and channels of the illustration, shape [h, w, 3] or [h, w, 4].

        Raises:
            InvalidInputError: there is no such frame.
        """
        return self._over_plate(self._places(t))

    def alpha(self, t: int) -> FloatImage:
        """Where moving bodies are in frame ``t``, 0 or 1, shape [h, w].

        Raises:
            InvalidInputError: there is no such frame.
        """
        return self._covered(self._places(t))

    def frame_and_alpha(self, t: int) -> tuple[NDArray[Any], FloatImage]:
        """``frame`` and ``alpha`` of one frame.

        Raises:
            InvalidInputError: there is no such frame.
        """
        places = self._places(t)
        return self._over_plate(places), self._covered(places)

    def uncovered(self, t: int) -> FloatImage:
        """Where bodies are in the drawing and not in frame ``t``, 0 or 1, shape [h, w].

        Raises:
            InvalidInputError: there is no such frame.
        """
        rest = np.concatenate([body.mesh.vertices for body in self.motion.bodies]).astype(np.float32)
        at_rest = self._laid(Motion(self.motion.bodies, rest[None], self.motion.frame_rate), 0)
        return np.clip(self._covered(at_rest) - self.alpha(t), 0, 1)

    def cutout(self, t: int) -> NDArray[Any]:
        """The moving bodies of frame ``t`` alone: straight RGB and alpha, dtype of the image, shape [h, w, 4].

        Raises:
            InvalidInputError: there is no such frame.
        """
        places = self._places(t)
        own = self._image.reshape(-1, self._image.shape[2])
        opaque = 255 if own.dtype == np.uint8 else 1
        pixels = own if own.shape[1] == 4 else np.pad(own, ((0, 0), (0, 1)), constant_values=opaque)
        return self._enlarged(np.where((places >= 0)[..., None], pixels[places], np.zeros(4, own.dtype)))

    def _over_plate(self, places: Places) -> NDArray[Any]:
        own = self._image.reshape(-1, self._image.shape[2])
        return self._enlarged(np.where((places >= 0)[..., None], own[places], self._behind))

    def _covered(self, places: Places) -> FloatImage:
        return self._enlarged((places >= 0).astype(np.float32))

    def _places(self, t: int) -> Places:
        """Which pixel of the illustration each pixel of a frame shows, -1 for the plate's."""
        require("frame", t, 0 <= t < len(self), f"0 to {len(self) - 1}")
        return self._laid(self.motion, t)

    def _laid(self, motion: Motion, t: int) -> Places:
        places = np.full(self._image.shape[:2], -1, dtype=np.int32)
        for (carried, pixels), k in zip(self._layers, self._order, strict=True):
            shown = carried.moved(pixels, motion.of_body(k)[t], motion.width, motion.height)
            np.copyto(places, shown, where=shown >= 0)
        return places

    def _blocks(self, image: NDArray[Any]) -> NDArray[Any]:
        """One pixel for each block: that in its middle."""
        half = self.block // 2
        return np.ascontiguousarray(image[half :: self.block, half :: self.block])

    def _enlarged(self, image: NDArray[Any]) -> NDArray[Any]:
        return image if self.block == 1 else image.repeat(self.block, axis=0).repeat(self.block, axis=1)


def _own_pixels(inside: Mask, visible: Mask) -> Places:
    """Which pixel stands for each of a body's: itself, or the nearest one that is not hidden; -1 elsewhere."""
    return np.where(inside, nearest_pixels(visible if visible.any() else inside)[1], np.int32(-1))


def pixel_plate(image: NDArray[Any], hole: Mask) -> NDArray[Any]:
    """A picture with the nearest pixel outside in place of each one in a hole.

    Args:
        image: shape [h, w, c].
        hole: shape [h, w].

    Raises:
        InvalidInputError: the hole leaves nothing of the picture.
    """
    if hole.all():
        raise InvalidInputError("masks must leave some of the picture as background. Got: they cover all of it")
    return image.reshape(-1, image.shape[2])[nearest_pixels(~hole)[1]] if hole.any() else image.copy()


def _in_channels_of(plate: NDArray[Any], image: NDArray[Any]) -> NDArray[Any]:
    """A plate with the image's channels."""
    if is_transparent(image) and not is_transparent(plate) and plate.dtype == image.dtype:
        opaque = 255 if plate.dtype == np.uint8 else 1
        plate = np.pad(plate, ((0, 0), (0, 0), (0, 1)), constant_values=opaque)
    if plate.shape != image.shape or plate.dtype != image.dtype:
        expected = f"{image.shape} and dtype {image.dtype}"
        raise InvalidInputError(f"plate must have the image's shape {expected}. Got: {plate.shape}, {plate.dtype}")
    return plate
