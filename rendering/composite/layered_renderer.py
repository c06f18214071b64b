"""The renderer without weights: the illustration's own pixels, moved with the meshes over a clean plate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import InvalidInputError, require
from ...physics.mesh import PixelBox, coverage_of, fitted
from ...physics.motion import Motion, layer_order
from ...physics.progress import Progress
from ..pictures import as_dtype, as_float, as_picture, is_transparent, straight
from .cutting import take_apart
from .kept_layers import apart
from .sprite_layers import take_sprite_apart

__all__ = ["LayeredRenderer", "render_frames"]

FloatImage = NDArray[np.float32]


class LayeredRenderer:
    """Draws any frame of a motion: textured, softly cut out layers over a clean plate, back to front.

    A frame in which nothing is displaced is the illustration itself, and so is every part of a frame that is at
    rest. Pixels that no body ever covers stay exactly as drawn.

    An illustration with transparency moves on transparency: its frames are straight RGBA, black where alpha is 0.

    Attributes:
        motion: what is drawn.
        plate: the illustration without its bodies, uint8 or float32 in its channels, shape [h, w, 3] or [h, w, 4].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.composite import LayeredRenderer
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mask = np.pad(np.ones((40, 40)), 10)
        >>> mesh = mesh_from_mask(mask, spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> renderer = LayeredRenderer(picture, [mask], motion)
        >>> frame = renderer.frame(1)
        >>> len(renderer), frame.shape, frame[30, 51].tolist(), picture[30, 51].tolist()
        (2, (60, 60, 3), [200, 60, 40], [230, 230, 230])
    """

    def __init__(
        self,
        image: NDArray[Any],
        masks: Sequence[ArrayLike],
        motion: Motion,
        *,
        plate: NDArray[Any] | None = None,
    ) -> None:
        """Take the illustration apart.

        Args:
            image: RGB or straight RGBA in any form that :func:`as_picture` takes, shape
                [h, w, 3] or [h, w, 4].
            masks: one for each body of the motion, in its order: bool, integers 0 to 255 or floats 0 to 1,
                shape [h, w].
            motion: of the bodies.
            plate: what is behind all bodies, of the image's size and channels; for RGBA it may be RGB, and what is
                transparent behind the bodies is then found. None makes a clean plate.

        Raises:
            InvalidInputError: sizes, ranges or the number of masks do not fit together.
        """
        image = as_picture(image, alpha=True)
        size, expected = image.shape[1::-1], (motion.width, motion.height)
        require("image", f"{size[0]} x {size[1]} px", size == expected, f"as large as the motion's, {expected} px")
        require("masks", len(masks), len(masks) == len(motion.bodies), f"one for each of {len(motion.bodies)} bodies")
        if plate is not None:
            plate = as_picture(plate, name="plate", alpha=is_transparent(image))
            if plate.shape[:2] != image.shape[:2]:
                raise InvalidInputError(f"plate must have the image's size {image.shape[:2]}. Got: {plate.shape[:2]}")
        self.motion = motion
        self._order = layer_order(motion.bodies)
        background, self._layers = apart(
            take_sprite_apart if is_transparent(image) else take_apart,
            as_float(image),
            [fitted(coverage_of(masks[k]), *size) for k in self._order],
            [motion.bodies[k].mesh for k in self._order],
            plate=None if plate is None else as_float(plate),
        )
        if is_transparent(image):
            self.plate = as_dtype(straight(background), image.dtype)
            self._planes = np.ascontiguousarray(np.moveaxis(background, 2, 0))
        else:
            self.plate = as_dtype(background, image.dtype)
            self._planes = np.ascontiguousarray(np.moveaxis(as_float(self.plate), 2, 0))

    def __len__(self) -> int:
        """Number of frames."""
        return len(self.motion)

    def frame(self, t: int) -> NDArray[Any]:
        """Frame ``t``, uint8 or float32 as the illustration is taken and in its channels, [h, w, 3] or [h, w, 4].

        Raises:
            InvalidInputError: there is no such frame.
        """
        return self._over_plate(self._drawn(t))

    def alpha(self, t: int) -> FloatImage:
        """How much of each pixel moving bodies cover in frame ``t``, 0 to 1, shape [h, w].

        Raises:
            InvalidInputError: there is no such frame.
        """
        return self._covered(self._drawn(t))

    def frame_and_alpha(self, t: int) -> tuple[NDArray[Any], FloatImage]:
        """``frame`` and ``alpha`` of one frame in little more than the time of one of them.

        Raises:
            InvalidInputError: there is no such frame.
        """
        drawn = self._drawn(t)
        return self._over_plate(drawn), self._covered(drawn)

    def uncovered(self, t: int) -> FloatImage:
        """How much of each pixel bodies cover in the drawing and have left in frame ``t``, 0 to 1, shape [h, w].

        There the frame shows the plate, which nobody drew.

        Raises:
            InvalidInputError: there is no such frame.
        """
        return self.uncovered_by(self.alpha(t))

    def uncovered_by(self, alpha: FloatImage) -> FloatImage:
        """What is uncovered in a frame whose alpha is known, shape [h, w]; see ``uncovered``."""
        return np.asarray(np.clip(self._at_rest - alpha, 0, 1), dtype=np.float32)

    @cached_property
    def _at_rest(self) -> FloatImage:
        """How much of each pixel the bodies cover as drawn, shape [h, w]."""
        rest = np.concatenate([body.mesh.vertices for body in self.motion.bodies]).astype(np.float32)
        return self._covered(self._laid(Motion(self.motion.bodies, rest[None], self.motion.frame_rate), 0))

    def cutout(self, t: int) -> NDArray[Any]:
        """The moving bodies of frame ``t`` alone: straight RGB and alpha, dtype of the image, shape [h, w, 4].

        Raises:
            InvalidInputError: there is no such frame.
        """
        planes = np.zeros((4, *self.plate.shape[:2]), dtype=np.float32)
        for box, layer in self._drawn(t):
            _lay_over(_part(planes, box), layer)
        return _interleaved(planes, self.plate.dtype)

    def _over_plate(self, drawn: list[tuple[PixelBox, FloatImage]]) -> NDArray[Any]:
        """Drawn layers over the plate."""
        frame = self.plate.copy()
        if not drawn:
            return frame
        box = _union([each for each, _ in drawn])
        planes = _part(self._planes, box).copy()
        for each, layer in drawn:
            _lay_over(_part(planes, _within(each, box)), layer)
        frame[box.slices] = _interleaved(planes, frame.dtype)
        return frame

    def _covered(self, drawn: list[tuple[PixelBox, FloatImage]]) -> FloatImage:
        """Coverage by drawn layers, shape [h, w]."""
        covered = np.zeros(self.plate.shape[:2], dtype=np.float32)
        for box, layer in drawn:
            part = covered[box.slices]
            part += np.clip(layer[..., -1], 0, 1) * (1 - part)
        return covered

    def _drawn(self, t: int) -> list[tuple[PixelBox, FloatImage]]:
        """The layers that show in a frame, from back to front, each with its box."""
        require("frame", t, 0 <= t < len(self), f"0 to {len(self) - 1}")
        return self._laid(self.motion, t)

    def _laid(self, motion: Motion, t: int) -> list[tuple[PixelBox, FloatImage]]:
        """The layers in a frame of any motion of the bodies."""
        bodies = zip(self._layers, self._order, strict=True)
        size = motion.width, motion.height
        drawn = [layer.drawn(motion.of_body(k)[t], *size) for layer, k in bodies]
        return [(box, layer) for box, layer in drawn if box.width and box.height]


def render_frames(renderer: LayeredRenderer, *, progress: Progress | None = None) -> Iterator[NDArray[Any]]:
    """Every frame of a renderer in turn.

    Args:
        renderer: what to draw.
        progress: called after each frame with (done, total); may raise to stop.
    """
    for t in range(len(renderer)):
        yield renderer.frame(t)
        if progress is not None:
            progress(t + 1, len(renderer))


def _part(planes: FloatImage, box: PixelBox) -> FloatImage:
    """The view of planes, shape [c, h, w], within a box."""
    rows, columns = box.slices
    return planes[:, rows, columns]


def _lay_over(planes: FloatImage, layer: FloatImage) -> None:
    """Lay a layer's colours and coverage, shape [h, w, 4 or 5], over planes, shape [3 or 4, h, w], in place."""
    *colours, alpha = cv2.split(layer)
    np.clip(alpha, 0, 1, out=alpha)
    beneath = 1 - alpha
    for plane, added in zip(planes, [*colours, alpha], strict=False):
        plane *= beneath
        # Bicubic resampling overshoots at edges; light that is no colour times alpha would be seen as a fringe.
        plane += np.clip(added, 0, alpha, out=added)


def _interleaved(planes: FloatImage, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Planes in 0 to 1, four of them premultiplied, shape [c, h, w], as a straight picture, shape [h, w, c]."""
    picture = np.asarray(cv2.merge(list(planes)))
    return as_dtype(straight(picture) if is_transparent(picture) else picture, dtype)


def _union(boxes: Sequence[PixelBox]) -> PixelBox:
    return PixelBox(
        min(box.left for box in boxes),
        min(box.top for box in boxes),
        max(box.right for box in boxes),
        max(box.bottom for box in boxes),
    )


def _within(box: PixelBox, outer: PixelBox) -> PixelBox:
    """A box in the pixels of another that holds it."""
    return PixelBox(box.left - outer.left, box.top - outer.top, box.right - outer.left, box.bottom - outer.top)
