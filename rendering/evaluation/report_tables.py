"""The results as JSON, CSV and LaTeX."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import asdict
from typing import Any

from ... import __version__
from .columns import Column, Summary
from .paper_figures import NOTE, PAPER_TABLES
from .planning import left_out
from .results import Results, Value, shown_number

__all__ = ["as_clips_csv", "as_csv", "as_json", "as_latex"]

_TEX = {
    "\\": r"\textbackslash{}",
    **{each: f"\\{each}" for each in "&%$#_{}"},
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "/": "/",
}
_ARROWS = {"lower": r"$\downarrow$", "higher": r"$\uparrow$", None: ""}


def as_json(results: Results) -> str:
    """All that was found."""
    columns = [
        {name: getattr(each, name) for name in ("key", "title", "meaning", "unit", "better", "of")}
        for each in results.columns
    ]
    methods = [
        {
            "name": row.name,
            "values": {key: _told(value) for key, value in row.values.items()},
            "pictures": {
                picture: {each.key: row.of_picture(picture, each.key) for each in results.columns if each.of == "clip"}
                for picture in results.pictures
            },
            "clips": [asdict(each) for each in row.clips],
        }
        for row in results.rows
    ]
    told = {
        "format": "physanimator-report",
        "version": 1,
        "physanimator": __version__,
        "title": results.title,
        "pictures": list(results.pictures),
        "samples": results.samples,
        "columns": columns,
        "methods": methods,
        "left_out": [asdict(each) for each in results.absent],
        "paper": {"note": NOTE, "tables": [asdict(each) for each in PAPER_TABLES]},
    }
    return json.dumps(told, indent=1, ensure_ascii=False) + "\n"


def _told(value: Value) -> Any:
    if isinstance(value, Summary):
        return {"mean": value.mean, "low": value.low, "high": value.high, "pictures": value.count}
    return {"missing": value} if isinstance(value, str) else None


def as_csv(results: Results) -> str:
    """One line for each method and column."""
    lines = [("method", "column", "unit", "better", "mean", "low", "high", "pictures", "missing")]
    for row in results.rows:
        for column in results.columns:
            value = row.values[column.key]
            numbers: tuple[Any, ...] = ("", "", "", 0)
            if isinstance(value, Summary):
                numbers = (value.mean, value.low, value.high, value.count)
            missing = value if isinstance(value, str) else ""
            lines.append((row.name, column.key, column.unit, column.better or "", *numbers, missing))
    return _csv(lines)


def as_clips_csv(results: Results) -> str:
    """One line for each clip."""
    columns = [each for each in results.columns if each.of == "clip"]
    lines: list[Any] = [("method", "picture", "sample", *(each.key for each in columns))]
    for row in results.rows:
        for clip in row.clips:
            lines.append((row.name, clip.picture, clip.sample, *(clip.values.get(each.key) for each in columns)))
    return _csv(lines)


def _csv(lines: Any) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([tuple(map(_harmless, line)) for line in lines])
    return text.getvalue()


def _harmless(value: Any) -> Any:
    """A value that no spreadsheet takes for a formula."""
    return f"'{value}" if isinstance(value, str) and value[:1] in ("=", "+", "-", "@") else value


def as_latex(results: Results) -> str:
    """The paper's table with more columns, for the package booktabs: best values bold, intervals below them."""
    columns = [each for each in results.columns if any(row.values[each.key] is not None for row in results.rows)]
    lines = [
        "% Needs \\usepackage{booktabs}. Means over pictures, with 95 % intervals from a bootstrap over them.",
        f"\\begin{{tabular}}{{l{'c' * len(columns)}}}",
        "\\toprule",
        " & ".join(["Method", *map(_head, columns)]) + r" \\",
        "\\midrule",
    ]
    best = {each.key: results.best(each) for each in columns}
    for row in results.rows:
        cells = [_cell(results, row.values[each.key], bold=row.name in best[each.key]) for each in columns]
        lines.append(" & ".join([_tex(row.name), *cells]) + r" \\")
    lines += ["\\bottomrule", "\\end{tabular}"]
    lines += [f"% {_comment(f'{key} is empty: not at hand: {name}')}" for key, name in results.missing.items()]
    lines += [f"% {_comment(f'left out: {who}: {why}')}" for who, why in left_out(results.absent)]
    return "\n".join([*lines, "", *_paper_tables()]) + "\n"


def _head(column: Column) -> str:
    unit = f" [{_tex(column.unit)}]" if column.unit else ""
    return f"{_tex(column.title)}{unit}{_ARROWS[column.better]}"


def _cell(results: Results, value: Value, *, bold: bool) -> str:
    if not isinstance(value, Summary) or value.mean is None:
        return "--"
    mean = shown_number(value.mean)
    mean = f"\\textbf{{{mean}}}" if bold else mean
    mean += f" {{\\scriptsize ({note})}}" if (note := results.few(value)) else ""
    if value.low is None or value.high is None:
        return mean
    return f"{mean} {{\\scriptsize [{shown_number(value.low)}, {shown_number(value.high)}]}}"


def _paper_tables() -> list[str]:
    lines = [f"% {NOTE}"]
    heads = {"fid": "FID", "vsvq": "VSVQ", "vstc": "VSTC", "vsdd": "VSDD", "vsfc": "VSFC"}
    for table in PAPER_TABLES:
        keys = [each for each in heads if any(each in row for row in table.rows.values())]
        lines += [
            f"% {table.title}",
            f"\\begin{{tabular}}{{l{'c' * len(keys)}}}",
            "\\toprule",
            " & ".join(["Method", *(heads[key] for key in keys)]) + r" \\",
            "\\midrule",
            *(
                " & ".join([_tex(name), *(shown_number(row[key]) for key in keys)]) + r" \\"
                for name, row in table.rows.items()
            ),
            "\\bottomrule",
            "\\end{tabular}",
        ]
    return lines


def _tex(text: str) -> str:
    return "".join(_TEX.get(each, each) for each in text)


def _comment(text: str) -> str:
    return " ".join(text.split())
