"""A clip of 3840x2160 and 240 frames: does its memory stay bounded?

    python tests/benchmarks/large_clip.py [--frames 240]

Prints ``{"peak_mb": _, "peak_mb_after_a_tenth": _, "seconds": _, ...}``: the peak of the process's memory, after a
tenth of the frames and at the end; frames are drawn, and their sketches warped, one after another.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
import time

import cv2
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from physanimator.rendering.options import Timing
from physanimator.rendering.pipeline import animate
from pipeline import illustration

WIDTH, HEIGHT = 3840, 2160


def peak_mb() -> float:
    """Largest memory that this process has taken so far [MB]."""
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=240, help="length of the clip (default 240)")
    frames = parser.parse_args().frames
    image, mask = illustration()
    image = cv2.resize(image, (WIDTH, HEIGHT), interpolation=cv2.INTER_CUBIC)
    mask = cv2.resize(mask.astype("uint8"), (WIDTH, HEIGHT), interpolation=cv2.INTER_LINEAR) > 0
    start, at_start = time.perf_counter(), peak_mb()
    animation = animate(image, [mask], timing=Timing(frames=frames))
    early = 0.0
    for number, _ in enumerate(zip(animation.frames(), animation.sketches(), strict=True), start=1):
        if number == max(1, frames // 10):
            early = peak_mb()
    result = {
        "peak_mb": peak_mb(),
        "peak_mb_after_a_tenth": early,
        "peak_mb_before": at_start,
        "all_frames_would_take_mb": frames * image.nbytes / 1e6,
        "seconds": time.perf_counter() - start,
        "frames": frames,
        "size": [WIDTH, HEIGHT],
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()
