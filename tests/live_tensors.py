"""Counts the memory of tensors that live at once, without computing anything: for devices that are not at hand."""

from __future__ import annotations

import weakref
from typing import Any

import torch
from torch import nn
from torch.utils._python_dispatch import TorchDispatchMode
from torch.utils._pytree import tree_leaves

__all__ = ["LiveTensors"]


class LiveTensors(TorchDispatchMode):
    """While active, keeps count of results that are still in use. Use it inside PyTorch's FakeTensorMode.

    Attributes:
        peak: most bytes at once; weights do not count.
    """

    def __init__(self, *networks: nn.Module) -> None:
        super().__init__()
        self.peak, self._now = 0, 0
        self._known = {each.untyped_storage()._cdata for network in networks for each in network.parameters()}

    def __torch_dispatch__(self, function: Any, types: Any, args: Any = (), kwargs: Any = None) -> Any:
        result = function(*args, **(kwargs or {}))
        for tensor in tree_leaves(result):
            if isinstance(tensor, torch.Tensor):
                self._add(tensor.untyped_storage())
        return result

    def _add(self, storage: Any) -> None:
        key, size = storage._cdata, storage.nbytes()
        if key in self._known:
            return
        self._known.add(key)
        self._now += size
        self.peak = max(self.peak, self._now)
        weakref.finalize(storage, self._remove, key, size)

    def _remove(self, key: int, size: int) -> None:
        self._known.discard(key)
        self._now -= size
