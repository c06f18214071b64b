"""The one rule that says which part a painted picture means, judged by its opacity, its greys or its colours."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...physics.errors import InvalidInputError
from .mask_colours import Colour, colours_of, flat_levels, named, share_of_colour
from .picture_modes import GREY_MODES, grey_numbers, has_transparency, in_srgb, with_opacity
from .pixels import as_float
from .posterised import is_gradient, is_posterised

__all__ = ["EMPTY", "MaskFile", "judged"]

StrPath = str | os.PathLike[str]
FloatPlane = NDArray[np.float32]

# The masks of tests/rendering/pictures/test_mask_files.py are read the same at half and twice of _COLOURED, _FEW,
# _CLEAR, _DARK and _FAINT.
_COLOURED = 40  # difference of the channels from which a pixel is no grey [8-bit levels]
_FEW = 0.05  # of what is white: so much may be coloured by accident
_CLEAR = 0.001  # of the picture: less transparency than this is an accident
_BRIGHT, _DARK = 0.94, 0.06  # as bright as this is white, as dark as this is black (15 levels of 255)
_FAINT = 16 / 255  # a mask no brighter than this holds labels 0, 1, 2 and so on
EMPTY = "white (or opaque) where the part is. Got: an empty mask"
"""Ends a message about a mask that shows nothing."""


@dataclass(frozen=True, eq=False)
class MaskFile:
    """A mask as it was read.

    Attributes:
        coverage: how much of each pixel belongs to the part, 0 to 1, float32, shape [h, w].
        notes: a sentence for everything about it that may not be meant so.
    """

    coverage: FloatPlane
    notes: tuple[str, ...] = ()


def judged(picture: Image.Image, called: str) -> MaskFile:
    """What a picture says, at its own size.

    Args:
        picture: of any mode.
        called: its name, for messages.

    Raises:
        InvalidInputError: it is empty, or does not say which of several parts is meant.
    """
    opacity = None
    if has_transparency(picture):
        rgba = np.array(with_opacity(picture, name=called))
        opacity, rgb = np.ascontiguousarray(rgba[..., 3]), np.ascontiguousarray(rgba[..., :3])
    elif picture.mode in GREY_MODES:
        return _by_grey(_raw(picture, called), called)
    elif picture.mode in ("1", "L"):
        return _by_grey(as_float(np.array(picture.convert("L"))), called)
    else:
        rgb = np.array(in_srgb(picture).convert("RGB"))
    if opacity is not None and _tells(opacity):
        return _by_opacity(rgb, opacity, called)
    if _is_grey(rgb):
        return _by_grey(as_float(rgb[..., 1]), called)
    return _by_colour(rgb, called)


def _raw(picture: Image.Image, called: str) -> FloatPlane:
    """A plane of more than 8 bits; whole numbers that are far too small to be grey values are taken as they come."""
    plane = grey_numbers(picture, name=called)
    values = np.array(picture)
    small = picture.mode != "F" and 0 < values.max() <= 255
    return (values / 255.0 if small else plane).astype(np.float32)


def _tells(opacity: NDArray[np.uint8]) -> bool:
    clear = np.count_nonzero(opacity < 128)
    return bool(clear >= _CLEAR * opacity.size and opacity.max() > opacity.min())


def _is_grey(rgb: NDArray[np.uint8], where: NDArray[np.bool_] | None = None) -> bool:
    """Whether a picture has no colours, or has them by accident beside its white and black."""
    red, green, blue = cv2.split(rgb)
    darkest, brightest = cv2.min(cv2.min(red, green), blue), cv2.max(cv2.max(red, green), blue)
    tests = (brightest - darkest > _COLOURED, darkest >= 255 * _BRIGHT, brightest <= 255 * _DARK)
    coloured, white, black = (np.count_nonzero(each if where is None else each & where) for each in tests)
    return bool(coloured <= _FEW * min(white, black))


def _by_opacity(rgb: NDArray[np.uint8], opacity: NDArray[np.uint8], called: str) -> MaskFile:
    """White among the visible where there are areas of white and of black, otherwise the opacity."""
    alpha = as_float(opacity)
    visible = opacity >= 128
    if visible.any() and _is_grey(rgb, visible):
        grey = np.where(visible, as_float(rgb[..., 1]), np.float32(0.5))
        # Both are areas, a hundredth of what is visible at least, and together two fifths of it.
        area = np.ones((3, 3), np.uint8)
        white, black = (
            np.count_nonzero(cv2.erode(each.astype(np.uint8), area, borderValue=0))
            for each in (grey >= 0.9, grey <= 0.1)
        )
        shown = np.count_nonzero(visible)
        if min(white, black) >= 0.01 * shown and white + black >= 0.4 * shown:
            note = f"{called} shows white, black and nothing: white was taken as the part, not all that is opaque"
            plane = as_float(rgb[..., 1]) * alpha
            return replace(_by_grey(plane, called), notes=(note,))
    highest = float(alpha.max())
    return MaskFile(alpha / np.float32(highest) if highest < 0.5 else alpha)


def _by_grey(plane: FloatPlane, called: str) -> MaskFile:
    """White, or the only grey that there is; several flat greys are labels, unless they are steps of a soft mask."""
    highest = float(plane.max())
    if highest <= 0:
        raise InvalidInputError(f"{called} must be {EMPTY}: it is black all over")
    # Labels such as 0, 1, 2 are told apart only when they are spread.
    unit = highest if highest < _FAINT else 1.0
    levels = flat_levels(plane / np.float32(unit))
    greys = [level for level, _ in levels if level > (_DARK if highest >= 0.5 else _DARK / 3)]
    if len([level for level in greys if level >= _BRIGHT]) > 1:  # JPEG's noise in white
        greys = [level for level in greys if level < _BRIGHT] + [1.0]
    soft = _as_soft(plane / np.float32(unit), len(greys), called) if len(greys) > 1 else ()
    if len(greys) > 1 and soft is not None:
        greys = [highest / unit]
    white = highest >= _BRIGHT and _has_white(plane, levels)
    if white and len([level for level in greys if level < _BRIGHT]) == 1:
        return _with_one_grey(plane, next((level, share) for level, share in levels if level == greys[0]), called)
    if len(greys) > 1:
        seen = ", ".join(
            f"{255 * unit * level:.0f} on {100 * share:.1f} %" for level, share in levels if level >= greys[0]
        )
        raise InvalidInputError(
            f"{called} must show one part in white; of labels, save one as a mask of its own, and what fades in more"
            f" shades. Got: {len(greys)} grey levels besides black: {seen}"
        )
    if (greys and greys[0] < _BRIGHT * highest / unit) or (highest < 0.5 and (greys or _of_one_level(plane))):
        return MaskFile(np.clip(plane / np.float32(unit * greys[0] if greys else highest), 0, 1), soft or ())
    if highest < 0.5:
        raise InvalidInputError(
            f"{called} must be {EMPTY}: its brightest pixel is {255 * highest:.0f} of 255, without an even area"
        )
    return MaskFile(np.clip(plane / np.float32(greys[0]), 0, 1) if greys and greys[0] < _BRIGHT else plane, soft or ())


def _as_soft(plane: FloatPlane, count: int, called: str) -> tuple[str, ...] | None:
    """What is to be said of a plane of a few greys that is one soft mask; None where these are labels."""
    if is_posterised(plane):
        return ()
    note = f"{called} shows {count} shades in order: they were taken as one soft mask, not as labels"
    return (note,) if is_gradient(plane) else None


def _has_white(plane: FloatPlane, levels: list[tuple[float, float]]) -> bool:
    """Whether white is an area, or at least not just the rim of something grey."""
    white, painted = np.count_nonzero(plane >= _BRIGHT), np.count_nonzero(plane > _DARK)
    return bool(any(level >= _BRIGHT for level, _ in levels) or white >= _FEW * painted)


def _with_one_grey(plane: FloatPlane, grey: tuple[float, float], called: str) -> MaskFile:
    """White and one grey: beside black the grey is half covered, without black it is the part or what that lies on."""
    level, share = grey
    if np.count_nonzero(plane < level - 2 * _DARK) >= _CLEAR * plane.size:
        seen = f"grey ({255 * level:.0f} of 255) on {100 * share:.0f} % of the picture"
        return MaskFile(plane, (f"{called} is {seen}, which counts in part only",))
    raised = np.clip((plane - np.float32(level)) / np.float32(1 - level), 0, 1)
    border = np.concatenate([raised[0], raised[-1], raised[:, 0], raised[:, -1]])
    if border.mean() < 0.5:
        return MaskFile(raised)
    return MaskFile(1 - raised, (f"{called}: grey on white was taken as the part",))


def _of_one_level(plane: FloatPlane) -> bool:
    return bool(((plane == 0) | (plane == plane.max())).all())


def _by_colour(rgb: NDArray[np.uint8], called: str) -> MaskFile:
    """Of two colours that are all there is: white, or else the one that is neither black nor white around it."""
    colours, other = colours_of(rgb)
    # All but half a percent, where edges meet, is one of the colours or mixed of both.
    pair = _part_and_rest(colours, rgb) if len(colours) == 2 and other < 0.005 else None
    if pair is None:
        what = "a mask, not a picture" if other > 0.05 or len(colours) >= 8 else "one part"
        raise InvalidInputError(
            f"{called} must show {what}: white, or one colour, on black. Got: {named(colours, other)}"
        )
    part, rest = pair
    plane = share_of_colour(rgb, part, rest)
    between = [level for level, _ in flat_levels(plane) if _DARK < level < _BRIGHT]
    soft = _as_soft(plane, len(between) + 1, called) if between else ()
    if soft is None:
        raise InvalidInputError(
            f"{called} must show one part; of labels, save one as a mask of its own, and what fades in more shades."
            f" Got: {len(between) + 1} shades of {part.name}"
        )
    notes = (f"{called}: {part.name} on white was taken as the part",) if rest.name == "white" else ()
    return MaskFile(plane, (*notes, *soft))


def _part_and_rest(colours: list[Colour], rgb: NDArray[np.uint8]) -> tuple[Colour, Colour] | None:
    first, second = colours
    dark = [each for each in colours if max(each.rgb) < 60]
    white = [each for each in colours if min(each.rgb) > 200]
    if dark:
        return (second, first) if dark[0] is first else (first, second)
    if not white:
        return None
    paper, ink = (first, second) if white[0] is first else (second, first)
    border = np.concatenate([rgb[0], rgb[-1], rgb[:, 0], rgb[:, -1]]).astype(np.float64)
    to_paper, to_ink = (np.linalg.norm(border - np.array(each.rgb), axis=1) for each in (paper, ink))
    # What lies along the border is what the part lies on.
    return (ink, paper) if np.count_nonzero(to_paper < to_ink) * 2 >= len(border) else (paper, ink)
