"""Calls of a node's functions: lists are gone through one by one, and what is not there stops whoever takes it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

__all__ = ["called", "is_ours", "merged", "overridden"]


def is_ours(kind: type) -> bool:
    """Whether a node is written against the newer interface."""
    from comfy_api.latest import io

    return issubclass(kind, io.ComfyNode)


def overridden(kind: type, name: str) -> Any:
    """A node's own function of this name; None where it only has its base's."""
    from comfy_api.latest import io

    own = getattr(kind, name, None)
    base = getattr(io.ComfyNode, name, None)
    return None if own is None or getattr(own, "__func__", own) is getattr(base, "__func__", base) else own


def called(
    kind: type, function: str, lists: Mapping[str, list[Any]], *, place: tuple[str, str], paths: Mapping[str, str]
) -> list[Any]:
    """One result for each set of inputs.

    Args:
        kind: the node's class.
        function: its name.
        lists: a list for each input; shorter ones repeat their last value.
        place: of the prompt and of the node in it.
        paths: see ``choices.described``.
    """
    from comfy_execution.graph_utils import ExecutionBlocker
    from comfy_execution.utils import CurrentNodeContext

    from .choices import nested

    owner = kind.PREPARE_CLASS_CLONE(None) if is_ours(kind) else kind()
    results = []
    for number, inputs in enumerate(_sets(lists, whole=getattr(kind, "INPUT_IS_LIST", False))):
        blocked = next((value for value in inputs.values() if isinstance(value, ExecutionBlocker)), None)
        if blocked is not None:
            results.append(blocked)
            continue
        with CurrentNodeContext(*place, number):
            results.append(getattr(owner, function)(**nested(inputs, paths)))
    return results


def _sets(lists: Mapping[str, list[Any]], *, whole: bool) -> Iterator[dict[str, Any]]:
    if whole or not lists:
        yield dict(lists)
        return
    for number in range(max(map(len, lists.values()))):
        yield {name: values[min(number, len(values) - 1)] for name, values in lists.items()}


def merged(kind: type, results: list[Any]) -> tuple[list[list[Any]], dict[str, Any]]:
    """A list for each output, and what the node shows."""
    from comfy_execution.graph_utils import ExecutionBlocker

    count, lists = len(kind.RETURN_TYPES), getattr(kind, "OUTPUT_IS_LIST", None)
    outputs: list[list[Any]] = [[] for _ in range(count)]
    shown: dict[str, Any] = {}
    for result in results:
        values, told = (result,) * count, {}
        if not isinstance(result, ExecutionBlocker):
            values, told = _parts(result)
        for number, value in enumerate(values):
            several = lists and lists[number] and not isinstance(value, ExecutionBlocker)
            outputs[number] += value if several else [value]
        for name, each in told.items():
            shown.setdefault(name, []).extend(each)
    return outputs, shown


def _parts(result: Any) -> tuple[tuple[Any, ...], dict[str, Any]]:
    """Values and what is shown, of either interface."""
    if isinstance(result, dict):
        return tuple(result.get("result", ())), result.get("ui", {})
    if isinstance(result, tuple):
        return result, {}
    told = result.ui
    return result.args, told.as_dict() if hasattr(told, "as_dict") else told or {}
