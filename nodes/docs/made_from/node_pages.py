"""A page for every node: its help page, and all that the host is told of its inputs and outputs."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .markdown import code, escaped, number, table

__all__ = ["inputs_of", "node_pages"]

_SHORT = 60
"""Defaults longer than this are shown to this length [characters]."""


def node_pages(root: Path) -> dict[str, str]:
    """The pages by their names, and an index of them by their menus."""
    schemas = json.loads((root / "tests" / "nodes" / "node_schemas.json").read_text(encoding="utf-8"))
    titles = {node["display_name"].removesuffix(" (PhysAnimator)"): name for name, node in schemas.items()}
    texts = {
        f"{name}.md": _page(root, schemas[name], titles)
        for name in sorted(schemas, key=lambda name: _place(schemas[name]))
    }
    return {"index.md": _index(schemas), **texts}


def _place(node: dict[str, Any]) -> tuple[str, str]:
    return node["category"], node["display_name"]


def _index(schemas: dict[str, Any]) -> str:
    parts = [
        "# Every node\n",
        "The help page of each node, which ComfyUI opens too, and all its inputs with their bounds.\n",
    ]
    for category in sorted({node["category"] for node in schemas.values()}):
        inside = sorted((n for n in schemas.values() if n["category"] == category), key=lambda n: n["display_name"])
        parts.append(f"## {escaped(category.removeprefix('PhysAnimator/').capitalize())}\n")
        parts.append(
            table(
                ("node", "what it does"),
                [(f"[{n['display_name']}]({n['name']}.md)", escaped(_sentence(n["description"]))) for n in inside],
            )
        )
        parts.append("```{toctree}\n:hidden:\n\n" + "\n".join(n["name"] for n in inside) + "\n```\n")
    return "\n".join(parts)


def _sentence(text: str) -> str:
    """The first of a description."""
    return re.split(r"(?<=[.!?])\s", text, maxsplit=1)[0]


def _page(root: Path, node: dict[str, Any], titles: dict[str, str]) -> str:
    path = root / "nodes" / "web" / "docs" / f"{node['name']}.md"
    help_text = (
        path.read_text(encoding="utf-8") if path.exists() else f"# {node['display_name']}\n\n{node['description']}\n"
    )
    return "\n".join(
        [
            _linked(help_text.rstrip(), titles, but=node["name"]),
            f"\n## For graphs in JSON\n\nIts type is {code(node['name'])}, its menu {code(node['category'])}.\n",
            table(
                ("input", "type", "bounds", "default", "what it says"),
                [_input_row(*each) for each in inputs_of(node["input"])],
            ),
            table(("output", "type", "what it is"), _output_rows(node)),
        ]
    )


def _linked(text: str, titles: dict[str, str], *, but: str) -> str:
    """Names of other nodes in bold lead to their pages."""

    def link(match: re.Match[str]) -> str:
        name = match[1]
        return f"[**{name}**]({titles[name]}.md)" if name in titles and titles[name] != but else match[0]

    return re.sub(r"(?<!\[)\*\*([^*\n]+)\*\*", link, text)


def inputs_of(
    told: dict[str, Any], prefix: str = "", when: str = ""
) -> Iterator[tuple[str, Any, dict[str, Any], str, bool]]:
    """Name, type, options, condition and necessity of every input, those of a choice's options included."""
    for group in ("required", "optional"):
        for name, given in told.get(group, {}).items():
            kind, options = given[0], given[1] if len(given) > 1 else {}
            yield f"{prefix}{name}", kind, options, when, group == "required"
            for option in options.get("options", ()) if kind == "COMFY_DYNAMICCOMBO_V3" else ():
                yield from inputs_of(option["inputs"], f"{prefix}{name}.", f"{prefix}{name} = {option['key']}")


def _input_row(name: str, kind: Any, options: dict[str, Any], when: str, required: bool) -> tuple[str, ...]:
    choices = [each["key"] if isinstance(each, dict) else each for each in options.get("options", ())]
    kinds = {"COMBO": "choice", "COMFY_DYNAMICCOMBO_V3": "choice"}
    default = options.get("default", choices[0] if choices else None)
    said = [escaped(options.get("tooltip") or "")]
    if choices:
        said.append(f"One of {', '.join(code(str(each)) for each in choices)}.")
    if when:
        said.append(f"With {code(when)}.")
    if not required:
        said.append("Optional.")
    return (code(name), code(kinds.get(str(kind), str(kind))), _bounds(options), _default(default), " ".join(said))


def _bounds(options: dict[str, Any]) -> str:
    if "min" not in options or "max" not in options:
        return ""
    return escaped(f"{number(options['min'])} to {number(options['max'])}")


def _default(value: Any) -> str:
    if value is None or value == "":
        return ""
    text = " ".join((value if isinstance(value, str) else json.dumps(value)).split())
    return code(text if len(text) <= _SHORT else f"{text[:_SHORT]} ...")


def _output_rows(node: dict[str, Any]) -> list[tuple[str, ...]]:
    tooltips = node.get("output_tooltips") or [""] * len(node["output"])
    return [
        (code(name), code(str(kind)), escaped(tooltip or ""))
        for name, kind, tooltip in zip(node["output_name"], node["output"], tooltips, strict=True)
    ]
