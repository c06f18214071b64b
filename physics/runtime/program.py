"""Taichi's start and end: imported and initialised without a sound, whatever the environment says to others."""

from __future__ import annotations

import ctypes
import inspect
import os
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import CodeType, FrameType
from typing import Any

from .cache_folder import KernelCache

__all__ = ["end_program", "import_taichi", "is_initialising", "new_program", "program_of"]

_QUIET = {"ENABLE_TAICHI_HEADER_PRINT": "0", "TI_SKIP_VERSION_CHECK": "ON"}


def import_taichi() -> Any:
    """The module, imported without its banner."""
    _name_import_machinery()
    with _environment():
        import taichi

    return taichi


def new_program(ti: Any, cache: KernelCache) -> Any:
    """Initialise Taichi on this thread, and return its program."""
    quiet = {} if cache.usable else {"log_level": "error"}  # it would warn that it cannot keep kernels
    with _environment(), _without_announcement(ti.lang.misc):
        ti.init(
            arch=ti.cpu,
            offline_cache=cache.usable,
            offline_cache_file_path=cache.folder,
            fast_math=False,
            real_matrix_scalarize=False,
            make_cpu_multithreading_loop=False,
            **quiet,
        )
    return program_of(ti)


def end_program(reset: Any, program: Any, cache: KernelCache) -> None:
    """End a program by Taichi's ``reset``, which writes what it has compiled; leave it unended where that would fail.

    Taichi cannot end its program without its folder, and would end the process instead.
    """
    try:
        os.makedirs(cache.folder, exist_ok=True)
        with _environment():
            reset()
    except (OSError, RuntimeError):
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(program))  # so that it is never ended
        with suppress(AttributeError):
            sys.modules["taichi"].lang.impl.get_runtime().prog = None


def program_of(ti: Any) -> Any:
    """The program that lives in this process, None if there is none."""
    return ti.lang.impl.get_runtime().prog


def is_initialising(ti: Any) -> bool:
    """Whether another thread is inside Taichi's initialisation."""
    this, code = threading.get_ident(), ti.init.__code__
    return any(_is_inside(code, frame) for ident, frame in sys._current_frames().items() if ident != this)


def _is_inside(code: CodeType, frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code is code:
            return True
        frame = frame.f_back
    return False


def _name_import_machinery() -> None:
    """Tell ``inspect`` to which module the frames of the import machinery belong.

    Taichi asks for the source of such frames some hundred times while it is imported. Each time ``inspect`` would look
    through all modules of the process, which takes seconds where a host has thousands.
    """
    known = getattr(inspect, "modulesbyfile", {})
    known.setdefault("<frozen importlib._bootstrap>", "_frozen_importlib")


@contextmanager
def _environment() -> Iterator[None]:
    """For a while no variable that chooses another backend, precision or folder for Taichi, no banner, and a HOME.

    Without HOME Taichi ends the process. With the variables it asks no server for new versions.
    """
    changed: dict[str, str | None] = {name: None for name in os.environ if name.upper().startswith("TI_")}
    changed |= _QUIET
    if sys.platform != "win32" and "HOME" not in os.environ:
        changed["HOME"] = os.sep
    before = {name: os.environ.get(name) for name in changed}
    _set_environment(changed)
    try:
        yield
    finally:
        _set_environment(before)


def _set_environment(values: dict[str, str | None]) -> None:
    for name, value in values.items():
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
