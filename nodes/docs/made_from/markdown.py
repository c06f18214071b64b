"""Small pieces of Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any

__all__ = ["code", "escaped", "number", "table"]


def escaped(text: str) -> str:
    """Text that Markdown shows as it is, on one line."""
    return re.sub(r"([\\`*_{}\[\]<>|#~$@])", r"\\\1", " ".join(text.split()))


def code(text: str) -> str:
    """Text in a fixed font; a bar would end a table's cell."""
    return f"`{text}`".replace("|", "\\|") if text else ""


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table, or nothing where there are no rows."""
    lines = [f"| {' | '.join(cell.replace(chr(10), ' ') for cell in row)} |" for row in rows]
    if not lines:
        return ""
    return "\n".join([f"| {' | '.join(head)} |", f"|{' --- |' * len(head)}", *lines]) + "\n"


def number(value: Any) -> str:
    """A number as people write it: 65536 and 0.5, without an empty fraction."""
    return f"{value:.10g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value)
