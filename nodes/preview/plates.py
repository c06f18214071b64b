"""Clean plates for the scene editor, made when first asked for: it takes seconds, for which no queue should wait."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from collections import OrderedDict
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from .store import PreviewBodies

__all__ = ["Plates", "png_of"]

_MOST = 16
_FAST = [16, 1]  # cv2.IMWRITE_PNG_COMPRESSION


class Plates:
    """The last plates as PNG files; one is made at a time, and each only once however many ask."""

    def __init__(self) -> None:
        self._made: OrderedDict[str, asyncio.Task[bytes]] = OrderedDict()
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="physanimator-plate", initializer=_give_way)

    async def png(self, stored: PreviewBodies) -> bytes:
        """The plate of bodies that have a picture, as a PNG file.

        Raises:
            InvalidInputError: the bodies leave too little of the picture to fill the rest with.
        """
        task = self._made.get(stored.picture_key)
        if task is None or (task.done() and (task.cancelled() or task.exception() is not None)):
            task = asyncio.ensure_future(self._make(stored))
            self._made[stored.picture_key] = task
        self._made.move_to_end(stored.picture_key)
        while len(self._made) > _MOST:
            self._made.popitem(last=False)
        return await asyncio.shield(task)  # whoever goes away must not stop it for the others

    def close(self) -> None:
        """Let the thread end once it has nothing to do."""
        self._thread.shutdown(wait=False)

    async def _make(self, stored: PreviewBodies) -> bytes:
        return await asyncio.get_running_loop().run_in_executor(self._thread, _png_of, stored)


def _give_way() -> None:
    """Let previews have the processor first: somebody draws while a plate is made."""
    if sys.platform == "linux":  # where threads have priorities of their own
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), 10)


def _png_of(stored: PreviewBodies) -> bytes:
    import cv2

    from ...rendering.composite import sprite_plate
    from ...rendering.pictures import as_float, as_uint8
    from ...rendering.plate import clean_plate

    if stored.picture is None or stored.hole is None:
        raise InvalidInputError("the illustration must be connected to image. Got: none")
    if stored.picture.shape[2] == 4:
        plate = as_uint8(sprite_plate(as_float(stored.picture), as_float(stored.hole)))[..., [2, 1, 0, 3]]
    else:
        plate = clean_plate(stored.picture, stored.hole)[..., ::-1]
    return bytes(cv2.imencode(".png", plate, _FAST)[1])


def png_of(pixels: NDArray[np.uint8]) -> bytes:
    """RGBA pixels as a PNG file, uint8, shape [h, w, 4]."""
    import cv2

    return bytes(cv2.imencode(".png", np.ascontiguousarray(pixels[..., [2, 1, 0, 3]]), _FAST)[1])
