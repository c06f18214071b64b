"""Who hears of the work while it is done: progress bars, warnings, and signals that end it."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...physics.scene import Scene
    from ..options import Watch
    from ..stages import StageProgress

__all__ = ["progress_of", "watch_of"]


def watch_of(options: argparse.Namespace, progress: StageProgress, points: Sequence[str], image: Any) -> Watch:
    """Who hears of the work; before the simulation, what is suspicious about the cuts and the scene is said.

    Args:
        options: of the command.
        progress: what is called with every step.
        points: the texts of the point files.
        image: the illustration; read where there are points.
    """
    from ...physics.scene import advice
    from ..options import Watch
    from ..pictures import as_picture, over
    from ..segmentation import judge_points
    from .messages import warn
    from .names import parts_in_options
    from .networks import check_keyframes

    def tell(sentences: Sequence[str]) -> None:
        for sentence in sentences:
            warn(f"physanimator: warning: {sentence}")

    def on_cut(cut: Sequence[NDArray[Any]]) -> None:
        if points:
            names = [f"--points {path}" for path in getattr(options, "points", None) or ()]
            tell(judge_points(cut, points, names, image=over(as_picture(image, alpha=True))))

    def on_scene(scene: Scene) -> None:
        check_keyframes(options, scene)
        tell([parts_in_options(each, options) for each in advice(scene, masks=not getattr(options, "mask", None))])

    return Watch(
        progress=progress,
        on_cut=on_cut,
        on_scene=on_scene,
        on_note=lambda sentence: tell([parts_in_options(sentence, options)]),
    )


def progress_of(options: argparse.Namespace, stack: ExitStack) -> StageProgress:
    """What is called with every step: it draws bars, unless the user wants none, and hears signals and who gives up."""
    from ...physics.interruption import checkpoint
    from ..files import hear_signals
    from .messages import progress_bars

    bars = None if options.quiet else progress_bars(stack)

    def advance(stage: str, done: int, total: int) -> None:
        hear_signals()
        checkpoint()
        if bars is not None:
            bars(stage, done, total)

    return advance
