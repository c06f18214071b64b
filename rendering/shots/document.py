"""The list of shots: a TOML file with ``[defaults]`` and ``[[shot]]``, or a CSV file with one row a shot."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ...physics.errors import InvalidInputError, shown
from ..files import parsed_toml, read_text_file, suffix_of
from .problems import Problem
from .table_lines import TableLines, table_lines

__all__ = ["ShotRow", "read_rows"]

_SEVERAL = "|"  # between the values of a cell of a CSV file: a name of a file has none

# With which spreadsheets begin a file.
_SEPARATOR = re.compile(r"sep=([,;\t|])\s*$", re.IGNORECASE)


@dataclass(frozen=True)
class ShotRow:
    """One shot as the list has it.

    Attributes:
        number: from 1.
        values: by the names of options with underscores; the defaults are among them.
        lines: of the file, for each value.
        line: of the file, where the shot begins.
        as_text: whether all values are text, of which numbers and lists have to be made.
        head: line of the names of options, where all rows have them from there.
    """

    number: int
    values: Mapping[str, Any]
    lines: Mapping[str, int] = field(default_factory=dict)
    line: int | None = None
    as_text: bool = False
    head: int | None = None


def read_rows(path: str) -> tuple[list[ShotRow], list[Problem]]:
    """The shots of a list, and what of it is no list of shots.

    Args:
        path: of a .toml or .csv file.

    Raises:
        InvalidInputError: the file cannot be read, or is neither.
    """
    suffix = suffix_of(path)
    if suffix not in (".toml", ".csv"):
        raise InvalidInputError(f"SHOTS must be a .toml or .csv file. Got: {path}")
    text = read_text_file(path, "SHOTS")
    return _rows_of_toml(text, path) if suffix == ".toml" else _rows_of_csv(text, path)


def _rows_of_toml(text: str, path: str) -> tuple[list[ShotRow], list[Problem]]:
    document = parsed_toml(text, path, "SHOTS")
    lines = table_lines(text)
    problems = [
        Problem(f"tables must be [defaults] and [[shot]]. Got: {shown(name)}", line=_first(lines.get(name)))
        for name in document
        if name not in ("defaults", "shot")
    ]
    defaults, shots = document.get("defaults", {}), document.get("shot", [])
    if not isinstance(defaults, dict):
        raise InvalidInputError(f"defaults must be a table, [defaults]. Got: {shown(defaults)}")
    if not isinstance(shots, list) or not all(isinstance(each, dict) for each in shots):
        raise InvalidInputError("shots must be tables, each [[shot]]. Got: [shot]")
    if not shots:
        raise InvalidInputError(f"SHOTS must have a table [[shot]] for each shot. Got: {path} with none")
    heads = lines.get("shot", [])
    heads = heads if len(heads) == len(shots) else [TableLines(0) for _ in shots]  # written in a way unknown here
    common = (lines.get("defaults") or [TableLines(0)])[0]
    rows = []
    for number, (table, head) in enumerate(zip(shots, heads, strict=True), start=1):
        usual, usual_lines = _named(defaults, common, problems if number == 1 else [], "[defaults]")
        own, own_lines = _named(table, head, problems, str(table.get("name", number)))
        values = {**usual, **own}
        rows.append(ShotRow(number, values, {**usual_lines, **own_lines}, head.line or None))
    return rows, problems


def _first(tables: Sequence[TableLines] | None) -> int | None:
    return tables[0].line if tables else None


def _named(
    table: Mapping[str, Any], head: TableLines, problems: list[Problem], shot: str
) -> tuple[dict[str, Any], dict[str, int]]:
    """The values of a table and their lines, by names with underscores."""
    values: dict[str, Any] = {}
    lines: dict[str, int] = {}
    for key, value in table.items():
        name = key.replace("-", "_")
        if name in values:
            problems.append(
                Problem(f"{key} must be given once. Got: twice, with - and _", shot, key, head.line or None)
            )
        values[name] = value
        if key in head.keys:
            lines[name] = head.keys[key]
    return values, lines


def _rows_of_csv(text: str, path: str) -> tuple[list[ShotRow], list[Problem]]:
    first = text.lstrip("\r\n").partition("\n")[0]
    said = _SEPARATOR.match(first)
    delimiter = said[1] if said else max(",;\t", key=first.count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    rows: list[ShotRow] = []
    problems: list[Problem] = []
    names: list[str] = []
    head = 0
    try:
        for cells in reader:
            filled = [cell for cell in cells if cell.strip()]
            if not filled or (said and not names and filled[0].lower() == "sep="):
                continue
            if not names:
                names, head = [_option(cell) for cell in cells], reader.line_num
                problems += [
                    Problem(f"every column must have its own name. Got: {shown(name)} twice", line=head)
                    for name in sorted({each for each in names if each and names.count(each) > 1})
                ]
                continue
            rows.append(_row_of_cells(len(rows) + 1, names, cells, reader.line_num, head, problems))
    except csv.Error as error:
        raise InvalidInputError(f"SHOTS must be CSV. Got: {path}: {error} in line {reader.line_num}") from None
    if not rows:
        raise InvalidInputError(
            f"SHOTS must have a row for each shot below the names of options. Got: {path} with none"
        )
    return rows, problems


def _option(cell: str) -> str:
    """The option that a column is for, however a person writes it: wind-angle, --wind-angle or Wind Angle."""
    return "_".join(cell.strip().lstrip("-").replace("-", " ").lower().split())


def _row_of_cells(
    number: int, names: Sequence[str], cells: Sequence[str], line: int, head: int, problems: list[Problem]
) -> ShotRow:
    given = {name: cell.strip() for name, cell in zip(names, cells, strict=False) if name and cell.strip()}
    shot = given.get("name", str(number))
    if any(cell.strip() for cell in cells[len(names) :]):
        told = f"rows must have at most {len(names)} cells, as the first has. Got: {len(cells)}"
        problems.append(Problem(told, shot, line=line))
    for name, cell in zip(names, cells, strict=False):
        if cell.strip() and not name:
            problems.append(Problem(f"every column must have a name. Got: {shown(cell)} below none", shot, line=line))
    values = {
        name: [each.strip() for each in cell.split(_SEVERAL)] if _SEVERAL in cell else cell
        for name, cell in given.items()
    }
    return ShotRow(number, values, dict.fromkeys(values, line), line, as_text=True, head=head)
