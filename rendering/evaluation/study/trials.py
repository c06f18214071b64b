"""Which pairs of clips raters see, in which order, and which one is left."""

from __future__ import annotations

import hashlib
import random
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from ....physics.errors import InvalidInputError, printable
from .clip_folders import BROKEN, MethodClips, shared_names

__all__ = ["Trial", "trials_of"]

Kind = Literal["pair", "catch", "practice"]


@dataclass(frozen=True)
class Trial:
    """Two clips of one picture, side by side.

    Attributes:
        id: an opaque name.
        kind: a pair that counts; a catch trial, one of whose clips is broken; or practice.
        picture: name of the clips.
        left: method of the left clip, or ``BROKEN`` for a broken copy of the right one.
        right: method of the right clip, or ``BROKEN``.
    """

    id: str
    kind: Kind
    picture: str
    left: str
    right: str


def trials_of(
    methods: Sequence[MethodClips],
    *,
    against: str | None = None,
    most: int | None = None,
    catch: int | None = None,
    practice: bool = True,
    seed: int = 0,
) -> tuple[Trial, ...]:
    """Trials in a random order that the seed gives; practice comes first.

    Of the pairs of two methods half (or one more) have the first on the left. Of ``most`` pairs each two methods get
    about as many.

    Args:
        methods: with their clips.
        against: the method that each other one is compared with; None for every two.
        most: how many pairs, besides catch trials; all when None.
        catch: how many catch trials; one for eight pairs and at least two when None.
        practice: whether a practice pair comes first.
        seed: of order and sides.

    Raises:
        InvalidInputError: there is no such method, two methods have no picture in common, or a number is out of range.
    """
    chance = random.Random(f"study {seed}")
    if most is not None and most < 1:
        raise InvalidInputError(f"pairs must be at least 1. Got: {most}")
    if catch is not None and not 0 <= catch <= 1000:
        raise InvalidInputError(f"catch must be 0 to 1000. Got: {catch}")
    lots = [_lot(first, second, chance) for first, second in _matches(methods, against)]
    pairs = _chosen(lots, most)
    count = max(2, len(pairs) // 8) if catch is None else catch
    catches = [_broken(methods, chance) for _ in range(count)]
    shown = [("pair", *each) for each in pairs] + [("catch", *each) for each in catches]
    chance.shuffle(shown)
    if practice:
        shown.insert(0, ("practice", *_broken(methods, chance)))
    return tuple(
        Trial(hashlib.sha256(f"{seed} {k} {each}".encode()).hexdigest()[:12], *each)  # type: ignore[arg-type]
        for k, each in enumerate(shown)
    )


def _matches(methods: Sequence[MethodClips], against: str | None) -> list[tuple[MethodClips, MethodClips]]:
    if against is None:
        return [(a, b) for k, a in enumerate(methods) for b in methods[k + 1 :]]
    named = {each.method: each for each in methods}
    if against not in named:
        raise InvalidInputError(f"against must be one of {printable(', '.join(named))}. Got: {printable(against)}")
    return [(named[against], each) for each in methods if each.method != against]


def _lot(first: MethodClips, second: MethodClips, chance: random.Random) -> list[tuple[str, str, str]]:
    """All pairs of two methods: picture, left and right."""
    names = shared_names(first, second)
    sides = [k % 2 == 0 for k in range(len(names))]
    chance.shuffle(names)
    chance.shuffle(sides)
    a, b = first.method, second.method
    return [(name, a, b) if side else (name, b, a) for name, side in zip(names, sides, strict=True)]


def _chosen(lots: list[list[tuple[str, str, str]]], most: int | None) -> list[tuple[str, str, str]]:
    """Pairs of each lot in turn, until there are enough."""
    longest = max(len(lot) for lot in lots)
    turns = [lot[k] for k in range(longest) for lot in lots if k < len(lot)]
    return turns if most is None else turns[:most]


def _broken(methods: Sequence[MethodClips], chance: random.Random) -> tuple[str, str, str]:
    each = chance.choice(list(methods))
    name = chance.choice(sorted(each.clips))
    return (name, each.method, BROKEN) if chance.random() < 0.5 else (name, BROKEN, each.method)
