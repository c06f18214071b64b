"""Inputs of Time-to-Move (Singer et al. 2025, arXiv 2511.08633): a crude animation, and where its motion counts.

Time-to-Move starts from the crude animation's latents, noised. Until a later step it puts them back inside the mask
after each step; outside it lets the model go on freely. So the mask is where the moving parts are in each frame, as its
authors' own tool writes it: the union of the parts' alpha. What they have uncovered is outside, for the model to paint.

Wan's latents have one step for the first frame and one for every four frames after it, in cells of 8 x 8 px. A node
that takes one frame of four and one pixel of 64 loses a thin or fast strand. Masks are therefore pooled here by their
maximum: all pixels of a cell, in all frames of a step, have one value, and whichever is taken is right.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import require
from ...physics.motion import Motion
from ..composite import LayeredRenderer
from ..pictures import as_float, over
from .clip_rules import Timing, timed
from .model_format import FRAME_STEP, ModelFormat

__all__ = ["LATENT_CELL", "LatentStep", "time_to_move"]

LATENT_CELL = 8
"""Side of the square of pixels that one latent of Wan's stands for [px]."""

# A line one pixel wide that lies between two rows of pixels covers half of each; less is the haze of a soft cut.
_COVERED = 0.25


@dataclass(frozen=True, eq=False)
class LatentStep:
    """The frames that share one step of the model's latents.

    Attributes:
        frames: RGB, 0 to 1, shape [1 or 4, height, width, 3].
        cells: true where a moving part is in any of them, bool, shape [height / 8, width / 8].
    """

    frames: NDArray[np.float32]
    cells: NDArray[np.bool_]

    @property
    def mask(self) -> NDArray[np.float32]:
        """The cells as pixels of each frame, 0 or 1, shape [height, width]."""
        return np.kron(self.cells, np.ones((LATENT_CELL, LATENT_CELL), np.float32)).astype(np.float32)


def time_to_move(
    image: NDArray[Any],
    masks: Sequence[ArrayLike],
    motion: Motion,
    form: ModelFormat,
    *,
    timing: Timing = "whole motion",
    grow: int = 0,
    plate: NDArray[Any] | None = None,
    renderer: Callable[[Motion], LayeredRenderer] | None = None,
) -> Iterator[LatentStep]:
    """The crude animation and the mask of what moves in it, of one size and length, step by step of the latents.

    Args:
        image: RGB, uint8 or float32 in 0 to 1, shape [h, w, 3].
        masks: one for each body of the motion, shape [h, w].
        motion: of the bodies.
        form: length and size of the clip.
        timing: how the motion comes to that length.
        grow: how far the mask reaches beyond the parts [px of the illustration].
        plate: what is behind all bodies, of the image's shape and dtype; None makes a clean plate.
        renderer: see :func:`~physanimator.rendering.control.warped_frames`.

    Raises:
        InvalidInputError: the inputs do not fit together.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.control import ModelFormat, time_to_move
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mask = np.pad(np.ones((40, 40)), 10)
        >>> mesh = mesh_from_mask(mask, spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> steps = list(time_to_move(picture, [mask], motion, ModelFormat(frames=9, width=64, height=64)))
        >>> [len(step.frames) for step in steps], steps[0].cells.shape
        ([1, 4, 4], (8, 8))
    """
    require("grow", grow, 0 <= grow <= 64, "0 to 64 px")
    moved = timed(motion, form, timing)
    drawing = LayeredRenderer(image, masks, moved, plate=plate) if renderer is None else renderer(moved)
    square = np.ones((2 * grow + 1,) * 2, np.uint8)
    frames: list[NDArray[np.float32]] = []
    cells = _no_cells(form)
    for t in range(form.frames):
        drawn, alpha = drawing.frame_and_alpha(t)
        frames.append(form.resized(as_float(over(drawn))))
        cells |= _cells(cv2.dilate((alpha > _COVERED).astype(np.uint8), square), form)
        if t % FRAME_STEP == 0:
            yield LatentStep(np.stack(frames), cells)
            frames, cells = [], _no_cells(form)


def _no_cells(form: ModelFormat) -> NDArray[np.bool_]:
    return np.zeros((form.height // LATENT_CELL, form.width // LATENT_CELL), dtype=bool)


def _cells(covered: NDArray[np.uint8], form: ModelFormat) -> NDArray[np.bool_]:
    """Cells of the form that a mask of the illustration touches with as much as one pixel of either."""
    shown = form.resized(covered.astype(np.float32)) > 0
    rows, columns = (side // LATENT_CELL for side in shown.shape)
    return np.asarray(shown.reshape(rows, LATENT_CELL, columns, LATENT_CELL).any(axis=(1, 3)))
