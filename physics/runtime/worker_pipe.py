"""Messages between two processes of ours: pickled, with the memory of arrays beside it, copied once.

Both ends are this package's, started one by the other; nothing else is ever read with this.
"""

from __future__ import annotations

import pickle
import struct
from typing import IO, Any

import numpy as np

from .alignment import aligned

__all__ = ["receive", "send"]

_HEAD = struct.Struct("<QQ")


def send(pipe: IO[bytes], message: object) -> None:
    """
    Raises:
        OSError: the other end is gone.
    """
    buffers: list[pickle.PickleBuffer] = []
    body = pickle.dumps(message, protocol=5, buffer_callback=buffers.append)
    parts = [buffer.raw() for buffer in buffers]
    pipe.write(_HEAD.pack(len(body), len(parts)))
    pipe.write(struct.pack(f"<{len(parts)}Q", *(part.nbytes for part in parts)))
    pipe.write(body)
    for part in parts:
        pipe.write(part)
    pipe.flush()


def receive(pipe: IO[bytes]) -> Any:
    """The next message; its arrays can be changed, and lie where kernels can load vectors from.

    Raises:
        EOFError: the other end is gone.
    """
    length, count = _HEAD.unpack(_exactly(pipe, _HEAD.size))
    sizes = struct.unpack(f"<{count}Q", _exactly(pipe, 8 * count))
    body = _exactly(pipe, length)
    return pickle.loads(body, buffers=[_exactly(pipe, size) for size in sizes])


def _exactly(pipe: IO[bytes], size: int) -> memoryview:
    room = memoryview(aligned((size,), np.uint8))  # type: ignore[arg-type]
    done = 0
    while done < size:
        got = pipe.readinto(room[done:])  # type: ignore[attr-defined]
        if not got:
            raise EOFError
        done += got
    return room
