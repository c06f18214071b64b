"""The published graphs, as they are described in tests/host, and as prompts short enough for a test."""

from __future__ import annotations

import copy
import importlib.util
import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from .choices import described

__all__ = ["DESCRIBED", "filled", "graphs", "prompt_of", "shortened", "video_model_graphs", "without_beginnings"]

_HOST = Path(__file__).resolve().parents[1] / "host"
_NOTES = ("MarkdownNote", "Note")


def _sibling(name: str) -> ModuleType:
    """A module of tests/host under its own name, by which the others there import it."""
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, _HOST / f"{name}.py")
        assert spec is not None
        assert spec.loader is not None
        module = sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    return sys.modules[name]


graphs = _sibling("graphs")
_sibling("time_to_move_graphs")
video_model_graphs = _sibling("video_model_graphs")
DESCRIBED: dict[str, Any] = {
    **graphs.WORKFLOWS,
    **_sibling("layer_graphs").LAYER_WORKFLOWS,
    **_sibling("paper_graphs").PAPER_WORKFLOWS,
    **_sibling("showcase_graphs").SHOWCASE_WORKFLOWS,
}
"""Graphs whose every node the stand-in has."""


def filled(kind: type, inputs: Mapping[str, Any]) -> dict[str, Any]:
    """A node's inputs with the values that its widgets begin with, as the host's page fills them in."""
    given = dict(inputs)
    while True:
        found = described(kind.INPUT_TYPES(), given).all
        told = kind.INPUT_TYPES()
        choices = {**told.get("required", {}), **told.get("optional", {})}
        begins = {name: _beginning(*each[:2]) for name, each in (choices | found).items() if len(each) > 1}
        missing = {name: value for name, value in begins.items() if name not in given and value is not None}
        if not missing:
            return given
        given |= missing


def without_beginnings(kind: type, inputs: Mapping[str, Any]) -> dict[str, Any]:
    """A node's inputs without the optional ones that are as their widgets begin."""
    optional = described(kind.INPUT_TYPES(), inputs).optional
    begins = {name: _beginning(*each) for name, each in optional.items()}
    return {name: value for name, value in inputs.items() if name not in begins or value != begins[name]}


def _beginning(kind: Any, options: Mapping[str, Any]) -> Any:
    """What a widget shows at first; None where there is no widget."""
    if "default" in options:
        return options["default"]
    offered = kind if isinstance(kind, list) else options.get("options", [])
    first = offered[0] if offered else None
    return first["key"] if isinstance(first, dict) else {"STRING": ""}.get(kind) if first is None else first


def prompt_of(groups: Any, known: Mapping[str, type]) -> dict[str, Any]:
    """A described graph as the host's page would post it, by the nodes' keys."""
    nodes = [node for group in groups for column in group.columns for node in column.nodes if node.type not in _NOTES]
    types = {node.key: node.type for node in nodes}
    prompt = {}
    for node in nodes:
        links = {name: _link(source, types, known) for name, source in node.inputs.items()}
        prompt[node.key] = {"class_type": node.type, "inputs": filled(known[node.type], node.values | links)}
    return prompt


def _link(source: str, types: Mapping[str, str], known: Mapping[str, type]) -> list[Any]:
    key, output = source.split(".")
    kind = known[types[key]]
    names = getattr(kind, "RETURN_NAMES", None) or [
        each.display_name or each.io_type for each in kind.GET_SCHEMA().outputs
    ]
    return [key, list(names).index(output)]


def shortened(api: dict[str, Any], frames: int, *, plate: bool = False) -> dict[str, Any]:
    """The same graph without model files, and with a clip of a few frames.

    Args:
        api: a published graph.
        frames: of the clip, 4 k + 1.
        plate: give the example's clean plate to Render, where masks cut bodies out.
    """
    short = copy.deepcopy(video_model_graphs.without_video_model(graphs.without_models(api)))
    for node in short.values():
        inputs = node["inputs"]
        limits = {"frames": frames, "length": frames, "last_frame": frames - 1, "every": 2, "loop": 1.5}
        for name, most in limits.items():
            if isinstance(inputs.get(name), (int, float)) and inputs[name] > most:
                inputs[name] = most
        if isinstance(inputs.get("keyframes"), str):
            inputs["keyframes"] = f"0, {frames // 2}, -1"
    if plate and "PhysAnimator_ArtworkToBodies" not in {node["class_type"] for node in short.values()}:
        short["plate"] = {"class_type": "LoadImage", "inputs": {"image": "clean_plate.png"}}
        for node in short.values():
            if node["class_type"] == "PhysAnimator_Render":
                node["inputs"]["clean_plate"] = ["plate", 0]
    return short
