"""Rhythms that fit a loop."""

from __future__ import annotations

__all__ = ["fitted_period"]


def fitted_period(period: float, loop: float | None) -> float:
    """The nearest period of which a whole number fills a loop; the period itself without one. Both in seconds."""
    return period if loop is None else loop / max(1, round(loop / period))
