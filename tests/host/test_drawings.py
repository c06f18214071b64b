"""Sketches and measures in a real host: both extractors, every way of warping, and the numbers."""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
import pytest
from PIL import Image

SIZE = (180, 320)
LINES = {"line_width": 2.0, "threshold": 0.06, "coherence": 3.0, "smallest_speck": 24}


def core(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": node_type, "inputs": inputs}


def ours(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return core(f"PhysAnimator_{node_type}", **inputs)


def bar() -> dict[str, Any]:
    """An upright white bar on grey that sways, and its sketch."""
    height, width = SIZE
    return {
        "black": core("SolidMask", value=0.0, width=width, height=height),
        "white": core("SolidMask", value=1.0, width=40, height=120),
        "mask": core("MaskComposite", destination=["black", 0], source=["white", 0], x=140, y=30, operation="add"),
        "grey": core("EmptyImage", width=width, height=height, batch_size=1, color=0x808080),
        "bright": core("EmptyImage", width=width, height=height, batch_size=1, color=0xFFFFFF),
        "picture": core(
            "ImageCompositeMasked", destination=["grey", 0], source=["bright", 0], x=0, y=0, resize_source=False,
            mask=["mask", 0],
        ),
        "mesh": ours("MaskToMesh", mask=["mask", 0], spacing=10.0, elements_across=3, mask_index=0),
        "body": ours("Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="top"),
        "scene": ours(
            "AutomaticScene", bodies=["body", 0], wind_strength=2.0, wind_angle=0.0, sway_by_size=True, frame_rate=12.0
        ),
        "simulate": ours("Simulate", scene=["scene", 0], frames=5),
        "sketch": ours("ExtractSketch", image=["picture", 0], **LINES),
    }  # fmt: skip


def pictures(host: Any, outputs: dict[str, Any], key: str) -> np.ndarray:
    files = [host.view(saved) for saved in outputs[key]["images"]]
    return np.stack([np.asarray(Image.open(io.BytesIO(file)).convert("L")).astype(int) for file in files])


def drawn(host: Any, **changes: Any) -> np.ndarray:
    graph = bar() | {"seen": core("PreviewImage", images=["sketch", 0])}
    graph["sketch"]["inputs"] |= changes
    return pictures(host, host.run(graph), "seen")[0]


@pytest.fixture(scope="module")
def weights(host: Any) -> str:
    """Random weights of the public size, where no other node looks for files."""
    torch = pytest.importorskip("torch")
    reference = pytest.importorskip("reference_nets")
    generator = torch.Generator().manual_seed(0)
    shapes = reference.full_shapes("informative_drawings_sk_model")
    folder = host.folder / "models" / "annotators"
    folder.mkdir(parents=True, exist_ok=True)
    made = {name: torch.randn(shape, generator=generator) * 0.05 for name, shape in shapes.items()}
    torch.save(made, folder / "sk_model.pth")
    return "sk_model.pth"


NETWORK = {"extractor": "drawing network", "extractor.working_size": 0, "extractor.precision": "auto"}


def test_missing_weights_are_named_when_the_graph_is_queued(host: Any) -> None:
    graph = bar() | {"seen": core("PreviewImage", images=["sketch", 0])}
    graph["sketch"]["inputs"] |= NETWORK | {"extractor.model": "netG.pth"}
    told = host.error_of(graph)
    for part in ("netG.pth is missing", "models/controlnet", "https://huggingface.co/lllyasviel/Annotators", "MIT"):
        assert part in told


def test_a_graph_of_before_the_choice_runs_as_it_did(host: Any) -> None:
    before = drawn(host)
    assert before[90, 138:142].min() < 80
    assert (before[90, 150:170] == 255).all()
    np.testing.assert_array_equal(drawn(host, extractor="difference of Gaussians"), before)


def test_a_network_draws_at_the_picture_s_size(host: Any, weights: str) -> None:
    network = drawn(host, **NETWORK, **{"extractor.model": weights})
    assert network.shape == SIZE
    assert network.max() == 255
    assert np.abs(network - drawn(host)).mean() > 1


def test_every_way_of_warping_and_the_numbers(host: Any) -> None:
    graph = bar() | {
        "flow": ours("OpticalFlow", motion=["simulate", 0]),
        "render": ours("Render", image=["picture", 0], motion=["simulate", 0]),
        "behind": ours("ExtractSketch", image=["render", 2], **LINES),
    }
    for mode in ("layered", "paper", "softmax"):
        graph[mode] = ours("WarpSketch", sketch=["sketch", 0], flow=["flow", 0], mode=mode, blur_sigma=0.0)
        graph[f"{mode}_seen"] = core("PreviewImage", images=[mode, 0])
    graph["layered"]["inputs"]["lines_behind"] = ["behind", 0]
    graph["metrics"] = ours(
        "Metrics", images=["render", 0], motion=["simulate", 0], drawing=["picture", 0], sketches=["layered", 0],
        fid=False, description="",
    )  # fmt: skip
    outputs = host.run(graph)
    for mode in ("layered", "paper", "softmax"):
        seen = pictures(host, outputs, f"{mode}_seen")
        assert seen.shape == (5, *SIZE)
        assert seen[-1].min() < 80
    found = json.loads(outputs["metrics"]["text"][0])
    assert found["flow_warp_error"] < 0.02
    assert found["static_drift"] < 0.01
    assert 0 <= found["sketch_adherence"] < 3


def test_measures_that_need_files_are_refused_without_them(host: Any) -> None:
    graph = bar() | {"render": ours("Render", image=["picture", 0], motion=["simulate", 0])}
    graph["metrics"] = ours("Metrics", images=["render", 0], motion=["simulate", 0], fid=True, description="a bar")
    told = host.error_of(graph)
    assert "models/metrics/pt_inception-2015-12-05-6726825d.pth is missing" in told
    assert "VideoScore is missing" in told
