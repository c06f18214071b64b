"""What is left of a colour drift in a looping clip, and of its jump at the wrap.

    python tests/benchmarks/colour_drift.py PICTURE ... --json

The picture sways once. The model's clip is the same, softer, with colours that drift: evenly over the clip, by gains
of red and blue, or by a step where each segment begins. Three ways to match it: none, each frame by itself, and
segments as a whole with a soft ramp from one to the next, closed at the wrap.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import cv2
import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from numpy.typing import NDArray
from physanimator.rendering.evaluation.columns.loop_residual import LOOP_RESIDUAL
from physanimator.rendering.neural.colour_drift import own_colours, without_drift
from physanimator.rendering.pictures import as_float, as_uint8, load_image
from physanimator.rendering.pictures.colour_matching import ColourStatistics, colours_of, common_weights, with_colours
from physanimator.rendering.pictures.lab import lab_to_rgb, rgb_to_lab
from physanimator.rendering.svd.loop_segments import plan_loop

Image = NDArray[np.float32]
OVERLAP = 4


def swaying(picture: Image, count: int) -> list[Image]:
    """A clip in which what lies higher sways further, up to 12 px."""
    height, width = picture.shape[:2]
    columns, rows = np.meshgrid(np.arange(width, dtype=np.float32), np.arange(height, dtype=np.float32))
    reach = 12 * (1 - rows / height)
    turns = 2 * np.pi * np.arange(count) / count
    moved = (columns + reach * np.float32(np.sin(turn)) for turn in turns)
    return [cv2.remap(picture, at, rows, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE) for at in moved]


def softened(picture: Image) -> Image:
    height, width = picture.shape[:2]
    small = cv2.resize(picture, (width // 2, height // 2), interpolation=cv2.INTER_AREA)
    return np.clip(cv2.resize(small, (width, height), interpolation=cv2.INTER_CUBIC), 0, 1)


def in_lab(frame: Image, share: float) -> Image:
    lab = rgb_to_lab(frame) * (1 - np.float32([0.1, 0.2, 0.2]) * np.float32(share))
    return lab_to_rgb(lab + np.float32(share) * np.float32([8, 5, -6]))


def by_gains(frame: Image, share: float) -> Image:
    return np.clip(frame * (1 + np.float32(share) * np.float32([0.12, 0, -0.12])), 0, 1).astype(np.float32)


def segment_of(count: int) -> list[int]:
    made = [len(segment.made) for segment in plan_loop(count + 1, OVERLAP)]
    return [number for number, length in enumerate(made) for _ in range(length)]


def drifts(count: int) -> dict[str, Callable[[Image, int], Image]]:
    segments = segment_of(count)
    return {
        "none": lambda frame, t: frame,
        "even": lambda frame, t: in_lab(frame, t / (count - 1)),
        "gains": lambda frame, t: by_gains(frame, t / (count - 1)),
        "steps": lambda frame, t: in_lab(frame, segments[t] / segments[-1]),
    }


def mean_of(found: Sequence[ColourStatistics]) -> ColourStatistics:
    mean, covariance = (np.mean([getattr(each, name) for each in found], axis=0) for name in ("mean", "covariance"))
    return ColourStatistics(mean, covariance, min(each.blocks for each in found))


def matched_by_segments(clip: Sequence[Image], truth: Sequence[Image]) -> list[Image]:
    """Each segment by its own statistics; those of the next come in over the last frames of a segment."""
    segments = np.array(segment_of(len(clip)))
    pairs = [[colours_of(each, common_weights(each)) for each in frames] for frames in (clip, truth)]
    pooled = [
        [mean_of([found[t] for t in np.flatnonzero(segments == k)]) for k in np.unique(segments)] for found in pairs
    ]
    drawn = []
    for t, frame in enumerate(clip):
        k, left = segments[t], int(np.count_nonzero(segments[t:] == segments[t]))
        share, following = max(0.0, 1 - left / (OVERLAP + 1)), (k + 1) % len(pooled[0])
        found, wanted = (each[k].towards(each[following], share) for each in pooled)
        drawn.append(with_colours(frame, found, wanted))
    return drawn


def wrap(clip: Sequence[Image]) -> float:
    told = LOOP_RESIDUAL.begin(SimpleNamespace(loops=True), SimpleNamespace())  # type: ignore[arg-type]
    for frame in clip:
        told.add(as_uint8(frame))
    return float(told.values()[LOOP_RESIDUAL.key] or 0)


def measured(clip: Sequence[Image], truth: Sequence[Image]) -> dict[str, float]:
    """The jump at the wrap, and of the mean colour in L*a*b* the worst error and the worst change of error."""
    away = np.array([(rgb_to_lab(a) - rgb_to_lab(b)).mean(axis=(0, 1)) for a, b in zip(clip, truth, strict=True)])
    steps = np.linalg.norm(away - np.roll(away, 1, axis=0), axis=1)
    worst = float(np.linalg.norm(away, axis=1).max())
    return {"wrap": round(wrap(clip), 5), "worst_error": round(worst, 3), "worst_step": round(float(steps.max()), 3)}


def figures(picture: Image, count: int) -> dict[str, Any]:
    truth = swaying(picture, count)
    found: dict[str, Any] = {"composite": {"wrap": round(wrap(truth), 5)}}
    for name, drift in drifts(count).items():
        clip = [drift(softened(frame), t) for t, frame in enumerate(truth)]
        each = list(without_drift(clip, map(own_colours, truth), 1.0))
        ways = {"as drawn": clip, "each frame": each, "segments": matched_by_segments(clip, truth)}
        found[name] = {way: measured(frames, truth) for way, frames in ways.items()}
    return found


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pictures", type=Path, nargs="+")
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--side", type=int, default=320, help="longer side that pictures are scaled to [px]")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    options = parser.parse_args()
    result = {}
    for path in options.pictures:
        picture = as_float(load_image(path))[..., :3]
        scale = options.side / max(picture.shape[:2])
        size = round(picture.shape[1] * scale), round(picture.shape[0] * scale)
        small = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
        result[path.name] = figures(np.ascontiguousarray(small, np.float32), options.frames)
    print(json.dumps(result, indent=2) if options.json else result)


if __name__ == "__main__":
    main()
