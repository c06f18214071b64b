"""What a clip is made from, as a hash: files by their content, options by their values, and our version."""

from __future__ import annotations

import hashlib
import json
import os
from functools import lru_cache
from pathlib import Path
from typing import Any

from ... import __version__
from ...physics.errors import InvalidInputError
from .evaluation_set import EvaluationSet, PictureOfSet
from .foreign_clips import foreign_clip
from .methods import Method

__all__ = ["clip_recipe", "digest_of_file", "digest_of_recipe"]

_CLIPS_FORMAT = 1  # counted up when methods draw otherwise than before
_WHOLE = 64 << 20  # bytes of a file that is read whole
_BLOCK, _BLOCKS = 1 << 20, 64  # of a larger one, such as weights


def clip_recipe(which: EvaluationSet, picture: PictureOfSet, sample: int, method: Method) -> dict[str, Any]:
    """All that a clip depends on, as a JSON value: an equal one means an equal clip.

    Raises:
        InvalidInputError: a file cannot be read.
    """
    facts = {"sample": sample, "rate": which.rate, "format": _CLIPS_FORMAT, "physanimator": __version__}
    if method.clips:
        return {**facts, "clip": digest_of_file(foreign_clip(method, picture, sample)), "method_rate": method.rate}
    named = dict.fromkeys((*method.weights, *_helpers(method)))
    weights = {key: digest_of_file(place) for key in named if (place := which.weights.of(key)) is not None}
    return {
        **facts,
        "method": method.as_record(),
        "picture": {
            "files": [digest_of_file(Path(each)) for each in picture.files],
            "parts": [len(picture.masks), len(picture.points), *map(bool, (picture.scene, picture.plate))],
            "presets": list(picture.presets),
        },
        "frames": which.frames,
        "seed": which.seed,
        "size": which.size,
        "name": picture.name if sample else "",  # of which the chance of further samples depends
        "weights": weights,
    }


def _helpers(method: Method) -> tuple[str, ...]:
    """Files that are used where they are named."""
    filled = ("sketch_encoder", "image_encoder", "text_encoder") if method.interpolate > 1 else ()
    return ("lines", *filled) if method.renderer == "svd" else filled


def digest_of_recipe(recipe: Any) -> str:
    """The hash of a JSON value."""
    return hashlib.sha256(json.dumps(recipe, sort_keys=True).encode()).hexdigest()


def digest_of_file(place: Path) -> str:
    """The hash of a file's content, or of all files of a folder; of a very large file, of blocks all over it.

    Raises:
        InvalidInputError: it cannot be read.
    """
    try:
        if place.is_dir():
            files = sorted(Path(folder, name) for folder, _, names in os.walk(place) for name in names)
            told = [(each.relative_to(place).as_posix(), digest_of_file(each)) for each in files]
            return digest_of_recipe(told)
        status = place.stat()
        return _content(place, status.st_size, status.st_mtime_ns)
    except OSError as error:
        raise InvalidInputError(f"{place} must be a file that can be read. Got: {error.strerror}") from None


@lru_cache(maxsize=4096)
def _content(place: Path, size: int, _: int) -> str:
    digest = hashlib.sha256(str(size).encode())
    with place.open("rb") as opened:
        if size <= _WHOLE:
            while block := opened.read(_BLOCK):
                digest.update(block)
        else:
            for number in range(_BLOCKS):
                opened.seek(number * (size - _BLOCK) // (_BLOCKS - 1))
                digest.update(opened.read(_BLOCK))
    return digest.hexdigest()
