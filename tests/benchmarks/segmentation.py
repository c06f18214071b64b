"""Masks from clicks against masks drawn by hand.

    python tests/benchmarks/segmentation.py [FOLDER] --json

FOLDER holds layered samples, one folder each, with composite.png and mask*.png (mask_sprite.png is left out); without
it the example that comes with the pack is measured. Printed is the intersection over union (IoU)

- "clicked": from the points of --points (at most five, chosen by looking at the pictures), and its least and median
  when every point is moved at random by up to --jitter pixels;
- "simulated": after each of --clicks clicks of the usual protocol, which puts the next click at the deepest place of
  the largest mistake (Xu et al., Deep interactive object selection, 2016);
- with --grid "grid" instead: from 1, 3 and 12 random points, with and without as many beside, on art without outlines
  that a program draws, and on the samples as they are, painted over, noisy, blurred, compressed, scaled, posterised:
  the least, the median, and how many cuts are specks (below a twentieth of the part) or swollen (above twice the part).
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter
from typing import Any

import cv2
import numpy as np
import source_tree  # loads this source tree as the package physanimator
from physanimator.physics.errors import PhysAnimatorError
from physanimator.rendering.pictures import load_image, load_mask
from physanimator.rendering.segmentation import segment

art = source_tree.helper("painted_art")
DAMAGES, PARTS, TECHNIQUES, painted, points_in = art.DAMAGES, art.PARTS, art.TECHNIQUES, art.painted, art.points_in
EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example"
POINTS = Path(__file__).with_name("segmentation_points.json")


def iou(mask: np.ndarray, truth: np.ndarray) -> float:
    """Intersection over union."""
    return float((mask & truth).sum() / max(1, (mask | truth).sum()))


def samples(folder: Path) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Name, picture and mask of every sample."""
    for picture in sorted([*folder.glob("*/composite.png"), *folder.glob("illustration.png")]):
        image = load_image(picture)
        height, width = image.shape[:2]
        for path in sorted(picture.parent.glob("mask*.png")):
            if path.stem != "mask_sprite":
                mask = load_mask(path, width=width, height=height) > 0.5
                yield f"{picture.parent.name}/{path.stem}", image, mask


def clicked(image: np.ndarray, truth: np.ndarray, points: list[list[float]], jitter: float, times: int) -> Any:
    """IoU from given points, exact and moved about."""
    given = np.array(points, dtype=float)
    height, width = truth.shape
    generator = np.random.default_rng(0)
    start = perf_counter()
    result: dict[str, Any] = {"points": len(given), "iou": iou(segment(image, given[:, :2], given[:, 2]), truth)}
    result["seconds"] = perf_counter() - start
    moved = []
    for _ in range(times):
        shaken = given[:, :2] + generator.uniform(-jitter, jitter, (len(given), 2))
        moved.append(iou(segment(image, np.clip(shaken, 0, (width - 1, height - 1)), given[:, 2]), truth))
    return result | ({"jitter_least": min(moved), "jitter_median": float(np.median(moved))} if moved else {})


def next_click(mask: np.ndarray, truth: np.ndarray) -> list[float]:
    """The deepest pixel of the largest connected mistake: x, y, label."""
    wrong = np.pad(mask != truth, 1).astype(np.uint8)
    _, labels, statistics, _ = cv2.connectedComponentsWithStats(wrong, connectivity=4)
    largest = 1 + int(np.argmax(statistics[1:, cv2.CC_STAT_AREA]))
    depth = cv2.distanceTransform((labels == largest).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1]
    y, x = np.unravel_index(int(depth.argmax()), depth.shape)
    return [float(x) + 0.5, float(y) + 0.5, float(truth[y, x])]


def simulated(image: np.ndarray, truth: np.ndarray, clicks: int) -> list[float]:
    """IoU after each click of the protocol."""
    points: list[list[float]] = []
    mask, result = np.zeros_like(truth), []
    for _ in range(clicks):
        points.append(next_click(mask, truth))
        given = np.array(points)
        mask = segment(image, given[:, :2], given[:, 2])
        result.append(iou(mask, truth))
    return result


def cases(folder: Path) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Kind, picture and mask of everything in the grid."""
    for technique in TECHNIQUES:
        for seed, part in enumerate(PARTS):
            yield technique, *painted(technique, part, width=640, height=480, seed=seed)
    for _, image, truth in samples(folder):
        for name, damage in DAMAGES.items():
            yield f"sample, {name}", *damage(image, truth)


def grid(folder: Path, seeds: int) -> dict[str, dict[str, Any]]:
    """IoU of cuts from random points, by kind of picture and number of points on and beside the part."""
    found: dict[str, list[tuple[float, float]]] = {}
    for kind, image, truth in cases(folder):
        for on, beside in ((1, 0), (1, 1), (3, 0), (3, 3), (12, 0), (12, 12)):
            for seed in range(seeds):
                points = points_in(truth, on, beside, seed=seed)
                mask = segment(image, points[:, :2], points[:, 2])
                pair = iou(mask, truth), float(mask.sum() / truth.sum())
                for key in ("all", kind, f"{on} on, {beside} beside"):
                    found.setdefault(key, []).append(pair)
    return {key: summed(np.array(pairs)) for key, pairs in found.items()}


def summed(pairs: np.ndarray) -> dict[str, Any]:
    """What is printed of several cuts: IoU, and size as a share of the part's."""
    overlap, size = pairs.T
    quantiles = {"least": overlap.min(), "tenth": np.quantile(overlap, 0.1), "median": np.median(overlap)}
    row = {key: round(float(value), 3) for key, value in quantiles.items()}
    return {"cuts": len(pairs), **row, "specks": int((size < 0.05).sum()), "swollen": int((size > 2).sum())}


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=EXAMPLE)
    parser.add_argument("--points", type=Path, default=POINTS, help='{"sample/mask": [[x, y, label], ...]}')
    parser.add_argument("--clicks", type=int, default=5, help="of the protocol (default 5)")
    parser.add_argument("--jitter", type=float, default=6, help="how far points are moved [px] (default 6)")
    parser.add_argument("--times", type=int, default=20, help="how often points are moved (default 20)")
    parser.add_argument("--json", action="store_true", help="print the whole document")
    parser.add_argument("--grid", action="store_true", help="measure the grid of pictures and points instead")
    parser.add_argument(
        "--seeds", type=int, default=1, help="sets of random points for each cell of the grid (default 1)"
    )
    options = parser.parse_args()
    if options.grid:
        print(json.dumps({"grid": grid(options.folder, options.seeds)}, indent=2))
        return
    points = json.loads(options.points.read_text(encoding="utf-8"))
    document: dict[str, dict[str, Any]] = {"clicked": {}, "simulated": {}}
    for name, image, truth in samples(options.folder):
        if name in points:
            document["clicked"][name] = clicked(image, truth, points[name], options.jitter, options.times)
        document["simulated"][name] = simulated(image, truth, options.clicks)
    if not document["simulated"]:
        raise PhysAnimatorError(f"{options.folder} must hold folders with composite.png and mask*.png. Got: none")
    if options.json:
        print(json.dumps(document, indent=2))
        return
    for name, row in document["clicked"].items():
        print(f"{name:>32} {row['points']} points", *(f"{key} {row[key]:.3f}" for key in row if key != "points"))
    for name, values in document["simulated"].items():
        print(f"{name:>32} clicks  ", *(f"{value:.3f}" for value in values))


if __name__ == "__main__":
    main()
