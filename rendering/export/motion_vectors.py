"""Motion vectors as OpenEXR files, one a frame, in the channels in which compositing programs look for them.

All values are float32 pixels of the illustration from one frame to the next, x right and y UP, as both programs count;
0 where nothing moves.

- ``nuke``: ``forward.u``, ``forward.v`` (to the next frame), ``backward.u``, ``backward.v`` (to the one before): the
  layers forward and backward of VectorBlur, Kronos and the like. Programs that take any channels take these, too.
- ``blender``: the pass ``ViewLayer.Vector`` as Cycles writes it. X and Y lead to the frame before; Z and W are the
  negative of what leads to the next one (``primitive_motion_vector`` in Cycles' kernel).
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, require
from ...physics.motion import FrameFlow, Motion, MotionVectors
from ...physics.progress import Progress
from ..files import RecordedFiles, StrPath, check_recorded_folder, write_recorded_folder

__all__ = [
    "VECTOR_CHANNELS",
    "VectorChannels",
    "check_openexr",
    "check_vectors_folder",
    "exr_channels",
    "save_motion_vectors",
]

VectorChannels = Literal["nuke", "blender"]
VECTOR_CHANNELS: tuple[VectorChannels, ...] = get_args(VectorChannels)

_NAME = "vectors_{:04d}.exr"
_PATTERN = re.compile(r"vectors_[0-9]{4,}\.exr", re.IGNORECASE)
_UP = np.array([1, -1], dtype=np.float32)


def exr_channels(vectors: MotionVectors, channels: VectorChannels) -> dict[str, NDArray[np.float32]]:
    """Each channel of a file by its name, shape [h, w].

    Args:
        vectors: of one frame, y down.
        channels: whose names and signs.

    Raises:
        InvalidInputError: no such channels.
    """
    require("channels", channels, channels in VECTOR_CHANNELS, f"one of {', '.join(VECTOR_CHANNELS)}")
    forward, backward = vectors.forward * _UP, vectors.backward * _UP
    if channels == "nuke":
        named = {"forward.u": forward[..., 0], "forward.v": forward[..., 1]}
        named |= {"backward.u": backward[..., 0], "backward.v": backward[..., 1]}
    else:
        both = np.dstack([backward, -forward])
        named = {f"ViewLayer.Vector.{name}": both[..., number] for number, name in enumerate("XYZW")}
    return {name: np.ascontiguousarray(values) + np.float32(0) for name, values in named.items()}  # no -0


def check_openexr() -> None:
    """Refuse to go on without the package that writes the files; raises InvalidInputError."""
    _openexr()


def check_vectors_folder(path: StrPath, *, coming: Collection[Path] = ()) -> Path:
    """Refuse a folder that could not be written, or holds vectors that :func:`save_motion_vectors` did not write.

    Args:
        path: the folder, which need not exist yet.
        coming: see :func:`~physanimator.rendering.files.check_file_place`.

    Returns:
        Where it really comes to lie.

    Raises:
        InvalidInputError: see above, or the package OpenEXR is not installed.
    """
    _openexr()
    return check_recorded_folder(path, _FILES, coming=coming)


def save_motion_vectors(
    motion: Motion, path: StrPath, *, channels: VectorChannels = "nuke", progress: Progress | None = None
) -> None:
    """Write ``vectors_0000.exr`` and so on; they appear, and earlier ones go, when all are complete.

    Args:
        motion: whose vectors they are, frame by frame; see :class:`~physanimator.physics.motion.FrameFlow`.
        path: the folder, which is made if it does not exist.
        channels: whose names and signs.
        progress: called after each frame with (done, total); may raise to stop.

    Raises:
        InvalidInputError: see :func:`check_vectors_folder`; or no such channels.
        OSError: the disk is full or the like; it names ``path``.
    """
    require("channels", channels, channels in VECTOR_CHANNELS, f"one of {', '.join(VECTOR_CHANNELS)}")
    check_vectors_folder(path)
    write_recorded_folder(path, _FILES, lambda staging: _written(motion, staging, channels, progress))


def _written(motion: Motion, staging: Path, channels: VectorChannels, progress: Progress | None) -> Iterator[str]:
    openexr = _openexr()
    header = {
        "compression": openexr.ZIP_COMPRESSION,
        "type": openexr.scanlineimage,
        "comments": "Motion vectors in pixels a frame, x right, y up.",
    }
    for number, vectors in enumerate(FrameFlow(motion)):
        name = _NAME.format(number)
        with openexr.File(header, exr_channels(vectors, channels)) as file:
            file.write(str(staging / name))
        yield name
        if progress is not None:
            progress(number + 1, len(motion))


def _openexr() -> Any:
    try:
        import OpenEXR
    except ImportError:
        raise InvalidInputError(
            "motion vectors need the package OpenEXR: pip install OpenEXR, or 'physanimator[exr]'. Got: none"
        ) from None
    return OpenEXR


_FILES = RecordedFiles(
    "vectors",
    ".physanimator-vectors.json",
    "no motion vectors but unchanged ones of an earlier motion",
    lambda folder: sorted(each.name for each in folder.iterdir() if _PATTERN.fullmatch(each.name)),
)
