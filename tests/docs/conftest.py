"""The site's own modules, which are no part of the package."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

SITE = Path(__file__).resolve().parents[2] / "nodes" / "docs"


def _load_generators() -> None:
    if "made_from" in sys.modules:
        return
    folder = SITE / "made_from"
    spec = importlib.util.spec_from_file_location(
        "made_from", folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    assert spec is not None
    assert spec.loader is not None
    sys.modules["made_from"] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)


_load_generators()
