"""From the latents of a clip to its frames."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor

__all__ = ["decode_clip"]


def decode_clip(decoder: Callable[[Tensor], Tensor], latents: Tensor) -> Tensor:
    """Decode a clip whole, and its middle frames from a second, shorter run.

    The middle two frames are farthest from both keyframes; in the second run, which leaves out the second frame and the
    last but one, they are nearer.

    Args:
        decoder: decodes unscaled latents [t, 4, h, w], with the keyframes' features.
        latents: unscaled, shape [t, 4, h, w], of an even number of frames.

    Returns:
        Pictures, -1..1, shape [t, 3, 8 h, 8 w].
    """
    count = len(latents)
    frames = decoder(latents)
    if count < 6:
        return frames
    shorter = decoder(torch.cat([latents[:1], latents[2:-2], latents[-1:]]))
    middle = count // 2
    frames = frames.clone()
    frames[middle - 1 : middle + 1] = shorter[middle - 2 : middle]
    return frames
