"""What the nodes tell of themselves, in the stand-in as in the real host that wrote node_schemas.json."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

SCHEMAS: dict[str, Any] = json.loads(Path(__file__).with_name("node_schemas.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("node_id", sorted(SCHEMAS))
def test_a_node_reports_what_it_reports_to_a_real_host(standin: Any, node_id: str) -> None:
    assert standin.object_info(node_id) == SCHEMAS[node_id]


def test_the_extension_has_no_other_nodes(standin: Any) -> None:
    assert {name for name in standin.known if name.startswith("PhysAnimator_")} == set(SCHEMAS)
