"""Where an animation is saved in the host's output folder, by the host's own rules of naming and counting."""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from ...physics.errors import InvalidInputError
from ...rendering.pictures import FORMATS

__all__ = ["EXR", "FILE_TYPES", "FRAMES", "SPINE", "Place", "check_prefix", "free_place"]

FRAMES = "png frames"
FILE_TYPES = (*(suffix.removeprefix(".") for suffix in FORMATS), FRAMES)
"""The file types of the command line, and numbered pictures in a folder of their own."""

SPINE = "spine"
"""The file type of skeletons, each in a folder of its own."""
EXR = "exr frames"
"""The file type of motion vectors, numbered files in a folder of their own."""


_LONGEST_NAME = 200  # bytes; file systems take 255, a number and an ending among them


class Place(NamedTuple):
    """A name that nothing has yet.

    Attributes:
        path: in full, as ``write_animation`` takes it: a folder ends in a slash.
        name: of the file or folder.
        subfolder: of the output folder, as the host's pages ask for it.
    """

    path: str
    name: str
    subfolder: str


def check_prefix(filename_prefix: str) -> None:
    """Refuse a prefix that leads out of the output folder or names no file, before any work.

    Raises:
        InvalidInputError: see above.
    """
    import folder_paths

    output = Path(folder_paths.get_output_directory()).resolve()
    longest = max(len(os.fsencode(part)) for part in filename_prefix.replace("\\", "/").split("/"))
    if longest > _LONGEST_NAME:
        raise InvalidInputError(
            f"filename_prefix must be of names with at most {_LONGEST_NAME} bytes each. Got: {longest} bytes"
        )
    named = os.path.basename(os.path.normpath(filename_prefix)) not in ("", ".", "..")
    if not named or "\0" in filename_prefix or not (output / filename_prefix).resolve().is_relative_to(output):
        raise InvalidInputError(
            f"filename_prefix must be a name in the output folder, such as film/hair. Got: {filename_prefix[:60]!r}"
        )


def free_place(filename_prefix: str, file_type: str, width: int, height: int) -> Place:
    """The next free number for a prefix, which may hold %width%, %height%, %year%, %month%, %day% and so on.

    Args:
        filename_prefix: as the host's save nodes take it, with folders.
        file_type: one of ``FILE_TYPES``, an ending without its dot, ``SPINE`` or ``EXR``.
        width: of the frames [px].
        height: of the frames [px].

    Raises:
        InvalidInputError: the prefix leads out of the output folder, or no folder can be made there.
    """
    import folder_paths

    check_prefix(filename_prefix)
    try:
        folder, name, number, subfolder, _ = folder_paths.get_save_image_path(
            filename_prefix, folder_paths.get_output_directory(), width, height
        )
    except OSError as error:
        raise InvalidInputError(
            f"filename_prefix must name a folder that can be made. Got: {filename_prefix[:60]!r}: {error.strerror}"
        ) from error
    ending = "" if file_type in (EXR, FRAMES, SPINE) else f".{file_type}"
    while os.path.lexists(os.path.join(folder, f"{name}_{number:05}_{ending}")):
        number += 1
    file = f"{name}_{number:05}_{ending}"
    path = os.path.join(folder, file)
    return Place(path + "/" if file_type == FRAMES else path, file, subfolder)
