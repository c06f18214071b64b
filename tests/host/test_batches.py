"""Batches in a real host: made when they are connected, and announced or refused before the work."""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
import pytest
from bar_graphs import core, moving_bar, ours
from PIL import Image


def seen_picture(source: str, slot: int) -> dict[str, Any]:
    return {"seen": core("PreviewImage", images=[source, slot])}


def seen_mask(source: str, slot: int) -> dict[str, Any]:
    return {"grey": core("MaskToImage", mask=[source, slot]), "shown": core("PreviewImage", images=["grey", 0])}


def pictures(host: Any, saved: list[dict[str, str]]) -> np.ndarray:
    return np.stack([np.asarray(Image.open(io.BytesIO(host.view(each))).convert("L")).astype(int) for each in saved])


def told_of_cache(entry: dict[str, Any]) -> list[str]:
    return next(data["nodes"] for name, data in entry["status"]["messages"] if name == "execution_cached")


@pytest.mark.parametrize(
    ("node", "first", "second"), [("render", seen_picture, seen_mask), ("warped", seen_picture, seen_mask)]
)
def test_what_is_connected_later_is_made_and_never_a_stand_in(host: Any, node: str, first: Any, second: Any) -> None:
    number = 4 if node == "render" else 5  # so that neither test finds the other's motion
    graph = moving_bar(number) | {
        "render": ours("Render", image=["picture", 0], motion=["motion", 0]),
        "flow": ours("OpticalFlow", motion=["motion", 0]),
        "warped": ours("WarpSketch", sketch=["picture", 0], flow=["flow", 0], mode="paper", blur_sigma=0.0),
    }
    alone = graph | first(node, 0)
    host.run(alone)
    again = host.wait(host.queue(alone))
    assert node in told_of_cache(again)
    both = host.wait(host.queue(alone | second(node, 1)))
    assert both["status"]["status_str"] == "success"
    assert node not in told_of_cache(both)
    masks = pictures(host, both["outputs"]["shown"]["images"])
    assert masks.shape == (number, 96, 160)
    assert masks.max() > 200
    without = host.wait(host.queue(graph | second(node, 1)))  # now the first output is the one that nobody takes
    assert (pictures(host, without["outputs"]["shown"]["images"]) == masks).all()


def test_the_plate_alone_costs_no_frames(host: Any) -> None:
    graph = moving_bar(3) | {"render": ours("Render", image=["picture", 0], motion=["motion", 0])}
    (plate,) = pictures(host, host.run(graph | seen_picture("render", 2))["seen"]["images"])
    assert plate.max() < 30


def test_a_batch_that_no_machine_holds_is_refused_before_the_work(host: Any) -> None:
    graph = moving_bar(3) | {
        "video": ours("WarpedVideo", image=["picture", 0], motion=["motion", 0], frames=10_001, width=8192, height=8192,
                      fit="crop", grow=4)
    }  # fmt: skip
    said = host.error_of(graph | seen_picture("video", 0))
    assert "10001 frames of 8192 x 8192 px are 10738.5 GB" in said
    assert "make fewer frames" in said


def test_advice_is_in_the_history_of_a_run_without_a_browser(host: Any) -> None:
    graph = moving_bar(12)  # a second: nothing is said of shorter trials, to which no wind may have come
    graph["scene"] = ours("AutomaticScene", bodies=["body", 0], wind_strength=0.0, wind_angle=0.0, sway_by_size=True,
                          frame_rate=12.0)  # fmt: skip
    outputs = host.run(graph | {"seen": core("PreviewAny", source=["motion", 1])})
    (sentence,) = outputs["motion"]["advice"]
    assert sentence.startswith("nothing moves")
    assert f"PhysAnimator, Simulate: {sentence}" in host.log


@pytest.mark.parametrize(("at", "sentence"), [("0, 9, 5", "increasing"), ("3, 3", "increasing"), ("-1, 4", "from 0")])
def test_keyframes_that_no_clip_has_are_refused_before_any_work(host: Any, at: str, sentence: str) -> None:
    filled = ours("Interpolate", images=["keys", 0], images_are="keyframes", every=5, backend="blend", keyframes_at=at)
    keys = core("EmptyImage", width=64, height=32, batch_size=2, color=0)
    status, answer = host.post("/prompt", {"prompt": {"filled": filled, "keys": keys} | seen_picture("filled", 0)})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert sentence in json.dumps(answer)


@pytest.mark.parametrize("backend", ["motion", "flow", "blend"])
def test_frames_before_the_first_keyframe_and_after_the_last_are_kept(host: Any, backend: str) -> None:
    """All frames: 11 of them, each of another grey; keyframes alone: the first is shown until its turn."""
    greys = {f"grey_{t}": core("SolidMask", value=t / 10, width=64, height=32) for t in range(11)}
    shades = {f"picture_{t}": core("MaskToImage", mask=[f"grey_{t}", 0]) for t in range(11)}
    batches = {"batch_0": core("ImageBatch", image1=["picture_0", 0], image2=["picture_1", 0])} | {
        f"batch_{t - 1}": core("ImageBatch", image1=[f"batch_{t - 2}", 0], image2=[f"picture_{t}", 0])
        for t in range(2, 11)
    }
    every = ours("Interpolate", images=["batch_9", 0], images_are="all frames", every=5, backend=backend,
                 keyframes_at="3, 6")  # fmt: skip
    alone = ours("Interpolate", images=["batch_0", 0], images_are="keyframes", every=5, backend=backend,
                 keyframes_at="3, 6")  # fmt: skip
    graph = greys | shades | batches | {"every": every, "alone": alone}
    outputs = host.run(graph | {"seen": core("PreviewImage", images=["every", 0]),
                                "held": core("PreviewImage", images=["alone", 0])})  # fmt: skip

    def shown(key: str) -> list[int]:
        return [round(picture.mean() / 25.5) for picture in pictures(host, outputs[key]["images"])]

    assert shown("seen") == list(range(11))
    assert shown("held")[:4] == [0, 0, 0, 0]
    assert len(shown("held")) == 7
