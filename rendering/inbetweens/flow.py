"""In-betweens along the optical flow that is seen between two keyframes, for clips whose motion is not known."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ..pictures import as_dtype, as_uint8, optical_flow
from ..sketch import forward_warp
from .backend import Clip, FloatImage, ModelFile

__all__ = ["FlowInterpolator"]

Way = tuple[FloatImage, FloatImage]
"""Flow from one keyframe to the other [px], and how surely each pixel is shown there too."""

# On parts drawn at both ends of a shift and a turn (4 to 16 px, 0 to 8 degrees), half and twice of _OCCLUSION, _STILL,
# _SAME and _AROUND change the in-between's PSNR by 0.2 dB at most, of _COMPARED by 1 dB: up or down with the motion.

# A pixel whose flow there and back ends this far from its start is probably hidden in the other keyframe [px].
_OCCLUSION = 2.0
# Flow below this is the noise of a still picture [px].
_STILL = 0.1
# What differs by no more than this, as far as this around it, has not moved [of 1], [px].
_SAME, _AROUND = 2.5 / 255, 8
# Both keyframes, brought to one time, are compared over so much of the picture [px].
_COMPARED = 3
# What flow knows is a straight and even way. Over more frames than this, things depart from it so far that keyframes
# faded into each other are nearer to the truth: measured on swinging hair and skirts, and on a walk.
_STRAIGHT = 4


class FlowInterpolator:
    """In-betweens along dense optical flow (Kroeger et al., "Fast optical flow using dense inverse search", 2016).

    Both flows are splatted to the in-between's time, as in softmax splatting (Niklaus and Liu, 2020), where flow that
    leads to a pixel hidden in the other keyframe yields to flow that both keyframes agree on. Where the keyframes agree
    no better along the flow than in their own places, they fade into each other instead; so do keyframes that are far
    apart in time, between which nothing moves in a straight line.
    """

    name = "flow"
    description = "Follows the optical flow between the keyframes: for clips from elsewhere, without files"
    requires: tuple[ModelFile, ...] = ()

    def in_betweens(self, clip: Clip, number: int) -> Iterator[NDArray[Any]]:
        """Yield the frames between two keyframes."""
        first, last = clip.keyframe(number), clip.keyframe(number + 1)
        times = clip.times(number)
        if len(times) >= _STRAIGHT:
            yield from (as_dtype(_mixed(first, last, place), clip.keyframes[number].dtype) for _, place in times)
            return
        forth, back = _flow(first, last), _flow(last, first)
        ways = (forth, _consistency(forth, back)), (back, _consistency(back, forth))
        for _, place in times:
            picture = _mixed(first, last, place)
            there = _brought(first, last, place, _flow_at(place, *ways))
            picture += _trust(*there, first, last) * (_mixed(*there, place) - picture)
            yield as_dtype(picture, clip.keyframes[number].dtype)


def _mixed(first: FloatImage, last: FloatImage, place: float) -> FloatImage:
    return first + np.float32(place) * (last - first)


def _brought(first: FloatImage, last: FloatImage, place: float, flow: FloatImage) -> tuple[FloatImage, FloatImage]:
    """Both keyframes as they look at a place between them, if the flow is right."""
    return _fetch(first, -place * flow), _fetch(last, (1 - place) * flow)


def _unlike(a: FloatImage, b: FloatImage) -> FloatImage:
    """How much two pictures differ around each pixel, shape [h, w]."""
    return cv2.GaussianBlur(np.square(a - b).sum(axis=2), (0, 0), _COMPARED)


def _trust(one: FloatImage, other: FloatImage, first: FloatImage, last: FloatImage) -> FloatImage:
    """Share of the keyframes brought along the flow, over the keyframes in their own places, shape [h, w, 1]."""
    here, along = _unlike(first, last), _unlike(one, other)
    return (here / (here + along + np.float32(1e-9)))[..., None]


def _flow(start: FloatImage, end: FloatImage) -> FloatImage:
    """Displacement from one picture to another [px], shape [h, w, 2]."""
    shown = (as_uint8(picture[..., :3]) for picture in (start, end))
    greys = [cv2.cvtColor(np.ascontiguousarray(picture), cv2.COLOR_RGB2GRAY) for picture in shown]
    flow = optical_flow(*greys)
    flow[(cv2.magnitude(*cv2.split(flow)) < _STILL) | ~_changed(start, end)] = 0
    return flow


def _changed(start: FloatImage, end: FloatImage) -> NDArray[np.bool_]:
    """Where two pictures differ, and near it, shape [h, w]: flow that is found elsewhere leaks from what moves."""
    different = (np.abs(end - start).max(axis=2) > _SAME).astype(np.uint8)
    return cv2.dilate(different, np.ones((2 * _AROUND + 1,) * 2, np.uint8)).astype(bool)


def _fetch(picture: FloatImage, displacement: FloatImage) -> FloatImage:
    """The picture read beside each pixel."""
    height, width = displacement.shape[:2]
    columns, rows = np.meshgrid(np.arange(width, dtype=np.float32), np.arange(height, dtype=np.float32))
    at = (np.dstack([columns, rows]) + displacement).astype(np.float32)
    return cv2.remap(picture, at, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def _consistency(flow: FloatImage, back: FloatImage) -> FloatImage:
    """How surely each pixel is shown in the other picture too, above 0 to 1, shape [h, w]."""
    error = flow + _fetch(back, flow)
    length = cv2.magnitude(*cv2.split(error))
    return np.exp(-np.square(length / _OCCLUSION)).astype(np.float32) + np.float32(1e-3)


def _flow_at(place: float, first: Way, last: Way) -> FloatImage:
    """Flow from the first to the last keyframe through each pixel of the in-between, shape [h, w, 2]."""
    total = np.zeros_like(first[0])
    weights = np.zeros(total.shape[:2], np.float32)
    for flow, seen, share, sign in ((*first, place, 1), (*last, 1 - place, -1)):
        values = np.dstack([sign * flow, seen])
        moved, coverage = forward_warp(values, np.float32(share) * flow, seen)
        weight = np.minimum(coverage, 1) * moved[..., 2] * np.float32(1 - share)
        total += moved[..., :2] * weight[..., None]
        weights += weight
    # Where nothing arrives, the flow around fills in.
    spread = cv2.GaussianBlur(np.dstack([total, weights + np.float32(1e-9)]), (0, 0), 9)
    weights = weights[..., None]
    around = spread[..., :2] / spread[..., 2:]
    flow = np.where(weights > 1e-3, total / np.maximum(weights, 1e-9), around).astype(np.float32)
    # Pixels at which unlike flows met would show as specks.
    return np.dstack([cv2.medianBlur(plane, 5) for plane in cv2.split(flow)])
