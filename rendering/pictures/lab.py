"""Colours in CIE L*a*b*, in which equal steps look about equally large: float32, exact to rounding there and back.

OpenCV's own conversion of float32 pictures reads from a table and is wrong by more than a level of 8 bits.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

__all__ = ["lab_to_rgb", "rgb_to_lab"]

FloatImage = NDArray[np.float32]

# From linear sRGB to CIE XYZ over its white, D65 (IEC 61966-2-1): grey has no a and b.
_PRIMARIES = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.072175], [0.0193339, 0.119192, 0.9503041]]
)
_WHITE = _PRIMARIES.sum(axis=1, keepdims=True)
_TO_XYZ = (_PRIMARIES / _WHITE).astype(np.float32)
_TO_RGB = np.linalg.inv(_PRIMARIES / _WHITE).astype(np.float32)
_TO_LAB = np.array([[0, 116, 0], [500, -500, 0], [0, 200, -200]], np.float32)
_FROM_LAB = np.linalg.inv(_TO_LAB.astype(np.float64)).astype(np.float32)
_DARK, _SLOPE, _FOOT = np.float32(6 / 29), np.float32(841 / 108), np.float32(4 / 29)


def rgb_to_lab(picture: FloatImage) -> FloatImage:
    """L* 0 to 100, a* and b*, of sRGB in 0 to 1, shape [h, w, 3]."""
    rgb = np.clip(picture, 0, 1).astype(np.float32, copy=False)
    linear = np.where(
        rgb <= 0.04045, rgb / np.float32(12.92), cv2.pow((rgb + np.float32(0.055)) / np.float32(1.055), 2.4)
    )
    xyz = np.maximum(cv2.transform(linear, _TO_XYZ), 0)
    bent = np.where(xyz > _DARK**3, cv2.pow(xyz, 1 / 3), _SLOPE * xyz + _FOOT)
    lab = cv2.transform(bent.astype(np.float32, copy=False), _TO_LAB)
    lab[..., 0] -= 16
    return lab


def lab_to_rgb(lab: FloatImage) -> FloatImage:
    """The reverse; colours that sRGB has not are cut off at 0 and 1."""
    shifted = np.array(lab, np.float32)
    shifted[..., 0] += 16
    bent = cv2.transform(shifted, _FROM_LAB)
    xyz = np.where(bent > _DARK, bent * bent * bent, (bent - _FOOT) / _SLOPE)
    linear = np.clip(cv2.transform(xyz, _TO_RGB), 0, 1)
    curved = np.float32(1.055) * cv2.pow(linear, 1 / 2.4) - np.float32(0.055)
    return np.clip(np.where(linear <= 0.0031308, np.float32(12.92) * linear, curved), 0, 1).astype(
        np.float32, copy=False
    )
