"""Times each stage of the pipeline at 1280x720 against cv2.remap of one RGB frame in the same run.

    python tests/benchmarks/pipeline.py --json

Prints ``{"ms": {...}, "ratios": {...}, "simulation_of_real_time": _, "plate_in_remaps": _, "first_frame_cold_s": _,
"demo_warm_s": _, "demo_stages_s": {...}, ...}``. A figure is the median over rounds in which every stage and the
yardstick take turns, so that a slow moment hits all alike.
"""

from __future__ import annotations

import argparse
import json
import platform
import statistics
import time
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from artwork_speed import layers_measured
from demo_speed import demo_measured, plate_measured
from meshes import SIDE2_OVER_AREA, mesh_of_about
from physanimator.physics.assembly import plan
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import FlowSequence
from physanimator.physics.scene import Body, automatic_scene
from physanimator.physics.simulation import simulate
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.plate import clean_plate
from physanimator.rendering.sketch import extract_sketch, warp_sketch

WIDTH, HEIGHT = 1280, 720
TRIANGLES = 2000


def illustration() -> tuple[np.ndarray, np.ndarray]:
    """A drawn test card of 1280x720: a leaf-shaped body of a tenth of the frame over stripes and gradients."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.float32)
    image = np.stack([x / WIDTH, y / HEIGHT, 0.5 + 0.5 * np.sin(x / 23)], axis=-1)
    mask = ((x - 640) / (150 + 60 * np.sin(y / 90))) ** 2 + ((y - 360) / 220) ** 2 < 1
    image[mask] = np.stack([0.8 - y / 2000, 0.3 + x / 4000, 0.3 + 0 * x], axis=-1)[mask]
    image = (image * 255).astype(np.uint8)
    contours, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    cv2.drawContours(image, contours, -1, (30, 20, 40), 3, cv2.LINE_AA)
    return image, mask


def timed(function: Callable[[], Any]) -> float:
    """Milliseconds that one call takes."""
    start = time.perf_counter()
    function()
    return (time.perf_counter() - start) * 1000


def measure(rounds: int) -> dict[str, Any]:
    """Run everything once to warm up, then ``rounds`` times in turn."""
    image, mask = illustration()
    start = time.perf_counter()
    mesh = mesh_of_about(mask, TRIANGLES)
    meshing_ms = timed(lambda: mesh_from_mask(mask, spacing=float(np.sqrt(mesh.areas.mean() * SIDE2_OVER_AREA))))
    scene = automatic_scene([Body(mesh, preset("hair"))])
    frames = int(scene.frame_rate) + 1
    simulate(scene, frames=2)
    motion = simulate(scene, frames=frames)
    plate_ms = timed(lambda: clean_plate(image, mask))
    sketch_ms = timed(lambda: extract_sketch(image))
    flow, renderer, sketch = FlowSequence(motion), LayeredRenderer(image, [mask], motion), extract_sketch(image)
    rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.float32)
    map_x, map_y = columns + 3.3 * np.sin(rows / 40), rows + 2.7 * np.cos(columns / 50)
    stages: dict[str, Callable[[int], Any]] = {
        "remap": lambda t: cv2.remap(image, map_x, map_y, cv2.INTER_LINEAR),
        "flow": flow.flow,
        "composite": renderer.frame,
        "sketch_warp": lambda t: warp_sketch(sketch, fields[t]),
    }
    fields = [flow.flow(t) for t in range(len(motion))]
    times: dict[str, list[float]] = {name: [] for name in (*stages, "simulate")}
    for round_number in range(rounds + 2):
        t = 1 + round_number % (len(motion) - 1)
        for name, stage in stages.items():
            elapsed = timed(lambda stage=stage, t=t: stage(t))
            if round_number >= 2:
                times[name].append(elapsed)
    for _ in range(5):
        times["simulate"].append(timed(lambda: simulate(scene, frames=frames)) / (frames - 1))
    ms = {name: statistics.median(values) for name, values in times.items()}
    plates = plate_measured()
    return {
        "ms": {**ms, "mesh_once": meshing_ms, "clean_plate_once": plate_ms, "extract_sketch_once": sketch_ms},
        "ratios": {name: ms[name] / ms["remap"] for name in ("flow", "composite", "sketch_warp")},
        "simulation_of_real_time": ms["simulate"] * scene.frame_rate / 1000,
        "layers": layers_measured(),
        "plate_in_remaps": max(plates.values()),
        "plates_in_remaps": plates,
        **demo_measured(),
        "triangles": len(mesh.triangles),
        "body_share_of_frame": float(mask.mean()),
        "substeps_per_frame": plan(scene, frames=frames).substeps_per_frame,
        "rounds": rounds,
        "machine": {"cores": cv2.getNumberOfCPUs(), "processor": platform.machine(), "opencv": cv2.__version__},
        "total_s": time.perf_counter() - start,
    }


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="print the whole document instead of a table")
    parser.add_argument("--rounds", type=int, default=40, help="how often each stage is timed (default 40)")
    arguments = parser.parse_args()
    result = measure(arguments.rounds)
    if arguments.json:
        print(json.dumps(result, indent=2))
        return
    for name, value in result["ms"].items():
        print(f"{name:>22} {value:9.2f} ms")
    for name, value in result["ratios"].items():
        print(f"{name:>22} {value:9.2f} x cv2.remap")
    layers = result["layers"]
    print(f"{'a frame of layers':>22} {layers['frame_of_remap']:9.2f} x cv2.remap")
    print(f"{'first frame of layers':>22} {layers['first_frame_ratio']:9.2f} x with masks")
    print(f"{'plate of one part':>22} {result['plate_in_remaps']:9.2f} x cv2.remap, at most")
    for name in ("first_progress_cold_s", "first_frame_cold_s", "demo_warm_s"):
        print(f"{name:>22} {result[name]:9.2f} s")
    for name, value in result["demo_stages_s"].items():
        print(f"{name:>22} {value:9.2f} s of it")


if __name__ == "__main__":
    main()
