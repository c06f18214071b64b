"""Whether what training needs beside the pack itself is installed."""

from __future__ import annotations

import sys
from importlib.util import find_spec

__all__ = ["is_ready"]


def is_ready() -> bool:
    """Whether accelerate is there; what to install is said on standard error where it is not."""
    try:
        found = find_spec("accelerate") is not None
    except ValueError:  # put out of reach on purpose
        found = False
    if not found:
        print("physanimator: training needs accelerate: pip install 'physanimator[train]'", file=sys.stderr)
    return found
