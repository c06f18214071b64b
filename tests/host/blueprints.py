"""The subgraph blueprint of the pack, which hosts list beside their own: written from the nodes' schemas.

    python tests/host/blueprints.py

What hosts find is ``subgraphs/*.json``; a file is a workflow whose only node is the subgraph.
"""

from __future__ import annotations

import json
import uuid
from pathlib import Path
from typing import Any

from stamps import stamped

__all__ = ["BLUEPRINT", "blueprint"]

ROOT = Path(__file__).resolve().parents[2]
BLUEPRINT = ROOT / "subgraphs" / "Animate Illustration.json"
_SCHEMAS = json.loads((ROOT / "tests" / "nodes" / "node_schemas.json").read_text(encoding="utf-8"))
_WIDGETS = ("INT", "FLOAT", "STRING", "COMBO", "BOOLEAN", "COMFY_DYNAMICCOMBO_V3")
_INPUT, _OUTPUT = -10, -20  # the host's numbers of a subgraph's ends
_TITLE = "Animate Illustration"
_ABOUT = "From a picture to its moving frames, each step a node: open it, and click in Segment by Points on what moves."

# Node, place and size.
_NODES = (
    ("SegmentByPoints", (0, 0), (440, 560)),
    ("MaskToMesh", (500, 0), (320, 420)),
    ("Body", (880, 0), (280, 180)),
    ("AutomaticScene", (1220, 0), (300, 260)),
    ("Simulate", (1580, 0), (300, 220)),
    ("Render", (1940, 0), (300, 240)),
)
# From a node's output to another one's input.
_WIRES = (
    ("SegmentByPoints.mask", "MaskToMesh.mask"),
    ("MaskToMesh.mesh", "Body.mesh"),
    ("Body.bodies", "AutomaticScene.bodies"),
    ("AutomaticScene.scene", "Simulate.scene"),
    ("Simulate.motion", "Render.motion"),
)
# What the subgraph's inputs and outputs are.
_INPUTS = (
    ("image", ("SegmentByPoints.image", "MaskToMesh.image", "Render.image")),
    ("preset", ("Body.preset",)),
    ("wind_strength", ("AutomaticScene.wind_strength",)),
    ("wind_angle", ("AutomaticScene.wind_angle",)),
    ("loop", ("Simulate.loop",)),
    ("frames", ("Simulate.frames",)),
    ("frame_rate", ("AutomaticScene.frame_rate",)),
)
_OUTPUTS = (
    ("frames", "Render.frames"),
    ("masks", "SegmentByPoints.mask"),
    ("motion", "Simulate.motion"),
    ("frame_rate", "Simulate.frame_rate"),
)


def blueprint() -> dict[str, Any]:
    """The file's contents."""
    inner = {name: _node(number, name, *place) for number, (name, *place) in enumerate(_NODES, 1)}
    links: list[dict[str, Any]] = []
    for source, target in _WIRES:
        _link(links, inner, source, target)
    ends = [_end(links, inner, slot, name, targets) for slot, (name, targets) in enumerate(_INPUTS)]
    outs = [_out(links, inner, slot, name, source) for slot, (name, source) in enumerate(_OUTPUTS)]
    identity = str(uuid.uuid5(uuid.NAMESPACE_URL, f"physanimator/subgraphs/{_TITLE}"))
    graph = {
        "id": identity,
        "version": 1,
        "state": {"lastGroupId": 0, "lastNodeId": len(inner), "lastLinkId": len(links), "lastRerouteId": 0},
        "revision": 0,
        "config": {},
        "name": _TITLE,
        "inputNode": {"id": _INPUT, "bounding": [-260, 60, 140, 40 + 20 * len(ends)]},
        "outputNode": {"id": _OUTPUT, "bounding": [2320, 60, 140, 40 + 20 * len(outs)]},
        "inputs": ends,
        "outputs": outs,
        "widgets": [],
        "nodes": list(inner.values()),
        "groups": [],
        "links": links,
        "extra": {},
        "category": "PhysAnimator",
        "description": _ABOUT,
    }
    holder = len(inner) + 1
    return stamped(
        {
            "revision": 0,
            "last_node_id": holder,
            "last_link_id": 0,
            "nodes": [_holder(holder, identity, ends, outs)],
            "links": [],
            "version": 0.4,
            "definitions": {"subgraphs": [graph]},
            "extra": {},
        }
    )


def _node(number: int, name: str, place: tuple[int, int], size: tuple[int, int]) -> dict[str, Any]:
    schema = _schema(name)
    inputs, values = [], []
    for key, (kind, options) in _described(schema).items():
        slot: dict[str, Any] = {"name": key, "type": kind, "link": None}
        if key in schema["input"].get("optional", {}):
            slot["shape"] = 7
        if kind in _WIDGETS:
            slot["widget"] = {"name": key}
            values.append(_default(kind, options))
        inputs.append(slot)
    outputs = [
        {"name": each, "type": kind, "links": []}
        for each, kind in zip(schema["output_name"], schema["output"], strict=True)
    ]
    return {
        "id": number,
        "type": f"PhysAnimator_{name}",
        "pos": list(place),
        "size": list(size),
        "flags": {},
        "order": number - 1,
        "mode": 0,
        "inputs": inputs,
        "outputs": outputs,
        "properties": {"Node name for S&R": f"PhysAnimator_{name}"},
        "widgets_values": values,
    }


def _default(kind: str, options: dict[str, Any]) -> Any:
    if kind == "COMFY_DYNAMICCOMBO_V3":
        return options["options"][0]["key"]
    return options.get("default", "" if kind == "STRING" else (options.get("options") or [None])[0])


def _link(links: list[dict[str, Any]], inner: dict[str, Any], source: str, target: str) -> None:
    (name, output), (other, into) = source.split("."), target.split(".")
    slot = next(number for number, each in enumerate(inner[name]["outputs"]) if each["name"] == output)
    link = _linked(links, inner[name]["id"], slot, inner[name]["outputs"][slot]["type"])
    inner[name]["outputs"][slot]["links"].append(link["id"])
    _into(link, inner[other], into)


def _end(
    links: list[dict[str, Any]], inner: dict[str, Any], slot: int, name: str, targets: tuple[str, ...]
) -> dict[str, Any]:
    ids, kind = [], ""
    for target in targets:
        other, into = target.split(".")
        kind = next(each["type"] for each in inner[other]["inputs"] if each["name"] == into)
        link = _linked(links, _INPUT, slot, kind)
        _into(link, inner[other], into)
        ids.append(link["id"])
    return {"id": _identity("in", name), "name": name, "type": kind, "linkIds": ids, "pos": [-140, 80 + 20 * slot]}


def _out(links: list[dict[str, Any]], inner: dict[str, Any], slot: int, name: str, source: str) -> dict[str, Any]:
    origin, output = source.split(".")
    place = next(number for number, each in enumerate(inner[origin]["outputs"]) if each["name"] == output)
    kind = inner[origin]["outputs"][place]["type"]
    link = _linked(links, inner[origin]["id"], place, kind) | {"target_id": _OUTPUT, "target_slot": slot}
    links[-1] = link
    inner[origin]["outputs"][place]["links"].append(link["id"])
    place_on = [2340, 80 + 20 * slot]
    return {"id": _identity("out", name), "name": name, "type": kind, "linkIds": [link["id"]], "pos": place_on}


def _linked(links: list[dict[str, Any]], origin: int, slot: int, kind: str) -> dict[str, Any]:
    link = {"id": len(links) + 1, "origin_id": origin, "origin_slot": slot, "target_id": 0, "target_slot": 0}
    links.append(link | {"type": kind})
    return links[-1]


def _into(link: dict[str, Any], node: dict[str, Any], name: str) -> None:
    slot = next(number for number, each in enumerate(node["inputs"]) if each["name"] == name)
    link |= {"target_id": node["id"], "target_slot": slot}
    node["inputs"][slot]["link"] = link["id"]


def _holder(number: int, identity: str, ends: list[dict[str, Any]], outs: list[dict[str, Any]]) -> dict[str, Any]:
    """The node that stands for the subgraph."""
    inputs, promoted, values = [], [], []
    for (name, targets), end in zip(_INPUTS, ends, strict=True):
        slot = {"name": name, "type": end["type"], "link": None}
        if end["type"] in _WIDGETS:
            node, into = targets[0].split(".")
            kind, options = _described(_schema(node))[into]
            slot["widget"] = {"name": name}
            promoted.append(["-1", name])
            values.append(_default(kind, options))
        inputs.append(slot)
    return {
        "id": number,
        "type": identity,
        "pos": [0, 0],
        "size": [360, 320],
        "flags": {},
        "order": 0,
        "mode": 0,
        "inputs": inputs,
        "outputs": [{"name": each["name"], "type": each["type"], "links": None} for each in outs],
        "title": _TITLE,
        "properties": {"proxyWidgets": promoted},
        "widgets_values": values,
    }


def _schema(name: str) -> dict[str, Any]:
    return _SCHEMAS[f"PhysAnimator_{name}"]


def _described(schema: dict[str, Any]) -> dict[str, Any]:
    return {**schema["input"].get("required", {}), **schema["input"].get("optional", {})}


def _identity(end: str, name: str) -> str:
    return str(uuid.uuid5(uuid.NAMESPACE_URL, f"physanimator/subgraphs/{_TITLE}/{end}/{name}"))


if __name__ == "__main__":
    BLUEPRINT.parent.mkdir(exist_ok=True)
    BLUEPRINT.write_text(json.dumps(blueprint(), indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    print(BLUEPRINT.relative_to(ROOT))
