"""Sizes of networks from values by name, as a JSON document holds them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, TypeVar

from ...physics.errors import InvalidInputError, require

__all__ = ["FromValues"]

Configuration = TypeVar("Configuration", bound="FromValues")


class FromValues:
    """Makes frozen dataclasses of sizes from values by name."""

    @classmethod
    def of(cls: type[Configuration], values: Configuration | Mapping[str, Any]) -> Configuration:
        """From values by name, such as a JSON document's; lists become tuples.

        Raises:
            InvalidInputError: a name is unknown, or these are no values by name.
        """
        if isinstance(values, cls):
            return values
        if not isinstance(values, Mapping):
            raise InvalidInputError(f"configuration must hold values by name. Got: {type(values).__name__}")
        known = {field.name for field in fields(cls)}  # type: ignore[arg-type]
        unknown = sorted(set(values) - known)
        require("configuration", unknown, not unknown, f"made of {', '.join(sorted(known))}")
        return cls(**{name: tuple(each) if isinstance(each, list) else each for name, each in values.items()})
