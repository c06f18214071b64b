"""What half and twice each threshold do, of line continuation, of the fill of holes, or of cuts from clicks.

    python tests/benchmarks/thresholds.py lines [PICTURE ...] --json

Holes 20 to 44 px wide are cut into the bundled example and into further pictures, at random places. Printed are

- "lines": the pixels that are drawn along continued lines, and how far these are from what was there [levels of 255];
- "smooth" and "fill": how far all pixels of holes are from what was there, filled smoothly, or with patches as well
  [levels of 255];
- "cut": the median and the least tenth of the intersection over union of cuts from two random points on parts and one
  beside them, on art that a program draws; pictures are not looked at.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

import cv2
import numpy as np
import source_tree  # loads this source tree as the package physanimator
from numpy.typing import NDArray
from physanimator.rendering.pictures import as_float, load_image
from physanimator.rendering.plate import (
    colour_spreading,
    fill_hole,
    line_continuation,
    line_end,
    line_ends,
    line_pairs,
    patch_search,
    patch_synthesis,
    plate,
    smooth_fill,
)
from physanimator.rendering.segmentation import (
    clicked_regions,
    grabcut,
    line_clicks,
    noise,
    outline_cuts,
    segment,
    trimap,
)

EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example" / "illustration.png"
LINES: dict[ModuleType, str] = {
    line_continuation: "_BAND _CROSSING _FALL",
    line_pairs: "_BEND _ASYMMETRY _DIFFERENCE _RELATIVE _LARGEST_COST _DISTINCT _ELSEWHERE _SHORTEST_GAP",
    line_ends: "_SIGMA _FAINTEST _STEEPEST _APART _STEPS _FEWEST _LINE",
    line_end: "_REST _REST_IN_MEAN _RESTING",
}
SMOOTH: dict[ModuleType, str] = {
    smooth_fill: (
        "_FILL_POWER _DEPTH _SWEEPS _AGREEMENT _BESIDE _FEWEST _MOST _REWEIGHTINGS _BETTER _BEYOND _CLOSE _INK"
        " _MOST_INK _AROUND _SOLVED"
    ),
    colour_spreading: "_LARGEST_WINDOW _ALONG _GROUPS _ALIKE _SHARPNESS _REACH",
}
FILL: dict[ModuleType, str] = {
    plate: "_TEXTURE _TEXTURE_DEPTH _CONTEXT _MATCHED_PIXELS",
    patch_search: "_COMPONENTS _SAMPLES _SWEEPS _GUIDE_WEIGHT _NEARNESS _FADING",
    patch_synthesis: "_ROUNDS",
}
CUT: dict[ModuleType, str] = {
    clicked_regions: (
        "_LARGEST_REGION _TEXTURE _GROWTH _SHORTEST _LOOKS _STROKES _SPREADS _LEAST_CONTRAST _BRIDGE LEAST_NOISE"
    ),
    noise: "_REACH _CLEAR",
    line_clicks: "_WIDEST _LEAST_CONTRAST _TIMES_NOISE _LONG _LINE_SHARE _BACKDROP _ALIKE _DIRECTIONS",
    trimap: "_COLOUR_BINS _BESIDE_HULL _MARGIN",
    outline_cuts: "_LINES_LEFT _LINE _WIDEST",
    grabcut: "_LINE",
}
ODD = ("_STROKES", "_REACH", "_WIDEST", "_BRIDGE")
HOLES = {"lines": 30, "smooth": 12, "fill": 6}
MARGIN = 130

Window = tuple[NDArray[np.float32], NDArray[np.bool_]]
Cut = tuple[NDArray[np.uint8], NDArray[np.bool_], NDArray[np.float64]]
Row = dict[str, float]


def windows(picture: Path, holes: int) -> list[Window]:
    """Windows of a picture, each with the hole that is cut into its middle."""
    image, random, found = as_float(load_image(picture)), np.random.default_rng(1), []
    height, width = image.shape[:2]
    for _ in range(holes):
        x, y = random.integers(MARGIN, width - MARGIN), random.integers(MARGIN, height - MARGIN)
        hole, axes = np.zeros((2 * MARGIN,) * 2, np.uint8), (int(random.integers(10, 22)), int(random.integers(30, 70)))
        cv2.ellipse(hole, (MARGIN, MARGIN), axes, float(random.uniform(0, 180)), 0, 360, 1, -1)
        found.append((image[y - MARGIN : y + MARGIN, x - MARGIN : x + MARGIN].copy(), hole > 0))
    return found


def painted_parts() -> list[Cut]:
    """Painted pictures with the mask of a part and points on it and beside it."""
    art, found = source_tree.helper("painted_art"), []
    for technique in art.TECHNIQUES:
        for seed, part in enumerate(art.PARTS):
            image, truth = art.painted(technique, part, seed=seed)
            found.append((image, truth, art.points_in(truth, 2, 1, seed=seed)))
    return found


def lines_of(of: list[Window]) -> Row:
    """Pixels drawn in all holes together, and their mean difference from what was there."""
    count, error = 0, 0.0
    for window, hole in of:
        known = np.where(hole[..., None], np.float32(0.5), window)
        filled, drawn = line_continuation.continue_lines(known, hole)
        count += int(drawn.sum())
        error += float(np.abs(filled - window).mean(axis=2)[drawn].sum()) * 255
    return {"pixels": count, "error": round(error / max(count, 1), 1)}


def smooth_of(of: list[Window]) -> Row:
    """Mean difference of all holes' pixels from what was there, without lines and patches."""
    return fill_of(of, smooth_fill.smooth_fill)


def fill_of(of: list[Window], fill: Callable[[Any, Any], Any] = fill_hole) -> Row:
    """Mean difference of all holes' pixels from what was there."""
    errors = []
    for window, hole in of:
        filled = fill(np.where(hole[..., None], np.float32(0.5), window), hole)
        errors.append(np.abs(filled - window).mean(axis=2)[hole])
    return {"error": round(float(np.concatenate(errors).mean()) * 255, 2)}


def cut_of(of: list[Cut]) -> Row:
    """Intersection over union of all cuts."""
    overlaps = []
    for image, truth, points in of:
        mask = segment(image, points[:, :2], points[:, 2])
        overlaps.append(float((mask & truth).sum() / (mask | truth).sum()))
    return {"median": round(float(np.median(overlaps)), 3), "tenth": round(float(np.quantile(overlaps, 0.1)), 3)}


@contextmanager
def scaled(module: ModuleType, name: str, factor: float) -> Iterator[None]:
    """A threshold, or each of several in a tuple, times a factor; sizes of windows stay odd."""
    usual = getattr(module, name)

    def changed(value: Any) -> Any:
        return type(value)(value * factor) | (name in ODD) if isinstance(value, int) else type(value)(value * factor)

    setattr(module, name, tuple(map(changed, usual)) if isinstance(usual, tuple) else changed(usual))
    try:
        with np.errstate(divide="ignore"):
            yield
    finally:
        setattr(module, name, usual)


def rows(thresholds: dict[ModuleType, str], measured: Callable[[Any], Row], of: Any) -> dict[str, Row]:
    """What is measured as it is, and with each threshold changed."""
    found = {"as it is": measured(of)}
    for module, names in thresholds.items():
        for name in names.split():
            for factor in (0.5, 2):
                with scaled(module, name, factor):
                    found[f"{module.__name__.rpartition('.')[2]} {name} x {factor}"] = measured(of)
    return found


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=[*HOLES, "cut"])
    parser.add_argument("pictures", type=Path, nargs="*", help="besides the bundled example")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    options = parser.parse_args()
    report: dict[str, dict[str, Row]] = {}
    if options.what == "cut":
        report["painted"] = rows(CUT, cut_of, painted_parts())
    else:
        kinds = {"lines": (LINES, lines_of), "smooth": (SMOOTH, smooth_of), "fill": (FILL, fill_of)}
        thresholds, measured = kinds[options.what]
        for picture in [EXAMPLE, *options.pictures]:
            name = "example" if picture == EXAMPLE else str(picture)
            report[name] = rows(thresholds, measured, windows(picture, HOLES[options.what]))
    if options.json:
        print(json.dumps(report))
        return
    for source, table in report.items():
        print(source)
        for name, row in table.items():
            print(f"  {name:40}", *(f"{key} {value:8}" for key, value in row.items()))


if __name__ == "__main__":
    main()
