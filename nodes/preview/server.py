"""The one store of this process, and its routes on the host's server where there is one."""

from __future__ import annotations

import logging
import sys
import threading

from .store import PreviewStore

__all__ = ["STORE", "register_routes", "start_warm_up"]

STORE = PreviewStore()
"""The bodies on which the editors of this process draw."""

_registered = threading.Event()
_warmed = {contact: threading.Event() for contact in (False, True)}


def register_routes() -> None:
    """Add the routes to the host's server; without one, as in a test or another host, do nothing."""
    running = sys.modules.get("server")  # importing it would start the host's machinery where none runs
    server = getattr(getattr(running, "PromptServer", None), "instance", None)
    if server is None or _registered.is_set():
        return
    _registered.set()
    from .routes import PreviewRoutes

    PreviewRoutes(STORE, warm_up=start_warm_up).register(server.routes)


def start_warm_up(*, contact: bool = False) -> None:
    """Start the solver in the background, so that the first preview need not wait for that.

    Args:
        contact: its kernels for contact too.
    """
    wanted = [kind for kind in ((False, True) if contact else (False,)) if not _warmed[kind].is_set()]
    for kind in wanted:
        _warmed[kind].set()
    if wanted:
        threading.Thread(target=_start_solver, args=(wanted,), name="physanimator-warm-up", daemon=True).start()


def _start_solver(wanted: list[bool]) -> None:
    from .session import warm_up

    try:
        for contact in wanted:
            warm_up(contact=contact)
    except Exception:
        logging.exception("PhysAnimator: the solver has not started; live previews will not work")
