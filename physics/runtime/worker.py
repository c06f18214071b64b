"""A process of our own for kernels: where another part of this one uses Taichi, or this one has to answer meanwhile.

It is started anew from the interpreter, so that nothing of the host's main module runs in it, and reads its work from
its standard input: when that is closed, which happens however this process ends, it ends as well.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import weakref
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import PhysAnimatorError
from ..linear_algebra import THREADS_OF_ALGEBRA
from .worker_pipe import receive, send

__all__ = ["TaichiWorker"]

_Key = tuple[Any, ...]

_ENDED = (
    "The process in which PhysAnimator simulates has ended before its work was done (exit code {code}); start the"
    " simulation again"
)
_LAST_SECONDS = 30.0  # that it is given to write its kernels to disk
_INTERPRETERS = ("py", "hython")  # python.exe, python3.12, pypy, mayapy; not a host that has Python built in
# The package gets its parent's name, whatever that is, so that what is pickled there is found here. The root module is
# left empty: a host's entry points have nothing to do here.
_PROGRAM = """\
import sys
sys.path[:] = [folder for folder in sys.path if folder]
import json
given = json.loads(sys.argv[1])
sys.path[:] = given["path"]
import importlib, types
package = types.ModuleType(given["package"])
package.__path__ = [given["folder"]]
sys.modules[given["package"]] = package
importlib.import_module(given["package"] + ".physics.runtime.worker_process").serve()
"""


class TaichiWorker:
    """The process; to be used by one thread at a time.

    It keeps what a simulation reads in all its launches, with what it notes there, as long as that lives here.
    """

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._kept: dict[_Key, list[weakref.ref[Any]]] = {}
        self._lost: set[_Key] = set()  # kept by a process that has ended
        self._gone: deque[_Key] = deque()  # what no longer lives here

    def launch(self, function: Callable[..., Any], constant: Any, state: Any, arguments: tuple[Any, ...]) -> Any:
        """Call a module-level function there; arrays of ``state`` are changed here as they were there.

        Raises:
            PhysAnimatorError: there is no process, or it has ended since the first launch with this constant.
        """
        self.start()
        forgotten = self._forget()
        leaves = list(_leaves(constant))
        key = tuple(id(leaf) if isinstance(leaf, np.ndarray) else leaf for leaf in leaves)
        if key in self._lost:
            raise PhysAnimatorError(_ENDED.format(code="unknown"))
        known = key in self._kept
        if not known:
            gone = partial(_note, self._gone, key)
            self._kept[key] = [weakref.ref(leaf, gone) for leaf in leaves if isinstance(leaf, np.ndarray)]
        sent = key, None if known else constant
        result, changed = self._answer(("launch", function, sent, forgotten, state, arguments))
        for array, values in zip(state or (), changed or (), strict=True):
            array[...] = values
        return result

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """What a module-level function returns there, called outside of Taichi's thread.

        Raises:
            PhysAnimatorError: as ``launch``.
        """
        self.start()
        return self._answer(("call", function, arguments))[0]

    def end_idle(self) -> None:
        """End the process, if no simulation needs it any more."""
        self._forget()
        if not self._kept:
            self.close()

    def _forget(self) -> list[_Key]:
        forgotten = []
        while self._gone:
            key = self._gone.popleft()
            self._lost.discard(key)
            if self._kept.pop(key, None) is not None:
                forgotten.append(key)
        return forgotten

    def keep_compiled(self) -> bool:
        """Let the process write what it has compiled to disk."""
        self.start()
        return bool(self._answer(("keep",))[0])

    def close(self) -> None:
        """End the process, if there is one."""
        process, self._process = self._process, None
        self._lost.update(self._kept)
        if process is None:
            return
        for pipe in (process.stdin, process.stdout):
            with suppress(OSError):
                pipe.close()  # type: ignore[union-attr]
        try:
            process.wait(_LAST_SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def kill(self) -> None:
        """End the process, if there is one, whatever it does; the only method for another thread than the one."""
        process = self._process
        if process is not None:
            process.kill()

    def start(self) -> None:
        """Start the process unless it runs.

        Raises:
            PhysAnimatorError: it cannot be started.
        """
        if self._process is not None and self._process.poll() is None:
            return
        self.close()
        self._process = _start()
        try:
            ready = receive(self._process.stdout)  # type: ignore[arg-type]
        except EOFError:
            ready = "it ended at once"
        if ready != "ready":
            self.close()
            raise PhysAnimatorError(
                "Another extension uses Taichi in this process, so the simulation needs a process of its own, which"
                f" could not be started from {sys.executable}. Got: {ready}"
            )

    def _answer(self, message: tuple[Any, ...]) -> tuple[Any, Any]:
        process = self._process
        assert process is not None
        try:
            send(process.stdin, message)  # type: ignore[arg-type]
            answer = receive(process.stdout)  # type: ignore[arg-type]
        except (OSError, EOFError, ValueError):
            self.close()
            raise PhysAnimatorError(_ENDED.format(code=process.returncode)) from None
        except BaseException:  # half a message: nothing can follow it
            self.close()
            raise
        kind, result, changed = answer
        if kind == "error":
            raise result
        return result, changed


def _leaves(value: Any) -> Iterator[Any]:
    """The arrays and numbers in nested tuples."""
    if isinstance(value, tuple):
        for each in value:
            yield from _leaves(each)
    else:
        yield value


def _note(gone: deque[_Key], key: _Key, _reference: Any) -> None:
    gone.append(key)


def _start() -> subprocess.Popen[bytes]:
    name = os.path.basename(sys.executable or "").lower()
    if getattr(sys, "frozen", False) or not any(part in name for part in _INTERPRETERS):
        raise PhysAnimatorError(
            "Another extension uses Taichi in this process, of which there can be only one, and there is no Python"
            f" interpreter with which to start another process; run PhysAnimator without it. Got: {name or 'none'}"
        )
    given = {
        "package": __package__.rpartition(".physics.")[0],
        "folder": str(Path(__file__).resolve().parents[2]),
        "path": [os.path.abspath(folder) for folder in sys.path],
    }
    try:
        return subprocess.Popen(
            [sys.executable, "-c", _PROGRAM, json.dumps(given)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={THREADS_OF_ALGEBRA: "1", **os.environ},
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
    except OSError as error:
        raise PhysAnimatorError(
            "Another extension uses Taichi in this process, so the simulation needs a process of its own, which could"
            f" not be started. Got: {error}"
        ) from None
