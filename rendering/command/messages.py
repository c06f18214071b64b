"""What the command line says: nothing that is printed may end the work, whatever the terminal makes of it."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from contextvars import ContextVar
from typing import IO, TYPE_CHECKING, Any

from ...physics.errors import printable

if TYPE_CHECKING:
    from ..stages import StageProgress

__all__ = ["gathered", "printable_streams", "progress_bars", "say", "show", "warn"]

_gathering: ContextVar[list[str] | None] = ContextVar("gathering", default=None)

_UNITS = {"mesh": "part", "prepare": "step", "svd": "step", "inpainting": "step", "tooncrafter": "step"}
_UNITS |= {"spine": "layer", "gltf": "layer", "clips": "clip"}
"""What stages advance by, where not by frames."""


@contextmanager
def gathered() -> Iterator[list[str]]:
    """Lines for a person, which go into the list that is given instead of to a terminal, on this thread."""
    lines: list[str] = []
    token = _gathering.set(lines)
    try:
        yield lines
    finally:
        _gathering.reset(token)


@contextmanager
def printable_streams() -> Iterator[None]:
    """Let standard output and error take every character: what their encoding lacks appears as an escape."""
    with ExitStack() as back:
        for stream in (sys.stdout, sys.stderr):
            reconfigure = getattr(stream, "reconfigure", None)
            if reconfigure is not None and getattr(stream, "errors", "") in ("strict", "surrogateescape"):
                back.callback(reconfigure, errors=stream.errors)
                reconfigure(errors="backslashreplace")
        yield


def show(text: str) -> None:
    """Print what the command was asked for.

    Raises:
        OSError: it cannot be printed; BrokenPipeError where nobody reads any more.
    """
    try:
        print(text, flush=True)
    except OSError:
        _silence(sys.stdout)
        raise


def say(text: str) -> None:
    """Print a line about what was done; where it cannot be printed, nothing happens."""
    _tell(text, sys.stdout)


def warn(text: str) -> None:
    """Print a line for a person on standard error; where it cannot be printed, nothing happens."""
    _tell(text, sys.stderr)


def progress_bars(stack: ExitStack) -> StageProgress | None:
    """A bar on standard error for each stage, which appears with its first step; None where there is no such stream."""
    if sys.stderr is None:
        return None
    from tqdm import tqdm

    bars: dict[str, Any] = {}
    stream = _Tolerant(sys.stderr)

    def advance(stage: str, done: int, total: int) -> None:
        if stage not in bars:
            unit = _UNITS.get(stage, "frame")
            bars[stage] = stack.enter_context(tqdm(total=total, desc=f"{stage:<8}", unit=unit, file=stream))
        bars[stage].update(done - bars[stage].n)
        if done == total:
            bars[stage].close()

    return advance


class _Tolerant:
    """A stream that swallows the errors of writing to it, such as those of a closed pipe."""

    def __init__(self, stream: IO[str]) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        try:
            return self._stream.write(text)
        except (OSError, ValueError):
            _silence(self._stream)
            return len(text)

    def flush(self) -> None:
        with suppress(OSError, ValueError):
            self._stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def _tell(text: str, stream: IO[str] | None) -> None:
    lines = _gathering.get()
    if lines is not None:
        lines.append(printable(text))
        return
    try:
        print(printable(text), file=stream, flush=True)
    except (OSError, ValueError):
        _silence(stream)


def _silence(stream: IO[str] | None) -> None:
    """Point a stream that nobody reads any more at the null device: Python writes what is left of it as it exits."""
    with suppress(OSError, ValueError, AttributeError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())  # type: ignore[union-attr]
        os.close(nowhere)
