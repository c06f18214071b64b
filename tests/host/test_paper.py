"""The strict paper's graph in a real host: refused while files are missing, run whole with small random networks."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
API = json.loads((ROOT / "workflows" / "api" / "paper_strict.json").read_text(encoding="utf-8"))
FRAMES = 15


def test_every_missing_file_is_named_and_nothing_else_is_refused(host: Any) -> None:
    _, answer = host.post("/prompt", {"prompt": API, "client_id": host.client})
    refused = {
        API[key]["class_type"].removeprefix("PhysAnimator_"): each for key, each in answer["node_errors"].items()
    }
    assert set(refused) == {"SegmentByPoints", "ExtractSketch", "Render", "Interpolate"}
    for told in refused.values():
        assert {error["type"] for error in told["errors"]} == {"custom_validation_failed"}
        assert "is missing" in json.dumps(told)


def test_the_whole_graph_runs_on_small_random_networks(host: Any) -> None:
    import av

    tiny_models = pytest.importorskip("tiny_models")
    tiny_models.write_tiny_models(host.folder / "models")
    prompt = tiny_models.with_tiny_models(API, frames=FRAMES)
    (save,) = [key for key, node in prompt.items() if node["class_type"] == "SaveVideo"]
    (saved,) = host.run(prompt)[save]["images"]
    with av.open(io.BytesIO(host.view(saved))) as container:
        frames = np.stack([frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)])
    assert frames.shape == (FRAMES, 720, 1280, 3)
    assert frames.std(axis=(1, 2, 3)).min() > 1
