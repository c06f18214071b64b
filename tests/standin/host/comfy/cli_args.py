"""How the host was started."""

from __future__ import annotations

from types import SimpleNamespace

args = SimpleNamespace(listen="127.0.0.1", port=8188, enable_cors_header=None, disable_metadata=True)
