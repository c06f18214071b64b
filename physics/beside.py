"""Something that other threads make while this one goes on, or waits for all of them."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextvars import copy_context
from types import TracebackType
from typing import Any, Generic, TypeVar

from .interruption import checkpoint, interruptible
from .threads import allowed_threads

__all__ = ["Beside", "made_ahead", "side_by_side"]

A = TypeVar("A")
T = TypeVar("T")

_POLL_SECONDS = 0.2  # without a timeout Windows would not deliver Ctrl+C


class _GivenUp(Exception):
    """Nobody wants the result any more."""


class Beside(Generic[T]):
    """What a function returns, called at once in a thread of its own; a block in which that may go on.

    Whoever leaves the block by an error gives it up: it stops at its next checkpoint (see
    :func:`~physanimator.physics.interruption.checkpoint`), and is waited for. What the calling thread asks at its
    checkpoints is asked at those of the other one as well.

    Where this process may use one thread only, the function is called when the block begins, in the calling thread.

    Examples:
        >>> from physanimator.physics.beside import Beside
        >>> with Beside(lambda: sum(range(1000))) as summing:
        ...     product = 6 * 7
        >>> product, summing.result()
        (42, 499500)
    """

    def __init__(self, make: Callable[[], T]) -> None:
        self._make = make
        self._maker, self._given_up = threading.current_thread(), threading.Event()
        self._made: list[T] = []
        self._error: BaseException | None = None
        # No daemon: the process must not end inside of a compiled library.
        run = copy_context().run
        self._thread = threading.Thread(target=run, args=(self._run,), name="physanimator-beside")

    def __enter__(self) -> Beside[T]:
        if allowed_threads() > 1:
            self._thread.start()
        else:
            self._made.append(self._make())
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        if error is not None:
            self._given_up.set()
        self._wait()

    @property
    def ended(self) -> bool:
        """Whether nothing runs any more."""
        return not self._thread.is_alive()

    def check(self) -> None:
        """Raise what has ended the making early, if anything has."""
        if self._error is not None:
            raise self._error

    def result(self, *, meanwhile: Callable[[], None] | None = None) -> T:
        """What has been made; waits for it, and raises what the function has raised.

        Args:
            meanwhile: called now and then while it is waited for; may raise to give it up.
        """
        while self._thread.is_alive():
            if meanwhile is not None:
                meanwhile()
            self._thread.join(_POLL_SECONDS)
        self.check()
        return self._made[0]

    def _wait(self) -> None:
        while self._thread.is_alive():
            self._thread.join(_POLL_SECONDS)

    def _run(self) -> None:
        outside = copy_context()

        def check() -> None:
            # Where the other thread is gone, a second signal has torn it out of waiting.
            if self._given_up.is_set() or not self._maker.is_alive():
                raise _GivenUp
            outside.run(checkpoint)

        try:
            with interruptible(check):
                self._made.append(self._make())
        except BaseException as error:  # raised in the other thread, whatever it is
            self._error = error


def side_by_side(
    function: Callable[..., T], *arguments: Iterable[Any], work: Sequence[float] | None = None
) -> Iterator[T]:
    """What a function returns for each of several arguments, as ``map`` gives it, computed on all cores
    that this process may use.

    Args:
        function: is called by several threads at once.
        arguments: as ``map`` takes them.
        work: about how long each call takes, in any unit: the longest begins first, so that no core waits for it at
            the end. None where they take about as long.

    Raises:
        BaseException: the first in the order of the arguments that the function has raised; what has not begun is
            left out then.

    Examples:
        >>> from physanimator.physics.beside import side_by_side
        >>> list(side_by_side(pow, [2, 3], [5, 2]))
        [32, 9]
    """
    calls = list(zip(*arguments, strict=True))
    threads = min(allowed_threads(), len(calls))
    if threads < 2:
        yield from (function(*each) for each in calls)
        return
    pool = ThreadPoolExecutor(threads, thread_name_prefix="physanimator-beside")
    try:
        order = sorted(range(len(calls)), key=lambda number: 0.0 if work is None else -work[number])
        begun = {number: pool.submit(copy_context().run, function, *calls[number]) for number in order}
        for number in range(len(calls)):
            yield _awaited(begun[number])
    finally:
        pool.shutdown(cancel_futures=True)


def made_ahead(function: Callable[[A], T], arguments: Iterable[A], *, most: int = 4) -> Iterator[T]:
    """What a function returns for each argument, in turn, while other threads already make the next ones.

    The first is made alone, so that it comes as soon as it can. Where this process may use one thread only, each is
    made when it is asked for.

    Args:
        function: is called by several threads at once.
        arguments: each is asked for when its turn comes to be made.
        most: how many are made at once, on however many cores; one more may wait.

    Examples:
        >>> from physanimator.physics.beside import made_ahead
        >>> list(made_ahead(abs, [-1, -2, -3]))
        [1, 2, 3]
    """
    threads = min(allowed_threads(), most)
    if threads < 2:
        yield from map(function, arguments)
        return
    pool = ThreadPoolExecutor(threads, thread_name_prefix="physanimator-beside")
    begun: deque[Future[T]] = deque()
    most = 0
    try:
        for argument in arguments:
            begun.append(pool.submit(copy_context().run, function, argument))
            if len(begun) > most:
                yield _awaited(begun.popleft())
                most = threads
        while begun:
            yield _awaited(begun.popleft())
    finally:
        pool.shutdown(cancel_futures=True)


def _awaited(begun: Future[T]) -> T:
    while not wait([begun], _POLL_SECONDS).done:
        pass
    return begun.result()
