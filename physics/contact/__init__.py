"""Bodies that touch each other and what stands still: search, contact forces, and steps in common."""

from __future__ import annotations

from .surface import contact_surface
from .touching_bodies import TouchingBodies

__all__ = [
    "TouchingBodies",
    "contact_surface",
]
