"""In-betweens without any model against the frames that were left out.

    python tests/benchmarks/inbetweens.py FRAMES --layers FOLDER --json

FRAMES holds consecutive frames; of every three the middle one is drawn from the others. The layered FOLDER holds
composite.png, background.png (the true one) and mask.png (what moves): the part moves in the automatic scene, and all
frames but every n-th are drawn anew, with the known motion and without.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from physanimator.rendering.inbetweens import BACKENDS, interpolate, keyframe_indices
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.pictures import load_image, load_mask
from physanimator.rendering.pipeline import animate

FRAMES = 31


def psnr(a: np.ndarray, b: np.ndarray) -> float:
    """Peak signal-to-noise ratio of two pictures [dB]."""
    error = np.mean((a.astype(np.float64) - b.astype(np.float64)) ** 2)
    return float(10 * np.log10(255**2 / max(error, 1e-12)))


def middle_frames(frames: Sequence[np.ndarray]) -> dict[str, float]:
    """Mean PSNR of the middle one of every three frames, by backend [dB]."""
    found: dict[str, float] = {}
    for name in BACKENDS:
        if name != "motion":
            triples = zip(frames, frames[1:], frames[2:], strict=False)
            drawn = [(list(interpolate([a, c], [0, 2], backend=name))[1], b) for a, b, c in triples]
            found[name] = float(np.mean([psnr(ours, true) for ours, true in drawn]))
    return found


def along_a_motion(folder: Path, every: int) -> dict[str, float]:
    """Mean PSNR of the frames between every n-th, by backend [dB]."""
    image, background = load_image(folder / "composite.png"), load_image(folder / "background.png")
    mask = load_mask(folder / "mask.png", width=image.shape[1], height=image.shape[0])
    animation = animate(image, [mask], plate=background, timing=Timing(frames=FRAMES), wind=AutomaticWind(strength=2.0))
    frames = [animation.renderer.frame(number) for number in range(FRAMES)]
    indices = keyframe_indices(FRAMES, every)
    between = [number for number in range(FRAMES) if number not in indices]
    found = {}
    for name in BACKENDS:
        known: dict[str, Any] = {"motion": animation.motion, "masks": animation.masks} if name == "motion" else {}
        drawn = list(interpolate([frames[index] for index in indices], indices, backend=name, **known))
        found[name] = float(np.mean([psnr(drawn[number], frames[number]) for number in between]))
    return found


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("frames", type=Path, help="folder of consecutive frames")
    parser.add_argument("--layers", type=Path, nargs="*", default=[], help="folders of layered pictures")
    parser.add_argument("--every", type=int, nargs="+", default=[5, 15], help="keyframes of the layered pictures")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    options = parser.parse_args()
    result: dict[str, Any] = {"middle_frames": middle_frames([load_image(p) for p in sorted(options.frames.iterdir())])}
    for folder in options.layers:
        result[folder.name] = {f"every {every}": along_a_motion(folder, every) for every in options.every}
    print(json.dumps(result, indent=2) if options.json else result)


if __name__ == "__main__":
    main()
