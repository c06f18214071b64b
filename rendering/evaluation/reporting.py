"""The report of a folder: a page, JSON, CSV and LaTeX."""

from __future__ import annotations

from .report_folder import ReportFolder
from .report_page import as_html
from .report_tables import as_clips_csv, as_csv, as_json, as_latex
from .results import Results

__all__ = ["write_report"]


def write_report(folder: ReportFolder, results: Results) -> None:
    """Write all files of a report; see :meth:`ReportFolder.write_report`."""
    figures = sorted(each.name for each in folder.figures.glob("*.png"))
    folder.write_report(
        {
            "report.html": as_html(results, figures),
            "report.json": as_json(results),
            "report.csv": as_csv(results),
            "clips.csv": as_clips_csv(results),
            "report.tex": as_latex(results),
        }
    )
