"""An experiment: white noise that moves along with the bodies, for video models that start from such noise.

Models tuned for it (Go-with-the-Flow, Burgert et al. 2025) follow the motion of their starting noise. There noise is
warped from frame to frame by an estimated flow. Ours is known from the drawing to each frame, so nothing accumulates:
each pixel of the drawing has a normal number for each channel for the whole clip, each number lies in one cell of the
latents in each frame, and a cell has the sum of its numbers over the root of their count (a sampled form of the
integral noise of Chang et al. 2024). Cells are sums of disjoint sets of independent normal numbers: normal, of
variance 1 and white in every frame, whatever the motion. A cell without any number has a new one.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...physics.checks import check_whole
from ...physics.mesh import PixelBox, triangle_ids
from ...physics.motion import FlowSequence, Motion, all_triangles, layer_order, without_covered
from ...physics.progress import Progress
from .crude_animation import LATENT_CELL
from .model_format import FRAME_STEP, ModelFormat

__all__ = ["experimental_moving_noise"]


def experimental_moving_noise(
    motion: Motion, form: ModelFormat, *, channels: int = 16, seed: int = 0, progress: Progress | None = None
) -> NDArray[np.float32]:
    """Noise for each step of a model's latents, carried along by the motion.

    Args:
        motion: of the bodies; what is beside them stands still.
        form: length and size of the clip; the motion is spread over its frames.
        channels: of the latents, 16 for Wan.
        seed: of the numbers.
        progress: called after each step of the latents with (done, total); may raise to stop.

    Returns:
        Normal numbers of variance 1, shape [(frames - 1) / 4 + 1, channels, height / 8, width / 8].

    Raises:
        InvalidInputError: an argument is out of range.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.control import ModelFormat, experimental_moving_noise
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> experimental_moving_noise(motion, ModelFormat(frames=9, width=64, height=64), channels=4).shape
        (3, 4, 8, 8)
    """
    check_whole("channels", channels, 1, 128)
    check_whole("seed", seed, 0, 2**64 - 1)
    rng = np.random.default_rng(seed)
    numbers = rng.standard_normal((2, channels, motion.height * motion.width), dtype=np.float32)
    rows, columns = form.height // LATENT_CELL, form.width // LATENT_CELL
    steps: list[NDArray[np.float32]] = []
    for cells in _cells(form.sampled(motion), form, rows, columns):
        steps.append(_summed(cells, numbers, rows * columns, rng))
        if progress is not None:
            progress(len(steps), (form.frames - 1) // FRAME_STEP + 1)
    return np.stack(steps).reshape(len(steps), channels, rows, columns)


def _cells(motion: Motion, form: ModelFormat, rows: int, columns: int) -> Iterator[NDArray[np.int64]]:
    """For each step the cell of each number: of the ground's pixels, then of the bodies'; -1 where it is hidden."""
    flows, whole = FlowSequence(motion), PixelBox(0, 0, motion.width, motion.height)
    triangles, order = all_triangles(motion.bodies), layer_order(motion.bodies)
    owner = np.repeat(order, [len(motion.bodies[k].mesh.triangles) for k in order])
    place = np.stack(np.meshgrid(np.arange(motion.width) + 0.5, np.arange(motion.height) + 0.5), axis=-1)
    for t in range(0, len(motion), FRAME_STEP):
        ids = without_covered(triangle_ids(motion.positions[t], triangles, whole), motion.bodies)
        seen = np.where(ids >= 0, owner[ids], -1)
        moved = place + flows.flow(t).displacement.astype(np.float64)
        column, row = np.floor(moved).astype(int).transpose(2, 0, 1)
        inside = flows.inside & (row >= 0) & (row < motion.height) & (column >= 0) & (column < motion.width)
        inside &= seen[row.clip(0, motion.height - 1), column.clip(0, motion.width - 1)] == flows.body
        ground = _cell_of(place, form, motion, rows, columns, seen < 0)
        yield np.stack([ground, _cell_of(moved, form, motion, rows, columns, inside)])


def _cell_of(
    points: NDArray[np.float64], form: ModelFormat, motion: Motion, rows: int, columns: int, shown: NDArray[np.bool_]
) -> NDArray[np.int64]:
    """Number of the cell in which each point of the illustration lies, -1 for none, shape [n]."""
    size, target = np.array([motion.width, motion.height]), np.array([form.width, form.height])
    scale = target / size
    if form.fit == "crop":
        scale[:] = scale.max()
    column, row = np.floor(((points - size / 2) * scale + target / 2) / LATENT_CELL).astype(np.int64).transpose(2, 0, 1)
    found = shown & (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
    return np.where(found, row * columns + column, -1).reshape(-1)


def _summed(
    cells: NDArray[np.int64], numbers: NDArray[np.float32], count: int, rng: np.random.Generator
) -> NDArray[np.float32]:
    """Sums of the numbers in each cell over the root of how many they are, shape [channels, count]."""
    used = cells >= 0
    chosen = cells[used]
    many = np.bincount(chosen, minlength=count)
    sums = [np.bincount(chosen, numbers[:, channel][used], minlength=count) for channel in range(numbers.shape[1])]
    new = rng.standard_normal((len(sums), count))
    return np.where(many > 0, np.stack(sums) / np.sqrt(np.maximum(many, 1)), new).astype(np.float32)
