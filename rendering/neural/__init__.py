"""Networks in place of what needs none, outside a host: which, from which files, on which device."""

from __future__ import annotations

from .options import CHOICES, NetworkOptions

__all__ = [
    "CHOICES",
    "NetworkOptions",
]
