"""What the frozen networks made of a clip, read in part, and whether it still belongs to the clip."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from itertools import islice
from pathlib import Path

import numpy as np
import torch
from numpy.typing import NDArray
from safetensors import SafetensorError, safe_open
from torch import Tensor

from ...physics.errors import InvalidInputError
from ..pictures import as_grey, read_clip
from .data_folder import clip_file, encoded_file, hash_of, sketch_file

__all__ = ["check_encoded", "frames_of", "in_order", "line_frames", "read_tensors"]


def read_tensors(data: Path, kind: str, name: str, wanted: Sequence[str]) -> dict[str, Tensor]:
    """Tensors of a clip, on the CPU.

    Args:
        data: the data folder.
        kind: ``svd`` or ``tooncrafter``.
        name: of the clip.
        wanted: names of the tensors.

    Raises:
        InvalidInputError: the clip is not encoded, the file is damaged, or the clip was changed since.
    """
    place = encoded_file(data, kind, name)
    check_encoded(data, kind, name)
    try:
        with safe_open(place, framework="pt") as opened:
            return {each: opened.get_tensor(each) for each in wanted}
    except (SafetensorError, OSError) as error:
        raise InvalidInputError(f"{place} must be what physanimator dataset encode wrote. Got: {error}") from None


@lru_cache(maxsize=1 << 20)
def check_encoded(data: Path, kind: str, name: str) -> None:
    """Refuse what was not made of the clip as it is now.

    Raises:
        InvalidInputError: it was not, or there is nothing.
    """
    place = encoded_file(data, kind, name)
    if not place.is_file():
        raise InvalidInputError(f"clip {name} must be encoded first, by physanimator dataset encode. Got: no {place}")
    try:
        with safe_open(place, framework="pt") as opened:
            told = (opened.metadata() or {}).get("clip", "")
    except (SafetensorError, OSError) as error:
        raise InvalidInputError(f"{place} must be what physanimator dataset encode wrote. Got: {error}") from None
    if told != hash_of(clip_file(data, name)):
        raise InvalidInputError(f"clip {name} must be encoded again. Got: {place}, made of other frames")


def frames_of(file: Path, numbers: Sequence[int]) -> list[NDArray[np.uint8]]:
    """Frames of a video by their numbers, RGB, shape [h, w, 3] each.

    Raises:
        InvalidInputError: it has too few, or cannot be read.
    """
    needed = set(numbers)
    read = {number: frame for number, frame in enumerate(islice(read_clip(file), max(needed) + 1)) if number in needed}
    if missing := sorted(needed - set(read)):
        raise InvalidInputError(f"{file} must have at least {missing[-1] + 1} frames. Got: fewer")
    return [read[number] for number in numbers]


def line_frames(data: Path, name: str, numbers: Sequence[int]) -> NDArray[np.float32]:
    """Sketches of a clip's frames, lines 1 on 0, shape [t, h, w].

    Raises:
        InvalidInputError: see :func:`frames_of`.
    """
    drawn = frames_of(sketch_file(data, name), numbers)
    return np.stack([1 - as_grey(each) for each in drawn]).astype(np.float32)


def in_order(latents: Tensor, numbers: Sequence[int]) -> Tensor:
    """Latents of the frames of these numbers, float32, shape [t, 4, h, w].

    Raises:
        InvalidInputError: there are too few.
    """
    if max(numbers) >= len(latents):
        raise InvalidInputError(f"latents must be of at least {max(numbers) + 1} frames. Got: {len(latents)}")
    return latents[torch.tensor(numbers)].float()
