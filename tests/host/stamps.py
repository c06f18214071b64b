"""Nodes of a workflow say which pack they are of, so that a host that lacks it can offer it.

    python tests/host/stamps.py

stamps the workflows that are there; export_workflows.py does so with those that it writes.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

__all__ = ["PACK_ID", "stamped", "version"]

ROOT = Path(__file__).resolve().parents[2]
PACK_ID = "physanimator"
"""The pack's name in the registry: ``name`` in pyproject.toml."""


def version() -> str:
    """The pack's version, from pyproject.toml."""
    found = re.search(r'^version = "([^"]+)"', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE)
    assert found is not None
    return found[1]


def stamped(ui: dict[str, Any]) -> dict[str, Any]:
    """A workflow whose nodes of this pack have its name and version, those in subgraphs too; changed in place."""
    graphs = [ui, *ui.get("definitions", {}).get("subgraphs", ())]
    for node in (node for graph in graphs for node in graph["nodes"]):
        if node["type"].startswith("PhysAnimator_"):
            node["properties"] = {**node.get("properties", {}), "cnr_id": PACK_ID, "ver": version()}
    return ui


def main() -> None:
    for path in [*(ROOT / "workflows").glob("*.json"), *(ROOT / "subgraphs").glob("*.json")]:
        ui = stamped(json.loads(path.read_text(encoding="utf-8")))
        path.write_text(json.dumps(ui, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
