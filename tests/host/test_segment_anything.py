"""Several parts at once, and networks of the Segment Anything family, in a real host."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

TWO_PARTS = "[[700, 50, 1], [690, 540, 1, 1], [360, 420, 0, 1]]"
SAM = "segment anything"


def prompt(**changes: Any) -> dict[str, Any]:
    """The example's parts under the points, as pictures."""
    given = {"image": ["example", 0], "points": TWO_PARTS, **changes}
    return {
        "example": {"class_type": "PhysAnimator_ExampleIllustration", "inputs": {}},
        "cut": {"class_type": "PhysAnimator_SegmentByPoints", "inputs": given},
        "seen": {"class_type": "MaskToImage", "inputs": {"mask": ["cut", 0]}},
        "saved": {"class_type": "PreviewImage", "inputs": {"images": ["seen", 0]}},
    }


def test_each_part_is_a_mask_of_the_batch(host: Any) -> None:
    cleaning = {"smallest_speck": 50, "largest_hole": 50, "smoothing": 1.0}
    assert len(host.run(prompt())["saved"]["images"]) == 2
    assert len(host.run(prompt(backend="grabcut", **cleaning))["saved"]["images"]) == 2


def test_a_box_may_replace_the_points(host: Any) -> None:
    assert len(host.run(prompt(points="", box="[440, 10, 860, 160]"))["saved"]["images"]) == 1


@pytest.mark.parametrize("box", ["[1, 2, 3]", "[[5, 5, 1, 1]]", "here"])
def test_a_bad_box_is_refused_before_any_work(host: Any, box: str) -> None:
    status, answer = host.post("/prompt", {"prompt": prompt(box=box)})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert "box must be [x0, y0, x1, y1]" in answer["node_errors"]["cut"]["errors"][0]["details"]


def test_missing_weights_are_named_before_any_work(host: Any) -> None:
    choice = {"backend": SAM, "backend.sam_model": "sam_vit_b_01ec64.pth", "backend.precision": "fp32"}
    status, answer = host.post("/prompt", {"prompt": prompt(**choice)})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    told = answer["node_errors"]["cut"]["errors"][0]["details"]
    for part in ("sam_vit_b_01ec64.pth is missing", "models/sams", "https://", "Apache-2.0", "config.json"):
        assert part in told


@pytest.fixture
def small_network(host: Any) -> Any:
    """A folder of random weights in models/sams."""
    pytest.importorskip("transformers")
    from random_sam import random_network, save_network

    return save_network(random_network("sam2"), host.folder / "models" / "sams" / "small")


def test_a_network_of_the_family_runs(host: Any, small_network: Path) -> None:
    choice = {"backend": SAM, "backend.sam_model": "small/", "backend.precision": "fp32"}
    assert len(host.run(prompt(**choice))["saved"]["images"]) == 2
    config = json.loads((small_network / "config.json").read_text())
    (small_network / "config.json").write_text(json.dumps(config | {"model_type": "bert"}))
    assert "names the model type 'bert'" in host.error_of(prompt(**choice, smoothing=1.0))
