"""Ways of warping a sketch against layered truth.

    python tests/benchmarks/sketch_warp.py FOLDER [FOLDER ...] --json

Each folder holds composite.png, background.png, sprite.png (what moves, transparent around) and mask_sprite.png. The
sprite moves in the automatic scene. In the true frame it is deformed at twice the resolution and laid over the true
background, and the true sketch is extracted from that; the ways of warping only saw the composite and the mask.
Distances up to 1.5 px count as found. For each way:

    still        share of the true still lines that are found, far from the body
    still_near   the same beside the body and where it has been
    moving       share of the true lines on the body that are found
    ghost        share of the body's old lines that should be gone and are still there
    chamfer      mean distance between the warped and the true lines, of both ways [px]
    holes        share of the picture that is reported as unknown
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from physanimator.physics.mesh import PixelBox, TriangleMesh, interpolate
from physanimator.physics.motion import FlowSequence
from physanimator.rendering.composite import ApronedMesh, canvas_of
from physanimator.rendering.metrics import chamfer_distance
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.pictures import load_image, load_mask
from physanimator.rendering.pipeline import animate
from physanimator.rendering.sketch import extract_sketch, warped_sketches
from PIL import Image

FOUND = 1.5
GONE = 2.5
FINER = 2
REACH = 16
FRAMES = (12, 20, 28, 36, 44)


class Truth:
    """Draws the true frames of a sample."""

    def __init__(self, folder: Path, mesh: TriangleMesh) -> None:
        rgba = np.asarray(Image.open(folder / "sprite.png").convert("RGBA")).astype(np.float32) / 255
        self.background = load_image(folder / "background.png").astype(np.float32) / 255
        self.canvas = canvas_of(mesh, reach=REACH)
        height, width = rgba.shape[:2]
        rows = np.clip(np.arange(self.canvas.top, self.canvas.bottom), 0, height - 1)
        columns = np.clip(np.arange(self.canvas.left, self.canvas.right), 0, width - 1)
        premultiplied = np.dstack([rgba[..., :3] * rgba[..., 3:], rgba[..., 3]])
        self.texture = np.ascontiguousarray(premultiplied[rows[:, None], columns])
        self.mesh = ApronedMesh.around(mesh, self.texture[..., 3], self.canvas, reach=REACH)

    def frame(self, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The frame and the body's opacity, shape [h, w, 3] and [h, w]."""
        height, width = self.background.shape[:2]
        points = self.mesh.positions(vertices)
        box = PixelBox(0, 0, width * FINER, height * FINER)
        x, y = interpolate(points * FINER, self.mesh.triangles, self.mesh.rest - points, box, fill=-1e4)
        x += (np.arange(box.width, dtype=np.float32) + 0.5) / FINER - 0.5 - self.canvas.left
        y += ((np.arange(box.height, dtype=np.float32) + 0.5) / FINER - 0.5 - self.canvas.top)[:, None]
        drawn = cv2.remap(self.texture, x, y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_CONSTANT, borderValue=0)
        drawn = cv2.resize(np.clip(drawn, 0, 1), (width, height), interpolation=cv2.INTER_AREA)
        return drawn[..., :3] + (1 - drawn[..., 3:]) * self.background, drawn[..., 3]


def away(lines: np.ndarray) -> np.ndarray:
    """Distance to the nearest line [px]."""
    return cv2.distanceTransform((~lines).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)


def grown(mask: np.ndarray, reach: int) -> np.ndarray:
    return cv2.dilate(mask.astype(np.uint8), np.ones((2 * reach + 1,) * 2, np.uint8)) > 0


def figures(warped: Any, true: np.ndarray, alpha: np.ndarray, before: np.ndarray, body: np.ndarray) -> dict[str, float]:
    """Figures of one frame.

    Args:
        warped: what a way of warping gives.
        true: the true sketch, shape [h, w].
        alpha: opacity of the body in the frame, shape [h, w].
        before: the sketch of the drawing, shape [h, w].
        body: where the body is in the drawing, shape [h, w].
    """
    lines, found = true < 0.5, away(warped.sketch < 0.5) <= FOUND
    region = grown(body | (alpha > 0.5), 6)
    old = (before < 0.5) & grown(body, 3) & (away(lines) > GONE)
    return {
        "still": float(found[lines & ~region].mean()),
        "still_near": float(found[lines & region & (alpha < 0.02)].mean()),
        "moving": float(found[lines & (alpha > 0.5)].mean()),
        "ghost": float((warped.sketch < 0.5)[old].mean()),
        "chamfer": chamfer_distance(warped.sketch, true),
        "holes": float(warped.holes.mean()),
    }


def measure(folder: Path, wind: float) -> dict[str, Any]:
    """Figures of one sample, the mean over some frames."""
    image = load_image(folder / "composite.png")
    height, width = image.shape[:2]
    mask = load_mask(folder / "mask_sprite.png", width=width, height=height)
    animation = animate(
        image, [mask], preset="hair", timing=Timing(frames=FRAMES[-1] + 1), wind=AutomaticWind(strength=wind)
    )
    truth, flow = Truth(folder, animation.motion.bodies[0].mesh), FlowSequence(animation.motion)
    frames = [truth.frame(animation.motion.positions[t]) for t in FRAMES]
    sketch, plate = extract_sketch(image), extract_sketch(animation.renderer.plate)
    ways: dict[str, dict[str, Any]] = {
        "paper": {"mode": "paper"},
        "softmax": {"mode": "softmax"},
        "layered": {"mode": "layered"},
        "layered, with lines behind": {"mode": "layered", "behind": plate},
    }
    table = {}
    for name, options in ways.items():
        rows = [
            figures(warped, extract_sketch(frame.astype(np.float32)), alpha, sketch, mask > 0.5)
            for warped, (frame, alpha) in zip(
                warped_sketches(sketch, flow, FRAMES, blur_sigma=0, **options), frames, strict=True
            )
        ]
        table[name] = {key: float(np.mean([row[key] for row in rows])) for key in rows[0]}
    return table


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", type=Path, nargs="+")
    parser.add_argument("--wind", type=float, default=2.0, help="strength of the automatic wind (default 2)")
    parser.add_argument("--json", action="store_true", help="print the whole document")
    options = parser.parse_args()
    table = {folder.name: measure(folder, options.wind) for folder in options.folders}
    if options.json:
        print(json.dumps(table, indent=2))
        return
    for name, rows in table.items():
        print(name)
        for way, row in rows.items():
            print(f"{way:>28} " + "  ".join(f"{key} {value:.4f}" for key, value in row.items()))


if __name__ == "__main__":
    main()
