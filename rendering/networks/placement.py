"""Where networks compute, and how they share a device that cannot hold all of them at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import torch
from torch import nn

from .memory import bytes_of

__all__ = ["Placement"]


@dataclass(frozen=True)
class Placement:
    """The device, and whom to ask for room on it.

    Attributes:
        device: where networks compute.
        make_room: called before networks come to the device, with the bytes that they and their work need.
        left: called after they have left it.
    """

    device: torch.device
    make_room: Callable[[int], None] = lambda _: None
    left: Callable[[], None] = lambda: None

    @contextmanager
    def at_work(self, *networks: nn.Module, working_bytes: int = 0) -> Iterator[None]:
        """Networks are on the device meanwhile, and their memory there is free afterwards.

        The tensors that they had before are kept and put back, so that nothing is copied from the device.

        Args:
            networks: that will be used.
            working_bytes: what their results in between need.
        """
        self.make_room(sum(map(bytes_of, networks)) + working_bytes)
        kept = [network.state_dict() for network in networks]
        try:
            for network, tensors in zip(networks, kept, strict=True):
                moved = {name: tensor.to(self.device) for name, tensor in tensors.items()}
                network.load_state_dict(moved, assign=True)
            yield
        finally:
            for network, tensors in zip(networks, kept, strict=True):
                network.load_state_dict(tensors, assign=True)
            self.left()
