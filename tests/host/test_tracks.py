"""Tracks in a real host: its own nodes take them."""

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


def tracked(**options: Any) -> dict[str, Any]:
    """The example's ribbon in the automatic wind, and its tracks."""
    values = {"points": 12, "static_points": 4, "frames": 21, "width": 416, "height": 240, "fit": "crop"}
    return {
        "example": ours("ExampleIllustration"),
        "mesh": ours("MaskToMesh", mask=["example", 2], spacing=0.0, elements_across=3, mask_index=0),
        "body": ours("Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="left"),
        "scene": ours(
            "AutomaticScene", bodies=["body", 0], wind_strength=2.0, wind_angle=0.0, sway_by_size=True, frame_rate=12.0
        ),
        "simulate": ours("Simulate", scene=["scene", 0], frames=25),
        "tracks": ours("Tracks", motion=["simulate", 0], weighting=0.5, **{**values, **options}),
    }


def pictures(host: Any, outputs: dict[str, Any], key: str) -> np.ndarray:
    files = [host.view(saved) for saved in outputs[key]["images"]]
    return np.stack([np.asarray(Image.open(io.BytesIO(file)).convert("RGB")).astype(int) for file in files])


def test_the_host_draws_tracks_of_the_wire_and_of_the_text_alike(host: Any) -> None:
    prompt = tracked() | {
        "black": core("EmptyImage", width=416, height=240, batch_size=1, color=0),
        "read": core("WanMoveTracksFromCoords", track_coords=["tracks", 1]),
        "length": core("PreviewAny", source=["read", 1]),
        "text": core("PreviewAny", source=["tracks", 1]),
    }
    look = {"images": ["black", 0], "line_resolution": 8, "circle_size": 3, "opacity": 1.0, "line_width": 2}
    for name, source in (("wire", "tracks"), ("string", "read")):
        prompt[f"draw_{name}"] = core("WanMoveVisualizeTracks", tracks=[source, 0], **look)
        prompt[name] = core("PreviewImage", images=[f"draw_{name}", 0])
    outputs = host.run(prompt)
    assert outputs["length"]["text"] == ["21"]
    coordinates = json.loads(outputs["text"]["text"][0])
    assert [len(track) for track in coordinates] == [21] * 16
    wire, string = pictures(host, outputs, "wire"), pictures(host, outputs, "string")
    assert wire.shape == string.shape == (21, 240, 416, 3)
    assert (wire == string).all(axis=3).mean() > 0.995
    for time in (0, 20):
        for track in coordinates:
            x, y = int(track[time]["x"]), int(track[time]["y"])
            if 4 < x < 411 and 4 < y < 235:
                assert wire[time, y - 3 : y + 4, x - 3 : x + 4].max() > 60
    assert np.abs(wire[20] - wire[0]).max() > 60


def test_tracks_join_those_of_the_host(host: Any) -> None:
    made = {"start_x": 0.1, "start_y": 0.1, "end_x": 0.9, "end_y": 0.9, "num_frames": 21, "num_tracks": 3,
            "track_spread": 0.025, "bezier": False, "mid_x": 0.5, "mid_y": 0.5, "interpolation": "linear",
            "width": 416, "height": 240}  # fmt: skip
    prompt = tracked() | {
        "made": core("GenerateTracks", **made),
        "joined": core("WanMoveConcatTrack", tracks_1=["tracks", 0], tracks_2=["made", 0]),
        "black": core("EmptyImage", width=416, height=240, batch_size=1, color=0),
        "drawn": core("WanMoveVisualizeTracks", images=["black", 0], tracks=["joined", 0], line_resolution=8,
                      circle_size=3, opacity=1.0, line_width=2),
        "seen": core("PreviewImage", images=["drawn", 0]),
    }  # fmt: skip
    assert pictures(host, host.run(prompt), "seen").shape == (21, 240, 416, 3)


def test_the_preview_lies_on_the_picture(host: Any) -> None:
    prompt = tracked(frames=0, width=0, height=0, image=["example", 0]) | {
        "seen": core("PreviewImage", images=["tracks", 2])
    }
    outputs = host.run(prompt)
    assert outputs["tracks"]["animated"] == [True]
    seen = pictures(host, outputs, "seen")
    assert seen.shape == (13, 360, 640, 3)
    (drawing,) = pictures(host, host.run(prompt | _small(seen.shape)), "small")
    same = np.abs(seen[0] - drawing).max(axis=2) < 24
    assert 0.95 < same.mean() < 0.9995


def _small(shape: tuple[int, ...]) -> dict[str, Any]:
    size = {"upscale_method": "area", "width": shape[2], "height": shape[1], "crop": "disabled"}
    return {
        "scaled": core("ImageScale", image=["example", 0], **size),
        "small": core("PreviewImage", images=["scaled", 0]),
    }


def test_without_a_picture_the_preview_has_the_size_of_the_tracks(host: Any) -> None:
    prompt = tracked(frames=121, width=832, height=480) | {"seen": core("PreviewImage", images=["tracks", 2])}
    outputs = host.run(prompt)
    assert pictures(host, outputs, "seen").shape == (61, 370, 640, 3)


def test_a_picture_of_another_size_is_refused_in_words(host: Any) -> None:
    prompt = tracked(image=["other", 0]) | {"other": core("EmptyImage", width=64, height=64, batch_size=1, color=0)}
    assert "1280 x 720 px" in host.error_of(prompt)
