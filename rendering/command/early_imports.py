"""Libraries that are imported while pictures are read: the processor's other cores have nothing to do then."""

from __future__ import annotations

import importlib
import threading
from contextlib import suppress

__all__ = ["begin_imports"]

_SLOW = ("scipy.sparse.linalg", "scipy.fft", "scipy.cluster.vq")


def begin_imports() -> None:
    """Import in another thread what masks, meshes and what is behind the parts will need; returns at once."""
    threading.Thread(target=_import, name="physanimator-imports").start()


def _import() -> None:
    for name in _SLOW:
        with suppress(ImportError):  # it is said where it is needed
            importlib.import_module(name)
