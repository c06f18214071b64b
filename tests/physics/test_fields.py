"""Described fields: what is refused in which words, what is kept, and that every description agrees with itself."""

from __future__ import annotations

import math
from dataclasses import MISSING, dataclass
from typing import Annotated, Any, Literal

import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.fields import (
    DescribedField,
    Field,
    Input,
    check_field,
    check_fields,
    described,
    described_fields,
)
from physanimator.physics.forces import EnergyStroke, Wind
from physanimator.physics.material import Material
from physanimator.physics.rig import Circle, KeyedPath, Pulse, RigPoint, Rotation, Squash, Swing, Wave
from physanimator.physics.scene import Body, Contact, Paint, QueryPoint, Scene

KINDS = (Body, Circle, Contact, EnergyStroke, KeyedPath, Material, Paint, Pulse, QueryPoint, RigPoint, Rotation, Scene,
         Squash, Swing, Wave, Wind)  # fmt: skip


def doubled(name: str, value: Any) -> Any:
    return 2 * value


@described
@dataclass(frozen=True)
class Kettle:
    """A kettle."""

    heat: Annotated[float, Field("Heat", "How hot.", "degrees", above=0, maximum=99.5), Input("How hot [degrees].")] = (
        20
    )
    level: Annotated[float | None, Field("Level", "How full.", minimum=0, below=1)] = None
    cups: Annotated[int, Field("Cups", "How many.", minimum=1, maximum=9)] = 3
    lid: Annotated[Literal["open", "shut"], Field("Lid", "Where it is.")] = "shut"
    on: Annotated[bool, Field("On", "Whether it heats.")] = False
    label: Annotated[str, Field("Label", "What it says.")] = ""
    twice: Annotated[object, Field("Twice", "Kept doubled.", check=doubled)] = 1
    plain: object = None

    def __post_init__(self) -> None:
        check_fields(self)


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"heat": 0}, "heat must be above 0 and at most 99.5 degrees. Got: 0"),
        ({"heat": math.nan}, "heat must be above 0 and at most 99.5 degrees. Got: nan"),
        ({"heat": True}, "heat must be above 0 and at most 99.5 degrees. Got: True"),
        ({"heat": None}, "heat must be above 0 and at most 99.5 degrees. Got: None"),
        ({"level": 1}, "level must be at least 0 and below 1. Got: 1"),
        ({"cups": 2.5}, "cups must be a whole number from 1 to 9. Got: 2.5"),
        ({"lid": "ajar"}, "lid must be one of open, shut. Got: ajar"),
        ({"on": 1}, "on must be True or False. Got: 1"),
        ({"label": 5}, "label must be a text. Got: 5"),
        ({"label": 5, "cups": 0}, "cups must be a whole number from 1 to 9. Got: 0"),
    ],
)
def test_what_may_not_be_is_refused(given: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InvalidInputError) as caught:
        Kettle(**given)
    assert str(caught.value) == sentence


def test_what_may_be_is_kept() -> None:
    kettle = Kettle(heat=99.5, level=0, cups=2.0, lid="open", twice=4)  # type: ignore[arg-type]
    assert (kettle.heat, kettle.level, kettle.lid, kettle.twice) == (99.5, 0, "open", 8)
    assert type(kettle.cups) is int
    assert check_field(Kettle, "cups", 9) == 9


def test_the_docstring_tells_the_fields() -> None:
    assert Kettle.__doc__ is not None
    assert Kettle.__doc__.startswith("A kettle.")
    assert "heat: Heat [degrees]. How hot." in Kettle.__doc__
    assert "plain" not in Kettle.__doc__


def fields() -> list[tuple[str, DescribedField]]:
    return [(f"{kind.__name__}.{name}", field) for kind in KINDS for name, field in described_fields(kind).items()]


@pytest.mark.parametrize(("name", "field"), fields())
def test_defaults_and_what_nodes_offer_lie_within_the_bounds(name: str, field: DescribedField) -> None:
    if field.default is not MISSING:
        field.checked(field.default)
    ends = () if field.input is None else (field.input.low, field.input.high)
    for end in ends:
        if end is not None and not (field.nullable and end == 0):  # there 0 stands for None
            field.checked(end)


@pytest.mark.parametrize("kind", KINDS)
def test_every_field_of_a_scene_is_described(kind: type) -> None:
    in_no_document = {Body: {"cover", "rests_on"}, Scene: {"absent"}}.get(kind, set())
    assert set(described_fields(kind)) | in_no_document == set(kind.__dataclass_fields__)  # type: ignore[attr-defined]
