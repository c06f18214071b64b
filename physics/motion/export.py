"""A motion as files that other programs read: JSON with every vertex, and an SVG that plays in a browser."""

from __future__ import annotations

import html
import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import require
from .flow import layer_order
from .motion import Motion
from .trails import trails

__all__ = ["MOTION_VERSION", "motion_to_dict", "motion_to_json", "motion_to_svg"]

MOTION_VERSION = 1

_COLOURS = ("#e4572e", "#2e86ab", "#f3a712", "#4c9f70", "#8e6bbf", "#d1495b", "#00798c", "#7a5c3e")
_FINENESS = 10  # steps a pixel in an SVG


def motion_to_dict(motion: Motion, *, decimals: int = 3) -> dict[str, Any]:
    """The motion as plain data.

    ``{"format": "physanimator-motion", "version": 1, "width", "height", "frame_rate", "frames", "bodies": [...]}``,
    where each body has ``name``, ``layer`` (a higher one covers a lower one), ``rest`` ([[x, y], ...] of the drawing),
    ``triangles`` ([[a, b, c], ...], numbers of its vertices) and ``positions`` (for each frame [[x, y], ...]). Lengths
    are pixels, x right and y down, pixel centres at integer + 0.5.

    Args:
        motion: what to export.
        decimals: of the coordinates.
    """
    require("decimals", decimals, 0 <= decimals <= 9, "0 to 9")
    bodies = [
        {
            "name": body.name,
            "layer": body.layer,
            "rest": _rounded(body.mesh.vertices, decimals),
            "triangles": body.mesh.triangles.tolist(),
            "positions": _rounded(motion.of_body(number), decimals),
        }
        for number, body in enumerate(motion.bodies)
    ]
    return {
        "format": "physanimator-motion",
        "version": MOTION_VERSION,
        "width": motion.width,
        "height": motion.height,
        "frame_rate": motion.frame_rate,
        "frames": len(motion),
        "bodies": bodies,
    }


def motion_to_json(motion: Motion, *, decimals: int = 3) -> str:
    """:func:`motion_to_dict` as JSON text without blanks.

    Examples:
        >>> import json
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion, motion_to_json
        >>> from physanimator.physics.scene import Body
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> sorted(json.loads(motion_to_json(motion)))
        ['bodies', 'format', 'frame_rate', 'frames', 'height', 'version', 'width']
    """
    return json.dumps(motion_to_dict(motion, decimals=decimals), separators=(",", ":"), ensure_ascii=False) + "\n"


def motion_to_svg(motion: Motion, *, background: str | None = None) -> str:
    """The moving meshes as one SVG that plays in any browser, without a script.

    Each body is a group of two paths, its edges and its outline, whose shape is animated frame by frame. Programs that
    do not play SVG show the first frame.

    Args:
        motion: what to show.
        background: address of a picture behind the meshes (a file's name or a ``data:`` address); None for none.
    """
    from xml.sax.saxutils import quoteattr  # which loads a client for the web

    size = f'width="{motion.width}" height="{motion.height}"'
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 {motion.width} {motion.height}">',
        "<title>Motion of the meshes</title>",
    ]
    if background is not None:
        lines.append(f'<image href={quoteattr(background)} {size} opacity="0.45"/>')
    for number in layer_order(motion.bodies):
        lines += _group(motion, number)
    return "\n".join([*lines, "</svg>", ""])


def _group(motion: Motion, number: int) -> list[str]:
    body, colour = motion.bodies[number], _COLOURS[number % len(_COLOURS)]
    look = f'fill="{colour}" stroke="{colour}" stroke-linejoin="round"'
    mesh, positions = body.mesh, motion.of_body(number)
    edges = _path(trails(mesh.edges), positions, motion, 'fill="none" stroke-opacity="0.6" stroke-width="8"')
    outline = _path(
        trails(mesh.boundary_edges), positions, motion, 'fill-opacity="0.25" fill-rule="evenodd" stroke-width="20"'
    )
    name = html.escape(body.name or f"part {number + 1}", quote=False)
    return [f'<g transform="scale({1 / _FINENESS:g})" {look}>', f"<title>{name}</title>", edges, outline, "</g>"]


def _path(lines: list[NDArray[np.int64]], positions: NDArray[np.float32], motion: Motion, look: str) -> str:
    fixed = np.rint(positions * _FINENESS).astype(np.int64)
    shapes = [_shape(lines, frame) for frame in fixed]
    if len(shapes) == 1:
        return f'<path {look} d="{shapes[0]}"/>'
    # A discrete animation shows each value for an equal share of its duration.
    duration = len(shapes) / motion.frame_rate
    return (
        f'<path {look} d="{shapes[0]}"><animate attributeName="d" dur="{duration:.6g}s" repeatCount="indefinite"'
        f' calcMode="discrete" values="{";".join(shapes)}"/></path>'
    )


def _shape(lines: list[NDArray[np.int64]], points: NDArray[np.int64]) -> str:
    """Path data: each line from its first point on by steps."""
    parts = []
    for line in lines:
        (x, y), steps = points[line[0]], np.diff(points[line], axis=0)
        parts.append(f"M{x} {y}l" + " ".join(f"{dx} {dy}" for dx, dy in steps.tolist()))
    return "".join(parts)


def _rounded(array: NDArray[np.floating], decimals: int) -> Any:
    return array.astype(np.float64).round(decimals).tolist()
