"""Gradient checkpointing: stages of a network keep their inputs alone, and are computed again on the way back."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from torch import Tensor, nn
from torch.utils.checkpoint import checkpoint

from ..svd.encoder import Stage as VideoStage
from ..tooncrafter.stages import Stage as InterpolationStage

__all__ = ["recompute_stages"]


def recompute_stages(network: nn.Module) -> int:
    """Let all stages of a network be computed twice.

    Args:
        network: changed in place; its results and gradients stay the same.

    Returns:
        How many stages it has.
    """
    stages = [each for each in network.modules() if isinstance(each, VideoStage | InterpolationStage)]
    for stage in stages:
        stage.forward = _twice(stage.forward)  # type: ignore[method-assign]
    return len(stages)


def _twice(forward: Callable[..., Tensor]) -> Callable[..., Tensor]:
    def checkpointed(x: Tensor, conditions: Any) -> Tensor:
        return checkpoint(forward, x, conditions, use_reentrant=False)

    return checkpointed
