"""Choices and numbers that a node does not offer, for every input of every node, without a host.

The schemas are the report of a real host; tests/host/test_choices.py posts the same to one.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from physanimator.nodes.host import checked, choices, one_line
from physanimator.nodes.host.choices import check_choices, check_values
from physanimator.physics.errors import InvalidInputError

SCHEMAS: dict[str, Any] = json.loads((Path(__file__).parents[1] / "node_schemas.json").read_text(encoding="utf-8"))
UNKNOWN = "no such thing"
Path_ = tuple[tuple[str, str], ...]


def named(described: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    for group in ("required", "optional"):
        for name, (kind, options) in described.get(group, {}).items():
            yield name, kind, options


def usual(described: dict[str, Any], chosen: Path_ = ()) -> dict[str, Any]:
    """Usable values for every input; for dynamic choices the named options, else the first ones."""
    values: dict[str, Any] = {}
    for name, kind, options in named(described):
        if kind == "COMFY_DYNAMICCOMBO_V3":
            key = dict(chosen).get(name, options["options"][0]["key"])
            option = next(each for each in options["options"] if each["key"] == key)
            values[name] = {**usual(option["inputs"], chosen), name: key}
        elif kind == "COMBO":
            values[name] = options["options"][0]
        else:
            values[name] = options.get("default", object())
    return values


def inputs(described: dict[str, Any], chosen: Path_ = ()) -> Iterator[tuple[Path_, str, str, dict[str, Any]]]:
    """Every input, with the options that lead to it."""
    for name, kind, options in named(described):
        yield chosen, name, kind, options
        if kind == "COMFY_DYNAMICCOMBO_V3":
            for option in options["options"]:
                yield from inputs(option["inputs"], (*chosen, (name, option["key"])))


EVERY = [(node, *found) for node, schema in SCHEMAS.items() for found in inputs(schema["input"])]
CLOSED = [each for each in EVERY if not each[4].get(choices.OPEN)]
CHOICES = [each[:3] for each in CLOSED if each[3] in ("COMBO", "COMFY_DYNAMICCOMBO_V3")]
NUMBERS = [(*each[:3], each[4]) for each in EVERY if each[3] in ("INT", "FLOAT")]


def placed(values: dict[str, Any], chosen: Path_, name: str, value: Any) -> dict[str, Any]:
    """The values with one of them replaced, below the options that lead to it."""
    inner = values
    for key, _ in chosen:
        inner = inner[key]
    inner[name] = value
    return values


def test_there_is_something_to_try() -> None:
    assert len(CHOICES) > 30
    assert any(len(each[1]) > 0 for each in CHOICES)
    assert len(NUMBERS) > 100


@pytest.mark.parametrize(("node", "chosen", "name"), CHOICES)
def test_an_unknown_choice_is_refused(node: str, chosen: Path_, name: str) -> None:
    described = SCHEMAS[node]["input"]
    check_choices(described, usual(described, chosen), None)
    with pytest.raises(InvalidInputError, match=rf"{name} must be one of .*Got: 'no such thing'$"):
        check_choices(described, placed(usual(described, chosen), chosen, name, UNKNOWN), None)


@pytest.mark.parametrize(("node", "chosen", "name", "options"), NUMBERS)
def test_a_number_out_of_its_range_is_refused(node: str, chosen: Path_, name: str, options: dict[str, Any]) -> None:
    described = SCHEMAS[node]["input"]
    check_values(described, usual(described, chosen), None, bounded=True)
    for wrong in (options["min"] - 1, options["max"] + 1, float("nan"), "many"):
        with pytest.raises(InvalidInputError, match=rf"{name} must be a number from"):
            check_values(described, placed(usual(described, chosen), chosen, name, wrong), None, bounded=True)


@pytest.mark.parametrize("sent", [{"renderer": UNKNOWN}, {"renderer": 3}, {"renderer": True}, {"renderer": ["9", 0]}])
def test_a_choice_that_the_host_has_dropped_is_found_in_the_prompt(sent: dict[str, Any]) -> None:
    described = SCHEMAS["PhysAnimator_Render"]["input"]
    values = {"image": object(), "motion": object()}
    check_choices(described, values, None)
    check_choices(described, values, {"image": ["1", 0], "motion": ["2", 0]})
    offered = "composite, sketch-guided SVD, soft inpainting, animation-guided SVD"
    with pytest.raises(InvalidInputError, match=rf"^renderer must be one of {offered}\. Got: "):
        check_choices(described, values, sent)


def test_what_a_choice_needs_must_be_there_but_may_come_from_another_node() -> None:
    described = SCHEMAS["PhysAnimator_RigPoint"]["input"]
    values = {"position": "[[1, 1]]", "motion": {"motion": "pinned"}, "body": 0}
    region = {"region": {"region": "circle", "radius": None}}
    check_choices(described, values | region, {"region": "circle", "region.radius": ["4", 0]})
    with pytest.raises(InvalidInputError, match=r"^region\.radius must be given: it belongs to region\. Got: nothing"):
        check_choices(described, values | region, {"region": "circle"})
    with pytest.raises(InvalidInputError, match=r"^region must be one of circle, polygon, mask\. Got: nothing"):
        check_choices(described, values, {"motion": "pinned"})


WIRES = [
    each[:4] for each in EVERY if each[3] not in ("COMBO", "COMFY_DYNAMICCOMBO_V3", "INT", "FLOAT", "STRING", "BOOLEAN")
]


@pytest.mark.parametrize("wrong", ["hair", 3, True, {"a": 1}])
@pytest.mark.parametrize(("node", "chosen", "name", "kind"), WIRES)
def test_a_value_is_refused_where_only_a_link_can_be(
    node: str, chosen: Path_, name: str, kind: str, wrong: Any
) -> None:
    described = SCHEMAS[node]["input"]
    full = ".".join([*(key for key, _ in chosen), name])
    values = placed(usual(described, chosen), chosen, name, wrong)
    check_choices(described, values, {full: ["4", 0]})
    with pytest.raises(InvalidInputError, match=rf"^{full} must be connected to another node\. Got: "):
        check_choices(described, values, {full: wrong})


TYPED = [each[:4] for each in EVERY if each[3] in ("INT", "FLOAT", "STRING")]


@pytest.mark.parametrize(("node", "chosen", "name", "kind"), TYPED)
def test_a_value_of_another_kind_is_refused(node: str, chosen: Path_, name: str, kind: str) -> None:
    described = SCHEMAS[node]["input"]
    check_values(described, usual(described, chosen), None)
    asked = "a text" if kind == "STRING" else "a finite number"
    for wrong in ([1, 2, 3], {}, float("nan"), 3 if kind == "STRING" else "many"):
        with pytest.raises(InvalidInputError, match=rf"{name} must be {asked}\. Got: "):
            check_values(described, placed(usual(described, chosen), chosen, name, wrong), None)


@pytest.mark.parametrize("digits", [400, 5000])
def test_a_number_of_very_many_digits_is_one_short_sentence(digits: int) -> None:
    described = SCHEMAS["PhysAnimator_Simulate"]["input"]
    values = usual(described) | {"frames": 10**digits}
    with pytest.raises(InvalidInputError, match=r"^frames must be a finite number\. Got: .{10,80}$"):
        check_values(described, values, None)
    with pytest.raises(InvalidInputError, match=r"^frames must be a number from 1 to 100000\. Got: .{10,80}$"):
        check_values(described, values, None, bounded=True)


def test_a_list_that_is_no_link_is_refused() -> None:
    described = SCHEMAS["PhysAnimator_SegmentByPoints"]["input"]
    values = usual(described) | {"points": [1, 2, 3]}
    check_values(described, values, {"points": ["4", 0]})
    with pytest.raises(InvalidInputError, match=r"^points must be a text\. Got: \[1, 2, 3\]"):
        check_values(described, values, {"points": [1, 2, 3]})


def test_nothing_is_refused_where_a_link_is_needed() -> None:
    described = SCHEMAS["PhysAnimator_Body"]["input"]
    values = usual(described) | {"mesh": None, "bodies": None}
    check_choices(described, values, {"mesh": ["4", 0], "bodies": None})
    with pytest.raises(InvalidInputError, match=r"^mesh must be connected to another node\. Got: nothing"):
        check_choices(described, values, {"mesh": None, "bodies": None})


class Node:
    """The least that a V3 node is."""

    ran: tuple[str, ...] = ()

    @classmethod
    def define_schema(cls) -> SimpleNamespace:
        return SimpleNamespace(node_id="PhysAnimator_Material")

    @classmethod
    def INPUT_TYPES(cls) -> dict[str, Any]:
        return SCHEMAS["PhysAnimator_Material"]["input"]

    @classmethod
    def execute(cls, preset: dict[str, Any] | None = None) -> str:
        return preset["preset"] if preset else "hair"


def test_every_way_into_a_node_is_guarded(monkeypatch: pytest.MonkeyPatch) -> None:
    sent: dict[str, Any] = {}
    for module in (choices, one_line):
        monkeypatch.setattr(module, "sent_inputs", lambda: sent)
    node = checked(type("Material", (Node,), {"execute": Node.__dict__["execute"]}))
    assert checked(node) is node
    good = {"preset": usual(Node.INPUT_TYPES())["preset"]}
    assert node.execute(**good) == "hair"
    assert node.validate_inputs(**good) is True
    sent["preset"] = UNKNOWN
    for way in (node.execute, node.validate_inputs):  # nothing but the prompt knows of it: raised, or the host drops it
        with pytest.raises(InvalidInputError, match=r"^preset must be one of hair"):
            way()
    assert "preset must be one of hair" in node.validate_inputs(other=1)
