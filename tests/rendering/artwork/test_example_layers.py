"""The bundled example in layers: the same picture, with what is hidden painted in."""

from __future__ import annotations

import numpy as np
from physanimator.rendering.artwork import flattened, load_artwork, moving_layers
from physanimator.rendering.command import EXAMPLE
from physanimator.rendering.pictures import load_image


def test_the_layers_are_the_illustration() -> None:
    artwork = load_artwork(EXAMPLE / "illustration.psd")
    assert artwork.warnings == ()
    difference = np.abs(flattened(artwork)[..., :3].astype(int) - load_image(EXAMPLE / "illustration.png")).max(axis=2)
    assert (difference > 2).mean() < 1e-3  # where outlines of two layers share a pixel


def test_what_moves_in_it() -> None:
    artwork = load_artwork(EXAMPLE / "illustration.psd")
    moving = {plan.name: plan.preset for plan in moving_layers(artwork) if plan.moves}
    assert moving == {
        "back hair": "hair",
        "cape": "cloth",
        "skirt": "cloth",
        "front hair": "hair",
        "ribbon": "ribbon",
        "plant": "leaf",
    }


def test_hidden_parts_are_painted_in() -> None:
    layers = {layer.name: layer for layer in load_artwork(EXAMPLE / "illustration.psd").layers}
    hair, face = layers["back hair"], layers["face"]
    canvas = np.zeros((2, 720, 1280), bool)
    for plane, layer in zip(canvas, (hair, face), strict=True):
        left, top, right, bottom = layer.box
        plane[top:bottom, left:right] = layer.pixels[..., 3] > 127
    assert (canvas[0] & canvas[1]).sum() > 1000
