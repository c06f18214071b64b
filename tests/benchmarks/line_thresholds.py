"""What half and twice each threshold of line continuation do.

    python tests/benchmarks/line_thresholds.py [PICTURE ...] --json

Holes 20 to 44 px wide are cut into the bundled example and into further pictures, at random places. Counted are the
pixels that are drawn along continued lines, and how far these are from what was there [levels of 255].
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from types import ModuleType

import cv2
import numpy as np
import source_tree  # noqa: F401
from numpy.typing import NDArray
from physanimator.rendering.pictures import as_float, load_image
from physanimator.rendering.plate import line_continuation, line_end, line_ends, line_pairs

EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example" / "illustration.png"
THRESHOLDS: dict[ModuleType, str] = {
    line_continuation: "_BAND _CROSSING _FALL",
    line_pairs: "_BEND _ASYMMETRY _DIFFERENCE _RELATIVE _LARGEST_COST _DISTINCT _ELSEWHERE _SHORTEST_GAP",
    line_ends: "_SIGMA _FAINTEST _STEEPEST _APART _STEPS _FEWEST _LINE",
    line_end: "_REST _REST_IN_MEAN _RESTING",
}
HOLES, MARGIN = 30, 130

Case = tuple[NDArray[np.float32], NDArray[np.bool_]]


def cases(picture: Path) -> list[Case]:
    """Windows of a picture, each with the hole that is cut into its middle."""
    image, random, found = as_float(load_image(picture)), np.random.default_rng(1), []
    height, width = image.shape[:2]
    for _ in range(HOLES):
        x, y = random.integers(MARGIN, width - MARGIN), random.integers(MARGIN, height - MARGIN)
        hole, axes = np.zeros((2 * MARGIN,) * 2, np.uint8), (int(random.integers(10, 22)), int(random.integers(30, 70)))
        cv2.ellipse(hole, (MARGIN, MARGIN), axes, float(random.uniform(0, 180)), 0, 360, 1, -1)
        found.append((image[y - MARGIN : y + MARGIN, x - MARGIN : x + MARGIN].copy(), hole > 0))
    return found


def measured(of: list[Case]) -> dict[str, float]:
    """Pixels drawn in all holes together, and their mean difference from what was there."""
    count, error = 0, 0.0
    for window, hole in of:
        known = np.where(hole[..., None], np.float32(0.5), window)
        filled, drawn = line_continuation.continue_lines(known, hole)
        count += int(drawn.sum())
        error += float(np.abs(filled - window).mean(axis=2)[drawn].sum()) * 255
    return {"pixels": count, "error": round(error / max(count, 1), 1)}


def with_factor(module: ModuleType, name: str, factor: float, of: list[Case]) -> dict[str, float]:
    """The same with one threshold changed."""
    usual = getattr(module, name)
    setattr(module, name, type(usual)(usual * factor))
    try:
        with np.errstate(divide="ignore"):
            return measured(of)
    finally:
        setattr(module, name, usual)


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pictures", type=Path, nargs="*", help="besides the bundled example")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    options = parser.parse_args()
    report: dict[str, dict[str, dict[str, float]]] = {}
    for number, picture in enumerate([EXAMPLE, *options.pictures]):
        cut = cases(picture)
        found = {"as it is": measured(cut)}
        for module, names in THRESHOLDS.items():
            for name in names.split():
                found |= {f"{name} x {factor}": with_factor(module, name, factor, cut) for factor in (0.5, 2)}
        report["example" if number == 0 else str(picture)] = found
    if options.json:
        print(json.dumps(report))
        return
    for source, rows in report.items():
        print(source)
        for name, row in rows.items():
            print(f"  {name:24} {row['pixels']:6} px, off by {row['error']:5.1f}")


if __name__ == "__main__":
    main()
