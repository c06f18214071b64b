"""What the transformers library shows while it loads."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["without_bars"]


@contextmanager
def without_bars(library: Any) -> Iterator[None]:
    """Without bars of the library's own on standard error: whoever loads says what is shown there.

    Args:
        library: the module transformers, which costs too much to be imported here.
    """
    bars = library.utils.logging
    shown = bars.is_progress_bar_enabled()
    bars.disable_progress_bar()
    try:
        yield
    finally:
        if shown:
            bars.enable_progress_bar()
