"""Inputs of nodes from the described fields of what they make."""

from __future__ import annotations

import inspect
from typing import Any

from comfy_api.latest import io

from ...physics.fields import described_fields

__all__ = ["ADVANCED", "input_of"]

ADVANCED: dict[str, Any] = {"advanced": True} if "advanced" in inspect.signature(io.Float.Input).parameters else {}
"""Options of an input that few need: newer hosts fold it away."""


def input_of(kind: type, field: str, *, name: str = "", default: Any = None, **options: Any) -> io.Input:
    """The input for a field: its default, its bounds where they are no narrower, its step and its tooltip.

    Args:
        kind: the dataclass.
        field: its name there.
        name: of the input, where it is another.
        default: instead of the field's own; where there is none, a number that may be None is 0.
        options: further ones of the host's input, such as optional and display_name.
    """
    described = described_fields(kind)[field]
    shown, bounds = described.input, described.field
    if shown is None:
        raise TypeError(f"{kind.__name__}.{field} is not described for nodes")
    name, default = name or described.key, described.default if default is None else default
    options["tooltip"] = shown.tooltip
    if described.choices:
        return io.Combo.Input(name, options=list(described.choices), default=default, **options)
    if described.type is bool:
        return io.Boolean.Input(name, default=default, **options)
    low = bounds.minimum if shown.low is None else shown.low
    high = bounds.maximum if shown.high is None else shown.high
    if described.type is int:
        return io.Int.Input(name, default=default, min=int(low), max=int(high), step=shown.step, **options)
    return io.Float.Input(name, default=default or 0.0, min=float(low), max=float(high), step=shown.step, **options)
