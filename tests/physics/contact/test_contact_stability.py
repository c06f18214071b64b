"""A soft body that lies in the wind against a stiff one keeps to speeds that the wind can give it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from physanimator.physics.forces import Wind
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.scene import Body, Contact, automatic_scene
from physanimator.physics.simulation import simulate
from PIL import Image

EXAMPLE = Path(__file__).resolve().parents[3] / "workflows" / "example"
FRAMES = 66
FASTEST = 60.0  # [px] in a frame; parts that gain energy from each other pass 400


def test_a_soft_body_against_a_stiff_one_gains_no_energy() -> None:
    """The stiff one takes 81 steps in the time of one of the soft one's own."""
    bodies = []
    for layer, (name, material) in enumerate((("hair", "hair"), ("plant", "leaf"))):
        mask = np.asarray(Image.open(EXAMPLE / f"mask_{name}.png").convert("L"))
        bodies.append(Body(mesh_from_mask(mask), preset(material), layer))
    scene = automatic_scene(bodies, attach=["left", "auto"], frame_rate=24, wind_strength=0.0, sway_by_size=True)
    wind = Wind(1.5, 180, 0.8, 2, 0.4, 200, 0)
    positions = simulate(replace(scene, wind=wind, contact=Contact(friction=0.2)), frames=FRAMES).positions
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=2)
    assert steps.max() < FASTEST
    assert np.linalg.norm(positions - positions[0], axis=2).max() > 50
