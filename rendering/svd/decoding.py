"""Latents to pictures, a few frames at a time: the decoder mixes neighbouring frames, so chunks overlap."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import torch
from torch import Tensor

from ...physics.errors import require
from .options import DECODED_TOGETHER

__all__ = ["Chunk", "around_the_wrap", "decode", "decoding_chunks"]

_OVERLAP = 3
"""Frames of the chunk before that are decoded once more, and dropped."""


@dataclass(frozen=True)
class Chunk:
    """Frames that are decoded together.

    Attributes:
        frames: frame 0, then successive ones.
        kept: first of them that is new.
    """

    frames: tuple[int, ...]
    kept: int


def decoding_chunks(count: int, size: int = DECODED_TOGETHER) -> Iterator[Chunk]:
    """Chunks that cover a clip; each holds frame 0, and all but the first a few frames of the one before.

    Args:
        count: frames of the clip.
        size: frames of a chunk.
    """
    require("size", size, size > 1 + _OVERLAP, f"{2 + _OVERLAP} frames or more")
    yield Chunk(tuple(range(min(size, count))), 0)
    end, kept = size, 1 + _OVERLAP
    while end < count:
        start = end - _OVERLAP
        end = start + size - 1
        yield Chunk((0, *range(start, min(end, count))), kept)


def around_the_wrap(count: int) -> list[int]:
    """Frames to decode of a clip whose last frame leads to frame 1, so that neighbours are mixed there as elsewhere.

    Frame 0, the reference picture, then the loop with its last frames once more before it and its first ones after it.

    Args:
        count: frames of the clip, frame 0 included.
    """
    cycle, more = count - 1, min(_OVERLAP, count - 1)
    return [0, *(1 + frame % cycle for frame in range(-more, cycle + more))]


@torch.no_grad()
def decode(
    decoder: Callable[[Tensor], Tensor],
    latents: Tensor,
    *,
    size: int = DECODED_TOGETHER,
    progress: Callable[[int, int], None] | None = None,
) -> Iterator[Tensor]:
    """Pictures of a clip, a chunk at a time.

    Args:
        decoder: makes pictures of unscaled latents, shapes [t, 4, h, w] to [t, 3, 8 h, 8 w].
        latents: unscaled, shape [f, 4, h, w].
        size: frames decoded together.
        progress: called after each chunk with frames done and frames in all.

    Yields:
        The next frames, -1..1, clamped, shape [n, 3, 8 h, 8 w].
    """
    for chunk in decoding_chunks(len(latents), size):
        pictures = decoder(latents[list(chunk.frames)])[chunk.kept :].clamp(-1, 1)
        if progress is not None:
            progress(chunk.frames[-1] + 1, len(latents))
        yield pictures
