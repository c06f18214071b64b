"""The motions of a set as the inputs of other systems, which are then compared with their clips."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..pictures import over
from ..stages import StageProgress
from .evaluation_set import EvaluationSet
from .motions import check_motion, reference_of
from .report_folder import ReportFolder
from .trajectories import TRAJECTORIES, check_trajectories

__all__ = ["write_trajectories"]


def write_trajectories(
    which: EvaluationSet, output: Path, formats: Sequence[str], *, progress: StageProgress | None = None
) -> int:
    """Write ``trajectories/FORMAT/PICTURE/sample_N/`` of every sample.

    Args:
        which: the set.
        output: folder of the report.
        formats: names of ``TRAJECTORIES``.
        progress: called with the stage "clips".

    Returns:
        How many samples there are.

    Raises:
        InvalidInputError: the set or the folder cannot be used.
    """
    folder = ReportFolder(output)
    folder.check()
    samples = [(picture, number) for picture in which.pictures for number in range(which.samples)]

    def place(name: str, picture: str, number: int) -> Path:
        return output / "trajectories" / name / picture / f"sample_{number}"

    for picture, number in samples:
        check_motion(which, picture)
        for name in formats:
            if place(name, picture.name, number).exists():
                check_trajectories(place(name, picture.name, number))
    folder.open()
    for done, (picture, number) in enumerate(samples):
        animation = reference_of(which, picture, number)
        first = np.asarray(over(next(iter(animation.frames()))))
        for name in formats:
            target = place(name, picture.name, number)
            target.parent.mkdir(parents=True, exist_ok=True)
            TRAJECTORIES[name](animation.shown_motion, first, target)
        if progress is not None:
            progress("clips", done + 1, len(samples))
    return len(samples)
