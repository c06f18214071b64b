"""The paper's workflow in a real host: refused while the weights are missing, run with small random ones."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
FRAMES = 9


def prompt(**changes: Any) -> dict[str, Any]:
    """The published graph, with other values for Render, and in-betweens without a model."""
    graph = json.loads((ROOT / "workflows" / "api" / "physanimator_paper.json").read_text(encoding="utf-8"))
    interpolate = _node(graph, "Interpolate")["inputs"]
    _node(graph, "Interpolate")["inputs"] = {
        name: value for name, value in interpolate.items() if not name.startswith("backend")
    } | {"backend": "flow"}
    _node(graph, "Render")["inputs"] |= {f"renderer.{name}": value for name, value in changes.items()}
    return graph


def _node(graph: dict[str, Any], kind: str) -> dict[str, Any]:
    (found,) = [node for node in graph.values() if node["class_type"] == f"PhysAnimator_{kind}"]
    return found


def test_missing_weights_are_named_with_their_source(host: Any) -> None:
    """Told when the graph is queued; what does not depend on the renderer runs all the same."""
    _, answer = host.post("/prompt", {"prompt": prompt(), "client_id": host.client})
    told = json.dumps(answer["node_errors"])
    for part in (
        "svd.safetensors is missing",
        "lvcd.ckpt is missing",
        "huggingface.co",
        "models/checkpoints",
        "icence",
    ):
        assert part in told


@pytest.fixture(scope="module")
def chosen(host: Any) -> dict[str, str]:
    """Small random weights among the host's models; a diffusers folder tells their sizes."""
    torch = pytest.importorskip("torch")
    random_svd = pytest.importorskip("random_svd")
    torch.set_num_threads(1)
    models, weights = host.folder / "models", random_svd.weights()
    for kind in ("diffusers", "controlnet"):
        (models / kind).mkdir(parents=True, exist_ok=True)
    random_svd.write_folder(models / "diffusers" / "svd-tiny", weights)
    random_svd.write_lvcd(models / "controlnet" / "lvcd-fp16.safetensors", weights, dtype=torch.float16)
    return {"svd_model": "diffusers/svd-tiny", "lvcd_model": "lvcd-fp16.safetensors"}


def test_model_files_are_offered(host: Any, chosen: dict[str, str]) -> None:
    options = host.get("/object_info")["PhysAnimator_Render"]["input"]["optional"]["renderer"][1]["options"]
    brought = next(option["inputs"]["required"] for option in options if option["key"] == "sketch-guided SVD")
    for name, value in chosen.items():
        assert value in brought[name][1]["options"]


def test_the_whole_workflow_runs(host: Any, chosen: dict[str, str]) -> None:
    import av

    graph = prompt(**chosen, steps=2, soft_edge=8.0, working_size="448 x 256", precision="fp32")
    _node(graph, "Simulate")["inputs"]["frames"] = FRAMES
    _node(graph, "Interpolate")["inputs"]["every"] = 4
    (save,) = [key for key, node in graph.items() if node["class_type"] == "SaveVideo"]
    outputs = host.run(graph)
    with av.open(io.BytesIO(host.view(outputs[save]["images"][0]))) as container:
        frames = np.stack([frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]).astype(int)
    assert frames.shape == (FRAMES, 720, 1280, 3)
    changes = np.abs(frames - frames[0]).max(axis=-1)
    assert changes[1:, :200, 1000:].max() < 16, "far from all bodies the illustration stays"
    assert (changes[8] > 60).mean() > 0.02, "random weights draw something else where bodies are"


def test_too_few_sketches_are_named(host: Any, chosen: dict[str, str]) -> None:
    graph = prompt(**chosen, steps=2)
    _node(graph, "Simulate")["inputs"]["frames"] = 3
    render = _node(graph, "Render")["inputs"]
    render["renderer.sketches"] = _node(graph, "WarpSketch")["inputs"]["sketch"]
    assert "sketches must be one for each of the motion's 3 frames. Got: 1" in host.error_of(graph)
