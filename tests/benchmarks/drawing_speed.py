"""Times line drawing and sketch warping at 1280x720 against cv2.remap of one RGB frame in the same run.

    python tests/benchmarks/drawing_speed.py --json [--large]

Prints ``{"ms": {...}, "ratios": {...}, "peak_mb": {...}, ...}``. A figure is the median over rounds in which all take
turns. The networks have random weights of the public sizes; ``peak_mb`` is the most memory that each needs in a process
of its own, weights and libraries included. ``--large`` adds a picture of 3840x2160.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import resource
import statistics
import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
import torch
from meshes import mesh_of_about
from physanimator.physics.material import preset
from physanimator.physics.motion import FlowSequence
from physanimator.physics.scene import Body, automatic_scene
from physanimator.physics.simulation import simulate
from physanimator.rendering.sketch import LayeredSketch, extract_sketch, warp_sketch
from physanimator.rendering.sketch.drawings import InformativeDrawingsConfiguration, SketchUNetConfiguration
from physanimator.rendering.sketch.drawings.extractor import draw_sketch
from physanimator.rendering.sketch.drawings.informative_drawings import InformativeDrawings
from physanimator.rendering.sketch.drawings.models import LineDrawer
from physanimator.rendering.sketch.drawings.sketch_unet import SketchUNet
from pipeline import TRIANGLES, illustration, timed

NETWORKS: dict[str, Callable[[], LineDrawer]] = {
    "informative_drawings": lambda: InformativeDrawings(InformativeDrawingsConfiguration()),
    "sketch_unet": lambda: SketchUNet(SketchUNetConfiguration()),
}


def warps(image: np.ndarray, mask: np.ndarray) -> dict[str, Callable[[], Any]]:
    """Every way of warping the sketch of one frame, for a body of a tenth of the picture in the automatic wind."""
    scene = automatic_scene([Body(mesh_of_about(mask, TRIANGLES), preset("hair"))])
    flow, sketch = FlowSequence(simulate(scene, frames=25)), extract_sketch(image)
    layers, field = LayeredSketch(sketch, flow), flow.flow(20)
    return {
        "warp_layered": lambda: layers.frame(20),
        "warp_paper": lambda: warp_sketch(sketch, field, mode="paper"),
        "warp_softmax": lambda: warp_sketch(sketch, field, mode="softmax"),
        "take_apart_once": lambda: LayeredSketch(sketch, flow),
    }


def measure(rounds: int, *, large: bool) -> dict[str, Any]:
    """Run everything once to warm up, then in turn."""
    image, mask = illustration()
    rows, columns = np.mgrid[0 : image.shape[0], 0 : image.shape[1]].astype(np.float32)
    map_x, map_y = columns + 3.3 * np.sin(rows / 40), rows + 2.7 * np.cos(columns / 50)
    stages: dict[str, Callable[[], Any]] = {
        "remap": lambda: cv2.remap(image, map_x, map_y, cv2.INTER_LINEAR),
        "extract_sketch": lambda: extract_sketch(image),
        **warps(image, mask),
    }
    times: dict[str, list[float]] = {name: [] for name in stages}
    for number in range(rounds + 1):
        for name, stage in stages.items():
            elapsed = timed(stage)
            if number:
                times[name].append(elapsed)
    ms, peak = {name: statistics.median(values) for name, values in times.items()}, {}
    for name in NETWORKS:
        ms[name], peak[name] = _alone(name, image)
    if large:
        picture = cv2.resize(image, (3840, 2160), interpolation=cv2.INTER_CUBIC)
        ms["extract_sketch_2160p"] = timed(lambda: extract_sketch(picture))
        ms["informative_drawings_2160p"], peak["informative_drawings_2160p"] = _alone("informative_drawings", picture)
    ratios = {name: value / ms["remap"] for name, value in ms.items() if name != "remap"}
    threads = {"opencv": cv2.getNumThreads(), "torch": torch.get_num_threads()}
    return {"ms": ms, "ratios": ratios, "peak_mb": peak, "threads": threads, "rounds": rounds}


def _alone(name: str, image: np.ndarray) -> tuple[float, float]:
    """Milliseconds and most memory [MB] of a network that draws a picture in a process of its own."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(_drawn, (name, image))


def _drawn(name: str, image: np.ndarray) -> tuple[float, float]:
    network = NETWORKS[name]().eval()
    draw_sketch(image[:256, :256], network)
    start = time.perf_counter()
    draw_sketch(image, network)
    elapsed = (time.perf_counter() - start) * 1000
    return elapsed, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="print the whole document instead of a table")
    parser.add_argument("--rounds", type=int, default=15, help="how often each stage is timed (default 15)")
    parser.add_argument("--large", action="store_true", help="also draw a picture of 3840x2160")
    options = parser.parse_args()
    result = measure(options.rounds, large=options.large)
    if options.json:
        print(json.dumps(result, indent=2))
        return
    for name, value in result["ms"].items():
        peak = f"{result['peak_mb'][name]:9.0f} MB" if name in result["peak_mb"] else ""
        print(f"{name:>28} {value:10.1f} ms {value / result['ms']['remap']:9.1f} x cv2.remap{peak}")


if __name__ == "__main__":
    main()
