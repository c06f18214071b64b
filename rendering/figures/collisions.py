"""The paper's figure of several bodies that collide, beside the same bodies without contact (paper, "Multi-Object")."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.forces import EnergyStroke
from ...physics.material import Material
from ...physics.mesh import mesh_from_mask
from ...physics.motion import Motion
from ...physics.progress import Progress
from ...physics.rig import Polygon, RigPoint
from ...physics.scene import Body, Collider, Contact, Scene
from ...physics.simulation import simulate
from ..composite import LayeredRenderer
from .ball import ACCENTS, draw_ball, draw_sand, draw_stage
from .contact_sheet import contact_sheet

__all__ = ["collision_figure", "collision_motions", "touching"]

Image = NDArray[np.uint8]

_WIDTH, _HEIGHT, _SAND = 560, 400, 340.0
_BALLS = (((85.0, 220.0), 62.0), ((330.0, 72.0), 56.0), ((425.0, 286.0), 72.0))
_FRAMES = (0, 10, 12, 18)
_NEAR = 4.0  # [px]: bodies that are so near touch
_MARK = (226, 44, 62)


def collision_motions(*, progress: Progress | None = None) -> tuple[Motion, Motion]:
    """A ball blown into one that stands in the sand, and one that falls onto both: without contact and with it.

    Args:
        progress: called after each simulation.
    """
    stage = _stage()
    jelly = Material(youngs_modulus=55.0, poisson_ratio=0.4, damping=0.6)
    bodies = tuple(
        Body(mesh_from_mask(draw_ball(stage, centre, radius)[1]), jelly, layer)
        for layer, (centre, radius) in enumerate(_BALLS)
    )
    gust = EnergyStroke(path=((20, 220), (200, 220)), radius=100, speed=600, strength=8.0, interval=0.1, end=0.2)
    edge = ((-900.0, _SAND), (_WIDTH + 900.0, _SAND), (_WIDTH + 900.0, _HEIGHT + 400.0), (-900.0, _HEIGHT + 400.0))
    foot = RigPoint((_BALLS[2][0][0], _SAND), Polygon(edge), body=2)
    scene = Scene(bodies, (gust,), (foot,), gravity=(0.0, 2.2))
    motions = []
    for done, contact in enumerate((None, Contact(friction=0.4, thickness=2.0)), start=1):
        touched = replace(scene, contact=contact, colliders=(Collider(Polygon(edge)),))
        motions.append(simulate(touched, frames=_FRAMES[-1] + 1))
        if progress is not None:
            progress(done, 2)
    return motions[0], motions[1]


def collision_figure(*, progress: Progress | None = None) -> Image:
    """Several bodies with and without contact; where they touch is marked.

    Args:
        progress: called after each simulation.

    Returns:
        A contact sheet, RGB: a column for each time.
    """
    plate = _stage()
    picture, masks = plate, []
    for number, (centre, radius) in enumerate(_BALLS):
        picture, mask = draw_ball(picture, centre, radius, accents=ACCENTS[number:] + ACCENTS[:number])
        masks.append(mask)
    rows = []
    for marked, motion in zip((False, True), collision_motions(progress=progress), strict=True):
        renderer = LayeredRenderer(picture, masks, motion, plate=plate)
        drawn = [draw_sand(renderer.frame(t), top=_SAND) for t in _FRAMES]
        if marked:
            drawn = [_marked(each, touching(motion, t)) for each, t in zip(drawn, _FRAMES, strict=True)]
        rows.append(drawn)
    rate = motion.frame_rate
    return contact_sheet(
        rows,
        title="Bodies that meet push each other away",
        note="A gust blows a soft ball into one that stands in the sand; a third falls onto both. Circles: they touch.",
        columns=[f"{frame / rate:.2f} s" for frame in _FRAMES],
        row_names=["without\ncontact", "with\ncontact"],
    )


def touching(motion: Motion, frame: int) -> list[tuple[float, float]]:
    """Middle of the place where two bodies touch, for each pair that does [px].

    Args:
        motion: of bodies that do not overlap.
        frame: when.
    """
    places = []
    for first, second in combinations(range(len(motion.bodies)), 2):
        a, b = (_outline(motion, number, frame) for number in (first, second))
        distance = np.hypot(*(a[:, None] - b[None]).transpose(2, 0, 1))
        near = distance.min(axis=1) < _NEAR
        if near.any():
            x, y = a[near].mean(axis=0)
            places.append((float(x), float(y)))
    return places


def _outline(motion: Motion, number: int, frame: int) -> NDArray[np.float64]:
    """Points along a body's outline, four for each edge [px], shape [n, 2]."""
    edges = motion.of_body(number)[frame].astype(np.float64)[motion.bodies[number].mesh.boundary_edges]
    share = np.array([0.0, 0.25, 0.5, 0.75])[:, None, None]
    return ((1 - share) * edges[:, 0] + share * edges[:, 1]).reshape(-1, 2)


def _marked(picture: Image, places: list[tuple[float, float]]) -> Image:
    marked = picture.copy()
    for x, y in places:
        cv2.circle(marked, (round(x * 16 - 8), round(y * 16 - 8)), 26 * 16, _MARK, 4, cv2.LINE_AA, 4)
    return marked


def _stage() -> Image:
    return draw_stage(_WIDTH, _HEIGHT, floor=0.72 * _HEIGHT)
