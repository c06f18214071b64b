"""Importing this makes the source tree importable as ``physanimator``, exactly as the tests do it."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

_TESTS = Path(__file__).resolve().parents[1]


def helper(name: str) -> Any:
    """A module of ``tests/``."""
    spec = importlib.util.spec_from_file_location(name, _TESTS / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


helper("conftest")
