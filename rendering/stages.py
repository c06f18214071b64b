"""The stages of a longer work, as its progress is told."""

from __future__ import annotations

from collections.abc import Callable

from ..physics.progress import Progress

__all__ = ["StageProgress", "stage_of"]

StageProgress = Callable[[str, int, int], None]
"""Called with (stage, done, total) while something takes time; may raise to stop the work."""


def stage_of(name: str, progress: StageProgress | None) -> Progress | None:
    """What one stage calls."""
    return None if progress is None else lambda done, total: progress(name, done, total)
