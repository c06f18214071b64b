"""Sizes of the line drawing networks; the defaults are those of the public weights."""

from __future__ import annotations

from dataclasses import dataclass

from ....physics.errors import require
from ...networks import FromValues

__all__ = ["InformativeDrawingsConfiguration", "SketchUNetConfiguration"]


@dataclass(frozen=True)
class InformativeDrawingsConfiguration(FromValues):
    """What the shapes of the informative drawings generator follow from.

    Attributes:
        input_nc: channels of the picture.
        output_nc: channels of the drawing.
        n_residual_blocks: residual blocks at a quarter of the size.
        sigmoid: whether the drawing is brought to 0..1.
        base_channels: channels at full size.
    """

    input_nc: int = 3
    output_nc: int = 1
    n_residual_blocks: int = 3
    sigmoid: bool = True
    base_channels: int = 64

    def __post_init__(self) -> None:
        for name in ("input_nc", "output_nc", "base_channels"):
            require(name, getattr(self, name), getattr(self, name) >= 1, "at least 1")
        require("n_residual_blocks", self.n_residual_blocks, self.n_residual_blocks >= 0, "at least 0")


@dataclass(frozen=True)
class SketchUNetConfiguration(FromValues):
    """What the shapes of the sketch U-Net follow from.

    Attributes:
        input_nc: channels of the picture.
        output_nc: channels of the drawing.
        levels: how often the size is halved.
        base_channels: channels at half the size; they double with each level up to eight times as many.
    """

    input_nc: int = 3
    output_nc: int = 1
    levels: int = 8
    base_channels: int = 64

    def __post_init__(self) -> None:
        require("levels", self.levels, 2 <= self.levels <= 12, "2 to 12")

    @property
    def level_channels(self) -> tuple[int, ...]:
        """Channels of each level, from half the size down."""
        return tuple(self.base_channels * min(2**level, 8) for level in range(self.levels))
