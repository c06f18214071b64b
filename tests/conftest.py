"""Loads this source tree as the package ``physanimator``, whatever its folder is called."""

from __future__ import annotations

import importlib.util
import os
import signal
import sys
from contextlib import suppress
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

if "PYTEST_XDIST_WORKER" in os.environ:  # one of several: threads of each would wait for those of the others
    os.environ.setdefault("OMP_NUM_THREADS", "1")


def _hear_signals() -> None:
    """Undo what ``nohup`` or a shell's ``&`` has done, or what tests start would ignore signals as well."""
    for name, usual in {
        "SIGINT": signal.default_int_handler,
        "SIGHUP": signal.SIG_DFL,
        "SIGTERM": signal.SIG_DFL,
    }.items():
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) == signal.SIG_IGN:
            with suppress(ValueError):  # only the main thread may
                signal.signal(number, usual)


def _load_package() -> None:
    if "physanimator" in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(
        "physanimator", ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["physanimator"] = module
    spec.loader.exec_module(module)


if "pytest" in sys.modules:
    _hear_signals()
_load_package()
