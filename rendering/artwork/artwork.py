"""Layered artwork: the parts of an illustration as they were drawn, what lies hidden behind others included."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, require
from ...physics.limits import MAX_LAYERS
from .limits import check_canvas

__all__ = ["ArtLayer", "Artwork", "Blend"]

Blend = Literal["normal", "multiply", "screen", "overlay", "add"]
"""How a layer mixes with what is below it; ``add`` is also called linear dodge."""

Pixels = NDArray[Any]


@dataclass(frozen=True, eq=False)
class ArtLayer:
    """One layer of an artwork.

    Attributes:
        name: as the artist wrote it.
        pixels: straight RGBA, uint8 or uint16, shape [h, w, 4]; may be empty, and may reach beyond the canvas.
        left: column of the canvas where the pixels begin [px]; may be negative.
        top: row of the canvas where the pixels begin [px]; may be negative.
        opacity: of the whole layer, 0 to 1.
        blend: how it mixes with what is below.
        visible: whether it is drawn.
        depth: from 0, near, to 1, far; None where nobody said. The order of the layers decides, not this.

    Raises:
        InvalidInputError: a value has another form.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import ArtLayer
        >>> hair = ArtLayer("front hair", np.zeros((8, 6, 4), np.uint8), left=20, top=4)
        >>> hair.box
        (20, 4, 26, 12)
    """

    name: str
    pixels: Pixels
    left: int = 0
    top: int = 0
    opacity: float = 1.0
    blend: Blend = "normal"
    visible: bool = True
    depth: float | None = None

    def __post_init__(self) -> None:
        pixels = self.pixels
        right = isinstance(pixels, np.ndarray) and pixels.ndim == 3 and pixels.shape[2] == 4
        if not (right and pixels.dtype in (np.uint8, np.uint16)):
            got = f"{pixels.dtype} {pixels.shape}" if isinstance(pixels, np.ndarray) else type(pixels).__name__
            raise InvalidInputError(f"layer {self.name}: pixels must be uint8 or uint16 of shape [h, w, 4]. Got: {got}")
        require(f"layer {self.name}: opacity", self.opacity, 0 <= self.opacity <= 1, "from 0 to 1")
        require(f"layer {self.name}: blend", self.blend, self.blend in get_args(Blend), f"of {get_args(Blend)}")

    @property
    def box(self) -> tuple[int, int, int, int]:
        """Left, top, right and bottom on the canvas [px]; right and bottom are the first that are not in it."""
        height, width = self.pixels.shape[:2]
        return self.left, self.top, self.left + width, self.top + height


@dataclass(frozen=True, eq=False)
class Artwork:
    """An illustration in layers.

    Attributes:
        width: of the canvas [px].
        height: of the canvas [px].
        layers: from back to front, all of one dtype; hidden ones as well.
        warnings: one sentence for each thing in the file that is not shown as its own program shows it.

    Raises:
        InvalidInputError: the canvas is empty or too large, or 8 and 16 bits are mixed.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import ArtLayer, Artwork, flattened
        >>> red = ArtLayer("red", np.full((2, 2, 4), (255, 0, 0, 255), np.uint8), left=1)
        >>> flattened(Artwork(4, 2, (red,)))[0].tolist()
        [[0, 0, 0, 0], [255, 0, 0, 255], [255, 0, 0, 255], [0, 0, 0, 0]]
    """

    width: int
    height: int
    layers: tuple[ArtLayer, ...]
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_canvas(self.width, self.height, "canvas")
        require("layers", len(self.layers), len(self.layers) <= MAX_LAYERS, f"at most {MAX_LAYERS}")
        kinds = {layer.pixels.dtype for layer in self.layers}
        require("layers", " and ".join(sorted(map(str, kinds))), len(kinds) < 2, "of one dtype")

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of the pixels: uint8 or uint16."""
        return self.layers[0].pixels.dtype if self.layers else np.dtype(np.uint8)

    @property
    def names(self) -> tuple[str, ...]:
        """One name for each layer, no two alike: the second and later layers of one name get `` (2)`` and so on.

        A layer without a name is called by its number, from the back.
        """
        given = [layer.name.strip() or f"layer {number}" for number, layer in enumerate(self.layers, 1)]
        taken = set(given)
        seen: Counter[str] = Counter()
        names = []
        for own in given:
            seen[own] += 1
            name = own
            while seen[own] > 1 and name in taken:
                name = f"{own} ({seen[own]})"
                seen[own] += name in taken
            taken.add(name)
            names.append(name)
        return tuple(names)
