"""Clips of several methods on disk: a folder each, in which clips of the same picture have the same name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ....physics.errors import InvalidInputError, printable

__all__ = ["ALL", "BROKEN", "MethodClips", "method_clips", "shared_names"]

BROKEN = "(broken)"
"""Stands for the method of a clip that was broken on purpose."""

ALL = "(all)"
"""Stands for all methods that one was compared with."""

_VIDEOS = (".mp4", ".webm", ".mov", ".mkv", ".avi", ".gif", ".webp", ".apng")
_PICTURES = (".png", ".jpg", ".jpeg", ".webp")
_DEEPEST = 3


@dataclass(frozen=True)
class MethodClips:
    """The clips of one method.

    Attributes:
        method: its name.
        clips: where the clip of each picture is: a video, or a folder of pictures.
    """

    method: str
    clips: dict[str, Path]


def method_clips(given: Sequence[str]) -> tuple[MethodClips, ...]:
    """Find the clips in folders.

    A folder may also hold a folder a picture with the clip in it, such as those of an evaluation's report
    (``REPORT/clips/METHOD``, with ``PICTURE/sample_0/clip.mp4``).

    Args:
        given: folders; ``NAME=FOLDER`` names the method, or else the folder does.

    Raises:
        InvalidInputError: fewer than two are given, two have the same name, or one holds no clip.
    """
    if len(given) < 2:
        raise InvalidInputError(f"CLIPS must be at least two folders, one a method. Got: {len(given)}")
    found: dict[str, MethodClips] = {}
    for each in given:
        name, folder = _named(each)
        if not name.strip() or name in (BROKEN, ALL):
            raise InvalidInputError(f"CLIPS must name a method before '='. Got: {printable(each)}")
        if name in found:
            raise InvalidInputError(f"CLIPS must be folders of different names, or NAME=FOLDER. Got: {name} twice")
        found[name] = MethodClips(name, _clips(folder))
    return tuple(found.values())


def _named(given: str) -> tuple[str, Path]:
    name, equals, folder = given.partition("=")
    path = Path(folder if equals and not Path(given).exists() else given)
    if not path.is_dir():
        raise InvalidInputError(f"CLIPS must be folders of clips, one a method. Got: {printable(str(path))}")
    return (name if equals and not Path(given).exists() else path.resolve().name), path


def _clips(folder: Path) -> dict[str, Path]:
    found: dict[str, Path] = {}
    for path in sorted(folder.iterdir()):
        if path.name.startswith("."):
            continue
        if path.is_file() and path.suffix.lower() in _VIDEOS:
            _add(found, path.stem, path)
        elif path.is_dir():
            for name, clip in _inside(path, path.name, _DEEPEST):
                _add(found, name, clip)
    if not found:
        raise InvalidInputError(f"CLIPS must be folders that hold clips. Got: none in {printable(str(folder))}")
    return found


def _add(found: dict[str, Path], name: str, clip: Path) -> None:
    if name in found:
        raise InvalidInputError(f"clips of a method must have different names. Got: {found[name].name} and {clip.name}")
    found[name] = clip


def _inside(folder: Path, name: str, depth: int) -> list[tuple[str, Path]]:
    """Clips in the folder of one picture, each with its name."""
    inside = sorted(path for path in folder.iterdir() if not path.name.startswith("."))
    videos = [path for path in inside if path.is_file() and path.suffix.lower() in _VIDEOS[:5]]
    if videos:
        mp4 = [path for path in videos if path.suffix.lower() == ".mp4"]
        best = (mp4 or videos)[0]
        return [(name, best)] if len(mp4 or videos) == 1 else [(f"{name}/{path.stem}", path) for path in mp4 or videos]
    if any(path.is_file() and path.suffix.lower() in _PICTURES for path in inside):
        return [(name, folder)]
    deeper = [path for path in inside if path.is_dir()] if depth else []
    return [each for path in deeper for each in _inside(path, f"{name}/{path.name}", depth - 1)]


def shared_names(first: MethodClips, second: MethodClips) -> list[str]:
    """Names that both methods have clips of.

    Raises:
        InvalidInputError: there is none.
    """
    names = sorted(first.clips.keys() & second.clips.keys())
    if not names:
        raise InvalidInputError(
            f"clips of {printable(first.method)} and {printable(second.method)} must have names in common."
            f" Got: {printable(min(first.clips))} and {printable(min(second.clips))}"
        )
    return names
