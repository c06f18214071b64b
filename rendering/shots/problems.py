"""What is wrong with a list of shots: all of it in one list, each with its shot, its option and its line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...physics.errors import printable

__all__ = ["Problem", "merged"]


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong.

    Attributes:
        message: what was expected and what was got.
        shot: name of the shot, empty where it concerns all of the list.
        option: as a person writes it in the list, empty where it is none.
        line: of the list's file, from 1.
    """

    message: str
    shot: str = ""
    option: str = ""
    line: int | None = None

    def __str__(self) -> str:
        place = f"line {self.line}" if self.line is not None else ""
        shot = f"shot {self.shot}" if self.shot else ""
        head = ", ".join(each for each in (place, shot) if each)
        told = self.message if not self.option or self.option in self.message else f"{self.option}: {self.message}"
        return printable(f"{head}: {told}" if head else told)


def merged(problems: Sequence[Problem]) -> list[Problem]:
    """Problems by their lines; one that the defaults give to every shot is told once."""
    found: dict[tuple[int | None, str], list[Problem]] = {}
    for each in problems:
        found.setdefault((each.line, str(replace(each, shot=""))), []).append(each)
    alone = [
        same[0] if len({each.shot for each in same}) == 1 else replace(same[0], shot="") for same in found.values()
    ]
    return sorted(alone, key=lambda each: each.line or 0)
