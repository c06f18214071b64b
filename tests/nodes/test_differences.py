"""The page of differences from the paper names inputs that there are, with the values of the strict graph."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "workflows" / "differences_from_the_paper.md").read_text(encoding="utf-8")
API = json.loads((ROOT / "workflows" / "api" / "paper_strict.json").read_text(encoding="utf-8"))
SCHEMAS: dict[str, Any] = json.loads(Path(__file__).with_name("node_schemas.json").read_text(encoding="utf-8"))
NAMED = re.findall(r"`([A-Z]\w+)\.([a-z][\w.]*)(?: = ([^`]+))?`", PAGE)
OTHERWISE = {("RigPoint", "motion.period"), ("RigPoint", "motion"), ("Scene", "contact"), ("MaskToMesh", "image")}
"""What the graph does not show: it has a rigging point of each kind, and what must be left unconnected."""


def inputs_of(described: dict[str, Any]) -> dict[str, list[Any]]:
    """Names of all inputs, those of dynamic choices included, with the values that they offer."""
    found: dict[str, list[Any]] = {}
    for name, (kind, *options) in {**described.get("required", {}), **described.get("optional", {})}.items():
        offered = (options[0] if options else {}).get("options", [])
        found.setdefault(name, []).extend(each["key"] if isinstance(each, dict) else each for each in offered)
        for option in offered if kind == "COMFY_DYNAMICCOMBO_V3" else ():
            for inner, values in inputs_of(option["inputs"]).items():
                found.setdefault(f"{name}.{inner}", []).extend(values)
    return found


@pytest.mark.parametrize(("node", "name", "value"), NAMED)
def test_every_input_of_the_page_is_there(node: str, name: str, value: str) -> None:
    known = inputs_of(SCHEMAS[f"PhysAnimator_{node}"]["input"])
    assert name in known
    if value and known[name]:
        assert value in known[name]


@pytest.mark.parametrize(("node", "name", "value"), [each for each in NAMED if each[2]])
def test_the_strict_graph_has_the_paper_s_values(node: str, name: str, value: str) -> None:
    if (node, name) in OTHERWISE:
        return
    nodes = [each["inputs"] for each in API.values() if each["class_type"] == f"PhysAnimator_{node}"]
    assert nodes
    for inputs in nodes:
        assert str(inputs[name]).lower() in (value.lower(), f"{value}.0"), f"{node}.{name} of paper_strict"


def test_the_strict_graph_s_meshes_are_not_fitted_to_the_picture() -> None:
    meshes = [node["inputs"] for node in API.values() if node["class_type"] == "PhysAnimator_MaskToMesh"]
    assert meshes
    assert not any("image" in inputs for inputs in meshes)
