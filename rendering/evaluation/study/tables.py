"""Results of a study as text, JSON and CSV."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import asdict

from ....physics.errors import printable
from .results import Preference, StudyResults

__all__ = ["results_csv", "results_json", "results_text"]


def results_json(results: StudyResults) -> str:
    """All of it."""
    return json.dumps(asdict(results), indent=1, ensure_ascii=False)


def results_csv(results: StudyResults) -> str:
    """A line a question and pair of methods."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["question", "method", "other", "preferred", "answers", "share", "low", "high", "p_value"])
    for each in results.preferences:
        numbers = [f"{n:.6g}" for n in (each.share, each.low, each.high, each.p_value)]
        names = [f"'{n}" if n[:1] in "=+-@" else n for n in (each.method, each.other)]  # no formula in a spreadsheet
        writer.writerow([each.question, *names, each.preferred, each.answers, *numbers])
    return text.getvalue()


def results_text(results: StudyResults) -> str:
    """A table as the paper's: how often a method is preferred to each other one, in percent with its interval."""
    pairs = list(dict.fromkeys((each.method, each.other) for each in results.preferences))
    found = {(each.question, each.method, each.other): each for each in results.preferences}
    rows = [["preferred", *results.questions]]
    for method, other in pairs:
        cells = [found.get((question, method, other)) for question in results.questions]
        shown = [_cell(each) for each in cells]
        rows.append([f"{printable(method)} to {printable(other)}", *shown])
    alphas = [results.agreement[question] for question in results.questions]
    rows.append(["agreement (alpha)", *("-" if a is None else f"{a:.2f}" for a in alphas)])
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    dropped = [each for each in results.raters if each.dropped]
    several = [each for each in results.raters if each.files > 1]
    lines += ["", f"raters: {len(results.raters)}, of whom {len(dropped)} dropped by catch trials"]
    lines += [
        f"dropped: {printable(each.rater)}, {each.caught} of {each.catch_answers} catch answers right"
        for each in dropped
    ]
    if several:
        lines.append(f"raters with several files, of which the last answers count: {len(several)}")
    return "\n".join(lines)


def _cell(each: Preference | None) -> str:
    if each is None:
        return "-"
    return f"{100 * each.share:.0f} % [{100 * each.low:.0f}, {100 * each.high:.0f}] of {each.answers}"
