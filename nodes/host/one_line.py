"""One line for one wrong value, in the host's report of a prompt that it has refused.

The host repeats what a node's ``validate_inputs`` says for every input that it has handed over to it, and it hands over
those for which that function has parameters. So it is given a function with a parameter for the wrong input alone.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from inspect import Parameter, Signature
from types import MethodType
from typing import Any

from ...physics.errors import InvalidInputError
from .running import posted_nodes, sent_inputs

__all__ = ["Check", "OneLine", "nested"]

Check = Callable[[Any, Mapping[str, Any], Mapping[str, Any] | None], bool | str]
"""From the node's class, its values as the host hands them over and as they were sent: True, or why it is refused."""

_DYNAMIC = "COMFY_DYNAMICCOMBO_V3"


class OneLine:
    """A node's ``validate_inputs``, to be looked up in its class."""

    def __init__(self, node_id: str, check: Check, subjects: tuple[str, ...] = ()) -> None:
        """
        Args:
            node_id: of the node's kind.
            check: what is asked of its values.
            subjects: inputs that a sentence may be about which names none.
        """
        self._node_id, self._check, self._subjects = node_id, check, subjects

    def __get__(self, _: Any, node: Any) -> Any:
        names = list(dict.fromkeys(filter(None, (self._wrong(node, sent) for sent in posted_nodes(self._node_id)))))

        def validate_inputs(cls: Any, **values: Any) -> bool | str:
            sent = sent_inputs()
            whole = nested(cls.INPUT_TYPES(), sent) if names and sent is not None else values
            said = self._check(cls, whole, sent)
            if said is not True and not values:
                # The host drops an answer where there is no input to name it after.
                raise InvalidInputError(str(said))
            return said

        if names:
            kinds = [Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in ("cls", *names)]
            validate_inputs.__signature__ = Signature(kinds)  # type: ignore[attr-defined]
        return MethodType(validate_inputs, node)

    def _wrong(self, node: Any, sent: Mapping[str, Any]) -> str | None:
        """The input to name a refusal after; None where nothing is refused."""
        described = node.INPUT_TYPES()
        values = nested(described, sent)
        said = self._check(node, values, sent)
        if said is True:
            return None
        every = {name: each[0] for group in ("required", "optional") for name, each in described.get(group, {}).items()}
        # A choice that it does not offer the host has dropped.
        there = [name for name, kind in every.items() if name in sent and not (kind == _DYNAMIC and name not in values)]
        first = re.split(r"[^\w.]", str(said), maxsplit=1)[0]
        brought = [full.partition(".")[0] for full in sent if full.rpartition(".")[2] == first]
        found = [first, first.partition(".")[0], *brought, *self._subjects, *there]
        return next((name for name in found if name in there), None)


def nested(described: Mapping[str, Any], sent: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Values as the host hands them over, from those that were sent.

    Args:
        described: the node's inputs as the host describes them: ``INPUT_TYPES()``.
        sent: its inputs in the prompt: values, or links as [node, output].
        prefix: stands before the names of the described inputs in the prompt.

    Returns:
        By name; None for what comes from another node, for a dynamic choice a mapping with what it brings.
    """
    values: dict[str, Any] = {}
    for group in ("required", "optional"):
        for name, (kind, options) in ((name, each[:2]) for name, each in described.get(group, {}).items()):
            if prefix + name not in sent:
                continue
            value = sent[prefix + name]
            linked = isinstance(value, list) and len(value) == 2
            if isinstance(value, Mapping) and "__value__" in value:  # how a page writes a list that is no link
                value = value["__value__"]
            if kind != _DYNAMIC:
                values[name] = None if linked else value
                continue
            option = next((each for each in options["options"] if each["key"] == value), None)
            if option is not None:
                values[name] = {**nested(option["inputs"], sent, f"{prefix}{name}."), name: value}
    return values
