"""Sizes of networks from values by name, as a JSON document holds them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, TypeVar

from ...physics.errors import InvalidInputError, require

__all__ = ["DiffusionConfiguration", "FromValues"]

Configuration = TypeVar("Configuration", bound="FromValues")


class FromValues:
    """Makes frozen dataclasses of sizes from values by name."""

    @classmethod
    def of(cls: type[Configuration], values: Configuration | Mapping[str, Any]) -> Configuration:
        """From values by name, such as a JSON document's; lists become tuples.

        Raises:
            InvalidInputError: a name is unknown, or these are no values by name.
        """
        if isinstance(values, cls):
            return values
        if not isinstance(values, Mapping):
            raise InvalidInputError(f"configuration must hold values by name. Got: {type(values).__name__}")
        known = {field.name for field in fields(cls)}  # type: ignore[arg-type]
        unknown = sorted(set(values) - known)
        require("configuration", unknown, not unknown, f"made of {', '.join(sorted(known))}")
        return cls(**{name: tuple(each) if isinstance(each, list) else each for name, each in values.items()})


@dataclass(frozen=True)
class DiffusionConfiguration(FromValues):
    """Sizes that the UNets of both video models and their sketch encoders have in common.

    Attributes:
        model_channels: width m of the first level.
        channel_mult: width of each level, in multiples of m.
        num_res_blocks: residual blocks a level.
        attention_at_levels: levels whose residual blocks are followed by transformers.
        num_head_channels: channels of one attention head.
        context_dim: channels of a token of the context, such as the picture embedding.
    """

    model_channels: int = 320
    channel_mult: tuple[int, ...] = (1, 2, 4, 4)
    num_res_blocks: int = 2
    attention_at_levels: tuple[int, ...] = (0, 1, 2)
    num_head_channels: int = 64
    context_dim: int = 1024

    def __post_init__(self) -> None:
        width, heads = self.model_channels, self.num_head_channels
        require("model_channels", width, width % 32 == 0 and width % heads == 0, f"a multiple of 32 and of {heads}")

    @property
    def embedding_channels(self) -> int:
        """Channels of the embedding that every residual block receives."""
        return 4 * self.model_channels

    @property
    def level_channels(self) -> tuple[int, ...]:
        """Channels of each level."""
        return tuple(self.model_channels * multiple for multiple in self.channel_mult)
