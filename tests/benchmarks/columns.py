"""What the columns of an evaluation say of known faults, and their time.

    python tests/benchmarks/columns.py --json

The clip is the bundled example's in the automatic wind; each fault is done to all of its frames.

Prints ``{"values": {fault: {column: value}}, "ms_per_frame": {"any clip": _, "with a motion": _}}``.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from physanimator.rendering.evaluation.columns import COLUMNS, ClipOfPicture, clip_values
from physanimator.rendering.options import Timing
from physanimator.rendering.pictures import as_uint8, load_image, load_mask
from physanimator.rendering.pipeline import animate

EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example"
FRAMES = 24

Picture = NDArray[np.uint8]


def jpeg(frame: Picture) -> Picture:
    return np.asarray(cv2.imdecode(cv2.imencode(".jpg", frame, [cv2.IMWRITE_JPEG_QUALITY, 40])[1], cv2.IMREAD_COLOR))


def noisy(frame: Picture, t: int) -> Picture:
    return np.clip(frame + np.random.default_rng(t).normal(0, 4, frame.shape), 0, 255).astype(np.uint8)


def faults(frames: list[Picture]) -> dict[str, list[Picture]]:
    def each(change: Callable[[Picture, int], Picture]) -> list[Picture]:
        return [change(frame, t) for t, frame in enumerate(frames)]

    return {
        "none": frames,
        "stands still": [frames[0]] * FRAMES,
        "flickers by 8 of 255": each(
            lambda frame, t: np.clip(frame.astype(int) + 8 * (t % 2), 0, 255).astype(np.uint8)
        ),
        "noise of 4 of 255": each(noisy),
        "JPEG of quality 40": each(lambda frame, t: jpeg(frame)),
        "blurred by 2 px": each(lambda frame, t: np.asarray(cv2.GaussianBlur(frame, (0, 0), 2))),
        "half the size": each(lambda frame, t: np.asarray(cv2.resize(frame, None, fx=0.5, fy=0.5))),
        "the picture slides by 3 px a frame": [np.roll(frames[0], 3 * t, axis=1) for t in range(FRAMES)],
        "frames in disorder": [frames[k] for k in np.random.default_rng(0).permutation(FRAMES)],
    }


def measured(frames: list[Picture], picture: Picture, **known: Any) -> tuple[dict[str, float], float]:
    start = time.perf_counter()
    columns = [column for column in COLUMNS if not column.weights]
    found = clip_values(ClipOfPicture(frames, 24.0, picture, **known), columns)
    seconds = time.perf_counter() - start
    return {key: round(value, 5) for key, value in found.items() if isinstance(value, float)}, seconds


def main() -> None:
    picture = as_uint8(load_image(EXAMPLE / "illustration.png"))[..., :3]
    height, width = picture.shape[:2]
    masks = [load_mask(path, width=width, height=height) for path in sorted(EXAMPLE.glob("mask_*.png"))]
    animation = animate(picture, masks, timing=Timing(frames=FRAMES))
    frames = [as_uint8(frame) for frame in animation.frames()]
    known = {"motion": animation.shown_motion, "sketches": list(animation.sketches())}
    values = {name: measured(each, picture, **known)[0] for name, each in faults(frames).items()}
    speed = {
        "any clip": measured(frames, picture)[1],
        "with a motion": measured(frames, picture, **known)[1],
    }
    print(
        json.dumps(
            {"values": values, "ms_per_frame": {k: round(1000 * s / FRAMES) for k, s in speed.items()}}, indent=2
        )
    )


if __name__ == "__main__":
    main()
