"""Measures of clips by anyone: the paper's by local weights, others without any, and their means over pictures."""

from __future__ import annotations

from .clip import ClipOfPicture, Frames
from .column import Column, Missing
from .measuring import clip_values, method_values
from .statistics import Summary, mean_of_samples, summary
from .table import COLUMNS
from .weights import ColumnWeights

__all__ = [
    "COLUMNS",
    "ClipOfPicture",
    "Column",
    "ColumnWeights",
    "Frames",
    "Missing",
    "Summary",
    "clip_values",
    "mean_of_samples",
    "method_values",
    "summary",
]
