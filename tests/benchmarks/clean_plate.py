"""Clean plate against OpenCV's inpainting, on layered pictures whose true background is known.

    python tests/benchmarks/clean_plate.py FOLDER [FOLDER ...] --json

Each folder holds composite.png, sprite.png, background.png and mask.png (what moves); other masks are chosen with
--mask. The body moves in the automatic scene; the uncovered region is every pixel of the mask that it bares in some
frame and behind which the background is known to be (see layered_truth.py): behind a sash is a skirt that no layer
shows. The figures named _anywhere take the background for the truth there too. OpenCV gets the best of both its methods
and many radii, chosen afterwards for each picture and region. Also checks what must hold exactly: the
first frame is the picture, and pixels that no body covers stay as drawn.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from layered_sample import load_sample
from layered_truth import TrueFrames
from physanimator.rendering.options import AutomaticWind
from physanimator.rendering.pipeline import animate

RADII = (1, 2, 3, 5, 8, 12)
METHODS = {"telea": cv2.INPAINT_TELEA, "navier_stokes": cv2.INPAINT_NS}


def psnr(picture: np.ndarray, truth: np.ndarray, region: np.ndarray) -> float:
    """Peak signal-to-noise ratio within a region [dB]."""
    error = picture[region].astype(np.float64) - truth[region]
    return float(10 * np.log10(255**2 / max(float((error**2).mean()), 1e-12)))


def best_of_opencv(image: np.ndarray, mask: np.ndarray, truth: np.ndarray, region: np.ndarray) -> tuple[float, str]:
    """The best PSNR of cv2.inpaint over its methods and radii, and which setting it was."""
    results = []
    for name, method in METHODS.items():
        for radius in RADII:
            filled = cv2.inpaint(image, mask.astype(np.uint8) * 255, radius, method)
            results.append((psnr(filled, truth, region), f"{name}, radius {radius}"))
    return max(results)


def measure(folder: Path, mask_name: str, preset: str, wind: float) -> dict[str, Any]:
    """Figures of one layered picture."""
    sample = load_sample(folder, mask_name=mask_name)
    image, mask, truth = sample.picture, sample.mask, np.rint(sample.background * 255).astype(np.uint8)
    animation = animate(image, [mask], preset=preset, wind=AutomaticWind(strength=wind))
    bared, ever_covered = np.zeros(mask.shape, dtype=bool), np.zeros(mask.shape, dtype=bool)
    untouched_error = 0
    frames = []
    for t in animation.shown:
        frame, alpha = animation.renderer.frame_and_alpha(t)
        bared |= (mask > 0.5) & (alpha < 0.5)
        ever_covered |= alpha > 0
        frames.append(frame)
    for frame in frames:
        untouched_error = max(untouched_error, int(np.abs(frame.astype(int) - image)[~ever_covered].max()))
    known = bared & ~TrueFrames(sample, animation.motion).unknown
    theirs, setting = best_of_opencv(image, mask > 0.5, truth, known)
    return {
        "ours_psnr": psnr(animation.renderer.plate, truth, known),
        "opencv_psnr": theirs,
        "opencv_setting": setting,
        "uncovered_px": int(known.sum()),
        "ours_psnr_anywhere": psnr(animation.renderer.plate, truth, bared),
        "opencv_psnr_anywhere": best_of_opencv(image, mask > 0.5, truth, bared)[0],
        "uncovered_px_anywhere": int(bared.sum()),
        "first_frame_error": int(np.abs(frames[0].astype(int) - image).max()),
        "untouched_error": untouched_error,
    }


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=Path, nargs="+")
    parser.add_argument("--mask", default="mask.png", help="name of the mask in each folder (default mask.png)")
    parser.add_argument("--preset", default="hair", help="material (default hair)")
    parser.add_argument("--wind", type=float, default=1.0, help="strength of the automatic wind (default 1)")
    parser.add_argument("--json", action="store_true", help="print the whole document")
    options = parser.parse_args()
    table = {folder.name: measure(folder, options.mask, options.preset, options.wind) for folder in options.folders}
    if options.json:
        print(json.dumps(table, indent=2))
        return
    for name, row in table.items():
        print(f"{name:>24} ours {row['ours_psnr']:6.2f} dB, OpenCV {row['opencv_psnr']:6.2f} dB")


if __name__ == "__main__":
    main()
