"""The paper's figures on controllability (paper, "Controllable Generation"), each drawn from simulations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.forces import EnergyStroke
from ...physics.material import Material
from ...physics.mesh import mesh_from_mask
from ...physics.motion import Motion
from ...physics.progress import Progress
from ...physics.rig import Polygon, RigPoint
from ...physics.scene import Body, Scene
from ...physics.simulation import simulate
from ..composite import LayeredRenderer
from ..overlays import draw_strokes
from .ball import draw_ball, draw_sand, draw_stage
from .contact_sheet import contact_sheet

__all__ = ["MODULI", "STRENGTHS", "ball_motions", "stiffness_figure", "stroke_motions", "strokes_figure"]

Image = NDArray[np.uint8]

MODULI = (25.0, 50.0, 100.0, 300.0, 1000.0)
"""Young's moduli of the stiffness figure [density side^2 / s^2]."""
STRENGTHS = (1.0, 2.0, 4.0)
"""Strengths of the strokes figure [side/s^2]."""

_BALL_SIZE, _BALL_CENTRE, _BALL_RADIUS, _SAND = 360, (140.0, 192.0), 112.0, 276.0
_BALL_FRAMES = (0, 8, 13, 18)
_STROKE_FRAME = 14
_DIRECTIONS: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {
    "to the left": ((1000, 250), (420, 250)),
    "upwards": ((800, 640), (800, 60)),
    "downwards": ((800, 20), (800, 600)),
}
_CROP = (slice(0, 690), slice(330, 1020))


def ball_motions(moduli: Sequence[float] = MODULI, *, progress: Progress | None = None) -> list[Motion]:
    """A ball, held where it stands in the sand, in the same gust at each stiffness.

    Args:
        moduli: Young's moduli [density side^2 / s^2].
        progress: called after each ball.
    """
    mesh = mesh_from_mask(_ball()[1])
    x, y = _BALL_CENTRE
    buried = Polygon(((0, _SAND), (_BALL_SIZE, _SAND), (_BALL_SIZE, _BALL_SIZE), (0, _BALL_SIZE)))
    foot = RigPoint((x, _SAND), buried)
    gust = EnergyStroke(
        path=((x - 190, y - 30), (x + 200, y - 30)), radius=170, speed=800, strength=6.0, interval=0.12, end=0.6
    )
    motions = []
    for number, modulus in enumerate(moduli, start=1):
        body = Body(mesh, Material(youngs_modulus=modulus, poisson_ratio=0.4, damping=2.0))
        motions.append(simulate(Scene((body,), (gust,), (foot,), gravity=(0.0, 1.0)), frames=_BALL_FRAMES[-1] + 1))
        if progress is not None:
            progress(number, len(moduli))
    return motions


def stiffness_figure(*, progress: Progress | None = None) -> Image:
    """One ball under a sweep of Young's modulus, pushed by the same forces.

    Args:
        progress: called after each ball.

    Returns:
        A contact sheet, RGB: a column for each modulus, a row for each time from the drawing on.
    """
    motions = ball_motions(progress=progress)
    picture, mask = _ball()
    plate = _stage()
    rows = []
    for frame in _BALL_FRAMES:
        shown = _stills(motions, frame)
        renderer = LayeredRenderer(picture, [mask], shown, plate=plate)
        rows.append([draw_sand(renderer.frame(t), top=_SAND) for t in range(1, len(shown))])
    rate = motions[0].frame_rate
    return contact_sheet(
        rows,
        title="The stiffer the ball, the better it keeps its shape",
        note="The same gust and gravity in every column; the ball stands in the sand.",
        columns=[f"E = {modulus:g}" for modulus in MODULI],
        row_names=[f"{frame / rate:.2f} s" for frame in _BALL_FRAMES],
    )


def stroke_motions(scene: Scene, *, progress: Progress | None = None) -> list[list[Motion]]:
    """A scene under one wind stroke of each direction and strength, in place of its own.

    Args:
        scene: bodies and rig points, over a picture of the example's shape.
        progress: called after each simulation.

    Returns:
        Motions, a list of one for each strength for each direction.
    """
    scale = scene.width / 1280
    done, motions = 0, []
    for path in _DIRECTIONS.values():
        row = []
        for strength in STRENGTHS:
            stroke = _stroke(path, strength, scale)
            row.append(simulate(replace(scene, strokes=(stroke,)), frames=_STROKE_FRAME + 1))
            done += 1
            if progress is not None:
                progress(done, len(_DIRECTIONS) * len(STRENGTHS))
        motions.append(row)
    return motions


def strokes_figure(
    image: Image, masks: Sequence[NDArray[Any]], scene: Scene, plate: Image, *, progress: Progress | None = None
) -> Image:
    """The example's figure under energy strokes of different direction and strength.

    Args:
        image: the example's illustration, RGB, uint8, shape [h, w, 3].
        masks: its moving parts, each of shape [h, w].
        scene: its bodies and rig points; the strokes are replaced.
        plate: the illustration without the moving parts.
        progress: called after each simulation.

    Returns:
        A contact sheet, RGB: a column for each strength, a row for each direction.
    """
    motions = stroke_motions(scene, progress=progress)
    shown = _stills([motion for row in motions for motion in row], _STROKE_FRAME)
    renderer = LayeredRenderer(image, masks, shown, plate=plate)
    rows, scale = [], scene.width / 1280
    for number, path in enumerate(_DIRECTIONS.values()):
        # Before its start, a stroke is only its arrow.
        row = [draw_strokes(image, [replace(_stroke(path, 1.0, scale), start=1.0)], 0.0)]
        row += [renderer.frame(1 + number * len(STRENGTHS) + column) for column in range(len(STRENGTHS))]
        rows.append([_half(picture[_CROP]) for picture in row])
    return contact_sheet(
        rows,
        title="One stroke, three directions, three strengths",
        note=f"The same drawing {_STROKE_FRAME / scene.frame_rate:.2f} s after the wind begins along the blue arrow.",
        columns=["drawing", *(f"strength {strength:g}" for strength in STRENGTHS)],
        row_names=list(_DIRECTIONS),
    )


def _stroke(path: tuple[tuple[float, float], ...], strength: float, scale: float) -> EnergyStroke:
    points = tuple((x * scale, y * scale) for x, y in path)
    return EnergyStroke(path=points, radius=260 * scale, speed=1100 * scale, strength=strength, interval=0.15)


def _ball() -> tuple[Image, NDArray[np.float32]]:
    return draw_ball(_stage(), _BALL_CENTRE, _BALL_RADIUS)


def _stage() -> Image:
    return draw_stage(_BALL_SIZE, _BALL_SIZE, floor=0.66 * _BALL_SIZE)


def _stills(motions: Sequence[Motion], frame: int) -> Motion:
    """One frame of several motions of the same bodies, after the drawing: one renderer draws them all."""
    first = motions[0]
    positions = np.stack([first.positions[0], *(motion.positions[frame] for motion in motions)])
    return Motion(first.bodies, positions, first.frame_rate)


def _half(picture: Image) -> Image:
    import cv2

    return cv2.resize(picture, (picture.shape[1] // 2, picture.shape[0] // 2), interpolation=cv2.INTER_AREA)
