"""Lengths and sizes that no video model knows are refused when a graph is posted, and not after its simulation."""

from __future__ import annotations

import re
import sys
from typing import Any

import pytest
from bar_graphs import core, moving_bar, ours

FORM = {"frames": 17, "width": 160, "height": 96, "fit": "crop"}
SIZE = {name: FORM[name] for name in ("width", "height", "fit")}
SHOWN = {"image": ["picture", 0], "motion": ["motion", 0]}
NODES: dict[str, dict[str, Any]] = {
    "WarpedVideo": SHOWN | FORM | {"grow": 4},
    "LineControlVideo": {"sketch": ["picture", 0], "motion": ["motion", 0], "lines": "white on black"} | FORM,
    "FirstAndLastFrame": SHOWN | SIZE | {"first_frame": 0, "last_frame": -1},
    "Keyframes": SHOWN | FORM | {"keyframes": "0, -1"},
    "MovingNoise": {"motion": ["motion", 0], "channels": 4, "seed": 0} | FORM,
    "TimeToMove": SHOWN | FORM | {"timing": "whole motion", "size": "width and height", "grow": 0},
}
WRONG = {"frames": (18, "4 k \\+ 1"), "width": (100, "a multiple of 16 px"), "height": (8, "a multiple of 16 px|16")}


@pytest.mark.parametrize(
    ("node", "name"), [(node, name) for node, given in NODES.items() for name in WRONG if name in given]
)
def test_what_no_model_knows_is_refused_before_anything_runs(standin: Any, node: str, name: str) -> None:
    wrong, said = WRONG[name]
    prompt = moving_bar(2) | {"tried": ours(node, **NODES[node] | {name: wrong})}
    prompt["end"] = core("PreviewAny", source=["tried", 0])
    errors, _ = standin.post(prompt)
    assert "tried" not in standin.executed
    (told,) = errors["tried"]
    assert re.search(f"{name} must be .*({said})", told["details"]), told


def test_what_does_not_count_is_not_asked_for(standin: Any) -> None:
    prompt = moving_bar(2)
    given = NODES["TimeToMove"] | {"frames": 18, "width": 100, "timing": "own length", "size": "480p"}
    standin.run(prompt | {"tried": ours("TimeToMove", **given), "end": core("PreviewAny", source=["tried", 5])})


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"length": 18}, r"length must be 4 k \+ 1"),
        ({"width": 100}, "width must be a multiple of 16 px"),
        ({"indices": "0, 81"}, "indices must be frames of the clip"),
        ({"indices": "0, -81"}, "indices must be different frames"),
    ],
)
def test_keyframes_for_wan_speak_of_its_own_inputs(standin: Any, given: dict[str, Any], said: str) -> None:
    usual = {"length": 81, "width": 832, "height": 480, "indices": "0, 40, -1"}
    kind = standin.known["PhysAnimator_WanKeyframes"]
    assert kind.validate_inputs(**usual) is True
    assert re.search(said, kind.validate_inputs(**usual | given))


def test_motion_vectors_are_refused_first_where_their_package_is_missing(
    standin: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    given = {"motion": ["motion", 0], "channels": "nuke", "filename_prefix": "vectors/none"}
    prompt = moving_bar(2) | {"saved": ours("SaveMotionVectors", **given)}
    errors, _ = standin.post(prompt)
    assert "saved" not in standin.executed
    assert "pip install OpenEXR" in errors["saved"][0]["details"]


@pytest.mark.parametrize("node", ["Render", "SaveAnimation", "WarpedVideo", "TimeToMove", "Keyframes"])
def test_a_clean_plate_of_another_size_is_called_by_its_name(standin: Any, node: str) -> None:
    prompt = moving_bar(2) | {"small": core("EmptyImage", width=80, height=48, batch_size=1, color=0)}
    given = NODES.get(node, SHOWN) | {"clean_plate": ["small", 0]}
    given |= {"filename_prefix": "film", "file_type": "mp4", "width": 0} if node == "SaveAnimation" else {}
    prompt |= {"tried": ours(node, **given), "end": core("PreviewAny", source=["tried", 0])}
    said = standin.error_of(prompt)
    assert "clean_plate must be of the image's size, 160 x 96 px. Got: 80 x 48 px" in said
