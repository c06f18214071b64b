"""Every number that a node's input offers is one that the node takes.

Where a value needs more than fits, such as a million triangles, the node may say so; it must not ask for another range
than its input shows.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from bar_graphs import core, drawn_bar, ours

SCHEMAS: dict[str, Any] = json.loads(Path(__file__).with_name("node_schemas.json").read_text(encoding="utf-8"))
LONG = {
    "frames",
    "loop",
    "width",
    "height",
    "longest_side",
    "points",
    "working_size",
    "static_points",
    "elements_across",
}
"""Of these only the lower end is tried: the upper one would take minutes."""
NETWORKS = {
    "animation-guided SVD",
    "drawing network",
    "segment anything",
    "sketch-guided SVD",
    "soft inpainting",
    "tooncrafter",
}
"""Choices whose models a test does not have."""
NAMES_ONE = {
    "FirstAndLastFrame first_frame",
    "FirstAndLastFrame last_frame",
    "FrameAsLayers frame",
    "MaskToMesh mask_index",
}
"""Numbers of something that is there or not, and of which as many are offered as there may be."""
Given = dict[str, Any]


def numbers(described: Given, chosen: Given, prefix: str = "") -> Iterator[tuple[str, Given, Given]]:
    """Every number, with what has to be chosen for it and what the schema says of it."""
    for group in ("required", "optional"):
        for name, (kind, options) in described.get(group, {}).items():
            if kind in ("INT", "FLOAT"):
                yield prefix + name, chosen, options
            elif kind == "COMFY_DYNAMICCOMBO_V3":
                for option in (each for each in options["options"] if each["key"] not in NETWORKS):
                    more = chosen | {prefix + name: option["key"]} | usual(option["inputs"], f"{prefix}{name}.")
                    yield from numbers(option["inputs"], more, f"{prefix}{name}.")


def usual(described: Given, prefix: str = "") -> Given:
    """The values that a new node has; for a dynamic choice its first option."""
    values: Given = {}
    for group in ("required", "optional"):
        for name, (kind, options) in described.get(group, {}).items():
            if kind == "COMFY_DYNAMICCOMBO_V3":
                option = options["options"][0]
                values |= {prefix + name: option["key"]} | usual(option["inputs"], f"{prefix}{name}.")
            elif kind == "COMBO":
                values[prefix + name] = options.get("default", options["options"][0])
            elif "default" in options:
                values[prefix + name] = options["default"]
    return values


def tried(name: str, options: Given) -> Iterator[float]:
    """Both ends, and a little beyond the lower one, which often stands for something else."""
    low, high, step = options["min"], options["max"], options.get("step") or 1
    yield from {low, min(low + step, high)} | (set() if name.rpartition(".")[2] in LONG else {high})
    if isinstance(options["default"], float):
        yield low + 0.3 * step


OF_KIND = {
    "IMAGE": ["picture", 0],
    "MASK": ["mask", 0],
    "PHYSANIMATOR_BODIES": ["body", 0],
    "PHYSANIMATOR_FLOW": ["flow", 0],
    "PHYSANIMATOR_MESH": ["mesh", 0],
    "PHYSANIMATOR_MOTION": ["motion", 0],
    "PHYSANIMATOR_SCENE": ["scene", 0],
}
"""What gives each kind of thing that a node must be connected to."""
BESIDES: dict[str, Given] = {
    "Scene": {"strokes": ["wind", 0]},
    "EnergyStroke": {"path": "[[10, 40], [150, 40]]"},
    "RigPoint": {"position": "[[72, 20]]"},
    "Simulate": {"frames": 4},
    "SaveAnimation": {"filename_prefix": "film", "file_type": "gif"},
    "SegmentByPoints": {"points": "[[70, 40, 1]]"},
    "AnimateIllustration": {"points": "[[70, 40, 1]]", "frames": 4, "image": ["picture", 0]},
    "PaintMaterial": {"stiffness": ["mask", 0]},
}
"""What each node needs besides what it must be connected to."""


def needed(node: str) -> Given:
    """What a node runs with."""
    described = SCHEMAS[f"PhysAnimator_{node}"]["input"]
    required = described.get("required", {}).items()
    links = {name: OF_KIND[kind] for name, (kind, *_) in required if isinstance(kind, str) and kind in OF_KIND}
    return usual(described) | links | BESIDES.get(node, {})


CASES = [
    (node.removeprefix("PhysAnimator_"), name, chosen, value)
    for node, schema in SCHEMAS.items()
    for name, chosen, options in numbers(schema["input"], {})
    for value in dict.fromkeys(tried(name, options))
    if f"{node.removeprefix('PhysAnimator_')} {name}" not in NAMES_ONE
]


def graph() -> Given:
    made = drawn_bar()
    made["wind"] = ours("EnergyStroke", **needed("EnergyStroke"))
    made["flow"] = ours("OpticalFlow", motion=["motion", 0])
    return made


@pytest.mark.parametrize(("node", "name", "chosen", "value"), CASES)
def test_a_node_takes_what_its_input_offers(standin: Any, node: str, name: str, chosen: Given, value: float) -> None:
    given = needed(node) | chosen | {name: value}
    prompt = graph() | {"tried": ours(node, **given), "end": core("PreviewAny", source=["tried", 0])}
    try:
        said = standin.error_of(prompt)
    except AssertionError:  # it has run
        return
    if name == "time_step" and "swing ever farther" in said:  # depends on the mesh, as its tooltip says
        return
    if name == "repeat" and "where the stroke has no end" in said:  # depends on another input
        return
    short = re.escape(name.rpartition(".")[2])
    assert not re.search(rf"\b{short} must", said), said


@pytest.mark.parametrize("node", sorted({node for node, *_ in CASES}))
def test_it_runs_with_what_a_new_node_has(standin: Any, node: str) -> None:
    """Else nothing would be found out above."""
    if node in ("ArtworkToBodies", "WanKeyframes"):
        pytest.skip("needs layers, or a video model")
    standin.run(graph() | {"tried": ours(node, **needed(node)), "end": core("PreviewAny", source=["tried", 0])})
