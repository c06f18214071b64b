"""Bodies that previews can be made of, kept by their content while there is room."""

from __future__ import annotations

import hashlib
import json
import threading
from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...physics.document import LayerMasks, encode
from ...physics.scene import Body, Held
from ...rendering.layer_pictures import LayerPicture
from .limits import MAX_STORED_BYTES

__all__ = ["PreviewBodies", "PreviewStore"]

_SHARE_OF_DERIVED = 4  # a mesh keeps its edges, parts and the like beside its vertices and triangles


@dataclass(frozen=True, eq=False, repr=False)
class PreviewBodies:
    """What an editor draws on.

    Attributes:
        bodies: at least one, over a picture of one size.
        picture: the illustration, RGB or straight RGBA, uint8, shape [h, w, 3] or [h, w, 4]; None where there is none.
        hole: what moves in it, 0..255, uint8, shape [h, w]; None where there is no picture.
        layers: pictures of the layers that the bodies are, and of the others, from back to front; empty where masks
            cut the bodies out.
        layer_masks: gives the mask of a still layer by its name; None where there are no layers.
        layer_bytes: memory that it holds on to by that.
        attachments: where each body is found to be held; empty for "auto" everywhere.
    """

    bodies: tuple[Body, ...]
    picture: NDArray[np.uint8] | None = None
    hole: NDArray[np.uint8] | None = None
    layers: tuple[LayerPicture, ...] = ()
    layer_masks: LayerMasks | None = None
    layer_bytes: int = 0
    attachments: tuple[Held, ...] = ()

    @cached_property
    def key(self) -> str:
        """Hexadecimal digest that is equal for equal content."""
        digest = hashlib.sha256()
        for body in self.bodies:
            described = [body.mesh.content_hash, body.name, body.layer, encode(body.material)]
            digest.update(json.dumps(described).encode())
        digest.update(json.dumps(self.attachments).encode())
        digest.update(self.picture_key.encode())
        for layer in self.layers:
            digest.update(repr((layer.layer, layer.box, layer.blend, layer.pixels.shape)).encode())
            digest.update(np.ascontiguousarray(layer.pixels))
        return digest.hexdigest()

    @cached_property
    def picture_key(self) -> str:
        """The same for the picture and its hole alone."""
        digest = hashlib.sha256()
        for image in self._images:
            digest.update(repr(image.shape).encode())
            digest.update(image.tobytes())
        return digest.hexdigest()

    @cached_property
    def size(self) -> int:
        """Bytes of memory that it holds on to, about."""
        meshes = sum(body.mesh.vertices.nbytes + body.mesh.triangles.nbytes for body in self.bodies)
        shown = sum(layer.pixels.nbytes for layer in self.layers)
        return _SHARE_OF_DERIVED * meshes + sum(image.nbytes for image in self._images) + shown + self.layer_bytes

    @property
    def _images(self) -> list[NDArray[np.uint8]]:
        return [image for image in (self.picture, self.hole) if image is not None]


class PreviewStore:
    """Holds what was used last, up to a number of bytes; safe to use from any thread."""

    def __init__(self, *, max_bytes: int = MAX_STORED_BYTES) -> None:
        """
        Args:
            max_bytes: memory that the entries may take together; the one put last is kept however large it is.
        """
        self._max_bytes = max_bytes
        self._entries: OrderedDict[str, PreviewBodies] = OrderedDict()
        self._lock = threading.Lock()

    def put(self, bodies: PreviewBodies) -> str:
        """Keep bodies, forget those that there is no room for any more, and return the key."""
        key = bodies.key
        with self._lock:
            self._entries.setdefault(key, bodies)
            self._entries.move_to_end(key)
            while len(self._entries) > 1 and self._bytes() > self._max_bytes:
                self._entries.popitem(last=False)
        return key

    def get(self, key: str) -> PreviewBodies | None:
        """The bodies of a key, or None when they are not held any more."""
        with self._lock:
            if key in self._entries:
                self._entries.move_to_end(key)
            return self._entries.get(key)

    def __len__(self) -> int:
        return len(self._entries)

    @property
    def size(self) -> int:
        """Bytes that all entries hold."""
        with self._lock:
            return self._bytes()

    def _bytes(self) -> int:
        return sum(entry.size for entry in self._entries.values())
