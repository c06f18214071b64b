"""Rendered frames against the truth, on layered pictures; and their speed.

    python tests/benchmarks/rendering.py [FOLDER] --json

Each folder in FOLDER holds composite.png (the flat drawing), sprite.png (the figure alone, RGBA), background.png (what
is behind it) and mask.png (the part that moves). The part moves in the automatic scene. Ours and its peers see only the
flat drawing, the mask and the motion; the truth is drawn from the layers (see layered_truth.py), the scores are in
rendering_scores.py, the peers in rendering_peers.py.

Prints ``{"table": {sample: {method: {metric: _}}}, "ours_first_everywhere": _, "not_first": [...], "speed": {...}}``:
speed in milliseconds a frame at 1280x720, with ``cv2.remap`` of one RGB frame in the same run as the yardstick. With
``--large`` also the peak memory of 240 frames of 3840x2160.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from layered_sample import load_sample, sample_folders
from layered_truth import TrueFrames
from meshes import mesh_of_about
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.motion import FlowSequence
from physanimator.physics.scene import Body, automatic_scene
from physanimator.physics.simulation import simulate
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.pipeline import animate
from physanimator.rendering.sketch import extract_sketch, warp_sketch
from pipeline import illustration, timed
from rendering_peers import Peers
from rendering_scores import BETTER, Scores

SAMPLES = Path(__file__).resolve().parents[3] / "shared" / "samples"

Table = dict[str, dict[str, dict[str, float | None]]]


def measure(folder: Path, options: argparse.Namespace) -> dict[str, dict[str, float | None]]:
    """The scores of every method on one sample."""
    sample = load_sample(folder, mask_name=options.mask)
    animation = animate(
        sample.picture,
        [sample.mask],
        preset=options.preset,
        timing=Timing(frames=options.frames),
        wind=AutomaticWind(strength=options.wind, angle=options.wind_angle),
    )
    truth, peers = TrueFrames(sample, animation.motion), Peers(sample.picture, sample.mask, animation.motion)
    methods = {"ours": animation.renderer.frame, **peers.methods}
    scores = {name: Scores() for name in methods}
    for t in range(0, options.frames, options.every):
        true = truth.frame(t)
        drawn = {name: method(t) for name, method in methods.items()}
        drawn["ours"] = drawn["ours"].astype(np.float32) / np.float32(255)
        for name, frame in drawn.items():
            scores[name].add(frame, true)
        if options.sheet:
            write_sheet(options.sheet / f"{folder.name}_{t:03}.png", {"truth": true.picture, **drawn}, true)
    return {name: each.table() for name, each in scores.items()}


def not_first(table: Table) -> list[str]:
    """Where ours is behind another method: sample, metric and method."""
    behind = []
    for sample, methods in table.items():
        for metric, sign in BETTER.items():
            ours = methods["ours"][metric]
            for method, row in methods.items():
                theirs = row[metric]
                if ours is not None and theirs is not None and sign * (theirs - ours) > 0:
                    behind.append(f"{sample}: {metric}: {method} {theirs:.4f}, ours {ours:.4f}")
    return behind


def speed(rounds: int = 20) -> dict[str, float]:
    """Milliseconds of warp, composite and extraction at 1280x720, and as multiples of cv2.remap."""
    image, mask = illustration()
    motion = simulate(automatic_scene([Body(mesh_of_about(mask, 2000), preset("hair"))]), frames=25)
    renderer, fields, sketch = LayeredRenderer(image, [mask], motion), FlowSequence(motion), extract_sketch(image)
    rows, columns = np.mgrid[0 : image.shape[0], 0 : image.shape[1]].astype(np.float32)
    moved = columns + 3.3 * np.sin(rows / 40), rows + 2.7 * np.cos(columns / 50)
    stages = {
        "remap": lambda t: cv2.remap(image, *moved, cv2.INTER_LINEAR),
        "composite": renderer.frame,
        "warp": lambda t: warp_sketch(sketch, fields.flow(t)),
        "extract": lambda t: extract_sketch(image),
    }
    times: dict[str, list[float]] = {name: [] for name in stages}
    for number in range(rounds + 1):
        for name, stage in stages.items():
            taken = timed(lambda stage=stage, number=number: stage(1 + number % 24))
            times[name] += [taken] if number else []
    found = {f"{name}_ms": statistics.median(values) for name, values in times.items()}
    return found | {f"{name}_of_remap": found[f"{name}_ms"] / found["remap_ms"] for name in stages if name != "remap"}


def large() -> dict[str, Any]:
    """What large_clip.py measures, in a process of its own."""
    script = Path(__file__).with_name("large_clip.py")
    return json.loads(subprocess.run([sys.executable, str(script)], capture_output=True, check=True, text=True).stdout)


def write_sheet(path: Path, pictures: dict[str, np.ndarray], true: Any) -> None:
    """The moved part as each method draws it, side by side, to look at."""
    left, top, width, height = cv2.boundingRect((true.alpha > 0).astype(np.uint8) | true.uncovered.astype(np.uint8))
    rows, columns = slice(max(0, top - 20), top + height + 20), slice(max(0, left - 20), left + width + 20)
    tiles = []
    for name, picture in pictures.items():
        tile = np.rint(np.clip(picture[rows, columns, ::-1], 0, 1) * 255).astype(np.uint8)
        tiles.append(cv2.putText(tile.copy(), name, (4, 14), cv2.FONT_HERSHEY_SIMPLEX, 0.45, (0, 0, 255), 1))
    tiles += [np.zeros_like(tiles[0])] * (-len(tiles) % 4)
    path.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(path), np.vstack([np.hstack(tiles[k : k + 4]) for k in range(0, len(tiles), 4)]))


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", default=SAMPLES, help=f"layered samples (default {SAMPLES})")
    parser.add_argument("--mask", default="mask.png", help="name of the mask in each folder (default mask.png)")
    parser.add_argument("--preset", default="hair", help="material (default hair)")
    parser.add_argument("--wind", type=float, default=1.5, help="strength of the automatic wind (default 1.5)")
    parser.add_argument("--wind-angle", type=float, default=0.0, help="where it blows to [degrees], 90 is up")
    parser.add_argument("--frames", type=int, default=48, help="length of the clip (default 48)")
    parser.add_argument("--every", type=int, default=2, help="frames from one that is measured to the next (default 2)")
    parser.add_argument("--sheet", type=Path, help="folder for pictures of all methods side by side")
    parser.add_argument("--large", action="store_true", help="also the memory of a clip of 3840x2160")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    return parser.parse_args()


def main() -> None:
    """Read the command line, measure, print."""
    options = arguments()
    start = time.perf_counter()
    try:
        table = {folder.name: measure(folder, options) for folder in sample_folders(options.folder)}
    except InvalidInputError as error:
        sys.exit(str(error))
    behind = not_first(table)
    result: dict[str, Any] = {"table": table, "ours_first_everywhere": not behind, "not_first": behind}
    result["speed"] = speed()
    if options.large:
        result["large"] = large()
    result["total_s"] = time.perf_counter() - start
    if options.json:
        print(json.dumps(result, indent=2))
        return
    for sample, methods in table.items():
        print(sample)
        for name, row in methods.items():
            figures = "  ".join("-" if value is None else f"{metric} {value:8.4f}" for metric, value in row.items())
            print(f"  {name:>28}  {figures}")
    print("\n".join(behind) or "ours is first everywhere")
    print(", ".join(f"{name} {value:.2f}" for name, value in result["speed"].items()))
    if options.large:
        print(result["large"])


if __name__ == "__main__":
    main()
