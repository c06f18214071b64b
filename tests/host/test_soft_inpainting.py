"""Soft inpainting in a real host: refused while the model is missing, run with a small random one."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
FRAMES = 6


def prompt(renderer: str = "soft inpainting", **changes: Any) -> dict[str, Any]:
    """The published quickstart, with another renderer, and its frames as pictures."""
    graph = json.loads((ROOT / "workflows" / "api" / "quickstart.json").read_text(encoding="utf-8"))
    (scene,) = [key for key, node in graph.items() if node["class_type"].endswith("AutomaticScene")]
    (example,) = [key for key, node in graph.items() if node["class_type"].endswith("ExampleIllustration")]
    usual = {
        "inpainting_model": "stable-diffusion-inpainting",
        "prompt": "girl",
        "negative_prompt": "",
        "strength": 1.0,
        "steps": 2,
        "guidance": 4.0,
        "noise_from": 1,
        "shared_noise": True,
        "grow": 4.0,
        "soft_edge": 16.0,
        "working_size": "512 x 512",
        "precision": "fp32",
    }
    brought = {f"renderer.{name}": value for name, value in (usual | changes).items()}
    return {key: graph[key] for key in _needed(graph, scene)} | {
        "simulate": {
            "class_type": "PhysAnimator_Simulate",
            "inputs": {**_inputs(graph, "Simulate"), "frames": FRAMES, "scene": [scene, 0]},
        },
        "render": {
            "class_type": "PhysAnimator_Render",
            "inputs": {"image": [example, 0], "motion": ["simulate", 0], "renderer": renderer}
            | (brought if renderer != "composite" else {}),
        },
        "save": {
            "class_type": "SaveImage",
            "inputs": {"images": ["render", 0], "filename_prefix": f"inpainted_{renderer}"},
        },
    }


def _inputs(graph: dict[str, Any], kind: str) -> dict[str, Any]:
    (found,) = [node["inputs"] for node in graph.values() if node["class_type"] == f"PhysAnimator_{kind}"]
    return dict(found)


def _needed(graph: dict[str, Any], key: str) -> list[str]:
    """A node and all that it depends on."""
    needed = [key]
    for name in needed:
        links = [value for value in graph[name]["inputs"].values() if isinstance(value, list)]
        needed += [source for source, _ in links if source not in needed]
    return needed


def frames_of(host: Any, graph: dict[str, Any]) -> np.ndarray:
    pictures = host.run(graph)["save"]["images"]
    return np.stack([np.asarray(Image.open(io.BytesIO(host.view(each))).convert("RGB")) for each in pictures])


def test_a_missing_model_is_named_with_its_source(host: Any) -> None:
    _, answer = host.post("/prompt", {"prompt": prompt(), "client_id": host.client})
    told = json.dumps(answer["node_errors"])
    for part in ("stable-diffusion-inpainting is missing", "huggingface.co", "models/diffusers", "composite"):
        assert part in told


@pytest.fixture(scope="module")
def model(host: Any) -> str:
    """A small random model among the host's."""
    torch = pytest.importorskip("torch")
    random_inpainting = pytest.importorskip("random_inpainting")
    torch.set_num_threads(1)
    (host.folder / "models" / "diffusers").mkdir(parents=True, exist_ok=True)
    random_inpainting.write_inpainting_folder(host.folder / "models" / "diffusers" / "tiny-inpainting", sees_holes=True)
    return "tiny-inpainting"


def test_holes_are_painted_and_all_else_is_the_composite(host: Any, model: str) -> None:
    composite = frames_of(host, prompt("composite")).astype(int)
    painted = frames_of(host, prompt(inpainting_model=model)).astype(int)
    assert painted.shape == composite.shape
    apart = np.abs(painted - composite).max(axis=-1)
    assert not apart[0].any(), "nothing is uncovered at rest"
    assert (apart[-1] > 40).mean() > 0.0005
    assert (apart == 0).mean() > 0.7


def test_strength_that_leaves_no_step_is_refused_before_the_work(host: Any, model: str) -> None:
    _, answer = host.post("/prompt", {"prompt": prompt(inpainting_model=model, strength=0.4), "client_id": host.client})
    assert "strength must be 0.5 to 1" in json.dumps(answer["node_errors"])
