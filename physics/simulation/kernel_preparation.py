"""Kernels compiled in a process of their own, for servers that have to answer meanwhile.

Taichi holds Python's global lock while it compiles: for ten seconds and more nothing else would run in this process.
What another process has compiled is read from disk, the kernels of bodies that do not touch in a fraction of a second.
That for contact takes seconds even then, so it also runs in a process of its own.
"""

from __future__ import annotations

import hashlib
import logging
import platform
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext, suppress
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from ..errors import PhysAnimatorError
from ..interruption import checkpoint
from ..runtime import TaichiWorker, kernel_cache, taichi_runtime
from ..solver import read_kernels
from ..threads import allowed_threads

__all__ = ["begin_aside", "compile_aside", "simulated_aside", "simulated_beside"]

_POLL_SECONDS = 0.05

_compiling: dict[bool, threading.Event] = {}
_starting = threading.Lock()


def compile_aside(*, contact: bool, check: Callable[[], None] = checkpoint) -> None:
    """See to it that what simulations need of kernels is on disk, where it can be; waits while it is compiled.

    Where nothing can be kept on disk, or no process can be started, kernels are compiled later, in this one.

    Args:
        contact: whether parts touch, for which there are other kernels.
        check: called meanwhile; may raise to wait no longer. The compiling goes on.
    """
    with _starting:
        done = _compiling.get(contact)
        if done is None:
            done = _compiling[contact] = threading.Event()
            threading.Thread(target=_compile, args=(contact, done), name="physanimator-compile", daemon=True).start()
    while not done.wait(_POLL_SECONDS):
        check()


def begin_aside() -> None:
    """Start the process in which ``simulated_beside`` simulates, and let it read its kernels; returns at once."""
    if allowed_threads() > 1:
        taichi_runtime.begin_aside(read_kernels)


def simulated_aside(*, contact: bool) -> AbstractContextManager[None]:
    """What is simulated meanwhile, in this thread, shall not keep others in this process from answering.

    Args:
        contact: whether parts touch.
    """
    return taichi_runtime.aside(contact)


def simulated_beside() -> AbstractContextManager[None]:
    """What is simulated meanwhile, in this thread, leaves the processor's other cores to this process's other threads.

    In this process, a kernel would hold Python's global lock; where it may use one thread only, nobody else needs that.
    """
    return taichi_runtime.aside(beside=True) if allowed_threads() > 1 else nullcontext()


def _compile(contact: bool, done: threading.Event) -> None:
    try:
        cache = kernel_cache()
        note = Path(cache.folder) / f"compiled-{_fingerprint()}{'-contact' if contact else ''}"
        if not cache.usable or note.exists() or not taichi_runtime.compiles_here():
            return
        worker = TaichiWorker()
        try:
            worker.call(_compile_here, contact)
        finally:
            worker.close()
        taichi_runtime.read_anew()
        with suppress(OSError):
            note.touch()
    except PhysAnimatorError as error:
        logging.info("PhysAnimator: kernels are compiled in this process, for want of another: %s", error)
    except Exception:
        logging.exception("PhysAnimator: kernels could not be compiled aside")
    finally:
        done.set()


def _compile_here(contact: bool) -> None:
    """Compile in the other process, which writes to disk what it has compiled at once."""
    from .sample_simulations import simulate_samples

    simulate_samples(contact=contact)
    taichi_runtime.keep_compiled()


@lru_cache(maxsize=1)
def _fingerprint() -> str:
    """Of everything that decides which kernels there are."""
    digest = hashlib.sha256(platform.machine().encode())
    with suppress(PackageNotFoundError):
        digest.update(version("taichi").encode())
    for source in sorted(Path(__file__).parents[1].rglob("*.py")):
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]
