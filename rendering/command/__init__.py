"""The command line: its options, the checks before the work, its inputs, outputs and messages."""

from __future__ import annotations

from .example import EXAMPLE
from .exit_status import main
from .program import program

__all__ = [
    "EXAMPLE",
    "main",
    "program",
]
