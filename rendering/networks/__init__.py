"""What the video models share: checkpoint files, memory and devices, image encoder, embeddings, working size."""

from __future__ import annotations

from .configuration import DiffusionConfiguration, FromValues
from .working_size import LARGEST_AREA, SMALLEST_AREA, TRAINED_HEIGHT, TRAINED_WIDTH, Frame

__all__ = [
    "LARGEST_AREA",
    "SMALLEST_AREA",
    "TRAINED_HEIGHT",
    "TRAINED_WIDTH",
    "DiffusionConfiguration",
    "Frame",
    "FromValues",
]
