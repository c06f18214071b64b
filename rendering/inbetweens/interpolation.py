"""Keyframes and in-betweens (paper, Method, "Complementary Dynamics").

Every n-th frame is a keyframe and stays as it is; a backend draws what lies between two of them. Backends are
entries of ``BACKENDS`` and say which files they need.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError, require
from ...physics.mesh import coverage_of
from ...physics.motion import Motion
from ...physics.progress import Progress
from ..pictures import as_dtype, as_picture, is_transparent, premultiplied, straight
from .backend import Clip, Interpolator, ModelFile
from .flow import FlowInterpolator
from .loop import check_loop, led_around, loop_frames
from .motion import MotionInterpolator

__all__ = [
    "BACKENDS",
    "DEFAULT_GAP",
    "BlendInterpolator",
    "Interpolator",
    "ModelFile",
    "interpolate",
    "keyframe_indices",
]

DEFAULT_GAP = 15
"""Frames from one keyframe to the next in the paper."""

FileFinder = Callable[[ModelFile], Path | None]


class BlendInterpolator:
    """One keyframe fades into the next."""

    name = "blend"
    description = "Cross-dissolve: one keyframe fades into the next"
    requires: tuple[ModelFile, ...] = ()

    def in_betweens(self, clip: Clip, number: int) -> Iterator[NDArray[Any]]:
        """Yield the weighted mean of both keyframes for every frame between them."""
        first, last = clip.keyframe(number), clip.keyframe(number + 1)
        for _, place in clip.times(number):
            yield as_dtype(first + np.float32(place) * (last - first), clip.keyframes[number].dtype)


BACKENDS: dict[str, Interpolator] = {
    backend.name: backend for backend in (MotionInterpolator(), FlowInterpolator(), BlendInterpolator())
}
"""Every available backend by its name; further ones register by adding themselves."""


def keyframe_indices(count: int, every: int = DEFAULT_GAP, *, at: Sequence[int] = (), loops: bool = False) -> list[int]:
    """Frames 0, n, 2n, ... of a clip and its last one, or the listed ones.

    Args:
        count: number of frames of the clip.
        every: frames from one keyframe to the next.
        at: frame numbers of the keyframes, instead; frames before the first and after the last of them are no
            in-betweens, unless the clip is a loop.
        loops: frame 0 comes again after the last one, which then need be no keyframe; there are two at least.

    Examples:
        >>> from physanimator.rendering.inbetweens import keyframe_indices
        >>> keyframe_indices(20, every=8)
        [0, 8, 16, 19]
    """
    require("count", count, count >= 1, "at least 1 frame")
    require("every", every, every >= 1, "at least 1 frame")
    known = all(isinstance(index, int | np.integer) and 0 <= index < count for index in at)
    require("keyframes", list(at), known, f"frame numbers from 0 to {count - 1}")
    if at:
        return sorted({*at})
    if loops and count > 1:
        regular = list(range(0, count, every))
        return regular if len(regular) > 1 else [0, count // 2]
    return sorted({*range(0, count, every), count - 1})


def interpolate(
    keyframes: Sequence[NDArray[Any]],
    indices: Sequence[int],
    *,
    backend: str | Interpolator = "motion",
    motion: Motion | None = None,
    masks: Sequence[NDArray[Any]] = (),
    sketches: Sequence[NDArray[Any]] = (),
    find_file: FileFinder | None = None,
    progress: Progress | None = None,
    before: Sequence[NDArray[Any]] = (),
    after: Sequence[NDArray[Any]] = (),
    loop: int | None = None,
) -> Iterator[NDArray[Any]]:
    """All frames from the first keyframe to the last, or of a loop; keyframes come out unchanged.

    Args:
        keyframes: RGB or straight RGBA in any form that :func:`as_picture` takes, of one
            size and type, shape [h, w, 3] or [h, w, 4] each; backends by video models take RGB alone.
        indices: frame number of each keyframe, increasing.
        backend: name of an entry of ``BACKENDS``, or a backend that was made elsewhere, such as
            ``tooncrafter.interpolator.ToonCrafterInterpolator``; "motion" without a known motion becomes "flow".
        motion: positions of the bodies in every frame; needed by "motion".
        masks: soft mask of each body in the drawing, in the order of the motion's bodies, shape [h, w]; with them
            "motion" keeps soft edges exactly as soft as they were.
        sketches: dark lines on white that lead backends which heed them, one for each frame up to the last keyframe, of
            the keyframes' size, shape [h, w] or [h, w, 3].
        find_file: tells where a file lies that the backend requires, or None where it is missing.
        progress: called after each frame.
        before: frames that come out ahead of the first keyframe as they are, in the keyframes' size and type.
        after: frames that follow the last keyframe in the same way.
        loop: number of frames after which the clip begins again: in-betweens then lead from the last keyframe to the
            first as well, and all frames of the loop come out, frame 0 first. None: no loop.

    Returns:
        An iterator over ``before``, indices[-1] - indices[0] + 1 frames, and ``after``; or over the frames of the loop.
        Bad input raises here, not at the first frame.

    Raises:
        InvalidInputError: keyframes and indices do not belong together, the backend is unknown, or its files are
            missing.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.inbetweens import interpolate
        >>> keyframes = [np.full((8, 8, 3), level, np.uint8) for level in (0, 200)]
        >>> [int(frame[0, 0, 0]) for frame in interpolate(keyframes, [0, 4], backend="blend")]
        [0, 50, 100, 150, 200]
    """
    require("keyframes", f"{len(keyframes)}", len(keyframes) >= 1, "at least one")
    keyframes, around = _pictures(keyframes, "keyframes"), (_pictures(before, "before"), _pictures(after, "after"))
    _check(keyframes, indices, around)
    chosen = _chosen("flow" if backend == "motion" and motion is None else backend)
    if motion is not None:
        expected = f"within the motion's frames 0 to {len(motion) - 1}"
        require("indices", list(indices), indices[0] >= 0 and indices[-1] < len(motion), expected)
        counted = len(masks) in (0, len(motion.bodies))
        require("masks", f"{len(masks)}", counted, f"none or one per body ({len(motion.bodies)})")
    if loop is not None:
        check_loop(loop, indices, motion, alone=not (len(before) or len(after)))
    if len(sketches):
        _check_sketches(sketches, indices[-1] if loop is None else loop - 1, keyframes[0].shape[:2])
    # Hidden colours must not come into those that are seen.
    mixable = [premultiplied(each) for each in keyframes] if is_transparent(keyframes[0]) else keyframes
    files = _files(chosen, find_file)
    clip = Clip(mixable, tuple(indices), motion, tuple(map(coverage_of, masks)), files, sketches)
    if loop is not None:
        around_clip = led_around(clip, loop)
        closed = loop_frames(lambda k: _between(chosen, around_clip, k, keyframes[k]), keyframes, start=indices[0])
        return _counted(closed, loop, progress)
    total = clip.indices[-1] - clip.indices[0] + 1 + sum(map(len, around))
    frames = itertools.chain(around[0], _frames(chosen, clip, keyframes), around[1])
    return _counted(frames, total, progress)


def _frames(backend: Interpolator, clip: Clip, keyframes: Sequence[NDArray[Any]]) -> Iterator[NDArray[Any]]:
    for number, keyframe in enumerate(keyframes):
        yield keyframe
        if number + 1 < len(keyframes):
            yield from _between(backend, clip, number, keyframe)


def _between(backend: Interpolator, clip: Clip, number: int, keyframe: NDArray[Any]) -> Iterator[NDArray[Any]]:
    """The frames between a keyframe and the next, in the form that the keyframe was given in."""
    between = backend.in_betweens(clip, number)
    return (as_dtype(straight(each), keyframe.dtype) for each in between) if is_transparent(keyframe) else between


def _counted(frames: Iterable[NDArray[Any]], total: int, progress: Progress | None) -> Iterator[NDArray[Any]]:
    for done, frame in enumerate(frames, start=1):
        yield frame
        if progress is not None:
            progress(done, total)


def _pictures(given: Sequence[NDArray[Any]], name: str) -> list[NDArray[Any]]:
    return [as_picture(each, name=f"{name}[{number}]", alpha=True) for number, each in enumerate(given)]


def _check(
    keyframes: Sequence[NDArray[Any]], indices: Sequence[int], around: tuple[Sequence[NDArray[Any]], ...]
) -> None:
    same = len(indices) == len(keyframes)
    require("indices", f"{len(indices)}", same, f"one per keyframe ({len(keyframes)})")
    rising = all(a < b for a, b in itertools.pairwise(indices))
    whole = all(isinstance(index, int | np.integer) and index >= 0 for index in indices)
    require("indices", list(indices), whole and rising, "increasing frame numbers from 0")
    kinds = {(keyframe.shape, keyframe.dtype) for keyframe in keyframes}
    require("keyframes", sorted(map(str, kinds)), len(kinds) == 1, "of one size and type")
    for name, others in zip(("before", "after"), around, strict=True):
        unlike = {(each.shape, each.dtype) for each in others} - kinds
        require(name, sorted(map(str, unlike)), not unlike, "of the keyframes' size and type")


def _check_sketches(sketches: Sequence[NDArray[Any]], last: int, size: tuple[int, ...]) -> None:
    require("sketches", len(sketches), len(sketches) > last, f"one for each of the {last + 1} frames")
    sizes = sorted({sketch.shape[:2] for sketch in sketches})
    require("sketches", sizes, sizes == [size], f"of the keyframes' size, {size[1]} x {size[0]} px")


def _chosen(name: str | Interpolator) -> Interpolator:
    if not isinstance(name, str):
        return name
    if name not in BACKENDS:
        raise InvalidInputError(f"backend must be one of {', '.join(BACKENDS)}. Got: {name!r}")
    return BACKENDS[name]


def _files(backend: Interpolator, find_file: FileFinder | None) -> dict[str, Path]:
    found = {file.name: find_file(file) if find_file is not None else None for file in backend.requires}
    missing = [file for file in backend.requires if found[file.name] is None]
    if missing:
        listed = ", ".join(map(str, missing))
        raise InvalidInputError(f"backend {backend.name!r} needs files that are missing: {listed}")
    return {name: path for name, path in found.items() if path is not None}
