"""What contact costs: the same scene with it and without, in turns.

Without contact, bodies are computed side by side, each on a thread; with it, threads share all of them and wait for
each other in every step. ``--one-core`` leaves out what that costs.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import source_tree  # noqa: F401  (loads this source tree as the package physanimator)
from physanimator.physics.document import scene_from_dict
from physanimator.physics.forces import EnergyStroke
from physanimator.physics.material import Material
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.rig import Circle, KeyedPath, Pinned, RigPoint
from physanimator.physics.scene import Body, Contact, Scene
from physanimator.physics.simulation import simulate
from physanimator.rendering.pictures import load_mask

__all__ = ["contact_costs"]

EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example"


def four_blobs() -> Scene:
    """Soft discs that are drawn to one place, where they pile up."""
    y, x = np.mgrid[0:512, 0:512]
    soft = Material(youngs_modulus=100.0, damping=0.5)
    discs = [np.hypot(x - a, y - b) < 60 for a, b in ((120, 130), (390, 140), (130, 390), (380, 380))]
    pull = EnergyStroke(kind="attract", path=((256.0, 256.0),), radius=400.0, speed=0.0, strength=6.0)
    return Scene(tuple(Body(mesh_from_mask(disc, spacing=8), soft) for disc in discs), (pull,))


def folding_curl() -> Scene:
    """An open ring whose end is led into its other end; every vertex of the border may meet every edge."""
    y, x = np.mgrid[0:512, 0:512]
    radius, angle = np.hypot(x - 256, y - 256), np.arctan2(y - 256, x - 256)
    mesh = mesh_from_mask((radius > 80) & (radius < 112) & (np.abs(angle) > 0.5), spacing=6)
    held = RigPoint((160.0, 256.0), Circle(34.0), Pinned())
    end = RigPoint((340.0, 302.0), Circle(24.0), KeyedPath((0.0, 0.5, 1.5), ((340, 302), (340, 220), (300, 170))))
    return Scene((Body(mesh, Material(youngs_modulus=300.0, damping=0.5)),), rig_points=(held, end))


def example() -> Scene:
    """The bundled illustration's hair, cape, ribbon and plant."""
    document = json.loads((EXAMPLE / "scene.json").read_text(encoding="utf-8"))
    width, height = document["width"], document["height"]
    masks = [load_mask(EXAMPLE / f"mask_{body['name']}.png", width=width, height=height) for body in document["bodies"]]
    return scene_from_dict(document, meshes=[mesh_from_mask(mask) for mask in masks])


SCENES: dict[str, Callable[[], Scene]] = {"four_blobs": four_blobs, "curl": folding_curl, "example": example}


def contact_costs(rounds: int) -> dict[str, Any]:
    """For each scene the best seconds for 48 frames without and with contact, and the added part.

    ``usually_added`` is its median over the rounds, in which the two follow one another.
    """
    return {name: _cost(make(), rounds, within=name == "curl") for name, make in SCENES.items()}


def _cost(scene: Scene, rounds: int, *, within: bool) -> dict[str, float]:
    ways = {"without": replace(scene, contact=None), "with": replace(scene, contact=Contact(self_contact=within))}
    seconds = np.empty((rounds, len(ways)))
    for number in range(rounds):
        for column, way in enumerate(ways.values()):
            start = time.perf_counter()
            simulate(way, frames=48)
            seconds[number, column] = time.perf_counter() - start
    without, touching = seconds.min(axis=0)
    usually = np.median(seconds[:, 1] / seconds[:, 0])
    return {"without": without, "with": touching, "added": touching / without - 1, "usually_added": usually - 1}


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5, help="how often each is timed (default 5)")
    parser.add_argument("--one-core", action="store_true", help="use one processor only (Linux)")
    arguments = parser.parse_args()
    if arguments.one_core and hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    print(json.dumps(contact_costs(arguments.rounds), indent=2))


if __name__ == "__main__":
    main()
