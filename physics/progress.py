"""The shape of a progress callback, in one place."""

from __future__ import annotations

from collections.abc import Callable

__all__ = ["Progress"]

Progress = Callable[[int, int], None]
"""Called after each frame with (frames done, frames in all); may raise to stop the work between two frames."""
