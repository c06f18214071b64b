"""What stays behind of a moving part, with its mask as people make masks, against the true picture and true frames.

    python tests/benchmarks/mask_ghosts.py SAMPLE --mask mask.png --json

SAMPLE is a folder with composite.png, sprite.png (RGBA), background.png and a mask of the part that moves. The mask as
it is comes first, then each of ``mask_variants.py``; every one moves as the mask as it is does. Two counts of pixels:

- "plate": within ten of the part's edge, where the picture behind the part is darker than the true one by --darker
  8-bit steps and as dark as the drawing was there. It also counts what nobody sees or could know, as a cloud behind the
  part that is painted in the sky's blue, if that is as dark as the part was;
- "frames": the same in four frames against the true ones, wherever the truth is known: only what shows when the part
  has moved. A piece that the mask has lost and that therefore stays in its place counts here.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import mask_variants
import numpy as np
from layered_sample import LayeredSample, load_sample
from layered_truth import TrueFrames
from matte import band_of, behind
from physanimator.physics.motion import Motion
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.matting import regular_mask
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.pipeline import animate

FRAMES = (4, 8, 12, 16)
LUMINANCE = np.float32([0.299, 0.587, 0.114])
# Lightness that differs by less is the drawing's.
ALIKE = 0.1


def left_behind(shown: np.ndarray, true: np.ndarray, drawing: np.ndarray, darker: float) -> np.ndarray:
    """Where a picture is darker than the true one and as dark as the drawing, shape [h, w]."""
    lightness = shown @ LUMINANCE
    return (lightness < true @ LUMINANCE - darker / 255) & (np.abs(lightness - drawing @ LUMINANCE) < ALIKE)


def counts(sample: LayeredSample, motion: Motion, truth: TrueFrames, mask: np.ndarray, darker: float) -> dict[str, int]:
    """Both counts of one mask."""
    drawing = sample.picture / np.float32(255)
    plate = left_behind(behind(drawing, regular_mask(drawing, mask)), truth.behind, drawing, darker)
    renderer, frames = LayeredRenderer(sample.picture, [mask], motion), 0
    for t in FRAMES:
        true = truth.frame(t)
        shown = renderer.frame(t) / np.float32(255)
        frames += int((left_behind(shown, true.picture, drawing, darker) & true.judged).sum())
    return {"plate": int((plate & band_of(truth.rest_alpha, 10) & ~truth.unknown).sum()), "frames": frames}


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sample", type=Path)
    parser.add_argument("--mask", default="mask.png", help="name of the mask's file in SAMPLE (default mask.png)")
    parser.add_argument("--only", nargs="+", choices=mask_variants.VARIANTS, help="only these masks, not all")
    parser.add_argument("--darker", type=float, default=38, help="what is seen as a ghost [8-bit steps] (default 38)")
    parser.add_argument("--json", action="store_true", help="print the whole document")
    options = parser.parse_args()
    sample = load_sample(options.sample, mask_name=options.mask)
    timing = Timing(frames=FRAMES[-1] + 1)
    motion = animate(sample.picture, [sample.mask], timing=timing, wind=AutomaticWind(strength=2)).motion
    truth, table = TrueFrames(sample, motion), {}
    for name in options.only or mask_variants.VARIANTS:
        mask = mask_variants.VARIANTS[name](sample.mask)
        table[name] = counts(sample, motion, truth, mask, options.darker)
        if not options.json:
            print(f"{name:>26}  " + "   ".join(f"{key} {value:5d}" for key, value in table[name].items()), flush=True)
    if options.json:
        print(json.dumps({"sample": sample.name, "mask": options.mask, "ghosts": table}, indent=2))


if __name__ == "__main__":
    main()
