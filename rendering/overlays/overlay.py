"""Overlays that show a scene on a picture: meshes, rig points, energy strokes with their particles.

Every line is drawn in a bright colour over a wider dark one, so that it can be read on light and on dark pictures.
Positions are pixels of the illustration; ``scale`` carries them to a picture of another size.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...physics.errors import require
from ...physics.forces import EnergyStroke, particles
from ...physics.mesh import TriangleMesh
from ...physics.motion import Motion
from ...physics.rig import (
    Circle,
    Combined,
    KeyedPath,
    Polygon,
    RigMotion,
    RigPoint,
    RigRegion,
    Wave,
    displacement,
    linear_part,
)
from ...physics.scene import Scene
from ..pictures import as_picture, as_uint8
from .flow_colour import flow_to_color

__all__ = ["RIG_COLOURS", "STROKE_COLOURS", "draw_rig", "draw_strokes", "draw_wireframe", "flow_to_color", "preview"]

Canvas = NDArray[np.uint8]
Colour = tuple[int, int, int]

STROKE_COLOURS: dict[str, Colour] = {"wind": (70, 190, 255), "repel": (255, 110, 70), "attract": (120, 235, 110)}
RIG_COLOURS: dict[str, Colour] = {"Pinned": (255, 80, 100), "KeyedPath": (215, 130, 255), "Wave": (255, 205, 60)}
_TURN_COLOUR: Colour = (90, 225, 215)
_MESH_COLOUR: Colour = (255, 240, 120)
_DARK: Colour = (20, 20, 30)

# cv2 takes coordinates in sixteenths of a pixel.
_BITS = 4


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
    canvas = _canvas(image)
    points = mesh.vertices if positions is None else np.asarray(positions, dtype=np.float64)
    require("positions", f"shape {points.shape}", points.shape == mesh.vertices.shape, f"[{len(mesh.vertices)}, 2]")
    points = points * _scale_to(canvas, mesh.width, mesh.height)
    unit = _unit(canvas)

    edges = list(_fixed(points[mesh.edges]))
    for colour, width, opacity in ((_DARK, 2 * unit, 0.2), (_MESH_COLOUR, unit, 0.5)):
        _lay(canvas, partial(_thin, lines=edges, colour=colour, width=width), opacity)
    _lines(canvas, points[mesh.boundary_edges], _MESH_COLOUR, unit)
    return _returned(canvas, image)


def draw_rig(image: NDArray[Any], rig_points: Sequence[RigPoint], t: float, *, scale: ArrayLike = 1.0) -> NDArray[Any]:
    """The picture with rig points, their regions and the ways they go.

    Args:
        image: RGB, uint8 or float in 0..1, shape [h, w, 3].
        rig_points: pins in red, keyed paths in violet, waves in yellow, what turns or is squashed in turquoise.
        t: time at which they are shown [s].
        scale: picture's size over the illustration's, a number or (x, y).
    """
    canvas, scale = _canvas(image), np.asarray(scale, dtype=np.float64)
    unit = _unit(canvas)
    for rig_point in rig_points:
        colour = RIG_COLOURS.get(type(rig_point.motion).__name__, _TURN_COLOUR)
        position = np.array(rig_point.position)
        moved, (turned, _) = displacement(rig_point.motion, t), linear_part(rig_point.motion, t)
        drawn = _outlines(rig_point.position, rig_point.region)
        outlines = [((outline - position) @ turned.T + position + moved) * scale for outline in drawn]
        _lay(canvas, partial(_area, outlines=outlines, colour=colour), 0.2)
        for outline in outlines:
            _lines(canvas, [np.concatenate([outline, outline[:1]])], colour, 2 * unit)
        _lines(canvas, [way * scale for way in _way(rig_point)], colour, 2 * unit)
        _dot(canvas, (position + moved) * scale, colour, 4 * unit)
    return _returned(canvas, image)


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
    canvas, scale = _canvas(image), np.asarray(scale, dtype=np.float64)
    unit = _unit(canvas)
    for stroke in strokes:
        colour, path = STROKE_COLOURS[stroke.kind], np.array(stroke.path) * scale
        _lines(canvas, [path, *_arrow_head(path, 14 * unit)], colour, 3 * unit)
        radius = stroke.radius * float(scale.mean())
        for position in particles(stroke, t)[0] * scale:
            _lay(canvas, partial(_disc, centre=position, radius=radius, colour=colour), 0.18)
            _lines(canvas, [_circle(position, radius)], colour, 2 * unit)
            _dot(canvas, position, colour, 5 * unit)
    return _returned(canvas, image)


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
    picture, t = _canvas(image), frame / motion.frame_rate
    scale = _scale_to(picture, motion.width, motion.height)
    if wireframe:
        for number, body in enumerate(motion.bodies):
            picture = draw_wireframe(picture, body.mesh, motion.of_body(number)[frame])
    if scene is not None and strokes:
        picture = draw_strokes(picture, scene.strokes, t, scale=scale)
    if scene is not None and rig:
        picture = draw_rig(picture, scene.rig_points, t, scale=scale)
    return _returned(picture, image)


def _canvas(image: NDArray[Any]) -> Canvas:
    """A uint8 copy to draw on."""
    return np.array(as_uint8(as_picture(image)), order="C")


def _returned(canvas: Canvas, image: NDArray[Any]) -> NDArray[Any]:
    dtype = np.asarray(image).dtype
    return (canvas / 255).astype(dtype) if dtype.kind == "f" else canvas


def _scale_to(canvas: Canvas, width: int, height: int) -> NDArray[np.float64]:
    return np.array([canvas.shape[1] / width, canvas.shape[0] / height])


def _unit(canvas: Canvas) -> int:
    """Width of a thin line, so that overlays look alike at every resolution [px]."""
    return max(1, round(max(canvas.shape[:2]) / 1280))


def _fixed(points: ArrayLike) -> NDArray[np.int32]:
    """Coordinates as cv2 draws them: pixel centres at integers, in fixed point."""
    return np.rint(np.clip((np.asarray(points) - 0.5) * 2**_BITS, -(2**26), 2**26)).astype(np.int32)


def _thin(canvas: Canvas, lines: Sequence[NDArray[np.int32]], colour: Colour, width: int) -> None:
    cv2.polylines(canvas, lines, False, colour, width, cv2.LINE_AA, _BITS)


def _lines(canvas: Canvas, lines: Any, colour: Colour, width: int) -> None:
    """Polylines with a dark casing."""
    fixed = [_fixed(line) for line in lines]
    _thin(canvas, fixed, _DARK, width + 2)
    _thin(canvas, fixed, colour, width)


def _area(canvas: Canvas, outlines: Sequence[NDArray[np.float64]], colour: Colour) -> None:
    """What lies inside an odd number of outlines."""
    cv2.fillPoly(canvas, [_fixed(outline) for outline in outlines], colour, cv2.LINE_AA, _BITS)


def _disc(canvas: Canvas, centre: NDArray[np.float64], radius: float, colour: Colour) -> None:
    _area(canvas, [_circle(centre, radius)], colour)


def _dot(canvas: Canvas, centre: NDArray[np.float64], colour: Colour, radius: float) -> None:
    _disc(canvas, centre, radius + 1.5, _DARK)
    _disc(canvas, centre, radius, colour)


def _lay(canvas: Canvas, draw: Callable[[Canvas], Any], opacity: float) -> None:
    """Draw see-through."""
    layer = canvas.copy()
    draw(layer)
    cv2.addWeighted(layer, opacity, canvas, 1 - opacity, 0, dst=canvas)


def _circle(centre: ArrayLike, radius: float) -> NDArray[np.float64]:
    """A closed polygon."""
    angles = np.linspace(0, 2 * np.pi, 65)
    return np.asarray(centre) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _arrow_head(path: NDArray[np.float64], length: float) -> list[NDArray[np.float64]]:
    """The barbs at a path's last point, none for a path without a direction."""
    steps = np.diff(path, axis=0)
    steps = steps[np.hypot(*steps.T) > 0]
    if not len(steps):
        return []
    back = -steps[-1] / np.hypot(*steps[-1]) * length
    turned = np.array([-back[1], back[0]])
    return [np.stack([path[-1] + back + 0.6 * turned, path[-1], path[-1] + back - 0.6 * turned])]


def _outlines(position: tuple[float, float], region: RigRegion) -> list[NDArray[np.float64]]:
    if isinstance(region, Circle):
        return [_circle(position, region.radius)]
    if isinstance(region, Polygon):
        return [np.array(region.points)]
    contours, _ = cv2.findContours(region.mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    return [contour[:, 0] + 0.5 for contour in contours]


def _way(rig_point: RigPoint) -> list[NDArray[np.float64]]:
    """The line along which a rig point goes."""
    position, motion = np.array(rig_point.position), rig_point.motion
    singles = motion.motions if isinstance(motion, Combined) else (motion,)
    spans = [span for single in singles for span in _span(single)]
    if not spans:
        return []
    return [position + displacement(motion, np.linspace(min(spans), max(spans), 129))]


def _span(motion: RigMotion) -> tuple[float, ...]:
    """First and last time of the way that a motion leads along, none where it stays in its place [s]."""
    if isinstance(motion, Wave):
        return 0.0, motion.period
    return (motion.times[0], motion.times[-1]) if isinstance(motion, KeyedPath) else ()
