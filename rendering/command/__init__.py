"""The command line: its options, the checks before the work, its inputs, outputs and messages."""

from __future__ import annotations

from .commands import EXAMPLE, main

__all__ = [
    "EXAMPLE",
    "main",
]
