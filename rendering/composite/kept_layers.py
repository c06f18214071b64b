"""Illustrations that were taken apart last are kept: when only the motion has changed, nothing is taken apart anew.

What is kept is counted in bytes and bounded; the picture, the masks, the meshes and a given plate decide by their
contents whether it is the same.
"""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.mesh import TriangleMesh
from .layer import Layer
from .still_layers import StillLayer

__all__ = ["KEPT_BYTES", "KeptLayers", "apart"]

FloatImage = NDArray[np.float32]
Apart = tuple[FloatImage, list[Layer | StillLayer]]

KEPT_BYTES = 512 * 2**20
"""What is kept at most [bytes]."""

# However small they are.
_KEPT_PICTURES = 4


class KeptLayers:
    """Results of taking apart, the latest ones first; usable from several threads.

    Attributes:
        most_bytes: what is kept at most.
    """

    def __init__(self, most_bytes: int = KEPT_BYTES, most: int = _KEPT_PICTURES) -> None:
        """
        Args:
            most_bytes: what is kept at most; a larger result is not kept at all.
            most: how many results are kept at most.
        """
        self.most_bytes = most_bytes
        self._most = most
        self._kept: OrderedDict[bytes, tuple[Apart, int]] = OrderedDict()
        self._lock = threading.Lock()

    @property
    def size(self) -> int:
        """What is kept now [bytes]."""
        with self._lock:
            return sum(size for _, size in self._kept.values())

    def get(self, key: bytes, make: Callable[[], Apart]) -> Apart:
        """The result of a key; made, and kept where it fits, if it is not there.

        Args:
            key: of its inputs, see :func:`apart`.
            make: takes the picture apart. Its arrays become read-only.
        """
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
                return self._kept[key][0]
        made = make()
        background, layers = made
        arrays: list[NDArray[Any]] = [
            background,
            *(layer.texture for layer in layers),
            *(layer.mesh.rest for layer in layers if isinstance(layer, Layer)),
        ]
        for array in arrays:
            array.setflags(write=False)
        size = sum(array.nbytes for array in arrays)
        with self._lock:
            if size <= self.most_bytes:
                self._kept[key] = made, size
            while len(self._kept) > self._most or sum(each for _, each in self._kept.values()) > self.most_bytes:
                self._kept.popitem(last=False)
        return made

    def clear(self) -> None:
        """Keep nothing."""
        with self._lock:
            self._kept.clear()


_LAYERS = KeptLayers()


def apart(
    take_apart: Callable[..., Apart],
    picture: FloatImage,
    masks: Sequence[FloatImage],
    meshes: Sequence[TriangleMesh | None],
    *,
    plate: FloatImage | None,
    kept: KeptLayers = _LAYERS,
) -> Apart:
    """What ``take_apart`` gives for these inputs, from what is kept where it is there.

    Args:
        take_apart: :func:`~.cutting.take_apart` or :func:`~.sprite_layers.take_sprite_apart`.
        picture: see there, as are masks, meshes and plate.
        masks: one for each mesh.
        meshes: of the bodies, None for what stands still.
        plate: what is behind them, or None.
        kept: where results are kept.

    Returns:
        Background and layers; read-only.
    """
    arrays: list[NDArray[Any]] = [picture, *masks]
    arrays += [part for mesh in meshes if mesh is not None for part in (mesh.vertices, mesh.triangles)]
    arrays += [] if plate is None else [plate]
    moving = [mesh is not None for mesh in meshes]
    key = hashlib.blake2b(f"{take_apart.__name__} {moving} {plate is None}".encode(), digest_size=20)
    for array in arrays:
        key.update(f" {array.dtype} {array.shape} ".encode())
        key.update(np.ascontiguousarray(array).data)
    return kept.get(key.digest(), lambda: take_apart(picture, masks, meshes, plate=plate))
