"""Loops of parts shaped as people draw them: after a cycle, place and velocity are those of before, as simulated."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.document import scene_from_dict
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.rig import Polygon, RigPoint, Swing, Wave
from physanimator.physics.scene import Body, Scene, automatic_scene
from physanimator.physics.simulation import loop_frames, simulation

Array = NDArray[Any]
EXAMPLE = Path(__file__).resolve().parents[3] / "workflows" / "example"
WIDTH, HEIGHT = 640, 480


@dataclass(frozen=True)
class Course:
    """A loop, and what the simulation did around the cycle that became it [px].

    Attributes:
        loop: displacements in its frames, shape [f, v, 2].
        before: in the last frame before the cycle, shape [v, 2].
        after: in the two frames after it, shape [2, v, 2].
    """

    loop: Array
    before: Array
    after: Array


def course_of(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> Course:
    """Loop a scene, and let its simulation run on for two frames."""
    side, settle, found = max(scene.width, scene.height), simulation.settled, []

    def recorded(scene: Scene, displacements: Any, **options: Any) -> Any:
        seen: list[Array] = []

        def passing() -> Any:
            for displacement in displacements:
                seen.append(displacement.astype(np.float64) * side)
                yield displacement

        stream = passing()
        cycle, report = settle(scene, stream, **options)
        next(stream), next(stream)
        found.append(Course(cycle.astype(np.float64) * side, seen[-3 - len(cycle)], np.array(seen[-2:])))
        return cycle, report

    monkeypatch.setattr(simulation, "settled", recorded)
    motion = simulation.simulate(scene)
    assert len(motion) == len(found[0].loop) == loop_frames(scene)
    return found[0]


def farthest(difference: Array) -> float:
    return float(np.linalg.norm(difference, axis=-1).max())


def assert_returns(scene: Scene, monkeypatch: pytest.MonkeyPatch, *, moved: float) -> None:
    """Frame N is frame 0 within 0.1 px, the velocity is so within 0.1 px a frame, and the seam is no leap."""
    course = course_of(scene, monkeypatch)
    assert farthest(np.ptp(course.loop, axis=0)) > moved
    assert farthest(course.after[0] - course.loop[0]) < 0.1
    assert farthest(course.after[1] - course.after[0] - (course.loop[1] - course.loop[0])) < 0.1
    assert farthest(course.loop[-1] - course.before) < 0.1


def hair() -> Array:
    """A cap with seven wavy, tapering locks."""
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    cv2.ellipse(mask, (170, 130), (80, 70), 0, 0, 360, 255, -1)
    along = np.linspace(0, 1, 80)
    for number in range(7):
        x = 170 + along * (300 - 18 * number)
        y = 90 + 20 * number + along * 34 * number + 14 * np.sin(5 * along + number)
        width = 20 * (1 - along) + 3
        for centre, radius in zip(np.column_stack([x, y]).tolist(), width.tolist(), strict=True):
            cv2.circle(mask, (round(centre[0]), round(centre[1])), round(radius / 2), 255, -1)
    return mask


def skirt() -> Array:
    """A flared skirt with a scalloped hem."""
    x = np.linspace(60, 580, 90)
    hem = np.column_stack([x, 400 + 12 * np.abs(np.sin((x - 60) / 40)) + 0.0003 * (x - 320) ** 2])
    outline = np.concatenate([[[400, 90], [240, 90]], hem])
    return cv2.fillPoly(np.zeros((HEIGHT, WIDTH), np.uint8), [np.rint(outline).astype(np.int32)], 255)


def ribbons() -> Array:
    """A bow with two long, narrow ends that part and wind."""
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    cv2.ellipse(mask, (120, 120), (60, 30), 20, 0, 360, 255, -1)
    along = np.linspace(0, 1, 60)
    for side in (-1, 1):
        line = np.column_stack([140 + 380 * along, 130 + side * 60 * along + 26 * np.sin(7 * along)])
        cv2.polylines(mask, [np.rint(line).astype(np.int32)], False, 255, 26)
    return mask


@pytest.mark.parametrize(
    ("mask", "material", "attach", "turbulence"),
    [(hair(), "hair", "left", 0.5), (hair(), "hair", "left", None), (skirt(), "cloth", "top", None)],
    ids=["hair-in-eddies", "hair-in-gusts", "skirt-in-gusts"],
)
def test_drawn_shapes_return(
    mask: Array, material: str, attach: Any, turbulence: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    body = Body(mesh_from_mask(mask), preset(material))
    scene = automatic_scene([body], attach=attach, wind_strength=2.0, turbulence=turbulence)
    assert_returns(replace(scene, loop=3.0), monkeypatch, moved=8)


def test_a_bow_that_leads_its_ribbons_returns(monkeypatch: pytest.MonkeyPatch) -> None:
    """Root motion: the bow swings and turns, and the ends follow."""
    body = Body(mesh_from_mask(ribbons(), elements_across=2), preset("ribbon"))
    bow = Polygon(((50, 60), (190, 60), (190, 180), (50, 180)))
    root = RigPoint((120, 120), bow, (Wave(10.0, 1.5), Swing(10.0, 1.5)))
    assert_returns(Scene((body,), rig_points=(root,), loop=3.0), monkeypatch, moved=30)


def test_the_whole_example_returns(monkeypatch: pytest.MonkeyPatch) -> None:
    """Hair, cape, ribbon and plant, coarsely meshed, under all of its strokes."""
    document = json.loads((EXAMPLE / "scene.json").read_text(encoding="utf-8"))
    masks = (str(EXAMPLE / f"mask_{body['name']}.png") for body in document["bodies"])
    meshes = [mesh_from_mask(cv2.imread(mask, cv2.IMREAD_GRAYSCALE), spacing=24.0) for mask in masks]
    scene = scene_from_dict(document | {"loop": 3.0}, meshes=meshes)
    assert len(scene.bodies) == 4
    assert_returns(scene, monkeypatch, moved=40)
