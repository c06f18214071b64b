"""Choices that no node offers, posted to a real host: refused before the graph runs, whichever node and input it is."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

SCHEMAS = json.loads((Path(__file__).parents[1] / "nodes" / "node_schemas.json").read_text(encoding="utf-8"))
UNKNOWN = "no such thing"
Values = dict[str, Any]


def usual(described: dict[str, Any], prefix: str, chosen: Values) -> Values:
    """Flat values of the widgets as a prompt has them, with the chosen options of dynamic choices."""
    values: Values = {}
    for group in ("required", "optional"):
        for name, (kind, options) in described.get(group, {}).items():
            full = prefix + name
            if kind == "COMFY_DYNAMICCOMBO_V3":
                values[full] = chosen.get(full, options["options"][0]["key"])
                option = next(each for each in options["options"] if each["key"] == values[full])
                values |= usual(option["inputs"], f"{full}.", chosen)
            elif kind == "COMBO":
                values[full] = options["options"][0]
            elif "default" in options:
                values[full] = options["default"]
            elif group == "required":
                values[full] = ["other", 0]
    return values


def places(described: dict[str, Any], prefix: str, chosen: Values) -> Iterator[tuple[str, Values]]:
    for group in ("required", "optional"):
        for name, (kind, options) in described.get(group, {}).items():
            full = prefix + name
            if kind in ("COMBO", "COMFY_DYNAMICCOMBO_V3"):
                yield full, chosen
            if kind == "COMFY_DYNAMICCOMBO_V3":
                for option in options["options"]:
                    yield from places(option["inputs"], f"{full}.", {**chosen, full: option["key"]})


EVERY = [(node, *place) for node, schema in SCHEMAS.items() for place in places(schema["input"], "", {})]


@pytest.mark.parametrize(("node", "name", "chosen"), EVERY)
def test_an_unknown_choice_never_runs(host: Any, node: str, name: str, chosen: Values) -> None:
    values = usual(SCHEMAS[node]["input"], "", chosen) | {name: UNKNOWN}
    # Of another kind than most inputs take, which is one more thing to complain about, and no link to nowhere.
    other = {"class_type": "EmptyImage", "inputs": {"width": 64, "height": 64, "batch_size": 1, "color": 0}}
    shown = {"class_type": "PreviewAny", "inputs": {"source": ["tried", 0]}}
    prompt = {"tried": {"class_type": node, "inputs": values}, "end": shown, "other": other}
    status, answer = host.post("/prompt", {"prompt": prompt})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    said = json.dumps(answer["node_errors"].get("tried", answer), ensure_ascii=False)
    leaf = name.rpartition(".")[2]
    assert leaf in said
    # A model file that is missing is named with where to get it; the host words plain choices itself.
    assert any(words in said for words in ("must be one of", "must be a file of", "not in", f"{UNKNOWN} is missing"))


@pytest.mark.parametrize(
    ("node", "values", "sentence"),
    [
        ("Material", {"preset": "granite"}, "preset must be one of hair, ribbon"),
        ("Material", {"preset": ["9", 0]}, "preset must be one of hair"),
        ("RigPoint", {"position": "[[1, 1]]", "region": "circle", "motion": "pinned", "body": 0}, "region.radius"),
        (
            "RigPoint",
            {"position": "[[1, 1]]", "region": "circle", "region.radius": 1e9, "motion": "pinned", "body": 0},
            "region.radius must be a number from 0.5 to 16384.0",
        ),
    ],
)
def test_a_choice_that_is_incomplete_never_runs(host: Any, node: str, values: Values, sentence: str) -> None:
    tried = {"class_type": f"PhysAnimator_{node}", "inputs": values}
    text = {"class_type": "PrimitiveString", "inputs": {"value": "hair"}}
    shown = {"class_type": "PreviewAny", "inputs": {"source": ["tried", 0]}}
    status, answer = host.post("/prompt", {"prompt": {"tried": tried, "9": text, "end": shown}})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert sentence.rpartition(".")[2] in json.dumps(answer)
