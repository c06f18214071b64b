"""Loads this source tree as the package ``physanimator``, whatever its folder is called."""

from __future__ import annotations

import importlib.util
import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

if "PYTEST_XDIST_WORKER" in os.environ:  # one of several: threads of each would wait for those of the others
    os.environ.setdefault("OMP_NUM_THREADS", "1")


def _load_package() -> None:
    if "physanimator" in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(
        "physanimator", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["physanimator"] = module
    spec.loader.exec_module(module)


_load_package()
