"""The command line: ``physanimator`` or ``python -m physanimator``."""

from __future__ import annotations

import sys

from .rendering.command import main, program

__all__ = ["main"]

if __name__ == "__main__":
    sys.exit(program())
