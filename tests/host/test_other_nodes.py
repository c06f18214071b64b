"""Masks, lines, tracks and keyframes from and to nodes that are not ours."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

HERE = Path(__file__).parent
LINES = {
    "Canny": {"low_threshold": 0.2, "high_threshold": 0.5},
    "CannyEdgePreprocessor": {"low_threshold": 60, "high_threshold": 140, "resolution": 512},
    "LineartStandardPreprocessor": {"guassian_sigma": 6.0, "intensity_threshold": 8, "resolution": 512},
    "Scribble_XDoG_Preprocessor": {"threshold": 32, "resolution": 512},
}
"""Nodes that draw lines without a model: the host's own, and of comfyui_controlnet_aux."""


def node(kind: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": kind, "inputs": inputs}


def ours(kind: str, /, **inputs: Any) -> dict[str, Any]:
    return node(f"PhysAnimator_{kind}", **inputs)


def moved(frames: int) -> dict[str, Any]:
    """The example's ribbon in the automatic wind."""
    wind = {"wind_strength": 2.0, "wind_angle": 0.0, "sway_by_size": True, "frame_rate": 12.0}
    return {
        "example": ours("ExampleIllustration"),
        "mesh": ours("MaskToMesh", mask=["example", 2], spacing=0.0, elements_across=3, mask_index=0),
        "body": ours("Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="left"),
        "scene": ours("AutomaticScene", bodies=["body", 0], **wind),
        "simulate": ours("Simulate", scene=["scene", 0], frames=frames),
    }


def pictures(host: Any, outputs: dict[str, Any], key: str) -> np.ndarray:
    files = [host.view(saved) for saved in outputs[key]["images"]]
    return np.stack([np.asarray(Image.open(io.BytesIO(file)).convert("L")).astype(float) / 255 for file in files])


def require_node(host: Any, kind: str) -> None:
    if kind not in host.get("/object_info"):
        pytest.skip(f"this host has no {kind}; COMFYUI_PACKS names the folder of its pack")


@pytest.fixture(scope="module")
def called(host: Any) -> dict[str, Any]:
    """What nodes of the host and ours say in one process."""
    python = os.environ.get("COMFYUI_PYTHON", sys.executable)
    command = [python, HERE / "in_the_hosts_python.py", HERE.parents[1]]
    done = subprocess.run(command, cwd=host.checkout, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.parametrize("kind", LINES)
def test_lines_of_a_detector_are_bent_as_ours_are(host: Any, kind: str) -> None:
    require_node(host, kind)
    prompt = moved(25) | {
        "lines": node(kind, image=["example", 0], **LINES[kind]),
        "flow": ours("OpticalFlow", motion=["simulate", 0]),
        "bent": ours("WarpSketch", sketch=["lines", 0], flow=["flow", 0], mode="layered", blur_sigma=0.8),
        "led": ours("LineControlVideo", sketch=["lines", 0], motion=["simulate", 0], frames=5, width=832, height=480,
                    fit="crop", lines="white on black"),
        "own": ours("ExtractSketch", image=["example", 0], line_width=2.0, threshold=0.05, coherence=3.0,
                    smallest_speck=20),
        "turned": node("ImageInvert", image=["own", 0]),
    }  # fmt: skip
    for name in ("lines", "bent", "led", "turned"):
        prompt[f"see_{name}"] = node("PreviewImage", images=[name, 0])
    outputs = host.run(prompt)
    lines, bent, led, turned = (pictures(host, outputs, f"see_{name}") for name in ("lines", "bent", "led", "turned"))
    assert np.median(lines) < 0.25, "a detector draws light on dark"
    assert np.median(turned) < 0.25, "and so does our sketch once it is inverted"
    assert bent.shape == (25, 720, 1280)
    assert np.median(bent) > 0.75
    assert bent.min() < 0.5
    assert led.shape == (5, 480, 832)
    assert np.median(led) < 0.25
    assert np.abs(bent[-1] - bent[0]).max() > 0.3, "lines move"
    said = outputs["bent"].get("advice", [])
    assert any("light lines on dark" in sentence for sentence in said), outputs["bent"]


def test_ltx_draws_our_tracks_as_they_are(host: Any) -> None:
    require_node(host, "LTXVDrawTracks")
    values = {"points": 12, "static_points": 4, "frames": 25, "width": 448, "height": 256, "fit": "crop"}
    prompt = moved(25) | {
        "tracks": ours("Tracks", motion=["simulate", 0], weighting=0.5, **values),
        "text": node("PreviewAny", source=["tracks", 1]),
        "drawn": node("LTXVDrawTracks", tracks=["tracks", 1], width=448, height=256),
        "seen": node("PreviewImage", images=["drawn", 0]),
    }
    outputs = host.run(prompt)
    frames, tracks = pictures(host, outputs, "seen"), json.loads(outputs["text"]["text"][0])
    assert frames.shape == (25, 256, 448), "8 k + 1 frames, as many as samples"
    assert len(tracks) == 16
    for time in (0, 12, 24):
        for track in tracks:
            x, y = round(track[time]["x"]), round(track[time]["y"])
            if 3 < x < 444 and 3 < y < 252:
                # Where a point is now, the dot is of pure blue.
                assert frames[time, y - 2 : y + 3, x - 2 : x + 3].max() > 0.09, (time, x, y)


def test_first_and_last_keyframe_are_shown_to_wan_as_the_host_shows_them(called: dict[str, Any]) -> None:
    found = called["keyframes"]
    assert found["difference"] < 1e-6
    assert found["names"][0] == found["names"][1]
    assert found["latents"] == [[1, 16, 5, 6, 8]] * 2
    assert found["mask"] == [1, 4, 5, 6, 8]
    assert found["known"] == [[1] * 4, [0] * 4, [0, 0, 0, 1], [0] * 4, [0, 0, 0, 1]]


def test_masks_of_sam_3_are_parts(called: dict[str, Any]) -> None:
    found = called["segments"]
    if found is None:
        pytest.skip("this host has no nodes for SAM 3")
    apart, together = found["2 apart"], found["2 together"]
    assert apart["shape"] == [2, 64, 96]
    assert len(apart["parts"]) == 2
    assert min(apart["parts"]) > 300
    assert apart["mesh"] == apart["parts"][:1]
    assert together["shape"] == [1, 64, 96]
    assert together["parts"] == [sum(apart["parts"])]
    assert found["0 apart"]["shape"] == [0, 64, 96]
    for take in ("mesh", "parts"):
        assert "has found nothing" in found["0 apart"][take]
    assert "white where a part is" in found["0 together"]["parts"]
