"""What the command ``measure`` computes and prints."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...physics.errors import InvalidInputError
from ..metrics.learned import FID_FILE, check_video_score, require_file
from .names import named_as

if TYPE_CHECKING:
    from ..animation import Animation
    from ..stages import StageProgress

__all__ = ["check_measures", "measured", "table"]

UNITS = {"sketch_adherence": "px", "dynamic_degree": "px/frame"}
"""Units of the measures that have one."""

Measures = dict[str, float | None]


def check_measures(options: argparse.Namespace) -> None:
    """Refuse what cannot be measured, before any long work.

    Raises:
        InvalidInputError: the message names the option or the file.
    """
    if options.clip is not None:
        next(_clip(options.clip, "--clip"))
    if (options.fid is None) != (options.reference is None):
        raise InvalidInputError("--fid and --reference need each other. Got: one of them")
    if (options.video_score is None) != (options.description is None):
        raise InvalidInputError("--video-score and --description need each other. Got: one of them")
    if options.fid is not None:
        with named_as("--fid"):
            require_file(Path(options.fid), FID_FILE)
        next(_clip(options.reference, "--reference"))
        with named_as("--fid"):
            from ..metrics.learned.fid import load_inception

            load_inception(Path(options.fid))
    if options.video_score is not None:
        with named_as("--video-score"):
            check_video_score(Path(options.video_score))


def measured(options: argparse.Namespace, animation: Animation, progress: StageProgress | None) -> Measures:
    """Every measure by its name."""
    from ..metrics import measure_clip

    def frames() -> Iterator[Any]:
        return animation.frames() if options.clip is None else _clip(options.clip, "--clip")

    with named_as("--clip", "frames"):
        found: Measures = measure_clip(
            frames(),
            animation.shown_motion,
            drawing=animation.image,
            sketches=animation.sketches(),
            progress=None if progress is None else lambda done, total: progress("measure", done, total),
        ).as_dict()
    if options.fid is not None:
        from ..metrics.learned.fid import frechet_inception_distance

        with named_as("--fid"):
            references = _clip(options.reference, "--reference")
            found["fid"] = frechet_inception_distance(frames(), references, Path(options.fid))
    if options.video_score is not None:
        from ..metrics.learned import video_score

        with named_as("--video-score"):
            grades = video_score(list(frames()), options.description, Path(options.video_score))
        found |= {f"video_score_{name}": grade for name, grade in grades.items()}
    return found


def _clip(path: str, option: str) -> Iterator[Any]:
    """The frames of a clip that an option names; there is at least one."""
    from ..pictures import read_clip

    with named_as(option, "clip"):
        yield from read_clip(path)


def table(found: Measures, *, as_json: bool) -> str:
    """Measures as text."""
    if as_json:
        return json.dumps(found, indent=2)
    return "\n".join(f"{name:<36}{_shown(name, value)}" for name, value in found.items())


def _shown(name: str, value: float | None) -> str:
    return "-" if value is None else f"{value:.5g} {UNITS.get(name, '')}".rstrip()
