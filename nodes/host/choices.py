"""Values that a node does not offer are refused in one sentence, before the graph runs and before the node does.

The host checks plain choices and numbers alone, and not even those of a node that takes every input for checking. A
dynamic choice that it does not know it leaves out without a word, so that the node would run with its usual one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import wraps
from inspect import signature
from typing import Any, NamedTuple

from ...physics.errors import InvalidInputError
from .literals import refusal
from .one_line import Check, OneLine
from .running import sent_inputs
from .wording import placed_errors

__all__ = ["OPEN", "check_choices", "check_values", "checked"]

_DYNAMIC, _CHOICE, _NUMBERS = "COMFY_DYNAMICCOMBO_V3", "COMBO", ("INT", "FLOAT")
_TYPED = (_DYNAMIC, _CHOICE, *_NUMBERS, "STRING", "BOOLEAN")
_LISTED = 12

OPEN = "others_too"
"""Marks a choice, in its ``extra_dict``, for which the node itself checks values that are not listed."""


class _Given(NamedTuple):
    """One input of a node and what is known of its value.

    Attributes:
        name: in full, with those of the dynamic choices that bring it.
        kind: the host's name of its type.
        options: what the schema says of it.
        required: whether it must be there.
        value: None where it is left out, or comes from another node that has not run yet.
        linked: whether another node gives it.
        typed: what the prompt has in its place otherwise, where it is known.
    """

    name: str
    kind: str
    options: Mapping[str, Any]
    required: bool
    value: Any
    linked: bool
    typed: Any = None


def checked(node: Any) -> Any:
    """The node's class, changed so that it refuses what it does not offer; a second time changes nothing.

    Args:
        node: a V3 node.
    """
    if "_physanimator_checked" in vars(node):
        return node
    node._physanimator_checked = True
    node.execute = classmethod(_checking_execution(vars(node)["execute"].__func__))
    own = vars(node).get("validate_inputs")
    if own is not None or any(kind == _DYNAMIC for kind, _ in _described(node.INPUT_TYPES())):
        function = own.__func__ if own is not None else None
        subjects = () if function is None else tuple(signature(function).parameters)[1:]
        node.validate_inputs = OneLine(node.define_schema().node_id, _validation(function), subjects)
    return node


def check_choices(described: Mapping[str, Any], values: Mapping[str, Any], sent: Mapping[str, Any] | None) -> None:
    """Refuse a choice that is not offered, a dynamic one that is missing, and what a chosen one needs and lacks.

    A value that was typed where only another node's output can be, such as a picture, is refused too.

    Args:
        described: the node's inputs as the host describes them: ``INPUT_TYPES()``.
        values: what the host hands over, by name; for a dynamic choice a mapping with what it brings.
        sent: the inputs in the prompt, where they are known.

    Raises:
        InvalidInputError: one sentence about the first.
    """
    for given in _given(described, values, sent, ""):
        if given.kind not in _TYPED and given.typed is not None:
            raise InvalidInputError(f"{given.name} must be connected to another node. Got: {_shown(given.typed)}")
        if given.value is None:
            if given.required and not (given.linked and given.kind != _DYNAMIC) and _must_be_there(given, sent):
                raise InvalidInputError(f"{given.name} must be {_offered(given)}. Got: {_absent(given)}")
        elif given.kind in (_DYNAMIC, _CHOICE) and not given.options.get(OPEN) and given.value not in _keys(given):
            raise InvalidInputError(f"{given.name} must be {_offered(given)}. Got: {_shown(given.value)}")


def check_values(
    described: Mapping[str, Any], values: Mapping[str, Any], sent: Mapping[str, Any] | None, *, bounded: bool = False
) -> None:
    """Refuse what is no number where one belongs, and no text where that belongs.

    Args:
        described: see :func:`check_choices`.
        values: see :func:`check_choices`.
        sent: see :func:`check_choices`.
        bounded: refuse numbers beyond the bounds of their inputs, too.

    Raises:
        InvalidInputError: one sentence about the first.
    """
    for given in _given(described, values, sent, ""):
        if given.value is None or given.linked:
            continue
        if given.kind in _NUMBERS:
            low, high = (given.options.get("min", -math.inf), given.options.get("max", math.inf))
            expected = f"a number from {low} to {high}" if bounded else "a finite number"
            held = _is_number(given.value) and (not bounded or low <= given.value <= high)
        elif given.kind == "STRING":
            expected, held = "a text", isinstance(given.value, str)
        else:
            continue
        if not held:
            raise InvalidInputError(f"{given.name} must be {expected}. Got: {_shown(given.value)}")


def _checking_execution(inner: Callable[..., Any]) -> Callable[..., Any]:
    @wraps(inner)
    def execute(cls: Any, **values: Any) -> Any:
        described, sent = cls.INPUT_TYPES(), sent_inputs()
        with placed_errors():
            check_choices(described, values, sent)
            check_values(described, values, sent)  # the host's own bounds let NaN pass
            return inner(cls, **values)

    return execute


def _validation(inner: Callable[..., Any] | None) -> Check:
    """All that is asked of a node's typed values before it runs: True, or the first sentence of refusal."""

    def said(node: Any, values: Mapping[str, Any], sent: Mapping[str, Any] | None) -> bool | str:
        described = node.INPUT_TYPES()
        unknown = refusal(lambda: check_choices(described, values, sent), lambda: check_values(described, values, sent))
        if unknown is not True:
            return unknown
        # The node's own sentences know better than the bounds of a widget.
        own = True if inner is None else inner(node, **_taken(inner, values))
        if own is not True:
            return own
        return refusal(lambda: check_values(described, values, sent, bounded=True))

    return said


def _taken(function: Callable[..., Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """The values that a function has parameters for."""
    parameters = signature(function).parameters.values()
    if any(each.kind is each.VAR_KEYWORD for each in parameters):
        return dict(values)
    names = {each.name for each in parameters}
    return {name: value for name, value in values.items() if name in names}


def _given(
    described: Mapping[str, Any], values: Mapping[str, Any], sent: Mapping[str, Any] | None, prefix: str
) -> Iterator[_Given]:
    """Every input of a node, those that the chosen options bring included."""
    for group in ("required", "optional"):
        for name, (kind, options) in ((name, each[:2]) for name, each in described.get(group, {}).items()):
            full, value = prefix + name, values.get(name)
            raw = (sent or {}).get(full)
            linked = isinstance(raw, list) and len(raw) == 2
            if kind != _DYNAMIC:
                yield _Given(full, kind, options, group == "required", value, linked, None if linked else raw)
                continue
            brought = value if isinstance(value, Mapping) else {}
            key = brought.get(name) if brought else value
            # What is not offered the host has dropped: only the prompt still has it.
            key = raw if key is None and not linked else key
            yield _Given(full, kind, options, group == "required" or linked, key, linked)
            option = next((each for each in options["options"] if each["key"] == key), None)
            if option is not None:
                yield from _given(option["inputs"], brought, sent, f"{full}.")


def _must_be_there(given: _Given, sent: Mapping[str, Any] | None) -> bool:
    """A value from elsewhere is not known before it is run; without the prompt, only a dynamic choice is."""
    nothing_sent = sent is not None and given.name in sent and given.kind not in _TYPED  # a null, which the host takes
    return given.kind == _DYNAMIC or nothing_sent or (sent is not None and "." in given.name)


def _offered(given: _Given) -> str:
    if given.kind not in _TYPED and "." not in given.name:
        return "connected to another node"
    if given.kind not in (_DYNAMIC, _CHOICE):
        return f"given: it belongs to {given.name.rpartition('.')[0]}"
    keys = [str(key) for key in _keys(given)]
    more = "" if len(keys) <= _LISTED else f" and {len(keys) - _LISTED} more"
    return f"one of {', '.join(keys[:_LISTED])}{more}"


def _is_number(value: Any) -> bool:
    try:
        return isinstance(value, int | float) and math.isfinite(value)
    except OverflowError:  # a whole number that is too large for a float
        return False


def _shown(value: Any) -> str:
    try:
        return repr(value)[:60]
    except ValueError:  # more digits than Python writes
        return "a number of very many digits"


def _absent(given: _Given) -> str:
    return "a value from another node; choose it in this one" if given.linked else "nothing"


def _keys(given: _Given) -> list[Any]:
    return [each["key"] if given.kind == _DYNAMIC else each for each in given.options.get("options", [])]


def _described(described: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    for group in ("required", "optional"):
        yield from ((each[0], each[1]) for each in described.get(group, {}).values())
