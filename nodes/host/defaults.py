"""Defaults live once, beside the function that uses them; the nodes' widgets read them from there."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

__all__ = ["default_of"]


def default_of(function: Callable[..., Any], parameter: str) -> Any:
    """The default value of a function's parameter."""
    return inspect.signature(function).parameters[parameter].default
