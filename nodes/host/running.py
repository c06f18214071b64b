"""What the host runs at the moment: the prompt as it was sent, and the node in it whose code is being called.

A V3 node is not told of the links to its outputs, nor of a choice that it does not offer: the host drops it. Both stand
in the prompt. Where nothing is known, as in another host or in nodes that appear during a run, these functions say so
with None.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from contextvars import ContextVar
from typing import Any

__all__ = ["context", "is_linked", "is_wanted", "not_made", "posted_nodes", "sent_inputs", "server", "watch_prompts"]

_posted: ContextVar[Mapping[str, Any] | None] = ContextVar("physanimator_posted", default=None)
_watched: list[Any] = []
_OURS, _SCENE = "PhysAnimator_", "scene"
"""How the names of our nodes begin, and what those call their input that take a scene document."""


def server() -> Any:
    """The host's server, or None where none runs."""
    module = sys.modules.get("server")  # importing it would start the host's machinery where none runs
    return getattr(getattr(module, "PromptServer", None), "instance", None)


def context() -> Any:
    """The host's context of the node whose code is being called (``prompt_id``, ``node_id``), or None."""
    from comfy_execution.utils import get_executing_context

    return get_executing_context()


def watch_prompts() -> None:
    """Remember each prompt that is posted while the host checks it, which it does before it queues it."""
    host = server()
    if host is None or host in _watched or not hasattr(host, "add_on_prompt_handler"):
        return
    _watched.append(host)
    host.add_on_prompt_handler(_remember)


def sent_inputs() -> Mapping[str, Any] | None:
    """Inputs of the node being called, by name, as the prompt gives them: values, or links as [node, output]."""
    prompt, node = _prompt(), context()
    found = None if prompt is None or node is None else prompt.get(str(node.node_id))
    return found.get("inputs") if isinstance(found, Mapping) else None


def posted_nodes(node_id: str) -> list[Mapping[str, Any]]:
    """The inputs of each node of a kind in the prompt that is being checked, as it gives them; none elsewhere.

    Args:
        node_id: of the kind.
    """
    nodes = (each for each in (_posted.get() or {}).values() if isinstance(each, Mapping))
    inputs = (each.get("inputs") for each in nodes if each.get("class_type") == node_id)
    return [each for each in inputs if isinstance(each, Mapping)]


def is_wanted(output: int) -> bool:
    """Whether an output of the node being called has to be made: some node takes it, or that cannot be known.

    A node that asks this has to give the answer to ``fingerprint_inputs`` too, so that what was made without an output
    is not taken from the host's cache once somebody connects it.

    Args:
        output: its number, from 0.
    """
    return is_linked(output) is not False


def is_linked(output: int) -> bool | None:
    """Whether any node takes an output of the node being called; None where that cannot be known.

    Args:
        output: its number, from 0.
    """
    prompt, node = _prompt(), context()
    if prompt is None or node is None or str(node.node_id) not in prompt:
        return None
    inputs = (each.get("inputs", {}) for each in prompt.values() if isinstance(each, Mapping))
    links = (value for given in inputs for value in given.values() if isinstance(value, list) and len(value) == 2)
    return any(str(source) == str(node.node_id) and slot == output for source, slot in links)


def not_made(output: str) -> Any:
    """What stands for an output that nobody takes: the host stops whoever takes it all the same, with this sentence.

    Args:
        output: what the node calls it.
    """
    from comfy_execution.graph_utils import ExecutionBlocker

    return ExecutionBlocker(f"{output} was not connected when the node ran, and was not made: run it again.")


def _remember(posted: Any) -> Any:
    prompt = posted.get("prompt") if isinstance(posted, Mapping) else None
    _posted.set(prompt if isinstance(prompt, Mapping) else None)
    for node in (_posted.get() or {}).values():
        _spell_alike(node)
    return posted


def _spell_alike(node: Any) -> None:
    """Give a scene document that is sent its one spelling: the host then knows a scene again that it has had."""
    from .documents import canonical_text

    kind, inputs = (node.get("class_type"), node.get("inputs")) if isinstance(node, Mapping) else ("", None)
    text = inputs.get(_SCENE) if isinstance(inputs, dict) else None
    if isinstance(text, str) and text.strip() and str(kind).startswith(_OURS):
        inputs[_SCENE] = canonical_text(text)


def _prompt() -> Mapping[str, Any] | None:
    """The prompt of the node being called: one that runs, else the one that is being checked."""
    node, host = context(), server()
    queue = getattr(host, "prompt_queue", None)
    if node is not None and hasattr(queue, "get_current_queue_volatile"):
        running, _ = queue.get_current_queue_volatile()
        for item in running:
            if item[1] == node.prompt_id and isinstance(item[2], Mapping):
                return item[2]
    return _posted.get()
