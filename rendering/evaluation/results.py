"""What an evaluation has found: values of clips, and of methods with their intervals over pictures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .clip_files import SHOWN
from .columns import COLUMNS, Column, Summary, mean_of_samples, summary
from .planning import Absent, Cell, Plan

__all__ = ["ClipResult", "MethodResult", "Results", "Value", "results_of", "shown_number"]

Value = Summary | str | None
"""Of a method in a column: with its interval; the name of the file that is missing; or None where no clip has one."""


@dataclass(frozen=True)
class ClipResult:
    """A clip and its values.

    Attributes:
        picture, sample: whose.
        file: what a browser shows, from the report's folder on.
        values: by column; None where the clip has none.
    """

    picture: str
    sample: int
    file: str
    values: Mapping[str, float | None]


@dataclass(frozen=True)
class MethodResult:
    """A row.

    Attributes:
        name: of the method.
        values: by column.
        clips: of the method.
    """

    name: str
    values: Mapping[str, Value]
    clips: Sequence[ClipResult]

    def of_picture(self, picture: str, column: str) -> float | None:
        """The mean over the samples of a picture."""
        return mean_of_samples([each.values.get(column) for each in self.clips if each.picture == picture])


@dataclass(frozen=True)
class Results:
    """All rows.

    Attributes:
        title: of the report.
        columns: in order.
        pictures: names, in order.
        samples: of each picture.
        rows: in order.
        absent: what was left out.
    """

    title: str
    columns: Sequence[Column]
    pictures: Sequence[str]
    samples: int
    rows: Sequence[MethodResult]
    absent: Sequence[Absent]

    @property
    def missing(self) -> dict[str, str]:
        """For each column that lacks weights the name of their file."""
        found: dict[str, str] = {}
        for row in self.rows:
            found |= {key: value for key, value in row.values.items() if isinstance(value, str)}
        return found

    def few(self, value: Summary) -> str:
        """A note on a value that is of fewer pictures than the report has; empty for others."""
        return f"{value.count} of {len(self.pictures)} pictures" if value.count < len(self.pictures) else ""

    def best(self, column: Column) -> frozenset[str]:
        """The methods that are best in a column, as it is written, of those that have all pictures that any has.

        There are none where neither way is better.
        """
        found = {each.name: value for each in self.rows if isinstance(value := each.values[column.key], Summary)}
        most = max((each.count for each in found.values()), default=0)
        known = {name: value.mean for name, value in found.items() if value.count == most}
        shown = {name: float(shown_number(value)) for name, value in known.items() if value is not None}
        if column.better is None or len(shown) < 2:
            return frozenset()
        wanted = (min if column.better == "lower" else max)(shown.values())
        return frozenset(name for name, value in shown.items() if value == wanted)


def results_of(plan: Plan) -> Results:
    """What is known of the clips of a plan; those that are not there yet have no values."""
    which, rows = plan.which, []
    for method in plan.methods:
        cells = plan.cells_of(method)
        kept = [_values(plan, each) for each in cells]
        clips = [
            ClipResult(each.picture.name, each.sample, _file(each), _numbers(values))
            for each, values in zip(cells, kept, strict=True)
        ]
        together = plan.folder.read_measures(plan.folder.method_measures(method.name), plan.method_key(method)) or {}
        values = {
            column.key: _of_method(together.get(column.key))
            if column.of == "method"
            else _of_clips(column.key, clips, kept, [each.name for each in which.pictures], which.seed)
            for column in COLUMNS
        }
        rows.append(MethodResult(method.name, values, clips))
    names = [each.name for each in which.pictures]
    return Results(which.title or "Evaluation", COLUMNS, names, which.samples, rows, plan.absent)


def shown_number(value: float) -> str:
    """A number with about three places that say something, and no exponent where it can be read without."""
    if value == 0 or 1e-4 <= abs(value) < 1000:
        return f"{value:.3g}"
    return f"{value:.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.1e}"


def _values(plan: Plan, cell: Cell) -> Mapping[str, Any]:
    file = plan.folder.measures(cell.method.name, cell.picture.name, cell.sample)
    return plan.folder.read_measures(file, f"{cell.key} {plan.weights_key}") or {}


def _file(cell: Cell) -> str:
    return f"clips/{cell.method.name}/{cell.picture.name}/sample_{cell.sample}/{SHOWN}"


def _numbers(values: Mapping[str, Any]) -> dict[str, float | None]:
    return {key: float(each) if isinstance(each, int | float) else None for key, each in values.items()}


def _of_clips(
    key: str, clips: Sequence[ClipResult], kept: Sequence[Mapping[str, Any]], pictures: Sequence[str], seed: int
) -> Value:
    missing = next((each[key]["missing"] for each in kept if isinstance(each.get(key), dict)), None)
    if missing is not None:
        return str(missing)
    of_pictures = [
        mean_of_samples([clip.values.get(key) for clip in clips if clip.picture == picture]) for picture in pictures
    ]
    found = summary(of_pictures, seed=seed)
    return found if found.count else None


def _of_method(value: Any) -> Value:
    if not isinstance(value, dict):
        return None
    if "missing" in value:
        return str(value["missing"])
    found = Summary(value["mean"], value["low"], value["high"], value["count"])
    return found if found.mean is not None else None
