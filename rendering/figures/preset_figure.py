"""The figure of the presets: one strip in one gust, made of each of them."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.forces import EnergyStroke
from ...physics.material import PRESETS
from ...physics.mesh import mesh_from_mask
from ...physics.motion import Motion
from ...physics.progress import Progress
from ...physics.rig import Polygon, RigPoint
from ...physics.scene import Body, Scene
from ...physics.simulation import simulate
from ..composite import LayeredRenderer
from .ball import draw_stage
from .contact_sheet import contact_sheet

__all__ = ["preset_motions", "presets_figure", "tip_path"]

Image = NDArray[np.uint8]

_SIZE, _LEFT, _RIGHT, _TOP, _BOTTOM, _HELD = 320, 84.0, 116.0, 16.0, 226.0, 40.0
_SECONDS, _RATE = 5.0, 24.0
_FRAMES = (0, 6, 10, 16, 24, 38, 72)
_GUST_END = 0.25  # [s]
_OUTLINE, _ROD = (52, 30, 58), (122, 88, 70)
_BANDS = ((236, 74, 86), (252, 190, 58))
_CURVE, _CALM, _WINDY = (206, 58, 78), (190, 186, 200), (222, 234, 246)


def preset_motions(*, progress: Progress | None = None) -> dict[str, Motion]:
    """A strip, held at its top, in a gust of half a second and then in calm air, made of each preset.

    Args:
        progress: called after each strip.
    """
    mesh = mesh_from_mask(_strip()[1], spacing=8.0)
    held = RigPoint((_SIZE / 2, _HELD), Polygon(((0, 0), (_SIZE, 0), (_SIZE, _HELD), (0, _HELD))))
    gust = EnergyStroke(path=((-60, 130), (420, 130)), radius=200, speed=900, strength=8.0, interval=0.1, end=_GUST_END)
    motions = {}
    for number, (name, material) in enumerate(PRESETS.items(), start=1):
        scene = Scene((Body(mesh, material),), (gust,), (held,), frame_rate=_RATE)
        motions[name] = simulate(scene, frames=round(_SECONDS * _RATE) + 1)
        if progress is not None:
            progress(number, len(PRESETS))
    return motions


def tip_path(motion: Motion) -> NDArray[np.float64]:
    """Displacement of the middle of the strip's lower end [px], shape [f, 2]."""
    tip = int(np.argmin(np.hypot(*(motion.positions[0] - [(_LEFT + _RIGHT) / 2, _BOTTOM]).T)))
    return (motion.positions[:, tip] - motion.positions[0, tip]).astype(np.float64)


def presets_figure(*, progress: Progress | None = None) -> Image:
    """One strip in one gust, made of each preset.

    Args:
        progress: called after each strip.

    Returns:
        A contact sheet, RGB: a column for each preset, a row for each time, and below how the tip moves to and fro.
    """
    motions = preset_motions(progress=progress)
    picture, mask = _strip()
    columns = []
    for motion in motions.values():
        renderer = LayeredRenderer(picture, [mask], motion, plate=_stage())
        stills = [renderer.frame(frame)[: round(0.82 * _SIZE), : round(0.82 * _SIZE)] for frame in _FRAMES]
        columns.append([*stills, _curve(tip_path(motion)[:, 0], stills[0].shape[:2])])
    return contact_sheet(
        list(zip(*columns, strict=True)),
        title="The same strip, the same gust, five materials",
        note=f"Wind blows from the left for {_GUST_END:g} s. Below: the tip's way to the right over {_SECONDS:g} s.",
        columns=list(motions),
        row_names=[*(f"{frame / _RATE:.2f} s" for frame in _FRAMES), "tip"],
    )


def _curve(sideways: NDArray[np.float64], shape: tuple[int, int]) -> Image:
    """Sideways displacement over time, to the right from top to bottom of the displacement's scale."""
    height, width = shape
    panel = np.full((height, width, 3), 255, dtype=np.uint8)
    panel[:, : round(width * _GUST_END / _SECONDS)] = _WINDY
    middle = 0.6 * height
    cv2.line(panel, (0, round(middle)), (width, round(middle)), _CALM, 1, cv2.LINE_AA)
    points = np.column_stack([np.linspace(0, width - 1, len(sideways)), middle - 0.75 * sideways])
    cv2.polylines(panel, [np.rint(points * 16).astype(np.int32)], False, _CURVE, 2, cv2.LINE_AA, 4)
    return panel


def _strip() -> tuple[Image, NDArray[np.float32]]:
    """The stage with a banded strip that hangs from a rod, RGB, and the strip's coverage 0..1."""
    y, x = (np.indices((3 * _SIZE, 3 * _SIZE)) + 0.5) / 3
    depth = np.minimum.reduce([x - _LEFT, _RIGHT - x, y - _TOP, _BOTTOM - y])
    colours = np.array(_BANDS, dtype=np.float32)[((y - _TOP) // 21).astype(int) % 2]
    colours *= np.where(x > 0.65 * _RIGHT + 0.35 * _LEFT, 0.86, 1.0)[..., None].astype(np.float32)
    colours[depth < 2.2] = _OUTLINE
    colour = cv2.resize(colours, (_SIZE, _SIZE), interpolation=cv2.INTER_AREA)
    coverage = cv2.resize((depth >= 0).astype(np.float32), (_SIZE, _SIZE), interpolation=cv2.INTER_AREA)
    stage = _stage()
    picture = stage + coverage[..., None] * (colour - stage)
    return np.rint(picture).astype(np.uint8), coverage


def _stage() -> Image:
    stage = draw_stage(_SIZE, _SIZE, floor=0.72 * _SIZE)
    cv2.rectangle(stage, (0, 8), (_SIZE, 18), _OUTLINE, -1)
    cv2.rectangle(stage, (0, 10), (_SIZE, 16), _ROD, -1)
    return stage
