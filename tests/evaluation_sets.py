"""A set of two small pictures that is evaluated within a second."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from physanimator.rendering.pictures import save_image

SIZE = 64

__all__ = ["SIZE", "small_set"]


def small_set(folder: Path, *, more: str = "", methods: str = '"composite", "warp-inpaint"') -> Path:
    """Write the set's files.

    Args:
        folder: where to.
        more: lines at the set's top.
        methods: of the set.

    Returns:
        The TOML file.
    """
    for number, name in enumerate(("flag", "bush")):
        place = folder / name
        place.mkdir(parents=True)
        chance = np.random.default_rng(number)
        picture = np.full((SIZE, SIZE, 3), (230, 235, 240), np.uint8)
        picture[14:50, 14:40] = chance.integers(30, 200, (6, 1, 3)).repeat(6, 0).repeat(26, 1)
        mask = np.zeros((SIZE, SIZE), np.uint8)
        mask[14:50, 14:40] = 255
        save_image(place / "picture.png", picture)
        save_image(place / "mask.png", mask)
    (folder / "flag" / "scene.json").write_text(json.dumps(_scene()))
    text = f"""{more}
frames = 4
size = 0
methods = [{methods}]

[[pictures]]
name = "flag"
image = "flag/picture.png"
masks = ["flag/mask.png"]
scene = "flag/scene.json"

[[pictures]]
name = "bush"
image = "bush/picture.png"
masks = ["bush/mask.png"]
presets = ["hair"]
"""
    file = folder / "set.toml"
    file.write_text(text)
    return file


def _scene() -> dict[str, object]:
    return {
        "version": 2,
        "width": SIZE,
        "height": SIZE,
        "bodies": [{"material": {"preset": "cloth"}}],
        "rig_points": [
            {
                "position": [27, 15],
                "motion": {"type": "pinned"},
                "region": {"type": "polygon", "points": [[10, 10], [44, 10], [44, 18], [10, 18]]},
            }
        ],
        "wind": {"strength": 20.0, "gust": 0.0},
    }
