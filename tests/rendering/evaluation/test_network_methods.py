"""Methods that are networks, by small random weights."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import random_networks
from evaluation_sets import small_set
from physanimator.rendering.command import main
from physanimator.rendering.evaluation.clip_files import EXACT
from physanimator.rendering.evaluation.methods import method_named
from physanimator.rendering.pictures import read_clip

SVD = "settings = {steps = 2, area = 4096}"
FILL = 'interpolate = 3, interpolate_settings = {steps = 1, area = 4096, solver = "dpm++ 2m"}'


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    pytest.importorskip("transformers")
    from random_inpainting import write_inpainting_folder

    folder = tmp_path_factory.mktemp("weights")
    found = random_networks.write(folder / "paper", "folder")
    return found | {"inpainting": write_inpainting_folder(folder / "inpainting", sees_holes=True)}


def clip(report: Path, method: str) -> np.ndarray:
    return np.stack(list(read_clip(report / "clips" / method / "flag" / "sample_0" / EXACT))).astype(int)


def test_networks_draw_beside_composite(tmp_path: Path, files: dict[str, Path]) -> None:
    methods = f"""
    "composite",
    {{name = "guided", draws = "sketch-guided", {SVD}}},
    {{name = "blurred", draws = "sketch-guided", sketch_blur = 3.0, {SVD}}},
    {{name = "filled", draws = "sketch-guided", {SVD}, {FILL}}},
    {{name = "repainted", draws = "dual-clock", {SVD}}},
    {{name = "painted", draws = "inpainting", {SVD}}},
    """
    file = small_set(tmp_path / "set", methods=methods, more='device = "cpu"')
    named = ("svd", "lvcd", "tooncrafter", "inpainting")
    with file.open("a") as opened:
        opened.write("\n[weights]\n" + "".join(f"{name} = {str(files[name])!r}\n" for name in named))
    report = tmp_path / "report"
    assert main(["evaluate", str(file), "-o", str(report), "--picture", "flag", "--quiet"]) == 0
    clips = {name: clip(report, name) for name in ("composite", "guided", "repainted", "blurred", "filled", "painted")}
    assert {each.shape for each in clips.values()} == {(4, 64, 64, 3)}
    assert np.abs(clips["guided"] - clips["composite"]).max() > 20
    assert (clips["guided"] != clips["blurred"]).any(), "the blur of sketches changes what is drawn after them"
    assert (clips["guided"][3] == clips["filled"][3]).all(), "keyframes are the same"
    assert (clips["guided"][1] != clips["filled"][1]).any()
    told = json.loads((report / "report.json").read_text())
    assert told["left_out"] == []
    recorded = json.loads((report / "clips" / "guided" / "flag" / "sample_0" / "clip.json").read_text())
    assert set(recorded["made_from"]["weights"]) == {"svd", "lvcd"}
    assert np.abs(clips["repainted"] - clips["composite"]).max() > 20
    assert (clips["repainted"] != clips["guided"]).any()
    recorded = json.loads((report / "clips" / "repainted" / "flag" / "sample_0" / "clip.json").read_text())
    assert set(recorded["made_from"]["weights"]) == {"svd"}


def test_what_frames_follow_says_which_weights_are_needed() -> None:
    needed = {name: method_named(name).weights for name in ("dual-clock", "sketch-guided", "sketch-guided-dual-clock")}
    assert needed == {
        "dual-clock": ("svd",),
        "sketch-guided": ("svd", "lvcd"),
        "sketch-guided-dual-clock": ("svd", "lvcd"),
    }


def test_settings_are_checked_before_the_work(
    tmp_path: Path, files: dict[str, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    file = small_set(tmp_path / "set", methods='{name = "a", draws = "sketch-guided", settings = {stps = 2}}')
    with file.open("a") as opened:
        opened.write("\n[weights]\n" + "".join(f"{name} = {str(files[name])!r}\n" for name in ("svd", "lvcd")))
    assert main(["evaluate", str(file), "-o", str(tmp_path / "report"), "--quiet"]) == 2
    assert "did you mean steps?" in capsys.readouterr().err
    assert not (tmp_path / "report").exists()
