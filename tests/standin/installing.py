"""The host's modules under their own names, for as long as a test needs them."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

__all__ = ["installed"]

_FOLDER = Path(__file__).with_name("host")
_NAMES = ("comfy", "comfy_api", "comfy_execution", "folder_paths", "latent_preview", "nodes", "server")
_ours: dict[str, Any] = {}


@contextmanager
def installed() -> Iterator[None]:
    """Import them meanwhile; the same modules each time, because nodes that were imported keep hold of them."""
    if str(_FOLDER) in sys.path:  # they are there already
        yield
        return
    before = _taken_out()
    nodes = ModuleType("nodes")
    nodes.NODE_CLASS_MAPPINGS, nodes.NODE_DISPLAY_NAME_MAPPINGS = {}, {}  # type: ignore[attr-defined]
    sys.modules.update({"nodes": nodes} | _ours)
    sys.path.insert(0, str(_FOLDER))
    try:
        yield
    finally:
        sys.path.remove(str(_FOLDER))
        _ours.update(_taken_out())
        sys.modules.update(before)


def _taken_out() -> dict[str, Any]:
    found = [name for name in sys.modules if name.partition(".")[0] in _NAMES]
    return {name: sys.modules.pop(name) for name in found}
