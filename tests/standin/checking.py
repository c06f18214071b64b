"""The check of a prompt before it runs: what the host refuses, and in which words."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any

from .calling import called, is_ours, overridden
from .choices import Described, described, is_link

__all__ = ["Checked", "checked_prompt"]

_KINDS = {"INT": int, "FLOAT": float, "STRING": str, "BOOLEAN": bool}

Errors = list[dict[str, Any]]


class Checked:
    """What is known of a prompt.

    Attributes:
        prompt: by node; numbers and texts in it are converted as the host does.
        errors: by node, of those that were refused.
        outputs: the output nodes that can run.
    """

    def __init__(self, prompt: dict[str, Any], known: Mapping[str, type], prompt_id: str) -> None:
        self.prompt, self.known, self.prompt_id = prompt, known, prompt_id
        self.errors: dict[str, Errors] = {}
        self._valid: dict[str, bool] = {}
        output_nodes = [key for key, node in prompt.items() if getattr(known[node["class_type"]], "OUTPUT_NODE", False)]
        self.outputs = [key for key in output_nodes if self.is_valid(key)]
        if not output_nodes:
            self.errors[""] = [_error("prompt_no_outputs", "Prompt has no outputs", "")]

    def is_valid(self, key: str) -> bool:
        """Whether a node and all before it may run."""
        if key not in self._valid:
            kind, inputs = self.known[self.prompt[key]["class_type"]], self.prompt[key]["inputs"]
            found = described(kind.INPUT_TYPES(), inputs)
            before = all([self.is_valid(value[0]) for value in inputs.values() if is_link(value)])
            try:
                errors = [*self._refused(found, inputs, self._own_check(kind)), *self._own(key, kind, found)]
            except Exception as error:  # as the host does
                errors = [_error("exception_during_validation", "Exception when validating node", str(error))]
            if errors:
                self.errors[key] = errors
            self._valid[key] = before and not errors
        return self._valid[key]

    def _own_check(self, kind: type) -> tuple[set[str], bool]:
        """The inputs that a node checks itself, and whether that is all of them."""
        function = overridden(kind, "validate_inputs") if is_ours(kind) else getattr(kind, "VALIDATE_INPUTS", None)
        if function is None:
            return set(), False
        spec = inspect.getfullargspec(function)
        return set(spec.args), spec.varkw is not None

    def _refused(self, found: Described, inputs: dict[str, Any], own: tuple[set[str], bool]) -> Errors:
        errors: Errors = []
        for name in found.required:
            if name not in inputs:
                errors.append(_error("required_input_missing", "Required input is missing", name.split(".")[-1]))
        for name, (kind, options) in found.all.items():
            if name not in inputs:
                continue
            value = inputs[name]
            if isinstance(value, list):
                errors += self._refused_link(name, kind, value)
            else:
                errors += _refused_value(name, kind, options, inputs, checked=name not in own[0] and not own[1])
        return errors

    def _refused_link(self, name: str, kind: str, value: list[Any]) -> Errors:
        if len(value) != 2:
            return [_error("bad_linked_input", "Bad linked input, must be a length-2 list", name)]
        source = self.known[self.prompt[value[0]]["class_type"]].RETURN_TYPES[value[1]]
        if "*" in (kind, source) or set(str(source).split(",")) & set(str(kind).split(",")):
            return []
        told = f"{name}, received_type({source}) mismatch input_type({kind})"
        return [_error("return_type_mismatch", "Return type mismatch between linked nodes", told)]

    def _own(self, key: str, kind: type, found: Described) -> Errors:
        """What the node itself says."""
        names, every = self._own_check(kind)
        if not names and not every:
            return []
        inputs = self.prompt[key]["inputs"]
        given = {
            name: [None if is_link(value) else value]
            for name, value in inputs.items()
            if (every or name in names) and (is_link(value) or name in found.all)
        }
        function = "validate_inputs" if is_ours(kind) else "VALIDATE_INPUTS"
        answers = called(kind, function, given, place=(self.prompt_id, key), paths=found.paths)
        said = [f" - {answer}" if answer is not False else "" for answer in answers if answer is not True]
        return [
            _error("custom_validation_failed", "Custom validation failed for node", name + each)
            for name in given
            for each in said
        ]


def checked_prompt(prompt: dict[str, Any], known: Mapping[str, type], prompt_id: str) -> Checked:
    """Check every output node and what it needs."""
    unknown = [node["class_type"] for node in prompt.values() if node["class_type"] not in known]
    if unknown:
        raise KeyError(f"the stand-in has no node {unknown[0]}")
    return Checked(prompt, known, prompt_id)


def _refused_value(name: str, kind: Any, options: Any, inputs: dict[str, Any], *, checked: bool) -> Errors:
    value = inputs[name]
    try:
        inputs[name] = value = _KINDS[kind](value) if isinstance(kind, str) and kind in _KINDS else value
    except Exception as error:  # whatever the conversion says
        told = f"Failed to convert an input value to a {kind} value"
        return [_error("invalid_input_type", told, f"{name}, {value}, {error}")]
    if not checked:
        return []
    if "min" in options and value < options["min"]:
        return [_error("value_smaller_than_min", f"Value {value} smaller than min of {options['min']}", name)]
    if "max" in options and value > options["max"]:
        return [_error("value_bigger_than_max", f"Value {value} bigger than max of {options['max']}", name)]
    offered = kind if isinstance(kind, list) else options.get("options", []) if kind == "COMBO" else None
    if offered is not None and value not in offered:
        return [_error("value_not_in_list", "Value not in list", f"{name}: '{value}' not in {offered}")]
    return []


def _error(kind: str, message: str, details: str) -> dict[str, Any]:
    return {"type": kind, "message": message, "details": details, "extra_info": {}}
