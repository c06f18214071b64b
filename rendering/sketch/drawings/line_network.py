"""What the networks that draw lines have in common: the way from public weights to a network."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar, TypeVar

import torch
from torch import nn

from ...networks.checkpoints import network_of

__all__ = ["LineNetwork"]

Network = TypeVar("Network", bound="LineNetwork")


class LineNetwork(nn.Module):
    """RGB in 0..1 becomes dark lines, 0, on paper, 1.

    Attributes:
        multiple: width and height must be multiples of this [px].
        least: the smallest width and height [px].
        configuration: class of its sizes.
        first_convolution: name of the weights off which the width is read.
        wanted: which file holds its weights, for messages.
    """

    multiple: int
    least: int
    configuration: ClassVar[Any]
    first_convolution: ClassVar[str]
    wanted: ClassVar[str]

    def __init__(self, config: Any) -> None:
        super().__init__()
        self.config = config

    @classmethod
    def from_reference(
        cls: type[Network],
        config: Any,
        state_dict: Mapping[str, Any],
        *,
        file: str = "the state dict",
        wanted: str | None = None,
    ) -> Network:
        """A network with the weights of a state dict, whose names are the public checkpoint's.

        Args:
            config: sizes, as a configuration or a mapping; the width is always read off the first convolution.
            state_dict: tensors or arrays by name.
            file: where they come from, for messages.
            wanted: which file this should be, for messages.

        Raises:
            CheckpointError: a name is missing, too many, or its tensor has another shape.
        """
        tensors = {name: torch.as_tensor(value) for name, value in state_dict.items()}
        sizes, first = cls.configuration.of(config), tensors.get(cls.first_convolution)
        if first is not None and first.ndim == 4:
            sizes = replace(sizes, base_channels=len(first))
        return network_of(lambda: cls(sizes), tensors, file=file, wanted=wanted or cls.wanted)
