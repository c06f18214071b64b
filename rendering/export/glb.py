"""Binary glTF files: arrays and pictures in one buffer, and the document that says what they are.

Source: Khronos Group, "glTF 2.0 Specification" (2021), sections 3.6 and 4.
"""

from __future__ import annotations

import json
import struct
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, require

__all__ = ["Buffer", "glb"]

ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
"""What a part of the buffer is for: values of vertices, or numbers of them."""

_FLOAT, _UNSIGNED_SHORT, _UNSIGNED_INT = 5126, 5123, 5125
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3"}
_LARGEST_INDEX = 2**16 - 2  # the last one means something else in 16 bits
_MOST_BYTES = 2**32 - 1


class Buffer:
    """The one buffer of a file, filled part by part.

    Attributes:
        views: the parts, as the document lists them.
        accessors: the arrays, as the document lists them.
    """

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self.size = 0
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def floats(self, values: NDArray[np.floating], *, target: int | None = None, bounds: bool = False) -> int:
        """Add numbers, shape [n] or [n, 2 or 3]; gives the number of the accessor.

        Args:
            values: the numbers.
            target: what they are for.
            bounds: whether the document tells the least and the largest.
        """
        array = np.ascontiguousarray(values, dtype="<f4")
        array = array[:, None] if array.ndim == 1 else array
        accessor = {"componentType": _FLOAT, "count": len(array), "type": _TYPES[array.shape[1]]}
        if bounds:
            accessor |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
        return self._accessor(array.tobytes(), accessor, target)

    def indices(self, triangles: NDArray[np.integer]) -> int:
        """Add triangles, shape [t, 3]; gives the number of the accessor."""
        short = int(triangles.max(initial=0)) <= _LARGEST_INDEX
        array = np.ascontiguousarray(triangles, dtype="<u2" if short else "<u4")
        kind = _UNSIGNED_SHORT if short else _UNSIGNED_INT
        accessor = {"componentType": kind, "count": array.size, "type": "SCALAR"}
        return self._accessor(array.tobytes(), accessor, ELEMENT_ARRAY_BUFFER)

    def png(self, pixels: NDArray[np.uint8]) -> int:
        """Add a picture, straight RGBA, shape [h, w, 4]; gives the number of its view."""
        written, data = cv2.imencode(".png", cv2.cvtColor(pixels, cv2.COLOR_RGBA2BGRA))
        if not written:
            raise InvalidInputError(f"a picture of {pixels.shape[1]} x {pixels.shape[0]} px cannot be written as PNG")
        return self._view(data.tobytes(), None)

    def data(self) -> bytes:
        """All of it."""
        return b"".join(self._parts)

    def _accessor(self, data: bytes, accessor: dict[str, Any], target: int | None) -> int:
        self.accessors.append({"bufferView": self._view(data, target)} | accessor)
        return len(self.accessors) - 1

    def _view(self, data: bytes, target: int | None) -> int:
        view: dict[str, Any] = {"buffer": 0, "byteOffset": self.size, "byteLength": len(data)}
        self.views.append(view | ({} if target is None else {"target": target}))
        padded = data + b"\0" * (-len(data) % 4)
        self._parts.append(padded)
        self.size += len(padded)
        return len(self.views) - 1


def glb(document: dict[str, Any], buffer: Buffer) -> bytes:
    """A whole file.

    Args:
        document: without buffers, views and accessors.
        buffer: what the document refers to.

    Raises:
        InvalidInputError: it would be larger than such a file can be.
    """
    whole = document | {
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": buffer.size}],
    }
    text = json.dumps(whole, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + buffer.size
    require("the .glb file", f"{size / 2**30:.1f} GiB", size <= _MOST_BYTES, "of less than 4 GiB")
    head = struct.pack("<4sIIII", b"glTF", 2, size, len(text), 0x4E4F534A)
    return head + text + struct.pack("<II", buffer.size, 0x004E4942) + buffer.data()
