"""A ControlNet as it starts: a copy of the encoder that it steers, and convolutions of zeros (Zhang et al. 2023)."""

from __future__ import annotations

from typing import TypeVar

import torch
from torch import nn

from ..networks.checkpoints import check_names

__all__ = ["copied_encoder"]

Network = TypeVar("Network", bound=nn.Module)

_OWN = ("input_hint_block.", "zero_convs.", "middle_block_out.")


@torch.no_grad()
def copied_encoder(control: Network, source: nn.Module | dict[str, torch.Tensor], *, file: str = "") -> Network:
    """Give a ControlNet the weights of an encoder; its layers for the sketch stay as they were made.

    Args:
        control: with its own storage.
        source: the network that it copies, or its tensors by name.
        file: where they come from, for messages.

    Returns:
        ``control``.

    Raises:
        CheckpointError: the encoder has another shape.
    """
    given = source.state_dict() if isinstance(source, nn.Module) else source
    own = control.state_dict()
    copied = {name: own[name] for name in own if not name.startswith(_OWN)}
    check_names(
        {name: tuple(tensor.shape) for name, tensor in copied.items()},
        {name: tuple(given[name].shape) for name in copied if name in given},
        file=file or "the encoder",
        wanted="the encoder that the ControlNet copies",
    )
    for name, tensor in copied.items():
        tensor.copy_(given[name])
    return control
