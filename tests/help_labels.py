"""Beside the names of inputs, outputs and choices in translated help pages: how the page calls them in that language.

Help pages name inputs as graphs do, in English; whoever reads one in another language sees other words on the node.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

__all__ = ["HELP", "labelled", "unlabelled", "write_labels"]

ROOT = Path(__file__).resolve().parents[1]
HELP = ROOT / "nodes" / "web" / "docs"
_ROW = re.compile(r"^\| (?P<names>\w+(?:, \w+)*|\*[^*|]+\*)(?: \([^|]*\))? \|", re.MULTILINE)
_OUTPUTS = ("出力", "출력", "输出", "輸出")
"""Headings under which tables list outputs."""
_DYNAMIC = "COMFY_DYNAMICCOMBO_V3"


def labelled(page: str, node: dict[str, Any], told: dict[str, Any], words: dict[str, str]) -> str:
    """A help page with the labels of one language in its tables.

    Args:
        page: the translated page.
        node: the node as the host reports it.
        told: the node's texts in that language.
        words: texts of the page's scripts in that language, by the English ones: choices are among them.
    """
    sections = re.split(r"(?m)^(?=## )", page)
    inputs, outputs = _input_labels(node, told), _output_labels(node, told)
    done = []
    for section in sections:
        heading = section.split("\n", 1)[0].removeprefix("## ")
        labels = {**inputs, **outputs} if heading in _OUTPUTS else {**outputs, **inputs}
        done.append(_ROW.sub(lambda row, labels=labels: _row(row["names"], labels, words), section))
    return "".join(done)


def unlabelled(page: str) -> str:
    """The page as it is without the labels."""
    return _ROW.sub(lambda row: f"| {row['names']} |", page)


def write_labels(nodes: dict[str, Any], locales: Path, words: Path) -> None:
    """Write the labels into all translated help pages."""
    for path in HELP.glob("*/*.md"):
        node_id, language = path.parent.name, path.stem
        told = json.loads((locales / language / "nodeDefs.json").read_text(encoding="utf-8"))[node_id]
        said = json.loads((words / f"{language}.json").read_text(encoding="utf-8"))
        page = path.read_text(encoding="utf-8")
        path.write_text(labelled(page, nodes[node_id], told, said), encoding="utf-8", newline="\n")


def _row(names: str, labels: dict[str, str], words: dict[str, str]) -> str:
    table = words if names.startswith("*") else labels
    known = [table.get(name) for name in names.strip("*").split(", ")]
    shown = ", ".join(label for label in known if label)
    return f"| {names} ({shown}) |" if all(known) and shown != names.strip("*") else f"| {names} |"


def _input_labels(node: dict[str, Any], told: dict[str, Any]) -> dict[str, str]:
    """By the names that a page gives inputs: those that a choice brings stand there without the choice's name."""
    listed = {**node["input"].get("required", {}), **node["input"].get("optional", {})}
    found = {key: text["name"] for key, text in told["inputs"].items()}
    for choice in (name for name, (kind, *_) in listed.items() if kind == _DYNAMIC):
        inner = {key: label for key, label in found.items() if key.startswith(f"{choice}_")}
        found = {**{key.removeprefix(f"{choice}_"): label for key, label in inner.items()}, **found}
    return found


def _output_labels(node: dict[str, Any], told: dict[str, Any]) -> dict[str, str]:
    return {name: told["outputs"][str(place)]["name"] for place, name in enumerate(node["output_name"])}
