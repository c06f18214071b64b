"""The scene editor's live preview: its routes, its guard and limits, and the simulations that it runs."""

from __future__ import annotations

from .holds import holds_of_bodies
from .records import FRAME, HEADER, split_records
from .requests import PreviewRequest, preview_scene, read_request
from .server import STORE, register_routes
from .store import PreviewBodies, PreviewStore

__all__ = [
    "FRAME",
    "HEADER",
    "STORE",
    "PreviewBodies",
    "PreviewRequest",
    "PreviewStore",
    "holds_of_bodies",
    "preview_scene",
    "read_request",
    "register_routes",
    "split_records",
]
