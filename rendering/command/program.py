"""The command line as a process of its own."""

from __future__ import annotations

import atexit
import os
import sys
from contextlib import suppress

from .exit_status import main

__all__ = ["program"]


def program() -> int:
    """Run the command of this process's arguments, and let the process end quickly.

    When all is written and everybody has been waited for, Python would still take a thousand modules apart, and free
    the memory of all pictures piece by piece: a tenth of a second for what the system does at once.

    Returns:
        The exit status, see :func:`~.exit_status.main`.
    """
    ended: list[int] = []
    atexit.register(_leave, ended)  # what is registered first is called last
    ended.append(main())
    return ended[0]


def _leave(ended: list[int]) -> None:
    """End the process at once, unless an error has ended it or its last words cannot be written: Python says so."""
    if not ended:
        return
    with suppress(OSError, ValueError):
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        os._exit(ended[0])
