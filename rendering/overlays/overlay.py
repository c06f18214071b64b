"""Overlays that show a scene on a picture: meshes, rig points, energy strokes with their particles.

Positions are pixels of the illustration; ``scale`` carries them to a picture of another size.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import require
from ...physics.forces import EnergyStroke, particles
from ...physics.mesh import TriangleMesh
from ...physics.motion import Motion
from ...physics.scene import Scene
from .canvas import (
    DARK,
    Colour,
    canvas_from,
    circle,
    draw_dot,
    draw_lines,
    draw_uncased,
    fill_disc,
    fixed_point,
    in_dtype_of,
    scale_to,
    see_through,
    thin_width,
)
from .rig_overlay import draw_rig

__all__ = ["STROKE_COLOURS", "draw_strokes", "draw_wireframe", "preview"]

STROKE_COLOURS: dict[str, Colour] = {"wind": (70, 190, 255), "repel": (255, 110, 70), "attract": (120, 235, 110)}
_MESH_COLOUR: Colour = (255, 240, 120)


def draw_wireframe(image: NDArray[Any], mesh: TriangleMesh, positions: ArrayLike | None = None) -> NDArray[Any]:
    """The picture with the edges of a mesh, its boundary in bold.

    Args:
        image: RGB, uint8 or float in 0..1, shape [h, w, 3]; of any size, the mesh is scaled to it.
        mesh: the mesh.
        positions: where its vertices are [px of the illustration], shape [v, 2]; None means at rest.

    Returns:
        A new picture of the same size and type.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.rendering.overlays import draw_wireframe
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> bool((draw_wireframe(picture, mesh) != picture).any())
        True
    """
    canvas = canvas_from(image)
    points = mesh.vertices if positions is None else np.asarray(positions, dtype=np.float64)
    require("positions", f"shape {points.shape}", points.shape == mesh.vertices.shape, f"[{len(mesh.vertices)}, 2]")
    points = points * scale_to(canvas, mesh.width, mesh.height)
    unit = thin_width(canvas)

    edges = list(fixed_point(points[mesh.edges]))
    for colour, width, opacity in ((DARK, 2 * unit, 0.2), (_MESH_COLOUR, unit, 0.5)):
        see_through(canvas, partial(draw_uncased, lines=edges, colour=colour, width=width), opacity)
    draw_lines(canvas, points[mesh.boundary_edges], _MESH_COLOUR, unit)
    return in_dtype_of(canvas, image)


def draw_strokes(
    image: NDArray[Any], strokes: Sequence[EnergyStroke], t: float, *, scale: ArrayLike = 1.0
) -> NDArray[Any]:
    """The picture with energy strokes as arrows and the particles that travel along them.

    Args:
        image: RGB, uint8 or float in 0..1, shape [h, w, 3].
        strokes: wind in blue, repel in orange, attract in green.
        t: time at which the particles are shown, each with the disc on which it acts [s].
        scale: picture's size over the illustration's, a number or (x, y).

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.forces import EnergyStroke
        >>> from physanimator.rendering.overlays import draw_strokes
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> shown = draw_strokes(picture, [EnergyStroke(path=((5, 30), (55, 30)), radius=20.0)], t=0.2)
        >>> bool((shown != picture).any())
        True
    """
    canvas, scale = canvas_from(image), np.asarray(scale, dtype=np.float64)
    unit = thin_width(canvas)
    for stroke in strokes:
        colour, path = STROKE_COLOURS[stroke.kind], np.array(stroke.path) * scale
        draw_lines(canvas, [path, *_arrow_head(path, 14 * unit)], colour, 3 * unit)
        radius = stroke.radius * float(scale.mean())
        for position in particles(stroke, t)[0] * scale:
            see_through(canvas, partial(fill_disc, centre=position, radius=radius, colour=colour), 0.18)
            draw_lines(canvas, [circle(position, radius)], colour, 2 * unit)
            draw_dot(canvas, position, colour, 5 * unit)
    return in_dtype_of(canvas, image)


def preview(
    image: NDArray[Any],
    motion: Motion,
    scene: Scene | None,
    frame: int,
    *,
    wireframe: bool = True,
    rig: bool = True,
    strokes: bool = True,
) -> NDArray[Any]:
    """The picture with everything that moves in one frame and everything that moves it.

    Args:
        image: the illustration or the rendered frame, RGB, uint8 or float in 0..1, shape [h, w, 3], of any size.
        motion: where the bodies are.
        scene: its strokes and rig points are shown; None for the bodies alone.
        frame: frame of the motion.
        wireframe: show the meshes.
        rig: show the rig points.
        strokes: show the strokes and their particles.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion
        >>> from physanimator.physics.scene import Body, Scene
        >>> from physanimator.rendering.overlays import preview
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> preview(picture, motion, Scene(motion.bodies), frame=1).shape
        (60, 60, 3)
    """
    require("frame", frame, 0 <= frame < len(motion), f"0 to {len(motion) - 1}")
    picture, t = canvas_from(image), frame / motion.frame_rate
    scale = scale_to(picture, motion.width, motion.height)
    if wireframe:
        for number, body in enumerate(motion.bodies):
            picture = draw_wireframe(picture, body.mesh, motion.of_body(number)[frame])
    if scene is not None and strokes:
        picture = draw_strokes(picture, scene.strokes, t, scale=scale)
    if scene is not None and rig:
        picture = draw_rig(picture, scene.rig_points, t, scale=scale)
    return in_dtype_of(picture, image)


def _arrow_head(path: NDArray[np.float64], length: float) -> list[NDArray[np.float64]]:
    """The barbs at a path's last point, none for a path without a direction."""
    steps = np.diff(path, axis=0)
    steps = steps[np.hypot(*steps.T) > 0]
    if not len(steps):
        return []
    back = -steps[-1] / np.hypot(*steps[-1]) * length
    turned = np.array([-back[1], back[0]])
    return [np.stack([path[-1] + back + 0.6 * turned, path[-1], path[-1] + back - 0.6 * turned])]
