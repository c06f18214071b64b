"""Masks that were made regular last are kept: meshes are made from them first, and layers are cut along them later.

What is kept is bounded; picture and mask decide by their contents whether it is the same.
"""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["KEPT_BYTES", "KeptMasks"]

FloatImage = NDArray[np.float32]

KEPT_BYTES = 128 * 2**20
"""What is kept at most [bytes]."""


class KeptMasks:
    """Results of a function of a picture and a mask, the latest ones first; usable from several threads."""

    def __init__(self, make: Callable[[FloatImage, FloatImage], FloatImage], most_bytes: int = KEPT_BYTES) -> None:
        """
        Args:
            make: gives a mask; its result becomes read-only.
            most_bytes: what is kept at most.
        """
        self._make, self._most_bytes = make, most_bytes
        self._kept: OrderedDict[bytes, FloatImage] = OrderedDict()
        self._lock = threading.Lock()

    def __call__(self, image: FloatImage, mask: FloatImage) -> FloatImage:
        """The result for a picture, shape [h, w, c], and a mask, shape [h, w]; read-only."""
        key = _digest(image, mask)
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
                return self._kept[key]
        made = self._make(image, mask)
        made.setflags(write=False)
        with self._lock:
            self._kept[key] = made
            while sum(each.nbytes for each in self._kept.values()) > self._most_bytes:
                self._kept.popitem(last=False)
        return made


def _digest(*arrays: NDArray[Any]) -> bytes:
    digest = hashlib.blake2b(digest_size=20)
    for array in arrays:
        digest.update(f" {array.dtype} {array.shape} ".encode())
        digest.update(np.ascontiguousarray(array).data)
    return digest.digest()
