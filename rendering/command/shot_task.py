"""What a worker calls to do one shot: ``animate`` with the shot's words, heard by nobody until it has ended."""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..shots import Animated

__all__ = ["animate_shot", "shot_files", "shot_parser"]


@lru_cache
def shot_parser() -> argparse.ArgumentParser:
    """What reads the words of a shot; it raises instead of ending the process."""
    from .options import add_animate
    from .parsing import RefusingParser

    parser = RefusingParser(prog="physanimator", allow_abbrev=False, add_help=False)
    add_animate(parser)
    parser.set_defaults(command="animate")
    return parser


def animate_shot(words: Sequence[str]) -> Animated:
    """Animate one shot.

    Args:
        words: of the command, without its own name.

    Returns:
        How it ended; errors of a user's making are told, not raised.
    """
    from ..shots import Animated
    from .animating import run_animate
    from .failures import failure_of
    from .messages import gathered
    from .names import named_by_options

    with gathered() as said:
        try:
            options = shot_parser().parse_args([*words, "--quiet"])
            with named_by_options(options):
                run_animate(options)
        except Exception as error:
            failure = failure_of(error)
            if failure is None:
                raise
            return Animated(failure.status, (*_plain(said), failure.message), failure.full)
    return Animated(0, _plain(said))


def _plain(said: Sequence[str]) -> tuple[str, ...]:
    return tuple(each.removeprefix("physanimator: ") for each in said)


def shot_files(path: str) -> list[str]:
    """The files that were written of an output: itself, or frames, layers' frames and a skeleton in a folder."""
    from ..export import SPINE_RECORD, spine_files_in
    from ..pictures import RECORD, frames_in

    place = Path(path)
    if not place.is_dir():
        return [path] if place.is_file() else []
    found: list[Path] = []
    if (place / SPINE_RECORD).is_file():
        found += [*(place / name for name in spine_files_in(place)), place / SPINE_RECORD]
    inside = sorted(each for each in place.iterdir() if each.is_dir())
    for folder in (place, *inside):
        if (folder / RECORD).is_file():
            found += [*frames_in(folder), folder / RECORD]
    return [os.fspath(each) for each in dict.fromkeys(found)]
