"""How fast layered artwork is, against the same picture flat with masks: 1280x720, 12 layers, of which 3 move."""

from __future__ import annotations

import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from drawn_artworks import bust
from physanimator.physics.material import preset
from physanimator.physics.scene import automatic_scene
from physanimator.physics.simulation import simulate
from physanimator.rendering.artwork import ArtLayer, Artwork, load_artwork, save_psd
from physanimator.rendering.composite import LayeredRenderer, hidden_by, mask_of_layer
from physanimator.rendering.parts import Parts, parts_of_artwork, parts_of_picture, picture_of
from physanimator.rendering.pictures import load_image, load_mask

__all__ = ["layers_measured"]

STILL = ("side hair-l",)
WIDTH, HEIGHT = 1280, 720


def artwork() -> Artwork:
    """The drawn bust without its mouth in the middle of 1280x720."""
    drawn, scale = bust(), HEIGHT / 480
    layers = []
    for layer in drawn.layers:
        if layer.name == "mouth":
            continue
        planes = layer.pixels.astype(np.float32)
        planes[..., :3] *= planes[..., 3:] / 255
        wide = WIDTH if layer.name == "background" else round(planes.shape[1] * scale)
        planes = cv2.resize(planes, (wide, round(planes.shape[0] * scale)), interpolation=cv2.INTER_LINEAR)
        planes[..., :3] *= 255 / np.maximum(planes[..., 3:], 1e-3)
        left = 0 if layer.name == "background" else round(layer.left * scale) + 280
        pixels = np.rint(np.clip(planes, 0, 255)).astype(np.uint8)
        layers.append(ArtLayer(layer.name, pixels, left, round(layer.top * scale)))
    return Artwork(WIDTH, HEIGHT, tuple(layers))


def layers_measured(rounds: int = 5) -> dict[str, Any]:
    """Seconds from the file to the first frame both ways, in turns, without the simulation, which both share; and
    milliseconds a frame beside cv2.remap of one RGB frame."""
    with tempfile.TemporaryDirectory() as folder:
        psd, flat, masks = _written(artwork(), Path(folder))
        whole = parts_of_artwork(load_artwork(psd), still=STILL)
        parts = _slit(whole)
        hair = parts.bodies([preset("hair")] * len(parts.meshes), [True] * len(parts.meshes))
        motion = simulate(automatic_scene(hair, attach=parts.attachments, wind_strength=2.0), frames=49)

        def layered() -> LayeredRenderer:
            renderer = _slit(parts_of_artwork(load_artwork(psd), still=STILL)).renderer(motion)
            renderer.frame(0)
            return renderer  # type: ignore[return-value]

        def masked() -> LayeredRenderer:
            picture = load_image(flat)
            seen = [load_mask(path, width=WIDTH, height=HEIGHT) for path in masks]
            # The picture differs in one pixel each time, so that nothing is kept from the time before.
            picture[0, 0] = np.random.default_rng().integers(0, 256, 3)
            given = parts_of_picture(
                picture, seen, [""] * len(seen), spacing=None, plate=None, in_front=None, pixel_art=False
            )
            renderer = _slit(given).renderer(motion)
            renderer.frame(0)
            return renderer  # type: ignore[return-value]

        first = {"layers": layered, "masks": masked}
        times: dict[str, list[float]] = {name: [] for name in first}
        for _ in range(rounds):
            for name, way in first.items():
                times[name].append(_seconds(way))
        renderers = {name: way() for name, way in first.items()}
        picture = load_image(flat)
    rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH].astype(np.float32)
    x, y = columns + 3.3 * np.sin(rows / 40), rows + 2.7 * np.cos(columns / 50)
    stages: dict[str, Callable[[int], Any]] = {"remap": lambda t: cv2.remap(picture, x, y, cv2.INTER_LINEAR)}
    stages |= {name: renderer.frame for name, renderer in renderers.items()}
    frame_times: dict[str, list[float]] = {name: [] for name in stages}
    for number in range(8 * rounds):
        for name, stage in stages.items():
            frame_times[name].append(_seconds(lambda stage=stage, number=number: stage(9 + number % 40)))
    seconds = {name: statistics.median(each) for name, each in times.items()}
    ms = {name: 1000 * statistics.median(each) for name, each in frame_times.items()}
    return {
        "first_frame_s": seconds,
        "first_frame_ratio": seconds["layers"] / seconds["masks"],
        "frame_ms": ms,
        "frame_of_remap": ms["layers"] / ms["remap"],
        "frame_of_remap_with_masks": ms["masks"] / ms["remap"],
        "layers": len(artwork().layers),
        "movers": len(motion.bodies),
        "movers_slit": sum(one is not other for one, other in zip(whole.meshes, parts.meshes, strict=True)),
    }


def _slit(parts: Parts) -> Parts:
    return parts.in_strands([True] * len(parts.meshes), parts.attachments)


def _written(whole: Artwork, folder: Path) -> tuple[Path, Path, list[Path]]:
    """A PSD, the flat picture and the masks of what is seen of the movers."""
    psd, flat = folder / "bust.psd", folder / "bust.png"
    save_psd(whole, psd)
    cv2.imwrite(str(flat), picture_of(whole)[..., ::-1])
    parts, masks = parts_of_artwork(whole, still=STILL), []
    indices = [whole.names.index(name) for name in parts.names]
    for number, (name, index) in enumerate(zip(parts.names, indices, strict=True)):
        seen = mask_of_layer(whole, index)
        cover = hidden_by(whole, index, moving=[index])
        masks.append(folder / f"{number} {name}.png")
        cv2.imwrite(
            str(masks[-1]), np.rint(255 * np.where(False if cover is None else cover, 0, seen)).astype(np.uint8)
        )
    return psd, flat, masks


def _seconds(function: Callable[[], Any]) -> float:
    start = time.perf_counter()
    function()
    return time.perf_counter() - start
