"""The command that makes training data, from videos to what other trainers read."""

from __future__ import annotations

import csv
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import random_networks
from command_status import status
from physanimator.rendering.pictures import load_image, read_clip, write_animation
from physanimator.rendering.training import building, kept_clips, read_index
from physanimator.rendering.training.clip_writing import write_clip
from physanimator.rendering.training.data_folder import clip_file, index_file, sketch_file
from physanimator.rendering.training.encoded_clips import check_encoded, read_tensors
from small_videos import panned, write_video

pytest.importorskip("scenedetect", reason="cuts are found by PySceneDetect")

Output = pytest.CaptureFixture[str]

ROOT = Path(__file__).resolve().parents[3]
SMALL = ("--size", "128x64", "--workers", "1", "--quiet")


@pytest.fixture(scope="module")
def videos(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two videos: shots on ones, on twos and a short one; and, between bars, a shot on threes and one that stands."""
    folder = tmp_path_factory.mktemp("videos")
    write_video(folder / "one.mp4", panned(1, 26, 0.8), panned(2, 52, 1.2, hold=2), panned(3, 23, 0.8))
    write_video(folder / "two.mp4", panned(4, 72, 1.2, hold=3), panned(5, 1, 0) * 30, bars=32)
    return folder


@pytest.fixture(scope="module")
def data(videos: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("made") / "data"
    assert status("dataset", "build", str(videos), "--output", str(place), "--licence", "CC0-1.0", *SMALL) == 0
    return place


def contents(folder: Path) -> dict[str, bytes]:
    return {str(each.relative_to(folder)): each.read_bytes() for each in folder.rglob("*") if each.is_file()}


def test_clips_are_cut_judged_and_written(data: Path) -> None:
    records = list(read_index(data))
    told = {(Path(each.source).name, each.frames, each.kept) for each in records}
    assert {("one.mp4", 26, True), ("one.mp4", 23, False), ("two.mp4", 24, True)} <= told
    twos = next(each for each in records if each.source.endswith("one.mp4") and each.start > 1 and each.kept)
    assert (twos.frames, twos.fps) == (26, pytest.approx(12, abs=0.01))
    assert (twos.start, twos.end) == (pytest.approx(26 / 24, abs=0.01), pytest.approx(78 / 24, abs=0.01))
    assert next(each.fps for each in records if each.frames == 24) == pytest.approx(8, abs=0.01)
    still = next(each for each in records if each.source.endswith("two.mp4") and not each.kept)
    assert still.why
    for each in kept_clips(data):
        assert (each.licence, each.sketches) == ("CC0-1.0", "difference of Gaussians")
        for file in (clip_file, sketch_file):
            frames = list(read_clip(file(data, each.name)))
            assert (len(frames), frames[0].shape) == (each.frames, (64, 128, 3))
    assert {each.stem for each in (data / "clips").iterdir()} == {each.name for each in kept_clips(data)}


def test_bars_are_cut_and_frames_are_those_of_the_video(data: Path) -> None:
    """Frames differ from what was drawn by H.264 alone: 30 dB at least after two compressions."""
    threes = next(each for each in kept_clips(data) if each.frames == 24)
    drawn = panned(4, 72, 1.2, hold=3)[::3]
    for frame, truth in zip(read_clip(clip_file(data, threes.name)), drawn, strict=True):
        assert frame[:, :3].mean() > 20
        error = float(np.mean((frame[:, 4:-4].astype(float) - truth[:, 4:-4]) ** 2))
        assert 10 * np.log10(255**2 / error) > 30


def test_a_second_build_leaves_out_what_is_done_and_adds_what_is_new(
    data: Path, videos: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = contents(data)
    (tmp_path / "renamed.mp4").write_bytes((videos / "one.mp4").read_bytes())
    monkeypatch.setattr(building, "write_clip", None)  # would fail if anything were built
    assert status("dataset", "build", str(videos), str(tmp_path), "--output", str(data), *SMALL) == 0
    assert contents(data) == before


def test_other_options_are_noticed(data: Path, videos: Path, capsys: Output) -> None:
    before = contents(data)
    for option, value in (("--size", "64x64"), ("--min-score", "0.1"), ("--fps", "8")):
        arguments = ["dataset", "build", str(videos), "--output", str(data), *SMALL, option, value]
        assert status(*arguments) == 2
        assert "must stay" in capsys.readouterr().err
    assert contents(data) == before


def test_folders_of_others_are_left_alone(videos: Path, tmp_path: Path, capsys: Output) -> None:
    (tmp_path / "thesis.txt").write_text("mine")
    assert status("dataset", "build", str(videos), "--output", str(tmp_path), *SMALL) == 2
    assert re.search(r"--output must be .* holds thesis\.txt", capsys.readouterr().err)
    assert os.listdir(tmp_path) == ["thesis.txt"]
    assert status("dataset", "simulate", "--clips", "1", "--output", str(tmp_path)) == 2


def test_without_pyscenedetect_a_sentence_tells_what_to_install(
    videos: Path, monkeypatch: pytest.MonkeyPatch, capsys: Output
) -> None:
    monkeypatch.setitem(sys.modules, "scenedetect", None)
    assert status("dataset", "build", str(videos), "--dry-run", *SMALL) == 2
    assert "physanimator[train]" in capsys.readouterr().err


def test_a_dry_run_counts_and_writes_nothing(videos: Path, tmp_path: Path, capsys: Output) -> None:
    arguments = ["dataset", "build", str(videos), "--dry-run", *SMALL]
    assert status(*arguments) == 0
    told = capsys.readouterr().out
    assert "kept: 3 clips, 76 frames" in told
    assert "shorter than 24 frames: 2" in told
    assert os.listdir(tmp_path) == []


def test_a_damaged_video_stops_nothing_and_data_among_the_videos_is_none(videos: Path, tmp_path: Path) -> None:
    whole = (videos / "one.mp4").read_bytes()
    (tmp_path / "noise.mp4").write_bytes(np.random.default_rng(0).bytes(4000))
    (tmp_path / "whole.mp4").write_bytes(whole)
    assert status("dataset", "build", str(tmp_path), "--output", str(tmp_path / "data"), *SMALL) == 0
    records = list(read_index(tmp_path / "data"))
    assert next(each.why for each in records if each.source.endswith("noise.mp4")).startswith("cannot be read")
    assert sum(each.kept for each in records) == 2
    before = contents(tmp_path)
    assert status("dataset", "build", str(tmp_path), "--output", str(tmp_path / "data"), *SMALL) == 0
    assert contents(tmp_path) == before


def test_scores_of_an_index_stand_instead_of_ours(videos: Path, tmp_path: Path) -> None:
    index = tmp_path / "index.csv"
    index.write_text("file,score\none.mp4,0.701\ntwo.mp4,0.7\n")
    options = ("--index", str(index), "--score-column", "score")
    assert status("dataset", "build", str(videos), "--output", str(tmp_path / "data"), *options, *SMALL) == 0
    assert {Path(each.source).name for each in kept_clips(tmp_path / "data")} == {"two.mp4"}
    assert status("dataset", "build", str(videos), "--output", str(tmp_path / "data"), *options[:2], *SMALL) == 2


def test_what_a_crash_left_is_taken_up_again(data: Path, videos: Path, tmp_path: Path) -> None:
    """The index ends within a line, and one video was begun only."""
    copy = tmp_path / "data"
    for name, content in contents(data).items():
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_bytes(content)
    lines = (copy / "sources.jsonl").read_bytes().splitlines(keepends=True)
    (copy / "sources.jsonl").write_bytes(b"".join(lines[:-1]))
    index_file(copy).write_bytes(index_file(copy).read_bytes()[:-40])
    assert status("dataset", "build", str(videos), "--output", str(copy), *SMALL) == 0
    assert {each.name: each.score for each in kept_clips(copy)} == {each.name: each.score for each in kept_clips(data)}


@pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")
def test_ctrl_c_over_several_processes_leaves_nothing_half_done_and_can_go_on(videos: Path, tmp_path: Path) -> None:
    package = tmp_path / "package"
    package.mkdir()
    (package / "physanimator").symlink_to(ROOT, target_is_directory=True)
    many = tmp_path / "many"
    many.mkdir()
    for number in range(6):
        write_video(many / f"{number}.mp4", panned(number, 40, 0.8))
    arguments = ["dataset", "build", str(many), "--output", str(tmp_path / "data"), "--size", "128x64"]
    command = [sys.executable, "-m", "physanimator", *arguments, "--workers", "2"]
    environment = os.environ | {"PYTHONPATH": str(package), "OMP_NUM_THREADS": "1"}
    with subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, env=environment, start_new_session=True
    ) as building_it:
        while not any((tmp_path / "data").glob("sketches/*.mp4")):
            assert building_it.poll() is None
        os.killpg(building_it.pid, signal.SIGINT)
        _, errors = building_it.communicate(timeout=120)
    assert building_it.returncode == 130, errors
    assert "Traceback" not in errors
    assert not [each for each in (tmp_path / "data").rglob(".*")]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=240)
    assert done.returncode == 0, done.stderr
    assert len(kept_clips(tmp_path / "data")) == 6


def test_show_draws_clips_and_counts(data: Path, tmp_path: Path, capsys: Output) -> None:
    assert status("dataset", "show", str(data), "--output", str(tmp_path / "sheet.png")) == 0
    assert "kept: 3 clips" in capsys.readouterr().out
    sheet = load_image(tmp_path / "sheet.png")
    first = kept_clips(data)[0]
    middle = list(read_clip(clip_file(data, next(iter(read_index(data))).name)))[first.frames // 2]
    tile = sheet[38 : 38 + 96, 8 : 8 + 192]
    assert abs(float(tile.mean()) - float(middle.mean())) < 5
    blue = (sheet == (40, 90, 200)).all(axis=2)
    assert blue.any()


def test_musubi_reads_the_export(data: Path, tmp_path: Path) -> None:
    """Keys and types of musubi-tuner's ConfigSanitizer for videos; a control video has the video's own name."""
    tomllib = pytest.importorskip("tomllib")
    (data / "captions").mkdir(exist_ok=True)
    name = kept_clips(data)[0].name
    (data / "captions" / f"{name}.txt").write_text("a girl\nturns", encoding="utf-8")
    assert status("dataset", "export", str(data), "--layout", "musubi", "-o", str(tmp_path / "out"), "-q") == 0
    told = tomllib.loads((tmp_path / "out" / "dataset.toml").read_text(encoding="utf-8"))
    general = {"caption_extension": str, "batch_size": int, "num_repeats": int, "resolution": list}
    general |= {"enable_bucket": bool, "bucket_no_upscale": bool}
    of_video = dict.fromkeys(("video_directory", "control_directory", "cache_directory", "frame_extraction"), str)
    of_video |= {"target_frames": list, "frame_stride": int, "frame_sample": int, "max_frames": int}
    assert set(told) == {"general", "datasets"}
    assert all(isinstance(value, general[key]) for key, value in told["general"].items())
    (dataset,) = told["datasets"]
    assert all(isinstance(value, (general | of_video)[key]) for key, value in dataset.items())
    assert told["general"]["resolution"] == [128, 64]
    assert all(each % 4 == 1 and each <= 24 for each in dataset["target_frames"])
    clips = {each.name for each in Path(dataset["video_directory"]).glob("*.mp4")}
    assert clips == {each.name for each in Path(dataset["control_directory"]).glob("*.mp4")}
    assert clips == {f"{each.name}.mp4" for each in kept_clips(data)}
    texts = {each.stem: each.read_text() for each in Path(dataset["video_directory"]).glob("*.txt")}
    assert texts.pop(name) == "a girl turns\n"
    assert set(texts.values()) == {"animation\n"}


@pytest.mark.parametrize("layout", ["diffsynth", "videox", "ltx"])
def test_other_trainers_read_the_export(data: Path, tmp_path: Path, layout: str) -> None:
    out = tmp_path / "out"
    assert (
        status("dataset", "export", str(data), "--layout", layout, "-o", str(out), "-q", "--caption", 'a "b", c') == 0
    )
    if layout == "diffsynth":
        with (out / "metadata.csv").open(encoding="utf-8", newline="") as opened:
            rows = list(csv.DictReader(opened))
        assert set(rows[0]) == {"video", "control_video", "reference_image", "prompt"}
        pairs = [(each["video"], each["control_video"], each["prompt"]) for each in rows]
        first = next(iter(read_clip(out / rows[0]["video"])))
        assert (load_image(out / rows[0]["reference_image"]) == first).all()
    elif layout == "videox":
        listed = json.loads((out / "metadata_control.json").read_text(encoding="utf-8"))
        assert all(set(each) == {"file_path", "control_file_path", "text", "type"} for each in listed)
        assert {each["type"] for each in listed} == {"video"}
        pairs = [(each["file_path"], each["control_file_path"], each["text"]) for each in listed]
    else:
        listed = json.loads((out / "dataset.json").read_text(encoding="utf-8"))
        assert all(set(each) == {"video", "reference_video", "caption"} for each in listed)
        pairs = [(each["video"], each["reference_video"], each["caption"]) for each in listed]
    assert len(pairs) == len(kept_clips(data))
    for video, control, text in pairs:
        name = Path(video).stem
        assert (out / video).read_bytes() == clip_file(data, name).read_bytes()
        assert (out / control).read_bytes() == sketch_file(data, name).read_bytes()
        assert text in ('a "b", c', "a girl turns")


def test_an_export_replaces_its_own_files_alone(data: Path, tmp_path: Path, capsys: Output) -> None:
    out = tmp_path / "out"
    arguments = ["dataset", "export", str(data), "-o", str(out), "-q", "--layout"]
    assert status(*arguments, "diffsynth") == 0
    (out / "videos" / "mine.mp4").write_bytes(b"mine")
    assert status(*arguments, "ltx") == 0
    assert not (out / "metadata.csv").exists()
    assert list((out / "reference").iterdir()) == []
    assert (out / "videos" / "mine.mp4").read_bytes() == b"mine"
    (out / "physanimator_export.json").write_text('{"files": ["../../thesis.txt"], "texts": {}}')
    assert status(*arguments, "ltx") == 2
    (out / "physanimator_export.json").unlink()
    assert status(*arguments, "ltx") == 2
    assert "new folder" in capsys.readouterr().err


@pytest.mark.parametrize(("layout", "name"), [("musubi", "dataset.toml"), ("diffsynth", "metadata.csv")])
def test_an_edited_export_is_kept(data: Path, tmp_path: Path, capsys: Output, layout: str, name: str) -> None:
    out = tmp_path / "out"
    arguments = ["dataset", "export", str(data), "-o", str(out), "-q", "--layout"]
    assert status(*arguments, layout) == 0
    assert status(*arguments, layout) == 0, "nothing has changed"
    edited = (out / name).read_bytes() + b"\n"
    (out / name).write_bytes(edited)
    for each in (layout, "ltx"):
        assert status(*arguments, each) == 2
        assert "has changed since" in capsys.readouterr().err
    assert (out / name).read_bytes() == edited
    (out / name).unlink()
    assert status(*arguments, layout) == 0


def test_colours_of_thin_lines_are_kept(tmp_path: Path) -> None:
    """4:2:0, which most videos are, gives 18 dB here, and this 33."""
    frame = np.full((64, 128, 3), (230, 220, 210), np.uint8)
    frame[:, ::6] = (200, 20, 40)
    frame[::8] = (20, 40, 190)
    write_clip([frame] * 3, tmp_path / "lines.mp4", 12)
    (back, *_) = read_clip(tmp_path / "lines.mp4")
    assert 10 * np.log10(255**2 / float(np.mean((back.astype(float) - frame) ** 2))) > 30
    write_animation([frame] * 3, tmp_path / "usual.mp4", 12)
    (usual, *_) = read_clip(tmp_path / "usual.mp4")
    assert 10 * np.log10(255**2 / float(np.mean((usual.astype(float) - frame) ** 2))) < 25


def test_the_network_draws_where_its_weights_are_given(videos: Path, tmp_path: Path, capsys: Output) -> None:
    lines = random_networks.write(tmp_path, "folder")["lines"]
    arguments = ["dataset", "build", str(videos / "two.mp4"), "--output", str(tmp_path / "data"), *SMALL]
    assert status(*arguments, "--lines", str(tmp_path / "none.pth")) == 2
    assert not (tmp_path / "data").exists()
    assert status(*arguments, "--lines", str(lines), "--device", "cpu") == 0
    (clip,) = kept_clips(tmp_path / "data")
    assert clip.sketches == f"network {lines.name}"
    assert status(*arguments) == 2
    assert "sketches must stay" in capsys.readouterr().err


@pytest.mark.parametrize(("kind", "tensor"), [("svd", "embeddings"), ("tooncrafter", "tokens")])
def test_encoding_by_the_command_is_done_once(
    videos: Path, tmp_path: Path, capsys: Output, kind: str, tensor: str
) -> None:
    files = random_networks.write(tmp_path, "folder")
    arguments = ["dataset", "build", str(videos / "two.mp4"), "--output", str(tmp_path / "data"), *SMALL]
    assert status(*arguments) == 0
    encode = ["dataset", "encode", str(tmp_path / "data"), f"--{kind}", str(files[kind]), "--device", "cpu"]
    assert status(*encode) == 0
    assert "1 clips encoded now" in capsys.readouterr().out
    (clip,) = kept_clips(tmp_path / "data")
    tensors = read_tensors(tmp_path / "data", kind, clip.name, ("latents", tensor))
    assert len(tensors["latents"]) == clip.frames
    assert all(bool(each.isfinite().all()) for each in tensors.values())
    check_encoded(tmp_path / "data", kind, clip.name)
    assert status(*encode) == 0
    assert "0 clips encoded now" in capsys.readouterr().out
    assert status(*encode, "--svd", str(files["svd"]), "--tooncrafter", str(files["tooncrafter"])) == 2


def test_an_index_that_is_none_names_its_option(videos: Path, tmp_path: Path, capsys: Output) -> None:
    index = tmp_path / "index.csv"
    for content, told in ((b"file,score\n", "--score-column must be"), (b"\xff\xfe", "--index must be")):
        index.write_bytes(content)
        made = ("dataset", "build", str(videos), "--dry-run", "--index", str(index), "--score-column", "speed")
        assert status(*made) == 2
        assert told in capsys.readouterr().err
