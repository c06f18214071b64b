"""The binary form in which meshes and moving frames go to an editor; little endian, everything aligned to 4 bytes.

A mesh is the length of a JSON header (u32), the header, and the arrays that it names. A preview is a chain of records:
type (u8), three zero bytes, length of the payload (u32), payload.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.forces import STROKE_KINDS, Particles, all_particles
from ...physics.motion import layer_order
from ...physics.rig import lead
from ...physics.scene import Scene
from .limits import MAX_SHOWN_PARTICLES
from .store import PreviewBodies

__all__ = ["END", "ERROR", "FRAME", "HEADER", "FrameEncoder", "encode_mesh", "record", "split_records"]

HEADER, FRAME, END, ERROR = range(4)
"""Types of records."""

FORMAT = 1
"""Version of both forms."""

_STEPS = 16_384  # of the longest side, so that 16 bits reach two sides in each direction
_MOST = 32_767
_ALIGNED = 4


def record(kind: int, payload: bytes | dict[str, Any]) -> bytes:
    """One record; a payload that is an object goes as JSON."""
    data = json.dumps(payload).encode() if isinstance(payload, dict) else payload
    return struct.pack("<B3xI", kind, len(data)) + data + bytes(-len(data) % _ALIGNED)


def split_records(data: bytes) -> list[tuple[int, bytes]]:
    """Type and payload of each record of a whole stream; what is cut off at the end is left out."""
    records, at = [], 0
    while at + 8 <= len(data):
        kind, length = struct.unpack_from("<B3xI", data, at)
        if at + 8 + length > len(data):
            break
        records.append((kind, data[at + 8 : at + 8 + length]))
        at += 8 + length + (-length % _ALIGNED)
    return records


def encode_mesh(stored: PreviewBodies) -> bytes:
    """The rest shape of all bodies: positions body after body, triangles from back to front."""
    bodies = stored.bodies
    starts = np.cumsum([0] + [len(body.mesh.vertices) for body in bodies])
    order = layer_order(bodies)
    ends = np.cumsum([len(bodies[number].mesh.triangles) for number in order])
    firsts = np.concatenate([[0], ends[:-1]])
    arrays = {
        "positions": np.concatenate([body.mesh.vertices for body in bodies]).astype("<f4"),
        "triangles": np.concatenate([bodies[n].mesh.triangles + starts[n] for n in order]).astype("<u4"),
        "bodies": np.column_stack([firsts, ends]).astype("<u4"),
    }
    header = {
        "version": FORMAT,
        "width": bodies[0].mesh.width,
        "height": bodies[0].mesh.height,
        "arrays": [{"name": name, "dtype": str(a.dtype), "shape": list(a.shape)} for name, a in arrays.items()],
        "names": [bodies[number].name for number in order],
    }
    text = json.dumps(header).encode()
    padding = bytes(-len(text) % _ALIGNED)
    return struct.pack("<I", len(text)) + text + padding + b"".join(array.tobytes() for array in arrays.values())


class FrameEncoder:
    """Frames of one scene as payloads of records.

    Attributes:
        unit: px in one step of the 16-bit numbers.
    """

    def __init__(self, scene: Scene, *, frames: int, first_frame: int = 0) -> None:
        """
        Args:
            scene: what is simulated; periodic where it loops.
            frames: how many frames there are.
            first_frame: number that frame 0 has in the time of the strokes.
        """
        self.unit = max(scene.width, scene.height) / _STEPS
        self._scene, self._first = scene, first_frame
        self._rest = np.concatenate([body.mesh.vertices for body in scene.bodies])
        times = np.arange(frames) / scene.frame_rate
        self._leads = [_led(point.position, lead(point.motion, point.position, times)) for point in scene.rig_points]

    def header(self, *, frames: int, points: Sequence[int] | None = None) -> dict[str, Any]:
        """The first record's payload.

        Args:
            frames: how many frames there are.
            points: the number that each rig point has in the editor's document, -1 for none; None where they are the
                same.
        """
        return {
            "version": FORMAT,
            "frames": frames,
            "frame_rate": self._scene.frame_rate,
            "vertices": len(self._rest),
            "rig_points": len(self._leads),
            "points": list(range(len(self._leads))) if points is None else list(points),
            "unit": self.unit,
            "loop": self._scene.loop is not None,
        }

    def frame(self, number: int, positions: NDArray[np.float32]) -> tuple[bytes, float]:
        """The payload of a frame, and its largest displacement [px].

        Args:
            number: of the frame.
            positions: of every vertex [px], shape [v, 2].
        """
        displacement = positions - self._rest
        anchors = np.array([led[number] for led in self._leads]).reshape(-1, 2)
        shown = self._particles(number)
        payload = [struct.pack("<I", number), self._steps(displacement), self._steps(anchors)]
        payload += [struct.pack("<I", len(shown)), shown.tobytes()]
        return b"".join(payload), float(np.abs(displacement).max(initial=0.0))

    def _particles(self, number: int) -> NDArray[np.int16]:
        group = all_particles(self._scene.strokes, (self._first + number) / self._scene.frame_rate)
        return _rows(group, self.unit)[:: max(1, -(-len(group.kind) // MAX_SHOWN_PARTICLES))]

    def _steps(self, lengths: NDArray[np.floating]) -> bytes:
        finite = np.nan_to_num(lengths / self.unit, nan=0.0, posinf=_MOST, neginf=-_MOST)
        return np.rint(finite).clip(-_MOST, _MOST).astype("<i2").tobytes()


def _led(position: tuple[float, float], led: Any) -> NDArray[np.float64]:
    """Displacement of the rig point itself, M X + d, shape [n, 2]."""
    linear, offset = led.coefficients[:, :4].reshape(-1, 2, 2), led.coefficients[:, 4:]
    return np.asarray(linear @ np.array(position) + offset)


def _rows(group: Particles, unit: float) -> NDArray[np.int16]:
    """x, y and radius in steps, and the kind, of each particle within reach of 16 bits, shape [p, 4]."""
    columns = np.column_stack([group.position / unit, group.radius / unit, group.kind % len(STROKE_KINDS)])
    near = (np.abs(columns[:, :2]) <= _MOST).all(axis=1)
    return np.asarray(np.rint(columns[near]).clip(-_MOST, _MOST).astype("<i2"))
