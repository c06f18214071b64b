"""Long preparations can be given up: whoever starts one names a check, and whoever computes asks it now and then."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from .process_end import stop_at_end

__all__ = ["checkpoint", "interruptible"]

_check: ContextVar[Callable[[], None] | None] = ContextVar("check", default=None)


@contextmanager
def interruptible(check: Callable[[], None]) -> Iterator[None]:
    """Ask ``check`` at every checkpoint inside; it may raise to stop. Only the calling thread is concerned."""
    token = _check.set(check)
    try:
        yield
    finally:
        _check.reset(token)


def checkpoint() -> None:
    """Stop here if whoever waits for the result has given it up, or the process is ending."""
    stop_at_end()
    check = _check.get()
    if check is not None:
        check()
