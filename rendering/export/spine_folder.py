"""A Spine skeleton in a folder: ``NAME.json``, an atlas with its pages for engines, and ``images/`` for the editor."""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterator
from pathlib import Path

from ...physics.progress import Progress
from ..files import RecordedFiles, StrPath, check_recorded_folder, place_of, plain_name, write_recorded_folder
from ..pictures import save_image
from .atlas import atlas_text, packed
from .puppet import Puppet
from .spine import SpineSkeleton, spine_skeleton

__all__ = ["SPINE_RECORD", "check_spine_folder", "is_spine_name", "save_spine", "spine_files_in"]

SPINE_RECORD = ".physanimator-spine.json"
"""Name of the record in the folder; hidden, where a leading dot hides."""

_IMAGES = "images"


def check_spine_folder(path: StrPath, *, coming: Collection[Path] = ()) -> Path:
    """Refuse a folder that could not be written, or holds a skeleton that :func:`save_spine` did not write.

    Args:
        path: the folder, which need not exist yet.
        coming: see :func:`~physanimator.rendering.files.check_file_place`.

    Returns:
        Where it really comes to lie.

    Raises:
        InvalidInputError: see above.
    """
    return check_recorded_folder(path, _files(path), coming=coming)


def is_spine_name(folder: Path, name: str) -> bool:
    """Whether a file of this name in a folder, with slashes, would count as one of its skeleton's.

    Args:
        folder: where it is, or is to be.
        name: of the file, or of a folder in it.
    """
    stem = re.escape(_stem(folder))
    pattern = rf"{stem}\.(json|atlas|png)|{stem}_[0-9]+\.png|{_IMAGES}|{_IMAGES}/[^/]*\.png"
    return re.fullmatch(pattern, name, re.IGNORECASE) is not None


def spine_files_in(folder: Path) -> list[str]:
    """Names of all files in a folder that are named as a skeleton's are, whoever wrote them; with slashes."""
    images = folder / _IMAGES
    names = [each.name for each in folder.iterdir() if not each.is_dir()]
    names += [f"{_IMAGES}/{each.name}" for each in images.iterdir()] if images.is_dir() else []
    return sorted(name for name in names if is_spine_name(folder, name))


def save_spine(puppet: Puppet, path: StrPath, *, tolerance: float, progress: Progress | None = None) -> SpineSkeleton:
    """Write a puppet as a skeleton; its files appear, and earlier ones go, when all are complete.

    Colours of pictures and pages are straight, not premultiplied by alpha.

    Args:
        puppet: the pieces and their motion.
        path: the folder, which is made if it does not exist; its name is the skeleton's.
        tolerance: how far a vertex may ever be from where the motion has it [px].
        progress: called after each piece; may raise to stop.

    Raises:
        InvalidInputError: see :func:`check_spine_folder`.
        OSError: the disk is full or the like; it names ``path``.
    """
    pictures = _picture_names(puppet)
    skeleton = spine_skeleton(puppet, pictures, tolerance=tolerance, progress=progress)
    stem = _stem(place_of(path))

    def written(staging: Path) -> Iterator[str]:
        (staging / _IMAGES).mkdir()
        by_name = {pictures[piece.name]: piece.pixels for piece in puppet.pieces}
        for name, pixels in by_name.items():
            save_image(staging / _IMAGES / f"{name}.png", pixels)
            yield f"{_IMAGES}/{name}.png"
        pages = packed(by_name)
        files = [f"{stem}.png", *(f"{stem}_{number}.png" for number in range(2, len(pages) + 1))]
        for page, name in zip(pages, files, strict=True):
            save_image(staging / name, page.pixels)
            yield name
        text = json.dumps(skeleton.document, separators=(",", ":"), ensure_ascii=False) + "\n"
        for ending, content in (("atlas", atlas_text(pages, files)), ("json", text)):
            (staging / f"{stem}.{ending}").write_text(content, encoding="utf-8", newline="\n")
            yield f"{stem}.{ending}"

    write_recorded_folder(path, _files(path), written)
    return skeleton


def _picture_names(puppet: Puppet) -> dict[str, str]:
    """A file name without ending for each piece, different also where case does not count."""
    names: dict[str, str] = {}
    taken: set[str] = set()
    for piece in puppet.pieces:
        plain = name = plain_name(piece.name, or_else="layer")
        number = 2
        while name.casefold() in taken:
            name, number = f"{plain} ({number})", number + 1
        taken.add(name.casefold())
        names[piece.name] = name
    return names


def _stem(folder: Path) -> str:
    return plain_name(folder.name, or_else="skeleton")


def _files(path: StrPath) -> RecordedFiles:
    return RecordedFiles("skeleton", SPINE_RECORD, "no skeleton but an unchanged earlier one", spine_files_in)
