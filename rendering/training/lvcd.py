"""Trains the video model's sketch ControlNet: ``accelerate launch -m physanimator.rendering.training.lvcd``."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .data_folder import kept_clips
from .held_out import split
from .needed import is_ready
from .settings import TrainingSettings

if TYPE_CHECKING:
    from .loop import Task

__all__ = ["main", "task_of"]


def task_of(settings: TrainingSettings) -> Task:
    """Networks and data as the settings say.

    Raises:
        InvalidInputError: the data or a file is unusable.
    """
    from .entry import frozen_precision
    from .loop import Task
    from .lvcd_networks import lvcd_networks
    from .lvcd_samples import LVCDSamples
    from .sample_clips import draw_lvcd

    data = Path(settings.data)
    trained_on, out = split(kept_clips(data), settings.held_out)
    start = Path(settings.start) if settings.start else None
    networks = lvcd_networks(Path(settings.svd), start, frozen=frozen_precision(settings), seed=settings.seed)
    held_out = LVCDSamples(data, out, settings) if out else None
    return Task(
        "lvcd", networks, LVCDSamples(data, trained_on, settings), held_out, draw_lvcd(settings, out or trained_on)
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Run; see :func:`~physanimator.rendering.training.entry.run`."""
    if not is_ready():
        return 2
    from .entry import run

    return run("lvcd", task_of, arguments)


if __name__ == "__main__":
    sys.exit(main())
