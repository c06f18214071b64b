"""Masks by the Segment Anything family, with weights that the user has."""

from __future__ import annotations

from .families import where_to_get

__all__ = [
    "where_to_get",
]
