"""A wrong value is one line in the host's report, named after its input, whatever else the node takes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from bar_graphs import ours
from standin.checking import checked_prompt

SCHEMAS: dict[str, Any] = json.loads(Path(__file__).with_name("node_schemas.json").read_text(encoding="utf-8"))
Given = dict[str, Any]


def usual(described: Given, prefix: str = "") -> Given:
    """Values of a new node, and links to nowhere where it has none."""
    values: Given = {}
    for group in ("required", "optional"):
        for name, (kind, options) in described.get(group, {}).items():
            if kind == "COMFY_DYNAMICCOMBO_V3":
                option = options["options"][0]
                values |= {prefix + name: option["key"]} | usual(option["inputs"], f"{prefix}{name}.")
            elif kind == "COMBO":
                values[prefix + name] = options.get("default", next(iter(options["options"]), ""))
            elif "default" in options:
                values[prefix + name] = options["default"]
    return values


def refused(standin: Any, node: str, given: Given, more: Given | None = None) -> list[str]:
    """What the node itself is reported to have said, a line each."""
    prompt = {"one": ours(node, **given)} | (more or {})
    for handler in standin.server.on_prompt_handlers:
        handler({"prompt": prompt})
    checked = checked_prompt(prompt, standin.known, "prompt")
    checked.is_valid("one")
    return [each["details"] for each in checked.errors.get("one", []) if "ustom" in each["type"]]


NUMBERS = [
    (node.removeprefix("PhysAnimator_"), name, wrong)
    for node, schema in SCHEMAS.items()
    for group in ("required", "optional")
    for name, (kind, options) in schema["input"].get(group, {}).items()
    if kind in ("INT", "FLOAT")
    for wrong in (float("nan"), options["max"] + 1)
]


@pytest.mark.parametrize(("node", "name", "wrong"), NUMBERS)
def test_a_wrong_number_is_said_once(standin: Any, node: str, name: str, wrong: float) -> None:
    clicked = {"points": "[[10, 10, 1]]"}
    needed = {"SegmentByPoints": clicked, "AnimateIllustration": clicked}.get(node, {})
    said = refused(standin, node, usual(SCHEMAS[f"PhysAnimator_{node}"]["input"]) | needed | {name: wrong})
    assert len(said) <= 1  # none where the host itself refuses it
    assert all(f"{name} must be" in line for line in said)


@pytest.mark.parametrize(
    ("node", "changed", "line"),
    [
        ("EnergyStroke", {"path": "nonsense"}, "path - path"),
        ("EnergyStroke", {"path": "[[0, 0], [9, 9]]", "strength_keys": "strong"}, "strength_keys - strength_keys"),
        ("RigPoint", {"position": "nowhere"}, "position - position"),
        ("RigPoint", {"position": "[[5, 5]]", "region.radius": -1.0}, "region - radius must be above 0"),
        ("SceneFromJSON", {"scene": '{"version": 2}'}, "scene - "),
        ("SceneEditor", {"scene": "{"}, "scene - "),
        ("SegmentByPoints", {"points": "[[1, 2, 0]]"}, "points - points must be with one on the part at least"),
        ("SegmentByPoints", {"box": "[1, 2]"}, "box - box"),
        ("SaveAnimation", {"filename_prefix": "../away"}, "filename_prefix - filename_prefix"),
        ("ExtractSketch", {"extractor": "crayons"}, "extractor must be one of"),
    ],
)
def test_a_wrong_value_is_named_after_its_input(standin: Any, node: str, changed: Given, line: str) -> None:
    (said,) = refused(standin, node, usual(SCHEMAS[f"PhysAnimator_{node}"]["input"]) | changed)
    assert line in said


def test_of_two_nodes_each_has_its_own_line(standin: Any) -> None:
    given = usual(SCHEMAS["PhysAnimator_EnergyStroke"]["input"])
    wrong = ours("EnergyStroke", **given | {"path": "nonsense"})
    right = given | {"path": "[[0, 0], [9, 9]]"}
    assert refused(standin, "EnergyStroke", right, {"other": wrong}) == []
    assert len(refused(standin, "EnergyStroke", right | {"start": float("nan")}, {"other": wrong})) <= 2


def test_what_was_not_clicked_is_said_of_the_points(standin: Any) -> None:
    for node, more in (("AnimateIllustration", {}), ("SegmentByPoints", {"image": ["other", 0]})):
        given = usual(SCHEMAS[f"PhysAnimator_{node}"]["input"]) | {"points": ""} | more
        said = refused(standin, node, given, {"other": ours("ExampleIllustration")})
        assert [line.partition(" - ")[0] for line in said] == ["points"]
        assert "click on what shall move" in said[0]


def test_a_picture_that_is_not_there_is_said_of_the_picture(standin: Any) -> None:
    given = usual(SCHEMAS["PhysAnimator_AnimateIllustration"]["input"]) | {
        "points": "[[10, 10, 1]]",
        "picture": "gone.png",
    }
    said = refused(standin, "AnimateIllustration", given)
    assert all(line.startswith("picture - ") for line in said)
