"""The renderer without weights: the illustration's own pixels, moved with the meshes over a clean plate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import InvalidInputError, require
from ...physics.mesh import PixelBox, coverage_of, fitted
from ...physics.motion import Motion, layer_order
from ...physics.progress import Progress
from ..pictures import as_float, as_picture, is_transparent
from .cutting import take_apart
from .drawn_layers import Drawn, covered, cut_out, interleaved, laid, over_plate, part_of, placed
from .hidden_areas import HiddenArea, hidden_areas
from .kept_layers import apart
from .layer import Layer
from .laying import lay_over
from .sprite_layers import take_sprite_apart
from .still_layers import StillLayer

if TYPE_CHECKING:
    from ..artwork import Artwork

__all__ = ["LayeredRenderer", "render_frames"]

FloatImage = NDArray[np.float32]


class LayeredRenderer:
    """Draws any frame of a motion: textured, softly cut out layers over a clean plate, back to front.

    A frame in which nothing is displaced is the illustration itself, and so is every part of a frame that is at
    rest. Pixels that no body ever covers stay exactly as drawn.

    An illustration with transparency moves on transparency: its frames are straight RGBA, black where alpha is 0.

    Layered artwork, or a mask of what stands in front, adds layers that stand still between and before those that
    move; see :meth:`of_artwork`.

    Attributes:
        motion: what is drawn.
        plate: the illustration without its bodies, uint8 or float32 in its channels, shape [h, w, 3] or [h, w, 4].
        drawn_plate: whether somebody drew what is behind the bodies.

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
        in_front: ArrayLike | None = None,
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
            in_front: mask of what stands still in front of all bodies, in any form that ``masks`` may have; None for
                nothing.

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
        still = [] if in_front is None else [fitted(coverage_of(in_front), *size)]
        order = layer_order(motion.bodies)
        background, layers = apart(
            take_sprite_apart if is_transparent(image) else take_apart,
            as_float(image),
            [*(fitted(coverage_of(masks[k]), *size) for k in order), *still],
            [*(motion.bodies[k].mesh for k in order), *(None for _ in still)],
            plate=None if plate is None else as_float(plate),
        )
        self._take(motion, background, layers, layer_order(motion.bodies))
        self._stand(background, image.dtype)
        self.drawn_plate = plate is not None
        # In the artwork that a flat picture is taken for, the background is the first layer.
        self._sources: list[int | None] = [
            number if isinstance(layer, Layer) else None for number, layer in enumerate(self._layers, 1)
        ]

    @classmethod
    def of_artwork(cls, artwork: Artwork, layers: Sequence[int], motion: Motion) -> LayeredRenderer:
        """The renderer of layered artwork: movers have pixels of their own, and nothing behind them is guessed.

        Args:
            artwork: the layers, from back to front.
            layers: index of the layer that each body of the motion is.
            motion: of the bodies, as large as the artwork's canvas.

        Raises:
            InvalidInputError: these do not fit together.
        """
        size, expected = (artwork.width, artwork.height), (motion.width, motion.height)
        require("artwork", f"{size[0]} x {size[1]} px", size == expected, f"as large as the motion's, {expected} px")
        from .artwork_pieces import Mover, pieces_of

        bodies = enumerate(zip(layers, motion.bodies, strict=True))
        movers = {layer: Mover(body.mesh, motion.of_body(number)) for number, (layer, body) in bodies}
        require("layers", list(layers), len(movers) == len(motion.bodies), "another layer for each body")
        renderer, pieces = cls.__new__(cls), pieces_of(artwork, movers)
        renderer._take(motion, pieces.background, pieces.layers, np.argsort(layers).tolist())
        renderer.plate, renderer._region = pieces.plate, pieces.region
        renderer.drawn_plate = True
        renderer._artwork, renderer._sources = artwork, pieces.sources
        return renderer

    @cached_property
    def _artwork(self) -> Artwork:
        """The layers at rest: those that were given, or the parts that a flat picture was taken apart into."""
        from .flat_artwork import artwork_of, part_names

        names = part_names(self.motion)
        called = ["in front" if body is None else names[body] for body in self._bodies]
        dtype = np.dtype(np.uint8 if self.plate.dtype == np.uint8 else np.uint16)
        return artwork_of(np.moveaxis(self._planes, 0, 2), self._layers, called, dtype)

    @property
    def layers_at_rest(self) -> Artwork:
        """The illustration in layers: those that were given, or what a flat picture was taken apart into."""
        return self._artwork

    @property
    def movers(self) -> dict[int, tuple[Layer, int]]:
        """For each layer of :attr:`layers_at_rest` that moves, how it is bent, and the number of its body."""
        pieces = zip(self._sources, self._layers, self._bodies, strict=True)
        return {
            source: (piece, body)
            for source, piece, body in pieces
            if source is not None and isinstance(piece, Layer) and body is not None
        }

    def showing(self, motion: Motion) -> LayeredRenderer:
        """The same for another motion of the same bodies; only where the illustration is flat."""
        other = copy(self)
        other.motion = motion
        return other

    @property
    def moving_layers(self) -> list[int]:
        """Indices of the layers that move in what :meth:`artwork` gives."""
        return sorted({source for source in self._sources if source is not None})

    @property
    def source(self) -> Artwork | None:
        """The layered artwork that is drawn, at rest; None where the illustration is flat."""
        return self._artwork

    def artwork(self, t: int, *, only: int | None = None) -> Artwork:
        """Frame ``t`` as layers: those that move bent, the others as they are.

        A flat picture gives its background, a layer for each part, and one for what stands still in front of them.

        Args:
            t: number of the frame.
            only: index of the layer that is wanted; others that move may be anywhere. None for all.

        Raises:
            InvalidInputError: there is no such frame.
        """
        require("frame", t, 0 <= t < len(self), f"0 to {len(self) - 1}")
        from .artwork_pieces import bent

        layers = list(self._artwork.layers)
        pieces: dict[int, list[tuple[PixelBox, FloatImage]]] = {}
        for piece, body, source in zip(self._layers, self._bodies, self._sources, strict=True):
            if source is not None and only in (None, source):
                pieces.setdefault(source, []).append(placed(piece, body, self.motion, t))
        for index, drawn_pieces in pieces.items():
            layers[index] = bent(layers[index], drawn_pieces)
        return replace(self._artwork, layers=tuple(layers))

    def _take(
        self, motion: Motion, background: FloatImage, layers: Sequence[Layer | StillLayer], order: Sequence[int]
    ) -> None:
        """Draw these layers, those that move in this order of the bodies, over a background of a region."""
        self.motion = motion
        bodies = iter(order)
        self._layers = list(layers)
        self._bodies = [next(bodies) if isinstance(layer, Layer) else None for layer in layers]
        self._planes = np.ascontiguousarray(np.moveaxis(background, 2, 0))

    def _stand(self, background: FloatImage, dtype: np.dtype[Any]) -> None:
        """Make the plate of a flat picture: its background and what stands still in front."""
        still = [layer for layer in self._layers if isinstance(layer, StillLayer)]
        self._region = PixelBox(0, 0, background.shape[1], background.shape[0])
        shown = self._planes.copy() if still else self._planes
        for layer in still:
            lay_over(part_of(shown, layer.box), layer.texture, layer.blend)
        self.plate = interleaved(shown, dtype)
        if not (still or is_transparent(background)):
            self._planes = np.ascontiguousarray(np.moveaxis(as_float(self.plate), 2, 0))

    def __len__(self) -> int:
        """Number of frames."""
        return len(self.motion)

    def frame(self, t: int) -> NDArray[Any]:
        """Frame ``t``, uint8 or float32 as the illustration is taken and in its channels, [h, w, 3] or [h, w, 4].

        Raises:
            InvalidInputError: there is no such frame.
        """
        return over_plate(self._drawn(t), self.plate, self._planes, self._region)

    def alpha(self, t: int) -> FloatImage:
        """How much of each pixel moving bodies cover in frame ``t``, 0 to 1, shape [h, w].

        Raises:
            InvalidInputError: there is no such frame.
        """
        return covered(self._drawn(t), self.plate.shape[:2])

    def frame_and_alpha(self, t: int) -> tuple[NDArray[Any], FloatImage]:
        """``frame`` and ``alpha`` of one frame in little more than the time of one of them.

        Raises:
            InvalidInputError: there is no such frame.
        """
        drawn = self._drawn(t)
        return over_plate(drawn, self.plate, self._planes, self._region), covered(drawn, self.plate.shape[:2])

    def uncovered(self, t: int) -> FloatImage:
        """How much of each pixel bodies cover in the drawing and have left in frame ``t``, 0 to 1, shape [h, w].

        There the frame shows the plate, which nobody drew.

        Raises:
            InvalidInputError: there is no such frame.
        """
        return self.uncovered_by(self.alpha(t))

    def uncovered_by(self, alpha: FloatImage) -> FloatImage:
        """What is uncovered in a frame whose alpha is known, shape [h, w]; see ``uncovered``."""
        return np.asarray(np.clip(self.alpha_at_rest - alpha, 0, 1), dtype=np.float32)

    @cached_property
    def in_front(self) -> FloatImage:
        """How much of each pixel shows what stands still in front of something that moves, 0 to 1, shape [h, w]."""
        shown = np.zeros(self.plate.shape[:2], dtype=np.float32)
        for layer in self._layers:
            if isinstance(layer, StillLayer) and layer.blend == "normal":
                part = shown[layer.box.slices]
                np.maximum(part, np.clip(layer.texture[..., -1], 0, 1), out=part)
        return shown

    @cached_property
    def alpha_at_rest(self) -> FloatImage:
        """How much of each pixel the bodies cover as drawn, 0 to 1, shape [h, w]."""
        rest = np.concatenate([body.mesh.vertices for body in self.motion.bodies]).astype(np.float32)
        still = Motion(self.motion.bodies, rest[None], self.motion.frame_rate)
        return covered(self._laid(still, 0), self.plate.shape[:2])

    def cutout(self, t: int) -> NDArray[Any]:
        """The moving bodies of frame ``t`` alone: straight RGB and alpha, dtype of the image, shape [h, w, 4].

        Raises:
            InvalidInputError: there is no such frame.
        """
        return cut_out(self._drawn(t), self.plate.shape[:2], self.plate.dtype)

    @cached_property
    def _hidden(self) -> list[HiddenArea | None]:
        """Where each layer is never seen."""
        still = [layer if isinstance(layer, StillLayer) else None for layer in self._layers]
        return hidden_areas(still, self.motion.width, self.motion.height)

    def _drawn(self, t: int) -> list[Drawn]:
        """The layers that show in a frame, from back to front."""
        require("frame", t, 0 <= t < len(self), f"0 to {len(self) - 1}")
        return self._laid(self.motion, t)

    def _laid(self, motion: Motion, t: int) -> list[Drawn]:
        """The layers in a frame of any motion of the bodies."""
        return laid(zip(self._layers, self._bodies, self._hidden, strict=True), motion, t)


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
