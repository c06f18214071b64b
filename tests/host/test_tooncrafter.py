"""The interpolation as a choice of Interpolate, in a real host."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]


def prompt(**changes: Any) -> dict[str, Any]:
    """Two pictures, one behind the other, with in-betweens by the model, as the paper's workflow sets it."""
    published = json.loads((ROOT / "workflows" / "api" / "physanimator_paper.json").read_text(encoding="utf-8"))
    (node,) = [node for node in published.values() if node["class_type"] == "PhysAnimator_Interpolate"]
    plain = {name: value for name, value in node["inputs"].items() if not isinstance(value, list)}
    given = {"images": ["2", 0], "images_are": "keyframes", "every": 4}
    return {
        "1": {"class_type": "PhysAnimator_ExampleIllustration", "inputs": {}},
        "2": {"class_type": "RepeatImageBatch", "inputs": {"image": ["1", 0], "amount": 2}},
        "3": {"class_type": "PhysAnimator_Interpolate", "inputs": {**plain, **given, **changes}},
        "4": {"class_type": "PreviewImage", "inputs": {"images": ["3", 0]}},
    }


def test_a_missing_model_is_named_with_its_source(host: Any) -> None:
    told = host.error_of(prompt())
    for part in ("model.ckpt is missing", "models/checkpoints", "huggingface.co/Doubiiu/ToonCrafter"):
        assert part in told


def test_keyframes_must_be_whole_numbers(host: Any) -> None:
    assert "keyframes_at must be whole numbers" in host.error_of(prompt(backend="flow", keyframes_at="0, 1.5"))


@pytest.fixture
def another_file(host: Any) -> Any:
    """A file of another model under the usual name."""
    torch = pytest.importorskip("torch")
    path = host.folder / "models" / "checkpoints" / "model.ckpt"
    path.parent.mkdir(parents=True, exist_ok=True)
    torch.save({"state_dict": {"layer.weight": torch.zeros(2)}}, path)
    yield path
    path.unlink()


def test_another_models_file_is_refused(host: Any, another_file: Path) -> None:
    told = host.error_of(prompt())
    assert "model.ckpt does not fit: nothing in it is called model.diffusion_model." in told
    assert "Wanted: ToonCrafter's model.ckpt" in told


def test_backends_without_files_run(host: Any) -> None:
    outputs = host.run(prompt(backend="flow", keyframes_at="0, 3"))
    assert len(outputs["4"]["images"]) == 4
