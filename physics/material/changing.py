"""Materials with values that somebody gives for them instead of their own."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ..errors import InvalidInputError
from .material import Material

__all__ = ["check_together", "with_values"]


def with_values(material: Material, **values: Any) -> Material:
    """The material with other values, of which what says how stiff it is takes the place of what said so before.

    Lame parameters, Young's modulus and a sway frequency each take the place of the others; Poisson's ratio alone that
    of Lame parameters, whose Young's modulus stays.

    Args:
        material: what is changed.
        values: its fields; None for those that stay.

    Raises:
        InvalidInputError: a value is none that may be, or they say twice how stiff it is.

    Examples:
        >>> from physanimator.physics.material import preset, with_values
        >>> with_values(preset("hair"), youngs_modulus=800.0).sway_frequency is None
        True
    """
    given = {name: value for name, value in values.items() if value is not None}
    check_together(given)
    if "mu" in given or "lambda_" in given:
        return replace(material, **{"sway_frequency": None, **given})
    no_lame = {"mu": None, "lambda_": None}
    if "youngs_modulus" in given:
        return replace(material, **{"sway_frequency": None, **no_lame, **given})
    if given.keys() & {"poisson_ratio", "sway_frequency"}:
        return replace(material, **{**no_lame, **given})
    return replace(material, **given)


def check_together(given: dict[str, Any]) -> None:
    """Refuse values that say twice how stiff something is.

    Raises:
        InvalidInputError: the message names one of them.
    """
    pairs = [("mu", "lambda_"), ("youngs_modulus",), ("sway_frequency",)]
    said = [names for names in pairs if given.keys() & set(names)]
    if len(said) > 1 or (said == [pairs[0]] and "poisson_ratio" in given):
        name = "poisson_ratio" if len(said) == 1 else said[-1][0]
        before = "mu and lambda are" if said[0] == pairs[0] else "youngs_modulus is"
        raise InvalidInputError(f"{name} must be left out where {before} given. Got: {given[name]!r:.60}")
