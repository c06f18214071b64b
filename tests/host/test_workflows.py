"""Every published workflow, run for real."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from comfy_host import skip_without_its_nodes
from frame_interpolation_graph import for_newer_hosts
from graphs import without_models
from video_model_graphs import led_by, without_video_model

ROOT = Path(__file__).resolve().parents[2]
ALL = {
    path: json.loads(path.read_text(encoding="utf-8")) for path in sorted((ROOT / "workflows" / "api").glob("*.json"))
}
WORKFLOWS = [path for path, api in ALL.items() if led_by(api) is None and not for_newer_hosts(api)]
FOR_NEWER_HOSTS = [path for path, api in ALL.items() if for_newer_hosts(api)]
FOR_VIDEO_MODELS = [path for path, api in ALL.items() if led_by(api) is not None]
MOVING = {"PhysAnimator_Simulate", "PhysAnimator_AnimateIllustration"}
LOADERS = {
    "CLIPLoader",
    "CLIPVisionLoader",
    "CheckpointLoaderSimple",
    "LTXAVTextEncoderLoader",
    "LTXVAudioVAELoader",
    "LoadWanVideoT5TextEncoder",
    "LoraLoaderModelOnly",
    "UNETLoader",
    "VAELoader",
    "WanVideoModelLoader",
    "WanVideoVAELoader",
}


def frames_of(video: bytes) -> np.ndarray:
    import av

    with av.open(io.BytesIO(video)) as container:
        return np.stack([frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)])


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_a_workflow_gives_a_moving_video(host: Any, path: Path) -> None:
    prompt = without_models(json.loads(path.read_text(encoding="utf-8")))
    outputs = host.run(prompt)
    (save,) = [key for key, node in prompt.items() if node["class_type"] == "SaveVideo"]
    (count,) = {node["inputs"]["frames"] for node in prompt.values() if node["class_type"] in MOVING}
    frames = frames_of(host.view(outputs[save]["images"][0]))
    assert frames.shape == (count, 720, 1280, 3)
    steps = np.abs(np.diff(frames.astype(np.int16), axis=0))
    moving = (steps > 24).any(axis=-1).mean(axis=(1, 2))
    assert (moving > 1e-4).mean() > 0.9, "most frames differ from the one before"
    assert moving.max() < 0.2, "the picture as a whole stays in place"


@pytest.mark.parametrize("path", FOR_VIDEO_MODELS, ids=lambda path: path.stem)
def test_a_video_model_s_workflow_lacks_nothing_but_its_files(host: Any, path: Path) -> None:
    """The host accepts every node and link of it; what it refuses are the names of files that are not there."""
    prompt = ALL[path]
    skip_without_its_nodes(host, prompt)
    _, answer = host.post("/prompt", {"prompt": prompt, "client_id": host.client})
    refused = answer["node_errors"]
    assert {node["class_type"] for node in prompt.values()} & LOADERS == {
        prompt[key]["class_type"] for key in refused
    }, refused
    for found in refused.values():
        assert {error["type"] for error in found["errors"]} == {"value_not_in_list"}, found


@pytest.mark.parametrize("path", FOR_VIDEO_MODELS, ids=lambda path: path.stem)
def test_what_a_video_model_is_given_has_its_length_and_size(host: Any, path: Path) -> None:
    prompt = ALL[path]
    shown = without_video_model(prompt)
    (save,) = [key for key, node in shown.items() if node["class_type"] == "SaveVideo"]
    frames = frames_of(host.view(host.run(shown)[save]["images"][0]))
    given = prompt[led_by(prompt) or ""]
    told = given["inputs"]
    size = (told.get("height"), told.get("width"), 3)
    if given["class_type"] == "PhysAnimator_FirstAndLastFrame":
        assert frames.shape == (1, *size)
    elif given["class_type"] == "PhysAnimator_UncoveredArea":
        assert frames.shape == (1, 720, 1280, 3)
    elif given["class_type"] == "PhysAnimator_TimeToMove":  # which chooses the size
        assert frames.shape == (81, 464, 832, 3)
    elif given["class_type"] == "PhysAnimator_Tracks":
        assert len(frames) == (told["frames"] + 1) // 2, "every second sample"
    else:
        assert frames.shape == (told["frames"], *size)
    if given["class_type"] == "PhysAnimator_Keyframes":
        drawn = frames.std(axis=(1, 2, 3)) > 20  # a codec leaves traces of a keyframe in the grey after it
        assert np.flatnonzero(drawn).tolist() == [0, 40, 80]
    elif given["class_type"] in (
        "PhysAnimator_WarpedVideo",
        "PhysAnimator_LineControlVideo",
        "PhysAnimator_TimeToMove",
    ):
        assert (np.abs(np.diff(frames.astype(np.int16), axis=0)) > 24).any(axis=(1, 2, 3)).mean() > 0.9


@pytest.mark.parametrize("path", FOR_NEWER_HOSTS, ids=lambda path: path.stem)
def test_a_workflow_for_newer_hosts_lacks_nothing_but_its_file(host: Any, path: Path) -> None:
    prompt = ALL[path]
    skip_without_its_nodes(host, prompt)
    _, answer = host.post("/prompt", {"prompt": prompt, "client_id": host.client})
    assert {prompt[key]["class_type"] for key in answer["node_errors"]} == {"FrameInterpolationModelLoader"}, answer


def test_what_was_not_changed_is_not_computed_again(host: Any) -> None:
    prompt = json.loads((ROOT / "workflows" / "api" / "quickstart.json").read_text(encoding="utf-8"))
    host.run(prompt)
    entry = host.wait(host.queue(prompt))
    cached = next(data["nodes"] for name, data in entry["status"]["messages"] if name == "execution_cached")
    again = {prompt[key]["class_type"] for key in set(prompt) - set(cached)}
    assert not {name for name in again if name.startswith("PhysAnimator_")}
