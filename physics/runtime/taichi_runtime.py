"""Taichi on a thread of its own, so that it can live in somebody else's process.

Taichi binds its program to the thread that initialised it and has one program in a process, with which the fields of
all its users go. Where nobody else has imported Taichi, one daemon thread does it all: it imports and initialises
Taichi when the first job arrives and runs every kernel. Where others have, or as soon as they initialise it, kernels
run in a process of their own (``worker``), and the program in this one is the others' alone.

Taichi holds Python's global lock while a kernel runs: a long kernel stops every other thread, so callers keep their
launches to some tens of milliseconds. It also holds it while it makes machine code of a kernel, which takes seconds
where that is large: servers let such kernels run in the process of our own (``aside``). Kernels take arrays only, never
Taichi fields.
"""

from __future__ import annotations

import atexit
import logging
import os
import queue
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any, ParamSpec, TypeVar, cast

from ..errors import PhysAnimatorError
from ..process_end import wait_to_the_end
from .cache_folder import KernelCache, kernel_cache
from .program import end_program, import_taichi, is_initialising, new_program, program_of
from .reading import quick_reading
from .worker import TaichiWorker

__all__ = [
    "aside",
    "begin_aside",
    "compiled",
    "compiles_here",
    "end",
    "is_beside",
    "keep_compiled",
    "launch",
    "own_this_process",
    "read_anew",
    "run",
]

P = ParamSpec("P")
T = TypeVar("T")

_POLL_SECONDS = 0.2
_LAST_SECONDS = 30.0  # that the end of the process, or of our program, waits for a kernel which still runs: some 15 ms
_IDLE_SECONDS = 300.0  # after which a process of our own, which holds some 200 MB, is ended
_WORTH_KEEPING = 0.25  # seconds of compiling: kernels that were on disk already take some hundredths to read

_goes_aside: ContextVar[bool] = ContextVar("physanimator_goes_aside", default=False)
_is_beside: ContextVar[bool] = ContextVar("physanimator_is_beside", default=False)


class _Job:
    """One call, and what came of it."""

    def __init__(self, call: Callable[[], Any]) -> None:
        self.call = call
        self.dropped = False
        self.done = threading.Event()
        self.result: Any = None
        self.error: BaseException | None = None

    def execute(self) -> None:
        try:
            if not self.dropped:
                self.result = self.call()
        except BaseException as error:  # handed to the caller, whatever it is
            self.error = error
        finally:
            self.done.set()

    def wait(self) -> Any:
        try:
            while not self.done.wait(_POLL_SECONDS):  # without a timeout Windows would not deliver Ctrl+C
                pass
        except BaseException:
            self.dropped = True
            raise
        if self.error is not None:
            raise self.error
        return self.result


class _TaichiThread:
    """The thread, Taichi's program on it, and the kernels that were compiled for that program."""

    def __init__(self) -> None:
        self._jobs: queue.SimpleQueue[_Job] = queue.SimpleQueue()
        self._starting = threading.Lock()
        self._thread: threading.Thread | None = None
        self._process = 0
        self._taichi: Any = None
        self._reset: Any = None  # Taichi's own
        self._program: Any = None
        self._cache = KernelCache(os.sep, usable=False)
        self._kernels: dict[Callable[[Any], Any], Any] = {}
        self._alone = False
        self._shared = False
        self._closed = False
        self._worker = TaichiWorker()
        self._worker_fails = False
        self._begins = False
        self._during_job = ExitStack()

    def run(self, call: Callable[[], T]) -> T:
        if threading.current_thread() is self._thread:
            return call()
        self._start()
        job = _Job(call)
        self._jobs.put(job)
        return cast(T, job.wait())

    def compiled(self, build: Callable[[Any], T]) -> T:
        if threading.current_thread() is not self._thread:
            raise RuntimeError("compiled() must be called inside a job of run()")
        if not self._is_here():
            raise PhysAnimatorError("Another part of this process uses Taichi, of which there can be only one")
        self._during_job.enter_context(quick_reading())
        if build not in self._kernels:
            self._kernels[build] = build(self._taichi)
        return cast(T, self._kernels[build])

    def launched(self, aside: bool, function: Callable[..., T], constant: Any, state: Any, *arguments: Any) -> T:
        if (aside and self._can_go_aside()) or not self._is_here():
            return cast(T, self._worker.launch(function, constant, state, arguments))
        return function(constant, state, *arguments)

    def keep_compiled(self, aside: bool) -> bool:
        if self._shared or (aside and self._can_go_aside()):
            return self._worker.keep_compiled()
        if not self._is_ours() or not self._cache.usable:
            return False
        if self._program.get_total_compilation_time() < _WORTH_KEEPING:
            return False
        self._drop()
        return True

    def read_anew(self) -> None:
        if self._is_ours():
            self._drop()

    def begin_aside(self, function: Callable[..., Any]) -> None:
        def begin() -> None:
            self._begins = True
            try:
                if self._can_go_aside():
                    self._worker.launch(function, (), None, ())
            finally:
                self._begins = False

        self._start()
        self._jobs.put(_Job(begin))

    @property
    def compiles_here(self) -> bool:
        shared = self._shared or (self._taichi is None and "taichi" in sys.modules and not self._alone)
        return not shared and not self._closed

    def own_this_process(self) -> None:
        self._alone = True

    def _start(self) -> None:
        with self._starting:
            if self._thread is None:
                self._process = os.getpid()
                atexit.register(self.end)
                self._thread = threading.Thread(target=self._work, name="physanimator-taichi", daemon=True)
                self._thread.start()
        if self._process != os.getpid():
            raise PhysAnimatorError(
                "Taichi cannot run in a forked process whose parent has used it; start the process with 'spawn'"
            )

    def _work(self) -> None:
        while True:
            try:
                job = self._jobs.get(timeout=_IDLE_SECONDS)
            except queue.Empty:
                self._worker.end_idle()
                continue
            with ExitStack() as self._during_job:
                job.execute()
            del job  # the arrays of a finished job must not live until the next one

    def end(self) -> None:
        """At the end of the process, close our program: only then does Taichi keep the compiled kernels on disk."""
        if self._process == os.getpid():
            if self._begins:  # for nothing, as bad input has been refused meanwhile
                self._worker.kill()
            job = _Job(self._close)
            self._jobs.put(job)
            wait_to_the_end(job.done.wait, _LAST_SECONDS)

    def _close(self) -> None:
        self._closed = True
        self._worker.close()
        if self._is_ours():
            self._drop()

    def _is_ours(self) -> bool:
        return self._program is not None and program_of(self._taichi) is self._program

    def _drop(self) -> None:
        """End our program, which writes what it has compiled to disk."""
        program, self._program = self._program, None
        self._kernels.clear()
        end_program(self._reset, program, self._cache)

    def _can_go_aside(self) -> bool:
        """Whether there is a process of our own, or one could be started."""
        self._check_open()
        if not self._worker_fails and not self._alone:
            try:
                self._worker.start()
            except PhysAnimatorError:
                logging.info(
                    "PhysAnimator: kernels stay in this process: none could be started from %s", sys.executable
                )
                self._worker_fails = True
        return not self._worker_fails and not self._alone

    def _check_open(self) -> None:
        if self._closed:  # a program that is made while the process ends would end it with an abort
            raise PhysAnimatorError("Nothing more can be simulated: the process is ending")

    def _is_here(self) -> bool:
        """Whether kernels run in this process, in which our program then is in place."""
        self._check_open()
        if self._taichi is None and not self._shared:
            self._shared = "taichi" in sys.modules and not self._alone
            if not self._shared:
                self._taichi = import_taichi()
                self._watch(self._taichi)
        if self._shared:
            return False
        if self._program is None:
            self._cache = kernel_cache()
            self._program = new_program(self._taichi, self._cache)
        return True

    def _watch(self, taichi: Any) -> None:
        """See to it that our program is gone before anybody else's comes: Taichi's ``init`` begins with ``reset``."""
        implementation = taichi.lang.impl
        self._reset = reset = implementation.reset

        @wraps(reset)
        def watched() -> None:
            if threading.current_thread() is not self._thread:
                self._leave()
                implementation.reset = reset
            reset()

        implementation.reset = watched
        # Others may have waited for the import, and have gone on before us.
        self._shared = is_initialising(taichi) or program_of(taichi) is not None

    def _leave(self) -> None:
        """Leave this process's Taichi to others."""
        self._shared = True
        job = _Job(lambda: self._drop() if self._is_ours() else None)
        self._jobs.put(job)
        job.done.wait(_LAST_SECONDS)


_taichi_thread = _TaichiThread()


def run(function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Call a function on the Taichi thread, wait for it, and return or raise what it does.

    Any thread may call this at any time; jobs run one after the other. When the wait is interrupted, a job that has
    not begun is dropped and one that has begun runs to its end; neither disturbs later jobs.

    Raises:
        PhysAnimatorError: this process was forked from one that has used Taichi.
    """
    return _taichi_thread.run(lambda: function(*args, **kwargs))


def launch(function: Callable[..., T], constant: Any, state: Any, *arguments: Any) -> T:
    """``function(constant, state, *arguments)`` on the Taichi thread, or in a process of ours where others use Taichi.

    Args:
        function: a function of a module of this package.
        constant: nested tuples of arrays that belong to one simulation, and numbers. Another process gets them once:
            what the function changes in them is seen by its later launches only.
        state: a sequence of arrays that it changes in place, or None.
        arguments: what else it reads.

    Raises:
        PhysAnimatorError: as ``run``, or the other process cannot be started, or has ended.
    """
    return run(_taichi_thread.launched, _goes_aside.get(), function, constant, state, *arguments)


@contextmanager
def aside(wanted: bool = True, *, beside: bool = False) -> Iterator[None]:
    """What this thread launches meanwhile runs in a process of ours, where one can be had, and this one can answer.

    A whole simulation belongs inside: what it has noted in one process is not known in the other.

    Args:
        wanted: whether it does.
        beside: whether other threads of this process work meanwhile, see :func:`is_beside`.
    """
    tokens = _goes_aside.set(wanted), _is_beside.set(beside)
    try:
        yield
    finally:
        _goes_aside.reset(tokens[0])
        _is_beside.reset(tokens[1])


def is_beside() -> bool:
    """Whether what this thread launches leaves processors to others, and may take long, as nobody waits for it."""
    return _is_beside.get()


def begin_aside(function: Callable[..., Any]) -> None:
    """Start the process of our own, where one can be had, and call ``function(constant, state)`` in it; do not wait.

    What is launched ``aside`` later then finds it ready, or waits for it.

    Args:
        function: a function of a module of this package, that does without its arguments.
    """
    _taichi_thread.begin_aside(function)


def compiled(build: Callable[[Any], T]) -> T:
    """What ``build(taichi)`` returned, called once for each Taichi program; only inside a job of ``run`` or ``launch``.

    Args:
        build: a module-level function that gets the taichi module and returns kernels.
    """
    return _taichi_thread.compiled(build)


def keep_compiled() -> bool:
    """Write kernels that were compiled in this process to Taichi's cache on disk, if there are any, and say so.

    Taichi writes them only where its program ends, and never in a process that a signal ends. So the program is ended
    between two jobs; the next one reads its kernels from disk, which takes half a second.
    """
    return run(_taichi_thread.keep_compiled, _goes_aside.get())


def end() -> None:
    """End the program, which writes the kernels that it has compiled to disk; nothing more can be launched then."""
    _taichi_thread.end()


def read_anew() -> None:
    """Let kernels be read from disk again, where another process has written them meanwhile."""
    _taichi_thread.run(_taichi_thread.read_anew)


def compiles_here() -> bool:
    """Whether kernels are compiled in this process, as they are where nobody else uses Taichi in it."""
    return _taichi_thread.compiles_here


def own_this_process() -> None:
    """Say that this process is ours alone, so that kernels run in it whoever has imported Taichi."""
    _taichi_thread.own_this_process()
