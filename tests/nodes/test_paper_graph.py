"""The strict paper's graph in the stand-in, with small random networks in place of all six files that it names."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from PIL import Image
from tiny_models import with_tiny_models, write_tiny_models

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "workflows" / "example" / "illustration.png"
API = json.loads((ROOT / "workflows" / "api" / "paper_strict.json").read_text(encoding="utf-8"))
FRAMES = 15  # what the video model draws at once
LAST = FRAMES - 1


@pytest.fixture(scope="module")
def caught(standin: Any) -> Iterator[dict[str, np.ndarray]]:
    """The frames of Render and Interpolate, drawn at a size that a processor manages in seconds."""
    from comfy_api.latest import io
    from physanimator.nodes.models import svd, tooncrafter

    class Catch(io.ComfyNode):
        @classmethod
        def define_schema(cls) -> Any:
            inputs = [io.Image.Input("images"), io.String.Input("name")]
            return io.Schema(node_id="Catch", inputs=inputs, is_output_node=True)

        @classmethod
        def execute(cls, images: torch.Tensor, name: str) -> Any:
            found[name] = images.numpy()
            return io.NodeOutput()

    found: dict[str, np.ndarray] = {}
    standin.known["Catch"] = Catch
    write_tiny_models(standin.folder / "models")
    prompt = with_tiny_models(API, frames=FRAMES)
    for name in ("Render", "Interpolate"):
        (key,) = [key for key, node in prompt.items() if node["class_type"] == f"PhysAnimator_{name}"]
        prompt[name] = {"class_type": "Catch", "inputs": {"images": [key, 0], "name": name}}
        if name == "Render":  # which would paint one otherwise, for its third output
            prompt[key]["inputs"]["clean_plate"] = ["plate", 0]
    prompt["plate"] = {"class_type": "LoadImage", "inputs": {"image": "clean_plate.png"}}
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(svd.AREAS, "448 x 256", 128 * 64)
        patch.setitem(tooncrafter.AREAS, "512 x 320", 128 * 64)
        assert standin.run(prompt)
    yield found
    torch.set_num_threads(threads)


def test_the_whole_graph_runs(caught: dict[str, np.ndarray]) -> None:
    drawn, filled = caught["Render"], caught["Interpolate"]
    assert drawn.shape == filled.shape == (FRAMES, 720, 1280, 3)
    for keyframe in (0, LAST):
        assert np.abs(filled[keyframe] - drawn[keyframe]).max() < 1e-6, "keyframes are those that were rendered"
    between = np.abs(filled[1:LAST] - drawn[1:LAST]).mean(axis=(1, 2, 3))
    assert between.min() > 1 / 255, "the others are drawn anew"


def test_no_pixel_is_taken_from_the_illustration(caught: dict[str, np.ndarray]) -> None:
    with Image.open(EXAMPLE) as picture:
        illustration = np.asarray(picture.convert("RGB")) / 255
    changed = np.abs(caught["Render"] - illustration).max(axis=-1) > 4 / 255
    assert changed.mean() > 0.9


def test_the_files_that_are_missing_are_named_with_their_sources(standin: Any) -> None:
    told = standin.error_of(API)
    for part in ("sam2.1-hiera-base-plus/ is missing", "svd.safetensors is missing", "lvcd.ckpt is missing"):
        assert part in told
    assert "model.ckpt is missing" in told
    assert "huggingface.co" in told
