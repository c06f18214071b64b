"""The Wind node, loops of Simulate, and what a stroke can choose, in a real host."""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
from PIL import Image


def core(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": node_type, "inputs": inputs}


def ours(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return core(f"PhysAnimator_{node_type}", **inputs)


def ribbon(**acting: Any) -> dict[str, Any]:
    """The example's ribbon, rendered as a loop of a second."""
    automatic = {"wind_strength": 1.0, "wind_angle": 0.0, "sway_by_size": True, "frame_rate": 12.0}
    return {
        "example": ours("ExampleIllustration"),
        "mesh": ours("MaskToMesh", mask=["example", 2], spacing=24.0, elements_across=3, mask_index=0),
        "body": ours("Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="left"),
        "scene": ours("AutomaticScene", bodies=["body", 0], **automatic, **acting),
        "simulate": ours("Simulate", scene=["scene", 0], frames=40, loop=1.0),
        "render": ours("Render", image=["example", 0], motion=["simulate", 0]),
        "seen": core("PreviewImage", images=["render", 0]),
    }


def pictures(host: Any, outputs: dict[str, Any]) -> np.ndarray:
    files = [host.view(saved) for saved in outputs["seen"]["images"]]
    return np.stack([np.asarray(Image.open(io.BytesIO(file)).convert("RGB")).astype(int) for file in files])


def assert_loops(frames: np.ndarray) -> None:
    assert len(frames) == 12
    steps = np.abs(np.diff(np.concatenate([frames, frames[:1]]), axis=0)).mean(axis=(1, 2, 3))
    assert steps.max() > 0.1
    assert steps[-1] < 1.3 * steps[:-1].max()


def test_wind_with_eddies_loops(host: Any) -> None:
    wind = ours(
        "Wind", strength=2.0, angle=20.0, gust=0.8, gust_period=1.0, turbulence=0.5, turbulence_size=150.0, wind_seed=3
    )
    assert_loops(pictures(host, host.run(ribbon(wind=["wind", 0]) | {"wind": wind})))


def test_a_repeated_smooth_stroke_loops(host: Any) -> None:
    stroke = ours(
        "EnergyStroke",
        kind="wind",
        path="[[400, 60], [1000, 60]]",
        radius=200.0,
        speed=900.0,
        strength=6.0,
        start=0.0,
        end=0.2,
        interval=0.1,
        falloff="smooth",
        repeat=0.5,
    )
    assert_loops(pictures(host, host.run(ribbon(strokes=["stroke", 0]) | {"stroke": stroke})))


def test_strength_and_speed_are_keyed_along_the_path(host: Any) -> None:
    stroke = {"kind": "wind", "path": "[[400, 60], [1000, 60]]", "radius": 200.0, "speed": 900.0, "strength": 6.0,
              "start": 0.0, "end": 0.0, "interval": 0.1, "strength_keys": "[[0, 1], [1, 0]]",
              "speed_keys": "[[0, 0.5], [1, 2]]"}  # fmt: skip
    prompt = ribbon(strokes=["stroke", 0]) | {"stroke": ours("EnergyStroke", **stroke)}
    prompt = {key: prompt[key] for key in ("example", "mesh", "body", "scene", "stroke")}
    outputs = host.run(prompt | {"seen": core("PreviewAny", source=["scene", 1])})
    (read,) = json.loads(outputs["seen"]["text"][0])["strokes"]
    assert read["strength_keys"] == [[0, 1], [1, 0]]
    assert read["speed_keys"] == [[0, 0.5], [1, 2]]
