"""Taichi on a thread of its own, so that it can live in somebody else's process.

Taichi binds its program to the thread that initialised it, keeps one program for the whole process, and drops it
when anybody calls ``ti.init`` again. Here one daemon thread does it all: it imports and initialises Taichi when the
first job arrives, runs every kernel, and initialises again when another part of the process has replaced the program.
Kernels take arrays only, never Taichi fields, whose memory would go with the program.

Taichi holds Python's global lock while a kernel runs: nothing can replace the program in the middle of a kernel,
and a long kernel stops every other thread, so callers keep their launches to some tens of milliseconds.
"""

from __future__ import annotations

import atexit
import inspect
import os
import queue
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from types import CodeType, FrameType
from typing import Any, ParamSpec, TypeVar, cast

from .errors import PhysAnimatorError
from .taichi_reading import quick_reading

__all__ = ["compiled", "keep_compiled", "run"]

P = ParamSpec("P")
T = TypeVar("T")

_POLL_SECONDS = 0.2
_PATIENCE = 1000  # hundredths of a second
_LAST_SECONDS = 30.0  # that the end of the process waits for a kernel which still runs: some 15 ms on an idle machine
_WORTH_KEEPING = 0.25  # seconds of compiling: kernels that were on disk already take some hundredths to read
_QUIET = {"ENABLE_TAICHI_HEADER_PRINT": "0", "TI_SKIP_VERSION_CHECK": "ON"}


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
        self._program: Any = None
        self._kernels: dict[Callable[[Any], Any], Any] = {}
        self._closed = False
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
        taichi = self._initialised()
        self._during_job.enter_context(quick_reading())
        if build not in self._kernels:
            self._kernels[build] = build(taichi)
        return cast(T, self._kernels[build])

    def _start(self) -> None:
        with self._starting:
            if self._thread is None:
                self._process = os.getpid()
                atexit.register(self._finish)
                self._thread = threading.Thread(target=self._work, name="physanimator-taichi", daemon=True)
                self._thread.start()
        if self._process != os.getpid():
            raise PhysAnimatorError(
                "Taichi cannot run in a forked process whose parent has used it; start the process with 'spawn'"
            )

    def _finish(self) -> None:
        """At the end of the process, close our program: only then does Taichi keep the compiled kernels on disk."""
        if self._process == os.getpid():
            job = _Job(self._close)
            self._jobs.put(job)
            job.done.wait(_LAST_SECONDS)

    def _close(self) -> None:
        self._closed = True
        if self._is_ours():
            self._drop()

    def keep_compiled(self) -> bool:
        if not self._is_ours() or self._program.get_total_compilation_time() < _WORTH_KEEPING:
            return False
        self._drop()
        return True

    def _is_ours(self) -> bool:
        return self._program is not None and self._taichi.lang.impl.get_runtime().prog is self._program

    def _drop(self) -> None:
        """End our program, which writes what it has compiled to disk."""
        self._kernels.clear()
        self._program = None
        self._taichi.reset()

    def _work(self) -> None:
        while True:
            job = self._jobs.get()
            with ExitStack() as self._during_job:
                job.execute()
            del job  # the arrays of a finished job must not live until the next one

    def _initialised(self) -> Any:
        """Taichi with our program in place; kernels of a program that is gone are forgotten."""
        if self._closed:  # a program that is made while the process ends would end it with an abort
            raise PhysAnimatorError("Nothing more can be simulated: the process is ending")
        if self._taichi is None:
            _name_import_machinery()
            with _environment(_QUIET):
                import taichi

            self._taichi = taichi
        ti = self._taichi
        if self._program is None or ti.lang.impl.get_runtime().prog is not self._program:
            self._kernels.clear()
            self._program = None
            try:
                self._program = _new_program(ti)
            except Exception:  # somebody else's initialisation came in between
                self._program = _new_program(ti)
        return ti


def _new_program(ti: Any) -> Any:
    _let_others_finish(ti.init)
    with _environment(_QUIET), _without_announcement(ti.lang.misc):
        ti.init(
            arch=ti.cpu,
            offline_cache=_can_cache(ti),
            fast_math=False,
            real_matrix_scalarize=False,
            make_cpu_multithreading_loop=False,
        )
    return ti.lang.impl.get_runtime().prog


def _name_import_machinery() -> None:
    """Tell ``inspect`` to which module the frames of the import machinery belong.

    Taichi asks for the source of such frames some hundred times while it is imported. Each time ``inspect`` would look
    through all modules of the process, which takes seconds where a host has thousands.
    """
    known = getattr(inspect, "modulesbyfile", {})
    known.setdefault("<frozen importlib._bootstrap>", "_frozen_importlib")


def _let_others_finish(function: Any) -> None:
    """Wait until no other thread is inside a function: two initialisations at once break each other."""
    this = threading.get_ident()
    for _ in range(_PATIENCE):
        others = [frame for ident, frame in sys._current_frames().items() if ident != this]
        if not any(_is_inside(function.__code__, frame) for frame in others):
            return
        time.sleep(0.01)


def _is_inside(code: CodeType, frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code is code:
            return True
        frame = frame.f_back
    return False


def _can_cache(ti: Any) -> bool:
    """Whether compiled kernels can be kept on disk; where they cannot, Taichi would fail on its way out."""
    folder = os.environ.get("TI_OFFLINE_CACHE_FILE_PATH") or ti.lang.impl.default_cfg().offline_cache_file_path
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError:
        return False
    return os.access(folder, os.W_OK)


@contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    """Environment variables for a while: no banner, and no question to Taichi's server about new versions."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


@contextmanager
def _without_announcement(module: Any) -> Iterator[None]:
    """Taichi announces its start with a plain print; hide it in that module alone, not on everybody's stdout."""
    module.print = lambda *_args, **_kwargs: None
    try:
        yield
    finally:
        del module.print


_taichi_thread = _TaichiThread()


def run(function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
    """Call a function on the Taichi thread, wait for it, and return or raise what it does.

    Any thread may call this at any time; jobs run one after the other. When the wait is interrupted, a job that has
    not begun is dropped and one that has begun runs to its end; neither disturbs later jobs.

    Raises:
        PhysAnimatorError: this process was forked from one that has used Taichi.
    """
    return _taichi_thread.run(lambda: function(*args, **kwargs))


def compiled(build: Callable[[Any], T]) -> T:
    """What ``build(taichi)`` returned, called once for each Taichi program; only inside a job of ``run``.

    Args:
        build: a module-level function that gets the taichi module and returns kernels.
    """
    return _taichi_thread.compiled(build)


def keep_compiled() -> bool:
    """Write kernels that were compiled in this process to Taichi's cache on disk, if there are any, and say so.

    Taichi writes them only where its program ends, and never in a process that a signal ends. So the program is ended
    between two jobs; the next one reads its kernels from disk, which takes half a second.
    """
    return _taichi_thread.run(_taichi_thread.keep_compiled)
