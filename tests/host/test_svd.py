"""The paper's workflow in a real host: refused while the weights are missing, run with small random ones."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bar_graphs import core
from numpy.typing import NDArray
from PIL import Image

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


def picture_of(host: Any, saved: dict[str, str]) -> NDArray[np.uint8]:
    with Image.open(io.BytesIO(host.view(saved))) as opened:
        return np.asarray(opened.convert("RGB"))


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


def test_the_workflow_that_repaints_lacks_nothing_but_its_file(host: Any) -> None:
    graph = json.loads((ROOT / "workflows" / "api" / "render_from_animation.json").read_text(encoding="utf-8"))
    _, answer = host.post("/prompt", {"prompt": graph, "client_id": host.client})
    (refused,) = answer["node_errors"].values()
    assert refused["class_type"] == "PhysAnimator_Render"
    (told,) = refused["errors"]
    assert "svd.safetensors is missing" in told["details"]
    assert "lvcd" not in told["details"].lower()


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
    (drawn,) = [node["inputs"]["images"] for node in graph.values() if node["class_type"] == "CreateVideo"]
    graph["drawn"] = core("PreviewImage", images=drawn)
    outputs = host.run(graph)
    with av.open(io.BytesIO(host.view(outputs[save]["images"][0]))) as container:
        assert sum(1 for _ in container.decode(video=0)) == FRAMES
    # Without the video's losses.
    frames = np.stack([picture_of(host, saved) for saved in outputs["drawn"]["images"]]).astype(int)
    assert frames.shape == (FRAMES, 720, 1280, 3)
    changes = np.abs(frames - frames[0]).max(axis=-1)
    assert changes[1:, :200, 1000:].max() == 0, "far from all bodies the illustration stays"
    assert (changes[8] > 60).mean() > 0.02, "random weights draw something else where bodies are"


def repainted(**changes: Any) -> dict[str, Any]:
    """The published graph whose frames follow the animation: three frames, small."""
    graph = prompt()
    _node(graph, "Simulate")["inputs"]["frames"] = 3
    _node(graph, "Interpolate")["inputs"]["every"] = 1
    render = _node(graph, "Render")["inputs"]
    kept = {name: value for name, value in render.items() if not name.startswith("renderer")}
    given = {"steps": 3, "working_size": "448 x 256", "precision": "fp32", "soft_edge": 8.0, "motion_bucket": 17}
    given |= {"weak": 0.32, "strong": 0.42, "guidance": 3.0, "noise_from": 0, "overlap": 4, "frames_per_second": 6}
    given |= {"picture_noise": 0.02, "decoded_together": 10, "keep_still_parts": True, "lvcd_model": "none", **changes}
    _node(graph, "Render")["inputs"] = {
        **kept,
        "renderer": "animation-guided SVD",
        **{f"renderer.{name}": value for name, value in given.items()},
    }
    return graph


def test_the_animation_leads_without_lvcd(host: Any, chosen: dict[str, str]) -> None:
    graph = repainted(svd_model=chosen["svd_model"])
    (drawn,) = [node["inputs"]["images"] for node in graph.values() if node["class_type"] == "CreateVideo"]
    graph["drawn"] = core("PreviewImage", images=drawn)
    assert len(host.run(graph)["drawn"]["images"]) == 3


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"svd_model": "svd.safetensors"}, "svd.safetensors is missing"),
        ({"lvcd_model": "lvcd-fp16.safetensors"}, "lvcd_model must be none where no sketches are connected"),
        ({"weak": 0.6}, "strong must be weak, which is 0.6, or more. Got: 0.42"),
    ],
)
def test_what_the_animation_lacks_is_told_before_the_work(
    host: Any, chosen: dict[str, str], changes: dict[str, Any], sentence: str
) -> None:
    graph = repainted(**{"svd_model": chosen["svd_model"], **changes})
    _, answer = host.post("/prompt", {"prompt": graph, "client_id": host.client})
    assert sentence in json.dumps(answer), answer


def test_too_few_sketches_are_named(host: Any, chosen: dict[str, str]) -> None:
    graph = prompt(**chosen, steps=2)
    _node(graph, "Simulate")["inputs"]["frames"] = 3
    render = _node(graph, "Render")["inputs"]
    render["renderer.sketches"] = _node(graph, "WarpSketch")["inputs"]["sketch"]
    assert "sketches must be one for each of the motion's 3 frames. Got: 1" in host.error_of(graph)


def alone(sketches: int = 3, **values: Any) -> dict[str, Any]:
    """Render with nothing but the illustration and some sketches of it, which are all the same."""
    given = {name: value for name, value in _node(prompt(), "Render")["inputs"].items() if not isinstance(value, list)}
    quick = {"steps": 2, "working_size": "448 x 256", "precision": "fp32", "keep_still_parts": False, **values}
    given |= {f"renderer.{name}": value for name, value in quick.items()}
    given |= {"image": ["small", 0], "renderer.sketches": ["sketches", 0]}
    return {
        "example": {"class_type": "PhysAnimator_ExampleIllustration", "inputs": {}},
        "small": core("ImageScale", image=["example", 0], upscale_method="area", width=160, height=96, crop="disabled"),
        "sketches": core("RepeatImageBatch", image=["small", 0], amount=sketches),
        "render": {"class_type": "PhysAnimator_Render", "inputs": given},
        "seen": core("PreviewImage", images=["render", 0]),
    }


def test_an_illustration_and_sketches_are_enough(host: Any, chosen: dict[str, str]) -> None:
    assert len(host.run(alone(**chosen))["seen"]["images"]) == 3
    assert "sketches must be 2 or more" in host.error_of(alone(1, **chosen))


def test_a_clean_plate_goes_through_without_a_motion(host: Any, chosen: dict[str, str]) -> None:
    graph = alone(**chosen) | {"plate": core("PreviewImage", images=["render", 2])}
    graph["render"]["inputs"]["clean_plate"] = ["small", 0]
    outputs = host.run(graph)
    assert len(outputs["plate"]["images"]) == 1


@pytest.mark.parametrize(
    ("values", "taken", "sentence"),
    [
        ({"keep_still_parts": True}, None, "motion must be connected or keep_still_parts switched off"),
        ({}, 1, "motion must be connected where alpha is"),
        ({}, 2, "motion must be connected where the output clean_plate is"),
        (None, None, "motion must be connected for the renderer composite"),
    ],
)
def test_what_only_a_motion_tells_is_refused_before_the_work(
    host: Any, chosen: dict[str, str], values: dict[str, Any] | None, taken: int | None, sentence: str
) -> None:
    graph = alone(**chosen, **(values or {}))
    if values is None:
        graph["render"]["inputs"] = {"image": ["small", 0], "renderer": "composite", "background": "picture"}
    if taken is not None:
        shown = "PreviewImage" if taken == 2 else "MaskPreview"
        graph["also"] = core(shown, **{"images" if taken == 2 else "mask": ["render", taken]})
    status, answer = host.post("/prompt", {"prompt": graph, "client_id": host.client})
    assert sentence in json.dumps(answer), answer
    assert status == 400 or answer["node_errors"]
