"""How much memory the autoencoder's work needs, roughly; ``tests/benchmarks/tooncrafter.py`` counts it exactly."""

from __future__ import annotations

import torch

from .options import ToonCrafterOptions

__all__ = ["decoding_bytes", "encoding_bytes"]

# All in pictures of full resolution, as wide as the autoencoder's first level.
# Features of a keyframe for the decoder, and all that encoding both keyframes needs.
_KEYFRAME_FEATURES = 3
_ENCODING = 12
# In the last level: features of a frame before its first block and after it, and what layers make of a frame.
_KEPT, _WORK = 1.5, 3
# For each frame, where all are decoded at once.
_ALL_AT_ONCE = 7.3


def encoding_bytes(pixels: int, channels: int) -> int:
    """Memory of encoding a pair of keyframes.

    Args:
        pixels: of one picture.
        channels: of the autoencoder's first level.
    """
    return _ENCODING * pixels * channels * torch.float32.itemsize


def decoding_bytes(
    pixels: int,
    channels: int,
    frames: int,
    *,
    together: int = ToonCrafterOptions.decoded_together,
    dtype: torch.dtype = torch.float32,
) -> int:
    """Memory of decoding a clip.

    Args:
        pixels: of one picture.
        channels: of the autoencoder's first level.
        frames: of the clip.
        together: frames that are decoded at once.
        dtype: in which it computes; sums and keyframes' features are in single precision always.
    """
    single, each = torch.float32.itemsize, dtype.itemsize
    if together >= frames:
        needed = _ALL_AT_ONCE * frames * (single + each) / 2
    else:
        needed = _KEPT * frames * each + _WORK * (max(together, 2) + 1) * single
    return int((2 * _KEYFRAME_FEATURES * single + needed) * pixels * channels)
