"""In which line of a TOML text the keys of its tables stand, for messages; no parser of TOML."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

__all__ = ["TableLines", "table_lines"]

_HEADER = re.compile(r"\s*\[(\[)?\s*[\"']?([\w-]+)[\"']?\s*\]")
_KEY = re.compile(r"\s*[\"']?([\w-]+)[\"']?\s*=")


@dataclass
class TableLines:
    """A table of a TOML text.

    Attributes:
        line: of its header.
        keys: line of each key.
    """

    line: int
    keys: dict[str, int] = field(default_factory=dict)


def table_lines(text: str) -> Mapping[str, list[TableLines]]:
    """Each table of a text by its name, in their order; keys inside of long texts may be taken for some."""
    found: dict[str, list[TableLines]] = {}
    table = TableLines(1)
    for number, line in enumerate(text.splitlines(), start=1):
        if header := _HEADER.match(line):
            table = TableLines(number)
            found.setdefault(header[2], []).append(table)
        elif key := _KEY.match(line):
            table.keys.setdefault(key[1], number)
    return found
