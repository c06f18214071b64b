"""What the nodes tell of themselves, in the stand-in as in the real host that wrote node_schemas.json."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

SCHEMAS: dict[str, Any] = json.loads(Path(__file__).with_name("node_schemas.json").read_text(encoding="utf-8"))


def without_files(standin: Any, report: dict[str, Any]) -> dict[str, Any]:
    """A report as a host gives it whose input folder is empty; words of the search are another test's."""
    report.pop("search_aliases", None)
    files = {path.name for path in (standin.folder / "input").iterdir()}
    for _, options in (value for group in report["input"].values() for value in group.values() if len(value) > 1):
        if "others_too" in options:
            options["options"] = [name for name in options["options"] if name not in files]
    return report


@pytest.mark.parametrize("node_id", sorted(SCHEMAS))
def test_a_node_reports_what_it_reports_to_a_real_host(standin: Any, node_id: str) -> None:
    assert without_files(standin, standin.object_info(node_id)) == SCHEMAS[node_id]


def test_the_extension_has_no_other_nodes(standin: Any) -> None:
    assert {name for name in standin.known if name.startswith("PhysAnimator_")} == set(SCHEMAS)
