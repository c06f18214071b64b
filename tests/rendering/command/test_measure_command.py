"""The command ``measure``: an own clip is nearly perfect, a faulty one is found out, and nothing is fetched."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from physanimator.rendering.command import main
from physanimator.rendering.pictures import load_image, save_image

WIDTH, HEIGHT = 128, 96
MOTION = ["girl.png", "--mask", "hair.png", "--wind", "3", "--frames", "6", "--skip", "2", "--quiet"]

Output = pytest.CaptureFixture[str]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a picture, a mask and the animation of both."""
    monkeypatch.chdir(tmp_path)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    strip = (np.abs(x - 60) < 10) & (y > 12) & (y < 80)
    image = np.stack([80 + x * 0.8, 200 - y * 0.9, 160 + 0 * x], axis=-1).astype(np.uint8)
    image[strip] = (70, 40, 30)
    image[strip & (y % 12 < 3)] = (200, 160, 90)
    save_image("girl.png", image)
    save_image("hair.png", strip.astype(np.uint8) * 255)
    assert main(["animate", *MOTION, "--output", "frames/"]) == 0
    return tmp_path


def measures(capsys: Output, *arguments: str) -> dict[str, float]:
    assert main(["measure", *MOTION, "--json", *arguments]) == 0
    return json.loads(capsys.readouterr().out)


def test_a_clip_in_a_folder_and_what_would_be_drawn_measure_alike(folder: Path, capsys: Output) -> None:
    own, written = measures(capsys), measures(capsys, "--clip", "frames")
    assert own == pytest.approx(written, abs=1e-3)
    assert own["flow_warp_error"] < 0.01
    assert own["static_drift"] < 1e-3
    assert own["sketch_adherence"] < 2
    assert own["hole_ratio"] > 0


def test_a_faulty_clip_is_found_out(folder: Path, capsys: Output) -> None:
    good = measures(capsys, "--clip", "frames")
    shutil.copytree("frames", "faulty")
    for number, path in enumerate(sorted(Path("faulty").glob("*.png"))):
        save_image(path, np.clip(load_image(path).astype(int) + 20 * (number % 2), 0, 255).astype(np.uint8))
    bad = measures(capsys, "--clip", "faulty")
    assert bad["flow_warp_error"] > good["flow_warp_error"] + 0.05
    assert bad["static_drift"] == pytest.approx(0.5 * 20 / 255, rel=0.2)


@pytest.mark.parametrize("name", ["clip.mp4", "clip.gif", "clip.webp"])
def test_videos_and_animated_pictures_are_read(folder: Path, capsys: Output, name: str) -> None:
    assert main(["animate", *MOTION, "--output", name]) == 0
    found = measures(capsys, "--clip", name)
    assert found["flow_warp_error"] < 0.08
    assert found["static_drift"] < 0.05


def test_the_table_names_measures_and_units(folder: Path, capsys: Output) -> None:
    assert main(["measure", *MOTION]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines][:3] == ["flow_warp_error", "flow_warp_error_to_first", "static_drift"]
    assert next(line for line in lines if line.startswith("sketch_adherence")).endswith(" px")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--clip", "none.mp4"], "--clip must be a video or a folder"),
        (["--clip", "girl.png"], "--clip must be one for each of the motion's 4 frames. Got: 1"),
        (["--clip", "hair.txt"], "clip hair.txt cannot be read"),
        (["--clip", "empty"], "holds pictures"),
        (["--fid", "w.pth"], "--fid and --reference need each other"),
        (["--fid", "w.pth", "--reference", "frames"], "pt_inception-2015-12-05-6726825d.pth from https://github.com"),
        (["--fid", "girl.png", "--reference", "frames"], "girl.png cannot be read"),
        (["--video-score", "vs"], "--video-score and --description need each other"),
        (["--video-score", "vs", "--description", "a girl"], "VideoScore from https://huggingface.co/TIGER-Lab"),
        (["--video-score", "frames", "--description", "a girl"], "config.json is missing or cannot be read"),
        (["--frames", "5"], "Got: at least 4"),
    ],
)
def test_bad_input_is_one_sentence(folder: Path, capsys: Output, arguments: list[str], words: str) -> None:
    (folder / "hair.txt").write_text("no video")
    (folder / "empty").mkdir()
    if "--frames" in arguments:
        arguments = [*arguments, "--clip", "frames"]
    capsys.readouterr()
    assert main(["measure", *MOTION, *arguments]) == 2
    captured = capsys.readouterr()
    assert words in captured.err
    assert captured.out == ""
    assert "Traceback" not in captured.err
