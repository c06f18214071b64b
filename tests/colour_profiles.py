"""ICC profiles written by hand, for files that tests make."""

from __future__ import annotations

import itertools
import struct

__all__ = ["grey_profile", "rgb_profile", "table_profile"]

P3 = ((0.5151, 0.2412, -0.0011), (0.2919, 0.6922, 0.0419), (0.1572, 0.0666, 0.7841))
"""Display P3: XYZ at D50 of its red, green and blue."""


def rgb_profile(gamma: float, colours: tuple[tuple[float, ...], ...] = P3, name: str = "wide") -> bytes:
    """A profile of three primaries and a power."""
    curve = b"curv" + bytes(4) + struct.pack(">IH", 1, round(gamma * 256)) + bytes(2)
    tags = {channel + b"TRC": curve for channel in (b"r", b"g", b"b")}
    for channel, colour in zip((b"r", b"g", b"b"), colours, strict=True):
        tags[channel + b"XYZ"] = _xyz(*colour)
    return _profile(b"RGB ", b"XYZ ", tags, name)


def grey_profile(gamma: float) -> bytes:
    """A profile for greyscale whose curve is a power, sampled."""
    samples = [round(65535 * (k / 1023) ** gamma) for k in range(1024)]
    curve = b"curv" + bytes(4) + struct.pack(">I1024H", 1024, *samples)
    return _profile(b"GRAY", b"XYZ ", {b"kTRC": curve}, "grey")


def table_profile() -> bytes:
    """A profile of tables, as scanners have them: dull colours."""
    head = b"mft1" + bytes(4) + bytes([3, 3, 2, 0]) + struct.pack(">9i", *(65536 * (k % 4 == 0) for k in range(9)))
    straight = bytes(range(256)) * 3
    corners = itertools.product((0, 1), repeat=3)
    table = bytes(v for r, g, b in corners for v in (85 * (r + g + b), 128 + 40 * (r - g), 128 + 40 * (g - b)))
    return _profile(b"RGB ", b"Lab ", {b"A2B0": head + straight + table + straight}, "scanner")


def _xyz(x: float, y: float, z: float) -> bytes:
    return b"XYZ " + bytes(4) + struct.pack(">3i", *(round(each * 65536) for each in (x, y, z)))


def _profile(space: bytes, between: bytes, tags: dict[bytes, bytes], name: str) -> bytes:
    text = name.encode() + b"\0"
    tags = {b"desc": b"desc" + bytes(4) + struct.pack(">I", len(text)) + text + bytes(79),
            b"cprt": b"text" + bytes(4) + b"none\0", b"wtpt": _xyz(0.9642, 1.0, 0.8249), **tags}  # fmt: skip
    entries, data, start = b"", b"", 132 + 12 * len(tags)
    for tag, value in tags.items():
        entries += struct.pack(">4sII", tag, start + len(data), len(value))
        data += value + bytes(-len(value) % 4)
    device = b"scnr" if b"A2B0" in tags else b"mntr"
    head = struct.pack(">I4sI4s4s4s", start + len(data), bytes(4), 0x02400000, device, space, between)
    head += bytes(12) + b"acsp" + bytes(28) + struct.pack(">3i", 63190, 65536, 54061)
    return head.ljust(128, b"\0") + struct.pack(">I", len(tags)) + entries + data
