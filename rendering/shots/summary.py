"""What became of the shots, as a table for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from .job import Outcome

__all__ = ["summary_lines"]

_WIDEST = 40


def summary_lines(outcomes: Sequence[Outcome]) -> Iterator[str]:
    """A row for each shot: its name, what became of it, and why; none where there are no shots."""
    if not outcomes:
        return
    wide = min(_WIDEST, max(len("shot"), *(len(each.name) for each in outcomes)))
    yield f"{'shot':<{wide}}  {'state':<6}  why"
    for each in outcomes:
        yield f"{each.name:<{wide}}  {each.state:<6}  {each.why}"
