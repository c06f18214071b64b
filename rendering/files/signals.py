"""Signals that end the process unwind it as Ctrl+C does, and wait while files are put in their places."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

__all__ = ["Ended", "clearing_up", "ending_signals", "hear_signals", "ignore_signals", "uninterrupted"]

_NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")  # the last one is Ctrl+Break of Windows
_REPEATED = 1.0  # seconds: some programs send a signal to the process and once more to its group


class Ended(KeyboardInterrupt):
    """A signal asked the process to end.

    Attributes:
        number: of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number

    @property
    def status(self) -> int:
        """Exit status by the shells' convention."""
        return 128 + self.number


class _State:
    """What the main thread is doing about signals.

    Attributes:
        held: how many blocks that must not be interrupted it is in.
        waiting: the signal that came meanwhile.
        raised: when the last one was raised [s].
        asked: the signal that was raised.
        ignoring: whether the process is ending anyway.
        clearing: whether a block of :func:`clearing_up` has taken the signals.
    """

    def __init__(self) -> None:
        self.held = 0
        self.waiting: int | None = None
        self.raised = -_REPEATED
        self.asked: int | None = None
        self.ignoring = False
        self.clearing = False


_state = _State()


@contextmanager
def ending_signals() -> Iterator[None]:
    """Raise :class:`Ended` in the main thread on Ctrl+C and the signals that ask a process to end.

    Only signals that nobody handles or ignores (as ``nohup`` does) are taken, and they are given back at the end.
    In another thread than the main one this does nothing.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _state.ignoring, _state.asked, _state.raised = False, None, -_REPEATED
    try:
        with _taken(_arrived):
            try:
                yield
            finally:
                ignore_signals()
    finally:
        _state.waiting, _state.asked, _state.ignoring = None, None, False


def ignore_signals() -> None:
    """The process is ending: nothing that arrives until the end of :func:`ending_signals` shall stop it from that."""
    _state.ignoring = True


def hear_signals() -> None:
    """Raise again what was raised and swallowed, as exceptions in finalizers and callbacks are."""
    if _state.asked is not None and threading.current_thread() is threading.main_thread():
        raise Ended(_state.asked)


@contextmanager
def clearing_up(clear: Callable[[], None]) -> Iterator[None]:
    """Clear up before a signal that nobody handles ends the process, as it would have without this.

    For the library in a script of the user's own, whose signals are not the library's to raise: SIGTERM and SIGHUP end
    the process by themselves, afterwards. Ctrl+C raises KeyboardInterrupt as ever, but not within
    :func:`uninterrupted`. In another thread than the main one this does nothing, nor within another such block or
    one of :func:`ending_signals`.

    Args:
        clear: removes what must not stay.
    """
    if _state.clearing or threading.current_thread() is not threading.main_thread():
        yield
        return

    def arrived(number: int, _: FrameType | None) -> None:
        if _state.held:
            _state.waiting = number
        elif number == signal.SIGINT:
            raise KeyboardInterrupt
        else:
            clear()
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)

    try:
        with _taken(arrived):
            _state.clearing = True
            yield
    finally:
        _state.clearing = False


@contextmanager
def _taken(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Give the signals that end a process a handler, where nobody handles or ignores them, and give them back."""
    earlier = {}
    try:
        for number in (getattr(signal, name) for name in _NAMES if hasattr(signal, name)):
            if signal.getsignal(number) in (signal.SIG_DFL, signal.default_int_handler):
                earlier[number] = signal.signal(number, handler)
        yield
    finally:
        for number, before in earlier.items():
            signal.signal(number, before)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Finish a short block before a signal of :func:`ending_signals` or :func:`clearing_up` is heard."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _state.held += 1
    try:
        yield
    finally:
        _state.held -= 1
        if not _state.held and _state.waiting is not None:
            number, _state.waiting = _state.waiting, None
            signal.raise_signal(number)


def _arrived(number: int, _: FrameType | None) -> None:
    if _state.ignoring or time.monotonic() - _state.raised < _REPEATED:
        return
    if _state.held:
        _state.waiting = number
        return
    _state.raised, _state.asked = time.monotonic(), number
    raise Ended(number)
