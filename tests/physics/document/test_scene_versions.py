"""Documents of older versions load to the scenes that they always were; new parts survive the way there and back."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.physics.document import dumps, loads, scene_from_dict, scene_to_dict
from physanimator.physics.document.encoding import SCENE_VERSION
from physanimator.physics.errors import SceneError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import (
    Circle,
    Combined,
    KeyedPath,
    Pinned,
    Pulse,
    RigMotion,
    RigPoint,
    Rotation,
    Squash,
    Swing,
    Wave,
)
from physanimator.physics.scene import Body, Scene

OLD = (Path(__file__).parents[2] / "fixtures" / "scene_version_1.json").read_text(encoding="utf-8")


def meshes(count: int) -> list[TriangleMesh]:
    corners = np.array([[0.0, 0], [90, 0], [0, 90]])
    return [TriangleMesh(corners + 10 * k, np.array([[0, 1, 2]]), 1280, 720) for k in range(count)]


def test_a_document_of_version_1_is_read_as_it_was_meant() -> None:
    assert '"version": 1' in OLD
    scene = loads(OLD, meshes=meshes(4))
    assert [body.name for body in scene.bodies] == ["hair", "cape", "ribbon", "plant"]
    assert [body.material.sway_frequency for body in scene.bodies] == [0.85, 1.05, 1.3, 0.6]
    assert [body.layer for body in scene.bodies] == [0, 1, 2, 3]
    assert scene.frame_rate == 24
    assert scene.gravity == (0, 0)
    first = scene.rig_points[0]
    assert (first.position, first.motion, first.body, first.falloff) == ((560, 240), Pinned(), 0, 0)
    assert [len(rig_point.region.points) for rig_point in scene.rig_points] == [7, 7, 6, 4]
    stroke = scene.strokes[1]
    assert (stroke.radius, stroke.speed, stroke.strength, stroke.start, stroke.end) == (170, 610, 1.7, 0.1, None)
    assert stroke.path[0] == (430, 380)


def test_version_1_and_2_of_one_document_are_one_scene() -> None:
    new = OLD.replace('"version": 1', '"version": 2')
    read = [scene_to_dict(loads(text, meshes=meshes(4))) for text in (OLD, new)]
    assert read[0] == read[1]
    assert read[0]["version"] == SCENE_VERSION == 2


def test_motions_of_version_1_keep_their_course() -> None:
    path = {"type": "path", "times": [0, 1], "points": [[0, 0], [5, 5]]}
    wave = {"type": "wave", "amplitude": 18}
    entries = [{"position": [1, 2], "motion": motion} for motion in (path, wave)]
    data = {"version": 1, "width": 1280, "height": 720, "rig_points": entries}
    led, swung = scene_from_dict(data, meshes=meshes(1)).rig_points
    assert led.motion == KeyedPath((0, 1), ((0, 0), (5, 5)), easing="smooth")
    assert swung.motion == Wave(18, phase=0)
    assert data["version"] == 1  # what was given is left as it was


MOTIONS = [
    KeyedPath((0, 1), ((0, 0), (5, 5)), easing="hold"),
    Wave(18, 1.5, (0, 1), phase=-90),
    Rotation((0, 1, 2), (0, 30, -10), easing="linear"),
    Swing(12, 3, 45),
    Squash((0, 0.5), (1, 0.7), angle=30, keep_area=False, easing="smooth"),
    Pulse(1.3, 0.8, 10, 0, keep_area=False),
    Combined((Wave(4), Swing(5), Pulse(1.1))),
]


@pytest.mark.parametrize("motion", MOTIONS, ids=lambda motion: type(motion).__name__)
def test_motions_go_there_and_back(motion: RigMotion) -> None:
    scene = Scene((Body(meshes(1)[0]),), rig_points=(RigPoint((3, 4), Circle(9.0), motion, falloff=12.5),))
    (read,) = loads(dumps(scene)).rig_points
    assert read == scene.rig_points[0]


SWING = {"type": "swing"}
WRONG: list[tuple[dict[str, Any], str, str]] = [
    ({"type": "rotation", "times": [0, 1]}, ".angles", "is missing"),
    ({"type": "rotation", "times": [0], "angles": [0]}, ".angles", "at least 2 entries"),
    ({"type": "rotation", "times": [0, 1], "angles": [0, 1e9]}, ".angles[1]", "at most 36000"),
    ({"type": "rotation", "times": [0, 1, 2], "angles": [0, 1]}, ".times", "one per angle"),
    ({"type": "wave", "phase": "late"}, ".phase", "must be a number"),
    ({"type": "path", "times": [0, 1], "points": [[0, 0]] * 2, "easing": "eas"}, ".easing", "'ease'"),
    ({"type": "squash", "times": [0, 1], "factors": [1, 0]}, ".factors[1]", "at least 0.05"),
    ({"type": "pulse", "keep_area": 1}, ".keep_area", "must be true or false"),
    ({"type": "combined", "motions": []}, ".motions", "at least 1 entry"),
    ({"type": "combined", "motions": [SWING, {"type": "swing", "period": 0}]}, ".motions[1].period", "0.01"),
    (
        {"type": "combined", "motions": [{"type": "combined", "motions": [SWING]}]},
        ".motions[0].type",
        "must be one of pinned",
    ),
]


@pytest.mark.parametrize(("motion", "place", "message"), WRONG)
def test_wrong_values_of_version_2_are_named(motion: dict[str, Any], place: str, message: str) -> None:
    data = {"version": 2, "width": 1280, "height": 720, "rig_points": [{"position": [1, 2], "motion": motion}]}
    with pytest.raises(SceneError) as caught:
        loads(json.dumps(data), meshes=meshes(1))
    assert caught.value.path == f"rig_points[0].motion{place}"
    assert message in str(caught.value)


def test_a_negative_falloff_is_named() -> None:
    data = {"version": 2, "width": 1280, "height": 720, "rig_points": [{"position": [1, 2], "falloff": -1}]}
    with pytest.raises(SceneError, match=r"rig_points\[0\].falloff: must be at least 0 px"):
        loads(json.dumps(data), meshes=meshes(1))


def test_what_is_newer_is_refused() -> None:
    with pytest.raises(SceneError, match=r"newer PhysAnimator \(format 3, known here up to 2\)"):
        loads(OLD.replace('"version": 1', '"version": 3'), meshes=meshes(4))


def test_gravity_still_lets_documents_of_version_1_sag() -> None:
    document = {"version": 1, "width": 1280, "height": 720, "gravity": [0, 0.5]}
    assert scene_from_dict(document, meshes=meshes(1)).sag
    assert not scene_from_dict({**document, "version": 2}, meshes=meshes(1)).sag
    assert not scene_from_dict({**document, "gravity": [0, 0]}, meshes=meshes(1)).sag
