"""The one store of this process, and its routes on the host's server where there is one."""

from __future__ import annotations

import logging
import sys
import threading

from ..physics.preview_store import PreviewStore

__all__ = ["STORE", "register_routes", "warm_up"]

STORE = PreviewStore()
"""The bodies on which the editors of this process draw."""

_registered = threading.Event()
_warmed = threading.Event()


def register_routes() -> None:
    """Add the routes to the host's server; without one, as in a test or another host, do nothing."""
    running = sys.modules.get("server")  # importing it would start the host's machinery where none runs
    server = getattr(getattr(running, "PromptServer", None), "instance", None)
    if server is None or _registered.is_set():
        return
    _registered.set()
    from .preview_routes import PreviewRoutes

    PreviewRoutes(STORE, warm_up=warm_up).register(server.routes)


def warm_up() -> None:
    """Start the solver in the background, so that the first preview need not wait for that."""
    if not _warmed.is_set():
        _warmed.set()
        threading.Thread(target=_start_solver, name="physanimator-warm-up", daemon=True).start()


def _start_solver() -> None:
    from ..physics.preview_session import warm_up

    try:
        warm_up()
    except Exception:
        logging.exception("PhysAnimator: the solver has not started; live previews will not work")
