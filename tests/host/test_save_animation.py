"""Save Animation in a real host: every file type, the host's names and counting, transparency, interruption."""

from __future__ import annotations

import io
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bar_graphs import core, moving_bar, ours
from PIL import Image

TYPES = ["mp4", "webm", "gif", "webp", "apng", "mov", "png frames"]


def saved(frames: int = 4, **changes: Any) -> dict[str, Any]:
    usual = {"image": ["picture", 0], "motion": ["motion", 0], "filename_prefix": "films/bar", "file_type": "mp4",
             "width": 0}  # fmt: skip
    return moving_bar(frames) | {"save": ours("SaveAnimation", **(usual | changes))}


def decoded(data: bytes) -> list[np.ndarray]:
    import av

    with av.open(io.BytesIO(data)) as container:
        return [frame.to_ndarray(format="rgb24").astype(int) for frame in container.decode(video=0)]


def frames_of(host: Any, outputs: dict[str, Any]) -> list[np.ndarray]:
    files = outputs["save"]["images"]
    if len(files) > 1:
        return [np.asarray(Image.open(io.BytesIO(host.view(each))).convert("RGB")).astype(int) for each in files]
    return decoded(host.view(files[0])) if not files[0]["filename"].endswith(".webp") else animated(host, files[0])


def animated(host: Any, file: dict[str, str]) -> list[np.ndarray]:
    picture = Image.open(io.BytesIO(host.view(file)))
    found = []
    for number in range(picture.n_frames):
        picture.seek(number)
        found.append(np.asarray(picture.convert("RGB")).astype(int))
    return found


@pytest.mark.parametrize("file_type", TYPES)
def test_every_file_type_shows_the_frames_of_render(host: Any, file_type: str) -> None:
    prompt = saved(file_type=file_type) | {
        "render": ours("Render", image=["picture", 0], motion=["motion", 0]),
        "seen": core("PreviewImage", images=["render", 0]),
        "path": core("PreviewAny", source=["save", 0]),
    }
    outputs = host.run(prompt)
    written = frames_of(host, outputs)
    assert len(written) == 4
    for frame, file in zip(written, outputs["seen"]["images"], strict=True):
        drawn = np.asarray(Image.open(io.BytesIO(host.view(file))).convert("RGB")).astype(int)
        apart = np.abs(frame - drawn)  # the host cuts off what is behind the point, this pack rounds
        assert apart.max() <= 1 if file_type in ("apng", "png frames") else apart.mean() <= 3
    (path,) = outputs["path"]["text"]
    assert Path(path).exists()
    assert Path(path).is_relative_to(host.folder / "output" / "films")
    assert outputs["save"].get("animated") == (None if file_type == "png frames" else [True])


def test_names_are_counted_and_nothing_is_overwritten(host: Any) -> None:
    names = []
    for width in (80, 82, 84):
        outputs = host.run(saved(filename_prefix="counted/%width%x%height%/bar", width=width))
        names.append((outputs["save"]["images"][0]["subfolder"], outputs["save"]["images"][0]["filename"]))
    assert names == [(f"counted/{size}/bar"[:-4], "bar_00001_.mp4") for size in ("80x48", "82x49", "84x50")]
    folder = host.folder / "output" / "again"
    for number in range(3):
        host.run(saved(filename_prefix="again/bar", width=90 + 2 * number))
    assert sorted(each.name for each in folder.iterdir()) == [f"bar_{number:05}_.mp4" for number in (1, 2, 3)]


def test_parts_alone_are_transparent(host: Any) -> None:
    outputs = host.run(saved(file_type="png frames", background="parts", filename_prefix="parts/bar"))
    first = Image.open(io.BytesIO(host.view(outputs["save"]["images"][0])))
    assert first.mode == "RGBA"
    alpha = np.asarray(first)[..., 3]
    assert alpha[40, 70] == 255
    assert alpha[5, 5] == 0


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"background": "parts"}, "file_type must be one of webm, gif, webp, apng, mov, png frames for transparency"),
        ({"background": "sky-high"}, "background must be one of picture, transparent, parts, colour"),
        ({"background": "colour", "background.colour": "sky-high"}, "background must be picture, transparent, parts"),
        ({"file_type": "avi"}, "file_type must be one of mp4, webm"),
        ({"filename_prefix": "../outside"}, "filename_prefix must be a name in the output folder"),
        ({"filename_prefix": "/etc/outside"}, "filename_prefix must be a name in the output folder"),
        ({"filename_prefix": "film/" + "x" * 300}, "filename_prefix must be of names with at most 200 bytes each"),
        ({"filename_prefix": ""}, "filename_prefix must be a name in the output folder"),
        ({"width": 20000}, "width must be a number from 0 to 16384"),
    ],
)
def test_what_cannot_be_written_is_refused_before_the_simulation(
    host: Any, changes: dict[str, Any], sentence: str
) -> None:
    status, answer = host.post("/prompt", {"prompt": saved(**changes)})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert sentence in answer["node_errors"]["save"]["errors"][0]["details"]
    if status == 200:  # the mesh is shown all the same; the simulation is not run
        assert set(host.wait(answer["prompt_id"])["outputs"]) <= {"mesh"}
    assert not (host.folder / "outside_00001_.mp4").exists()


def test_an_interrupted_file_leaves_nothing(host: Any) -> None:
    folder = host.folder / "output" / "stopped"
    prompt = saved(frames=60, filename_prefix="stopped/bar", width=2400)
    running = host.queue(prompt)
    end = time.monotonic() + 60
    while not (folder.is_dir() and any(folder.iterdir())):  # it is being written under a temporary name
        assert time.monotonic() < end
        time.sleep(0.02)
    assert not (folder / "bar_00001_.mp4").exists()
    host.post("/interrupt", {})
    entry = host.wait(running)
    assert "execution_interrupted" in [name for name, _ in entry["status"]["messages"]]
    assert list(folder.iterdir()) == []
