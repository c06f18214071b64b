"""A run of a checked prompt: nodes in the order of their links; what was not changed is not computed again."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from .calling import called, is_ours, merged, overridden
from .checking import Checked
from .choices import described, is_link

__all__ = ["Kept", "Run"]


class Kept(NamedTuple):
    """What a node has given: a list for each output, and what it shows."""

    outputs: list[list[Any]]
    shown: dict[str, Any]


class Run:
    """One prompt being run.

    Attributes:
        executed: keys of the nodes that were computed, in order.
        kept: what every node of the prompt has given, by what it was made from.
    """

    def __init__(self, checked: Checked, before: Mapping[Any, Kept]) -> None:
        self.prompt, self.known, self.prompt_id = checked.prompt, checked.known, checked.prompt_id
        self._before = before
        self._made: dict[str, tuple[Any, Kept]] = {}
        self.executed: list[str] = []

    @property
    def kept(self) -> dict[Any, Kept]:
        return dict(self._made.values())

    @property
    def shown(self) -> dict[str, Any]:
        return {key: kept.shown for key, (_, kept) in self._made.items() if kept.shown}

    def make(self, key: str) -> tuple[Any, Kept]:
        """What identifies a node's result, and the result."""
        if key in self._made:
            return self._made[key]
        node = self.prompt[key]
        kind = self.known[node["class_type"]]
        found = described(kind.INPUT_TYPES(), node["inputs"])
        lists, origins = {}, []
        for name, value in node["inputs"].items():
            if is_link(value):
                origin, source = self.make(value[0])
                lists[name] = source.outputs[value[1]]
                origins.append((name, origin, value[1]))
            elif name in found.all:
                lists[name] = [value]
                origins.append((name, repr(value)))
        made_from = (node["class_type"], *self._fingerprint(key, kind, lists, found.paths), *sorted(origins, key=repr))
        kept = self._before.get(made_from)
        if kept is None:
            kept = self._computed(key, kind, lists, found.paths)
        self._made[key] = made_from, kept
        return self._made[key]

    def _computed(self, key: str, kind: type, lists: dict[str, list[Any]], paths: Mapping[str, str]) -> Kept:
        from comfy.model_management import throw_exception_if_processing_interrupted

        throw_exception_if_processing_interrupted()
        results = called(kind, kind.FUNCTION, lists, place=(self.prompt_id, key), paths=paths)
        self.executed.append(key)
        for result in results:
            told = getattr(result, "message", None)
            if told is not None:
                raise RuntimeError(f"Execution Blocked: {told}")
        return Kept(*merged(kind, results))

    def _fingerprint(self, key: str, kind: type, lists: dict[str, list[Any]], paths: Mapping[str, str]) -> list[Any]:
        """What the node says of its inputs; links count as nothing, and what fails is never the same."""
        name = "fingerprint_inputs" if is_ours(kind) else "IS_CHANGED"
        if (overridden(kind, name) if is_ours(kind) else getattr(kind, name, None)) is None:
            return []
        typed = {
            given: [None] if is_link(self.prompt[key]["inputs"][given]) else values for given, values in lists.items()
        }
        try:
            return [repr(each) for each in called(kind, name, typed, place=(self.prompt_id, key), paths=paths)]
        except Exception:  # as the host does
            return [math.nan]
