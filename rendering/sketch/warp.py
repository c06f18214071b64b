"""Forward warping of a sketch along the flow of moving bodies (paper, Method, "Sketch-Guided Rendering").

    S_t(q) = sum_p b(q - p - F(p)) w(p) S_0(p) / sum_p b(q - p - F(p)) w(p),   w(p) = |F(p)|

with b the bilinear kernel. Taken literally, everything that rests would weigh 0. Here line density 1 - S is
splatted, so that a hole means "no line"; what rests weighs a little; and each pixel counts for the area that it
covers after the motion, so that a stretched body stays closed while the place that a body has left is known as a hole.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, get_args

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require
from ...physics.motion import FlowField
from ..pictures import as_float, splat
from .splatting import splats_of

__all__ = ["SPLAT_MODES", "SplatMode", "WarpedSketch", "forward_warp", "warp_sketch"]

FloatImage = NDArray[np.float32]
Mask = NDArray[np.bool_]
SplatMode = Literal["paper", "softmax"]
SPLAT_MODES: tuple[SplatMode, ...] = get_args(SplatMode)

# Weight of a pixel at rest beside one that moved by one pixel.
_REST_WEIGHT = 0.001


@dataclass(frozen=True, eq=False)
class WarpedSketch:
    """The sketch of one frame.

    Attributes:
        sketch: paper 1 and lines towards 0, float32, shape [h, w].
        holes: true where nothing came to lie, so that no line is known, bool, shape [h, w].
    """

    sketch: FloatImage
    holes: Mask


def forward_warp(
    values: NDArray[Any], displacement: NDArray[Any], weights: NDArray[Any]
) -> tuple[FloatImage, FloatImage]:
    """Move every pixel along its displacement and average what meets: out = sum b w v / sum b w.

    Args:
        values: shape [h, w] or [h, w, c].
        displacement: x right and y down [px], shape [h, w, 2].
        weights: importance of each pixel, at least 0, shape [h, w].

    Returns:
        warped: float32, shape of ``values``; 0 where nothing arrives.
        coverage: how much of each pixel is covered, sum of b over the pixels that weigh anything, each counted with
            the area that it takes after the motion, float32, shape [h, w].

    Raises:
        InvalidInputError: the shapes do not belong together.
    """
    values = np.asarray(values, dtype=np.float32)
    shape = values.shape[:2]
    require("values", f"shape {values.shape}", values.ndim in (2, 3), "of shape [h, w] or [h, w, c]")
    require("displacement", f"shape {displacement.shape}", displacement.shape == (*shape, 2), f"of shape {(*shape, 2)}")
    require("weights", f"shape {weights.shape}", weights.shape == shape, f"of shape {shape}")
    flow = np.asarray(displacement, dtype=np.float32)
    require("displacement", "NaN or infinity", bool(np.isfinite(flow).all()), "finite")
    weights = np.asarray(weights, dtype=np.float32)
    channels = values.reshape(*shape, -1)
    moved = ((flow[..., 0] != 0) | (flow[..., 1] != 0)) & (weights > 0)
    pieces = splats_of(channels, flow, weights, moved)
    importance = (pieces.weight * pieces.area).astype(np.float64)
    amounts = [importance * pieces.values[:, k] for k in range(channels.shape[2])]
    amounts += [importance, pieces.area.astype(np.float64)]
    *sums, total, coverage = splat(pieces.x, pieces.y, amounts, shape)
    resting = np.where(moved, np.float32(0), weights)
    coverage += resting > 0
    total += resting
    shares = 1 / np.maximum(total, np.finfo(np.float32).tiny)
    warped = np.empty(channels.shape, dtype=np.float32)
    for k, landed in enumerate(sums):
        warped[..., k] = (landed + resting * channels[..., k].astype(np.float64)) * shares
    return warped.reshape(values.shape), coverage.astype(np.float32)


def warp_sketch(
    sketch: NDArray[Any],
    field: FlowField,
    *,
    mode: SplatMode = "paper",
    alpha: float = 15.0,
    border: int = 2,
    blur_sigma: float = 0.8,
) -> WarpedSketch:
    """The sketch of one frame from the sketch of the drawing.

    Where several pixels meet, the one that moved further shows, since it mostly belongs to what is in front.

    Args:
        sketch: paper 1, lines 0, shape [h, w].
        field: flow from the drawing to the frame, of the same size.
        mode: "paper" weighs a pixel by how far it moved; "softmax" by exp(alpha |F| / max |F|).
        alpha: how strongly the further moved pixel wins under "softmax".
        border: contour lines that reach this far out of a body move with it [px].
        blur_sigma: Gaussian blur of the result, which hides broken contours from the renderer [px]; 0 for none.

    Raises:
        InvalidInputError: sizes differ or a parameter is unusable.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import FlowSequence, Motion
        >>> from physanimator.physics.scene import Body
        >>> from physanimator.rendering.sketch import warp_sketch
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> sketch = np.ones((60, 60), np.float32)
        >>> sketch[:, 30] = 0
        >>> warped = warp_sketch(sketch, FlowSequence(motion).flow(1))
        >>> int(np.argmin(warped.sketch[30]))
        33
    """
    sketch = as_float(sketch)
    height, width = sketch.shape[:2]
    require("sketch", f"shape {sketch.shape}", sketch.ndim == 2, "of shape [h, w]")
    same_size = field.inside.shape == sketch.shape
    require("flow", f"{field.inside.shape[::-1]} px", same_size, f"of the sketch's size, {width} x {height} px")
    require("mode", mode, mode in SPLAT_MODES, f"one of {', '.join(SPLAT_MODES)}")
    require("alpha", alpha, 0 < alpha <= 80, "above 0 and at most 80")
    require("border", border, 0 <= border <= 20, "0 to 20 px")
    require("blur_sigma", blur_sigma, 0 <= blur_sigma <= 100, "0 to 100 px")

    lines = 1 - sketch
    holes = np.zeros(sketch.shape, dtype=bool)
    box = _reach(field, border)
    if box is not None:
        flow = _with_contours(field.displacement[box], field.inside[box], lines[box], border)
        warped, coverage = forward_warp(lines[box], flow, _importance(flow, mode, alpha))
        # What is covered by less than a half has been left: the few lines that reach into it are torn edges.
        holes[box] = coverage < 0.5
        lines[box] = np.where(holes[box], 0, warped)
        if field.covered is not None:
            # What stands still in front of all that moves keeps its lines, and shows no others.
            lines[field.covered] = 1 - sketch[field.covered]
            holes &= ~field.covered
    result = 1 - lines
    if blur_sigma > 0:
        result = cv2.GaussianBlur(result, (0, 0), blur_sigma, borderType=cv2.BORDER_REPLICATE)
    return WarpedSketch(result, holes)


def _reach(field: FlowField, border: int) -> tuple[slice, slice] | None:
    """Rows and columns that the bodies touch before or after the motion; None without a body."""
    height, width = field.inside.shape
    left, top, columns, rows = cv2.boundingRect(field.inside.view(np.uint8))
    if not columns:
        return None
    u, v = cv2.split(field.displacement[top : top + rows, left : left + columns])
    (back, forth), (up, down) = cv2.minMaxLoc(u)[:2], cv2.minMaxLoc(v)[:2]
    margin = border + 2
    begin_x, end_x = left + min(back, 0) - margin, left + columns + max(forth, 0) + margin
    begin_y, end_y = top + min(up, 0) - margin, top + rows + max(down, 0) + margin
    x0, x1 = np.clip((begin_x, end_x), 0, width).astype(int)
    y0, y1 = np.clip((begin_y, end_y), 0, height).astype(int)
    return slice(y0, y1), slice(x0, x1)


def _with_contours(flow: FloatImage, inside: Mask, lines: FloatImage, border: int) -> FloatImage:
    """The flow, continued over the parts of contour lines that stand out of a body.

    A contour is drawn around the body and half of it lies outside the mask; without this it would be left behind.
    """
    if border == 0:
        return flow
    size = (2 * border + 1, 2 * border + 1)
    weight = inside.astype(np.float32)
    near = cv2.boxFilter(weight, -1, size, normalize=False, borderType=cv2.BORDER_CONSTANT)
    mean = cv2.boxFilter(flow, -1, size, normalize=False, borderType=cv2.BORDER_CONSTANT)
    darkest = cv2.dilate(lines * weight, np.ones(size, np.uint8))
    contour = ~inside & (near > 0.5) & (lines > 0) & (darkest > 0.5 * lines)
    extended = flow.copy()
    extended[contour] = mean[contour] / near[contour, None]
    return extended


def _importance(flow: FloatImage, mode: SplatMode, alpha: float) -> FloatImage:
    """Weight of each pixel, shape [h, w]."""
    length = cv2.magnitude(*cv2.split(flow))
    if mode == "paper":
        return length + np.float32(_REST_WEIGHT)
    # Only the ratios count: the largest weight is 1 so that nothing overflows.
    return np.exp(np.float32(alpha) * (length / max(float(length.max()), 1e-6) - 1)).astype(np.float32)
