"""What runs in the process that ``worker`` starts: it computes what comes in, until nothing more can come."""

from __future__ import annotations

import os
import signal
import sys
from typing import IO, Any, NoReturn

from ..errors import PhysAnimatorError
from . import taichi_runtime
from .worker_pipe import receive, send

__all__ = ["serve"]


def serve() -> NoReturn:
    """Answer messages until the standard input is closed, and end the process.

    When its kernels are kept, nothing in it is of use any more; to take all its modules apart would take far longer.
    """
    incoming, outgoing = _pipes()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl+C is the other process's to understand
    taichi_runtime.own_this_process()
    constants: dict[tuple[Any, ...], Any] = {}
    try:
        send(outgoing, "ready")
        while True:
            send(outgoing, _answer(receive(incoming), constants))
    except (EOFError, OSError):
        taichi_runtime.end()
        os._exit(0)


def _pipes() -> tuple[IO[bytes], IO[bytes]]:
    """The pipes to the other process; what libraries print goes elsewhere."""
    outgoing = os.fdopen(os.dup(1), "wb")
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)
    return sys.stdin.buffer, outgoing


def _answer(message: tuple[Any, ...], constants: dict[tuple[Any, ...], Any]) -> tuple[str, Any, Any]:
    try:
        if message[0] == "keep":
            return "done", taichi_runtime.keep_compiled(), None
        if message[0] == "call":
            return "done", message[1](*message[2]), None
        _, function, (key, constant), forgotten, state, arguments = message
        for each in forgotten:
            constants.pop(each, None)
        if constant is not None:
            constants[key] = constant
        result = taichi_runtime.launch(function, constants.get(key), state, *arguments)
    except Exception as error:
        known = isinstance(error, PhysAnimatorError | ValueError | MemoryError)
        return "error", error if known else PhysAnimatorError(f"{type(error).__name__}: {error}"), None
    return "done", result, state
