"""Networks that a node has loaded, in the hands of the host: it brings them to the device and takes them away.

The networks that a kind of node used last are kept for its next run, until the host wants their memory: when it frees
the device for others, when somebody asks it to unload all models (the route ``/free``, a menu, the Manager). Others of
the same kind are let go before new ones are read, so that two are never held.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Hashable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any, Generic, TypeVar
from weakref import WeakMethod

if TYPE_CHECKING:
    import torch
    from torch import nn

    from ...rendering.networks.placement import Placement

__all__ = ["Networks", "kept_networks"]

Held = TypeVar("Held")


@dataclass(eq=False)
class Networks(Generic[Held]):
    """What one kind of node has loaded.

    Attributes:
        held: the networks, as the loader gives them.
        key: what they were made from.
    """

    held: Held
    key: Hashable
    _patchers: dict[int, Any] = field(default_factory=dict)
    _loaded: set[int] = field(default_factory=set)
    _at_work: int = 0

    def placement(self, device: torch.device) -> Placement:
        """The device, on which the host makes room for these networks and keeps them until it wants it back."""
        return _host_placement()(device=device, networks=self)

    @contextmanager
    def at_work(self, device: torch.device, used: Iterable[nn.Module], working_bytes: int) -> Iterator[None]:
        """Some of the networks are on the device meanwhile.

        Args:
            device: where they compute.
            used: the networks.
            working_bytes: what their results in between need.
        """
        from comfy import model_management

        self._at_work += 1
        try:
            patchers = [self._patcher(network, device) for network in used]
            self._loaded |= {id(patcher) for patcher in patchers}
            # As a whole: layers that are not the host's own cannot fetch their weights one by one.
            model_management.load_models_gpu(patchers, memory_required=working_bytes, force_full_load=True)
            yield
        finally:
            self._at_work -= 1

    def _patcher(self, network: nn.Module, device: torch.device) -> Any:
        """What the host manages a network by; it holds the network, which therefore keeps its number."""
        patcher = self._patchers.get(id(network))
        if patcher is None or patcher.load_device != device:
            patcher = self._patchers[id(network)] = _patcher_class()(network, device, WeakMethod(self._taken_away))
        return patcher

    def _taken_away(self, patcher: Any) -> None:
        """The host has taken a network off the device; once it has all of them, nothing of ours keeps them either."""
        self._loaded.discard(id(patcher))
        if not self._loaded and self._at_work == 0 and self in _kept.values():
            _leaving.append(self)
            if _let_go not in gc.callbacks:
                gc.callbacks.append(_let_go)

    @property
    def _is_free(self) -> bool:
        """Whether the host has done with all of them: it still counts in its list while it takes models away."""
        from comfy import model_management

        listed = [each.model for each in model_management.current_loaded_models]
        return not any(patcher is each for patcher in self._patchers.values() for each in listed)


_kept: dict[str, Networks[Any]] = {}
_leaving: list[Networks[Any]] = []


def kept_networks(kind: str, key: Hashable, load: Callable[[], Held]) -> Networks[Held]:
    """The networks of a kind: those that are kept if they are the same, else new ones in their place.

    Args:
        kind: of node; one set is kept for each.
        key: what they are made from: files, when these were written, precision.
        load: reads them.
    """
    found = _kept.get(kind)
    if found is not None and found.key == key:
        _leaving[:] = [each for each in _leaving if each is not found]
        return found
    del found
    _leaving.clear()
    if _kept.pop(kind, None) is not None:
        gc.collect()  # networks hold themselves in circles
    _kept[kind] = made = Networks(load(), key)
    return made


def _let_go(phase: str, _: Any) -> None:
    """Forget what the host has taken away, when it collects garbage after that.

    Not at once: it goes through its list of models while it takes them away, and dying ones leave that list.
    """
    if phase != "start":
        return
    for networks in [each for each in _leaving if each._is_free]:
        _leaving.remove(networks)
        for kind in [kind for kind, each in _kept.items() if each is networks]:
            del _kept[kind]
    if not _leaving:
        gc.callbacks.remove(_let_go)


@cache
def _patcher_class() -> Any:
    import torch
    from comfy.model_patcher import ModelPatcher
    from comfy.patcher_extension import CallbacksMP

    class Managed(torch.nn.Module):
        """A network as the host wants it: with a device that can be noted down."""

        def __init__(self, network: nn.Module) -> None:
            super().__init__()
            self.network = network
            self.device = torch.device("cpu")

    class Patcher(ModelPatcher):  # type: ignore[misc]
        def __init__(self, network: nn.Module, device: torch.device, taken_away: WeakMethod[Any]) -> None:
            super().__init__(Managed(network), load_device=device, offload_device=torch.device("cpu"))
            self.taken_away = taken_away
            self.add_callback(CallbacksMP.ON_DETACH, _detached)

        def load(self, device_to: Any = None, **options: Any) -> Any:
            # Also where the host is told to use little of the device: plain layers work there or not at all.
            return super().load(device_to, **(options | {"full_load": True}))

        def partially_unload(self, *_: Any, **__: Any) -> int:
            return 0  # all or nothing, as in at_work

    return Patcher


def _detached(patcher: Any, everything: bool) -> None:
    told = patcher.taken_away()
    if everything and told is not None:
        told(patcher)


@cache
def _host_placement() -> Any:
    from ...rendering.networks.placement import Placement

    @dataclass(frozen=True, kw_only=True)
    class HostPlacement(Placement):
        networks: Networks[Any]

        @contextmanager
        def at_work(self, *networks: nn.Module, working_bytes: int = 0) -> Iterator[None]:
            with self.networks.at_work(self.device, networks, working_bytes):
                yield

    return HostPlacement
