"""Options of the models: whatever is given, they are usable or refused in one sentence."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.control import ModelFormat
from physanimator.rendering.svd import SVDOptions
from physanimator.rendering.tooncrafter import ToonCrafterOptions

WRONG = [-1, -(10**400), 10**5000, float("nan"), float("inf"), -0.5, "many", None, True, [1], {}, 3.7j]
OPTIONS = [(kind, each.name) for kind in (SVDOptions, ToonCrafterOptions, ModelFormat) for each in fields(kind)]
# Noise may be any number that fits, and these may be whole.
FITTING = {"seed": [-1]}


@pytest.mark.parametrize(("kind", "name"), OPTIONS)
@pytest.mark.parametrize("value", WRONG, ids=lambda value: str(type(value).__name__))
def test_what_no_option_can_be_is_refused_in_one_sentence(kind: Any, name: str, value: Any) -> None:
    if name in ("solver", "fit") and isinstance(value, int):
        value = str(type(value))  # a name that is none
    if value in FITTING.get(name, []):
        assert getattr(kind(**{name: value}), name) == value
        return
    with pytest.raises(InvalidInputError, match=f"^{name} must be .*Got: ") as caught:
        kind(**{name: value})
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize(
    "given",
    [{"overlap": 99}, {"overlap": 2}, {"area": 0}, {"area": 4095}, {"area": 10**12}, {"steps": 1}, {"steps": 2.5}],
)
def test_ranges_of_the_sketch_guided_renderer(given: dict[str, Any]) -> None:
    with pytest.raises(InvalidInputError, match=next(iter(given))):
        SVDOptions(**given)
    with pytest.raises(InvalidInputError, match=r"overlap must be a whole number from 3 to 13 frames\. Got: 99"):
        SVDOptions(overlap=99, area=0)
