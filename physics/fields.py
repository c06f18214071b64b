"""One description for each field of a scene: its check, its JSON Schema and its node input follow from it.

A dataclass says it in the type: ``radius: Annotated[float, Field("Radius", "How far it acts.", "px", above=0)] = 1.0``.
The type tells numbers, whole numbers, choices, switches and texts apart, and whether None may stand for the value.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, fields
from functools import cache
from types import NoneType
from typing import Annotated, Any, Literal, TypeVar, get_args, get_origin, get_type_hints

from .checks import is_whole, within
from .errors import require
from .limits import LARGEST

__all__ = ["DescribedField", "Field", "Input", "check_field", "check_fields", "described", "described_fields"]

K = TypeVar("K", bound=type)

_SPOKEN = {"1/s": "per second", "frames/s": "frames a second"}  # units as a sentence has them


@dataclass(frozen=True)
class Field:
    """What a field means and may hold.

    Attributes:
        title: its name for people.
        about: what it means.
        unit: of its numbers; empty for none.
        minimum: smallest number that may be.
        maximum: largest number that may be.
        above: number that it must lie above, instead of ``minimum``.
        below: number that it must lie below, instead of ``maximum``.
        noun: what a whole number is, for the sentence that refuses another.
        entry: name of the schema of a list's entries, or of the value itself where it is no list.
        least: smallest number of entries.
        most: largest number of entries; 0 for what is no list.
        check: called with name and value, returns the value as it is kept or raises InvalidInputError: for what
            bounds cannot say.
    """

    title: str
    about: str
    unit: str = ""
    _: KW_ONLY
    minimum: float = -LARGEST
    maximum: float = LARGEST
    above: float | None = None
    below: float | None = None
    noun: str = "a whole number from"
    entry: str = ""
    least: int = 0
    most: int = 0
    check: Callable[[str, Any], Any] | None = None

    @property
    def heading(self) -> str:
        """The title with its unit, such as "Radius [px]"."""
        return f"{self.title} [{self.unit}]" if self.unit else self.title

    def refuse_beyond(self, name: str, value: Any) -> None:
        """Refuse what is no number within the bounds.

        Raises:
            InvalidInputError: it is not.
        """
        low = self.minimum if self.above is None else self.above
        high = self.maximum if self.below is None else self.below
        if not within(value, low, high, above=self.above is not None, below=self.below is not None):
            first = f"above {low:.12g} and at most" if self.above is not None else f"{low:.12g} to"
            words = first if self.below is None else f"at least {low:.12g} and below"
            unit = f" {_SPOKEN.get(self.unit, self.unit)}" if self.unit else ""
            require(name, value, False, f"{words} {high:.12g}{unit}")


@dataclass(frozen=True)
class Input:
    """What a node's input says and offers of a field, where a node has one.

    Attributes:
        tooltip: what it says, with the unit.
        low: smallest number that it offers; None for the smallest that may be.
        high: largest number that it offers; None for the largest that may be.
        step: by how much it goes up and down; None for what the host takes.
    """

    tooltip: str
    low: float | None = None
    high: float | None = None
    _: KW_ONLY
    step: float | None = None


@dataclass(frozen=True)
class DescribedField:
    """A field of a dataclass with its description.

    Attributes:
        name: in the dataclass.
        type: float, int, bool, str, a Literal, or another that ``field`` checks.
        nullable: whether it may be None.
        choices: of a Literal.
        default: ``dataclasses.MISSING`` for none.
        field: the description.
        input: what nodes show of it; None where none has it.
    """

    name: str
    type: Any
    nullable: bool
    choices: tuple[str, ...]
    default: Any
    field: Field
    input: Input | None

    @property
    def key(self) -> str:
        """Its name in documents, in inputs of nodes and for people: without the underscore of "lambda_"."""
        return self.name.rstrip("_")

    def checked(self, value: Any) -> Any:
        """The value as it is kept.

        Raises:
            InvalidInputError: it is none that may be.
        """
        field, name = self.field, self.key
        if value is None and self.nullable:
            return None
        if field.check is not None:
            return field.check(name, value)
        if self.type is float:
            field.refuse_beyond(name, value)
        elif self.type is int:
            low, high = int(field.minimum), int(field.maximum)
            require(name, value, is_whole(value, low, high), f"{field.noun} {low} to {high}")
            return int(value)
        elif self.choices:
            known = isinstance(value, str) and value in self.choices
            require(name, value, known, f"one of {', '.join(self.choices)}")
        elif self.type in (bool, str):
            require(name, value, isinstance(value, self.type), "a text" if self.type is str else "True or False")
        return value


def described(kind: K) -> K:
    """A dataclass with what its fields mean in its docstring, under Attributes."""
    lines = [f"    {each.name}: {each.field.heading}. {each.field.about}" for each in described_fields(kind).values()]
    kind.__doc__ = "\n".join([f"{(kind.__doc__ or '').rstrip()}\n", "Attributes:", *lines])
    return kind


@cache
def described_fields(kind: type) -> dict[str, DescribedField]:
    """The fields of a dataclass that have a description, by name, in order."""
    hints = get_type_hints(kind, include_extras=True)
    told = [(field, hints[field.name]) for field in fields(kind)]
    return {field.name: _read(field.name, hint, field.default) for field, hint in told if get_origin(hint) is Annotated}


def check_fields(instance: Any) -> None:
    """Check every described field of an instance, as its ``__post_init__``.

    Raises:
        InvalidInputError: a value is none that may be; of several the first.
    """
    kind: type = type(instance)
    for name, field in described_fields(kind).items():
        value = getattr(instance, name)
        checked = field.checked(value)
        if checked is not value:
            object.__setattr__(instance, name, checked)


def check_field(kind: type, name: str, value: Any) -> Any:
    """A value as a field of a dataclass would keep it.

    Raises:
        InvalidInputError: it is none that may be.
    """
    return described_fields(kind)[name].checked(value)


def _read(name: str, hint: Any, default: Any) -> DescribedField:
    given, field, *inputs = get_args(hint)
    options = [option for option in get_args(given) if option is not NoneType]
    nullable = NoneType in get_args(given)
    kind = options[0] if nullable and len(options) == 1 else given
    choices = get_args(kind) if get_origin(kind) is Literal else ()
    return DescribedField(name, kind, nullable, choices, default, field, inputs[0] if inputs else None)
