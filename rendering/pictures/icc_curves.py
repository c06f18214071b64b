"""ICC profiles that are a curve for each channel and a matrix, read from their bytes.

Source: ICC.1:2022, "Image technology colour management", sections 7.3 (tag table), 10.6 (curveType), 10.18
(parametricCurveType) and F.3 (three-component matrix-based profiles).
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["CurvesAndMatrix", "curves_and_matrix"]

_HEADER = 128
_MOST_TAGS = 200
_CHANNELS = (b"r", b"g", b"b")
_LEVELS = 65536


@dataclass(frozen=True, eq=False)
class CurvesAndMatrix:
    """What a profile makes of its colours.

    Attributes:
        curves: light for each value of a channel, from 0 to 1, three arrays of shape [65536]; alike for grey.
        matrix: from the light of the channels to the colour space between profiles (XYZ at D50), shape [3, 3].
        grey: whether it is for pictures without colours, which need no matrix.
    """

    curves: tuple[NDArray[np.float32], ...]
    matrix: NDArray[np.float64]
    grey: bool


def curves_and_matrix(profile: bytes) -> CurvesAndMatrix | None:
    """What a profile is made of; None for those of tables, of other colours than RGB and grey, and for damaged ones."""
    try:
        return _read(profile)
    except (struct.error, ValueError, IndexError, KeyError, OverflowError):
        return None


def _read(profile: bytes) -> CurvesAndMatrix | None:
    tags = _tags(profile)
    space, between = profile[16:20], profile[20:24]
    if profile[36:40] != b"acsp" or between != b"XYZ " or b"A2B0" in tags:
        return None
    if space == b"GRAY":
        return CurvesAndMatrix((_curve(tags[b"kTRC"]),) * 3, np.eye(3), grey=True)
    if space != b"RGB ":
        return None
    columns = [_xyz(tags[channel + b"XYZ"]) for channel in _CHANNELS]
    curves = tuple(_curve(tags[channel + b"TRC"]) for channel in _CHANNELS)
    return CurvesAndMatrix(curves, np.array(columns).T, grey=False)


def _tags(profile: bytes) -> Mapping[bytes, bytes]:
    (count,) = struct.unpack_from(">I", profile, _HEADER)
    if count > _MOST_TAGS:
        raise ValueError("too many tags")
    tags = {}
    for number in range(count):
        name, start, size = struct.unpack_from(">4sII", profile, _HEADER + 4 + 12 * number)
        tags[name] = profile[start : start + size]
    return tags


def _xyz(tag: bytes) -> list[float]:
    if tag[:4] != b"XYZ ":
        raise ValueError("no colour")
    return [each / 65536 for each in struct.unpack_from(">3i", tag, 8)]


def _curve(tag: bytes) -> NDArray[np.float32]:
    values = np.arange(_LEVELS) / (_LEVELS - 1)
    if tag[:4] == b"para":
        light = _parametric(tag, values)
    elif tag[:4] == b"curv":
        light = _sampled(tag, values)
    else:
        raise ValueError("no curve")
    if not np.isfinite(light).all():
        raise ValueError("no numbers")
    return np.clip(light, 0, 1).astype(np.float32)


def _sampled(tag: bytes, values: NDArray[np.float64]) -> NDArray[np.float64]:
    (count,) = struct.unpack_from(">I", tag, 8)
    if count == 0:
        return values
    if count == 1:
        return np.asarray(values ** (struct.unpack_from(">H", tag, 12)[0] / 256))
    samples = np.frombuffer(tag, ">u2", count, 12) / 65535
    return np.interp(values, np.linspace(0, 1, count), samples)


def _parametric(tag: bytes, x: NDArray[np.float64]) -> NDArray[np.float64]:
    """(a x + b)^g + e above d, c x + f below; the forms with fewer numbers leave out the last ones."""
    (kind,) = struct.unpack_from(">H", tag, 8)
    given = [each / 65536 for each in struct.unpack_from(f">{(1, 3, 4, 5, 7)[kind]}i", tag, 12)]
    g, a, b, c, d, e, f = 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if kind == 0:
        (g,) = given
    elif kind in (1, 2):
        g, a, b = given[:3]
        d = -b / a if a else 0.0
        e = f = given[3] if kind == 2 else 0.0
    else:
        g, a, b, c, d = given[:5]
        e, f = given[5:] if kind == 4 else (0.0, 0.0)
    return np.where(x >= d, np.maximum(a * x + b, 0) ** g + e, c * x + f)
