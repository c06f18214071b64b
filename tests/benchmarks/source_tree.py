"""Importing this makes the source tree importable as ``physanimator``, exactly as the tests do it."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

_TESTS = Path(__file__).resolve().parents[1]


def helper(path: str) -> Any:
    """A module of ``tests/`` by its path there, which others may then import by its name."""
    name = path.rpartition("/")[2]
    spec = importlib.util.spec_from_file_location(name, _TESTS / f"{path}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


helper("conftest")
