"""A ControlNet as it starts: a copy of the encoder that it steers, and convolutions of zeros (Zhang et al. 2023)."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import torch
from torch import nn

from ..networks.checkpoints import check_names

__all__ = ["copied_encoder"]

Network = TypeVar("Network", bound=nn.Module)

_OWN = ("input_hint_block.", "zero_convs.", "middle_block_out.")


@torch.no_grad()
def copied_encoder(
    build: Callable[[], Network], source: nn.Module | dict[str, torch.Tensor], *, file: str = "", seed: int = 0
) -> Network:
    """A ControlNet with the weights of an encoder; its layers for the sketch are drawn at random and end in zeros.

    Args:
        build: makes the ControlNet.
        source: the network that it copies, or its tensors by name.
        file: where they come from, for messages.
        seed: of the layers for the sketch.

    Raises:
        CheckpointError: the encoder has another shape.
    """
    with torch.random.fork_rng(devices=()):
        torch.manual_seed(seed)
        control = build()
        _keep_strength(control)
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


def _keep_strength(control: nn.Module) -> None:
    """Draw the layers for the sketch so that little of its strength is lost in them (He et al. 2015).

    Dots on a sixth of the paper come out of the eight layers with a ninth of their contrast; with PyTorch's own start,
    with less than a hundredth.
    """
    for name, layer in control.named_modules():
        if name.startswith("input_hint_block.") and isinstance(layer, nn.Conv2d) and bool(layer.weight.any()):
            nn.init.kaiming_normal_(layer.weight)
            if layer.bias is not None:
                nn.init.zeros_(layer.bias)
