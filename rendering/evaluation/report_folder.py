"""The folder of a report: what is ours in it, and where each thing lies."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ... import __version__
from ...physics.errors import InvalidInputError
from ..files import RecordedFiles, check_folder_place, check_recorded_folder, write_recorded_folder, write_text

__all__ = ["REPORT_FILES", "ReportFolder"]

REPORT_FILES = ("report.html", "report.json", "report.csv", "clips.csv", "report.tex")
"""Names of the report's files, the page first."""

_MARK = "evaluation.json"
_FORMAT = "physanimator-evaluation"
_MEASURES = "physanimator-measures"
_LARGEST = 8 << 20


def _present(folder: Path) -> list[str]:
    return [name for name in REPORT_FILES if os.path.lexists(folder / name)]


_REPORT = RecordedFiles("report", ".report_record.json", "only reports that PhysAnimator wrote", _present)


class ReportFolder:
    """A report's folder: ``clips/METHOD/PICTURE/sample_0/``, ``measures/METHOD/PICTURE_0.json``, figures, the report.

    Attributes:
        place: of the folder.
    """

    def __init__(self, place: Path) -> None:
        self.place = place

    def check(self) -> None:
        """Refuse a place that is not ours.

        Raises:
            InvalidInputError: it cannot be written to, or holds what this command did not make, or somebody changed.
        """
        check_folder_place(self.place)
        if not self.place.is_dir() or self._is_ours():
            check_recorded_folder(self.place, _REPORT)
            return
        others = sorted(each.name for each in self.place.iterdir() if not each.name.startswith("."))
        if others:
            raise InvalidInputError(
                f"output must be a new folder, or one that physanimator evaluate made. Got: {self.place}, which holds"
                f" {others[0]}"
            )

    def open(self) -> None:
        """Make the folder, or go on with it."""
        self.place.mkdir(exist_ok=True)
        if not self._is_ours():
            told = {"format": _FORMAT, "version": 1, "physanimator": __version__}
            write_text(self.place / _MARK, json.dumps(told) + "\n")

    def _is_ours(self) -> bool:
        told = _read(self.place / _MARK)
        return told is not None and told.get("format") == _FORMAT and told.get("version") == 1

    @property
    def clips(self) -> Path:
        """The folder of all clips."""
        return self.place / "clips"

    @property
    def figures(self) -> Path:
        """The folder of figures."""
        return self.place / "figures"

    def clip(self, method: str, picture: str, sample: int) -> Path:
        """The folder of a clip."""
        return self.clips / method / picture / f"sample_{sample}"

    def measures(self, method: str, picture: str, sample: int) -> Path:
        """The file of a clip's measures."""
        return self.place / "measures" / method / f"{picture}_{sample}.json"

    def method_measures(self, method: str) -> Path:
        """The file of what all clips of a method have together."""
        return self.place / "measures" / method / "all.json"

    def read_measures(self, place: Path, key: str) -> dict[str, Any] | None:
        """The values that were kept for a key; None where there are none, or others."""
        told = _read(place)
        if told is None or told.get("format") != _MEASURES or told.get("key") != key:
            return None
        values = told.get("values")
        return values if isinstance(values, dict) else None

    def check_measures(self, place: Path) -> None:
        """Refuse a file that is not ours.

        Raises:
            InvalidInputError: it is somebody else's.
        """
        if os.path.lexists(place):
            told = _read(place)
            if told is None or told.get("format") != _MEASURES:
                raise InvalidInputError(
                    f"{place} must be what physanimator evaluate wrote. Got: something else; choose another folder"
                )

    def write_measures(self, place: Path, key: str, values: dict[str, Any]) -> None:
        """Keep values."""
        self.check_measures(place)
        place.parent.mkdir(parents=True, exist_ok=True)
        write_text(place, json.dumps({"format": _MEASURES, "key": key, "values": values}, indent=1) + "\n")

    def write_report(self, texts: Mapping[str, str]) -> None:
        """Write the report's files, which appear together.

        Args:
            texts: by name, one for each of ``REPORT_FILES``.

        Raises:
            InvalidInputError: there is a report that somebody else wrote, or changed.
        """

        def write(staging: Path) -> Iterable[str]:
            for name, text in texts.items():
                write_text(staging / name, text)
            return REPORT_FILES

        write_recorded_folder(self.place, _REPORT, write)


def _read(place: Path) -> dict[str, Any] | None:
    """The table in a JSON file; None where there is no such file."""
    try:
        if place.is_symlink() or not place.is_file() or place.stat().st_size > _LARGEST:
            return None
        told = json.loads(place.read_bytes())
    except (OSError, ValueError, RecursionError):
        return None
    return told if isinstance(told, dict) else None
