"""Trains the interpolation's ControlNet: ``accelerate launch -m physanimator.rendering.training.tooncrafter``."""

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
    from .sample_clips import draw_tooncrafter
    from .tooncrafter_networks import tooncrafter_networks
    from .tooncrafter_samples import ToonCrafterSamples

    data = Path(settings.data)
    trained_on, out = split(kept_clips(data), settings.held_out)
    start, encoder = (Path(each) if each else None for each in (settings.start, settings.encoder))
    networks = tooncrafter_networks(
        Path(settings.tooncrafter), start, encoder=encoder, frozen=frozen_precision(settings), seed=settings.seed
    )
    held_out = ToonCrafterSamples(data, out, settings) if out else None
    draw = draw_tooncrafter(settings, out or trained_on)
    return Task("tooncrafter", networks, ToonCrafterSamples(data, trained_on, settings), held_out, draw)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run; see :func:`~physanimator.rendering.training.entry.run`."""
    if not is_ready():
        return 2
    from .entry import run

    return run("tooncrafter", task_of, arguments)


if __name__ == "__main__":
    sys.exit(main())
