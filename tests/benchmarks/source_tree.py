"""Importing this makes the source tree importable as ``physanimator``, exactly as the tests do it."""

from __future__ import annotations

import importlib.util
from pathlib import Path

_conftest = Path(__file__).resolve().parents[1] / "conftest.py"
_spec = importlib.util.spec_from_file_location("physanimator_source_tree", _conftest)
assert _spec is not None
assert _spec.loader is not None
_spec.loader.exec_module(importlib.util.module_from_spec(_spec))
