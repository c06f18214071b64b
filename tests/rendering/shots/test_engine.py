"""The engine beside its clusters: what workers are refused for, how files travel, what a list's lines are."""

from __future__ import annotations

import json
import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from physanimator import __version__
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.threads import THREADS
from physanimator.rendering.shots import (
    Animated,
    Job,
    Shot,
    Word,
    check_workers,
    cluster,
    command_lines,
    longest_first,
    openjd_template,
)
from physanimator.rendering.shots.shipping import packed, perform_elsewhere, unpacked
from physanimator.rendering.shots.table_lines import table_lines
from physanimator.rendering.shots.waiting_shots import WaitingShots
from PIL import Image


def job(tmp_path: Path, *, on_gpu: bool = False) -> Job:
    """A shot that joins the files of a folder into one, and copies a picture into a folder of frames."""
    words = (
        Word("", str(tmp_path / "layers"), "input", "image"),
        Word("--mask", str(tmp_path / "hair.png"), "input", "mask"),
        Word("--collider", "a layer's name", "input", "collider"),
        Word("--svd", "/models/svd", "model", "svd"),
        Word("--output", f"{tmp_path / 'frames'}/", "output", "output"),
        Word("--save-scene", str(tmp_path / "scene.json"), "output", "save_scene"),
    )
    shot = Shot("a", words, {"wind": 2}, str(tmp_path / "a.shot.json"), on_gpu=on_gpu)
    return Job(shot, "identity", joined, all_in, str(tmp_path / "notes"))


def all_in(path: str) -> list[str]:
    place = Path(path)
    return sorted(map(str, place.iterdir())) if place.is_dir() else [path]


def joined(words: Any) -> Animated:
    image, mask, collider, svd, output, scene = words
    assert collider == "--collider=a layer's name"
    assert svd == "--svd=/models/svd"
    text = "".join(each.read_text() for each in sorted(Path(image).rglob("*.png")))
    Path(scene.partition("=")[2]).write_text(text)
    folder = Path(output.partition("=")[2])
    assert output.endswith("/")
    folder.mkdir()
    (folder / "frame_0000.png").write_text(Path(mask.partition("=")[2]).read_text())
    return Animated(0, (f"wrote {folder}",))


def test_files_travel_there_and_back(tmp_path: Path) -> None:
    """Folders with what is in them; results replace those of an earlier run, of which none stay."""
    (tmp_path / "layers" / "deep").mkdir(parents=True)
    (tmp_path / "layers" / "1.png").write_text("sky,")
    (tmp_path / "layers" / "deep" / "2.png").write_text("hair")
    (tmp_path / "hair.png").write_text("mask")
    (tmp_path / "frames").mkdir()
    (tmp_path / "frames" / "frame_0001.png").write_text("of an earlier run")
    (tmp_path / "there").mkdir()
    work = job(tmp_path)
    parcel = packed(work)
    returned = perform_elsewhere(work, parcel, lambda: True, folder=str(tmp_path / "there"))
    assert os.listdir(tmp_path / "there") == []
    outcome = unpacked(work, returned)
    assert outcome.state == "done"
    assert outcome.said == (f"wrote {tmp_path / 'frames'}",)
    assert (tmp_path / "scene.json").read_text() == "sky,hair"
    assert [path.name for path in (tmp_path / "frames").iterdir()] == ["frame_0000.png"]
    assert (tmp_path / "frames" / "frame_0000.png").read_text() == "mask"
    assert (tmp_path / "a.shot.json").exists()


class Cluster:
    """A client of one worker."""

    def __init__(self, answer: Any, **resources: int) -> None:
        self.answer, self.workers = answer, {"tcp://w:1": {"resources": resources}}

    def scheduler_info(self, **_: Any) -> Any:
        return {"workers": self.workers}

    def run(self, *_: Any, **__: Any) -> Any:
        return {"tcp://w:1": self.answer}


@pytest.mark.parametrize(
    ("cluster", "ship", "on_gpu", "told"),
    [
        (Cluster((__version__, True)), False, False, ""),
        (Cluster((__version__, False)), True, False, ""),
        (Cluster((__version__, False)), False, False, "or --ship be given"),
        (Cluster(("0.0.1", True)), False, False, f"must have PhysAnimator {__version__}. Got: 0.0.1 at tcp://w:1"),
        (Cluster(ModuleNotFoundError("No module named 'physanimator'")), True, False, "Got: none: No module named"),
        (Cluster((__version__, True)), False, True, "need a worker with a graphics card"),
        (Cluster((__version__, True), GPU=1), False, True, ""),
    ],
)
def test_workers_that_could_not_do_it_are_refused(
    tmp_path: Path, cluster: Any, ship: bool, on_gpu: bool, told: str
) -> None:
    jobs = [job(tmp_path, on_gpu=on_gpu)]
    if not told:
        check_workers(cluster, jobs, ship=ship)
        return
    with pytest.raises(InvalidInputError) as refused:
        check_workers(cluster, jobs, ship=ship)
    assert told in str(refused.value)


def test_the_longest_shots_are_begun_first(tmp_path: Path) -> None:
    """By frames, pixels and how many of them move; what is no picture is no reason to fail."""
    for name, size in (("small", (8, 8)), ("large", (80, 80))):
        Image.new("L", size).save(tmp_path / f"{name}.png")
    (tmp_path / "odd.png").write_text("x")

    def of(name: str, picture: str, frames: int, moving: int = 0) -> Job:
        word = Word("", str(tmp_path / picture), "input", "image")
        shot = Shot(name, (word,), {}, "", frames=frames, moving=moving)
        return Job(shot, "", joined, all_in, "")

    given = [of("a", "small.png", 10), of("b", "large.png", 10), of("c", "small.png", 10), of("d", "small.png", 20)]
    given += [of("e", "odd.png", 10), of("f", "none.png", 10), of("g", "", 0)]
    given += [of("h", "small.png", 1, moving=1000)]
    assert "".join(each.shot.name for each in longest_first(given)) == "hdacbefg"  # those of one picture in a row


def test_a_worker_goes_on_with_the_picture_that_it_knows() -> None:
    def of(name: str, picture: str) -> Job:
        shot = Shot(name, (Word("", picture, "input", "image"), Word("--scene", name, "input", "scene")), {}, "")
        return Job(shot, "", joined, all_in, "")

    waiting = WaitingShots([of("a", "x"), of("b", "y"), of("c", "x"), of("d", "x"), of("e", "y"), of("f", "z")])
    told = "".join(waiting.next_for(worker).shot.name for worker in ("one", "two", "two", "two", "one", "three"))
    assert told == "abefcd"  # the last one where most is left, though another worker knows it
    assert not waiting


def test_keys_have_lines() -> None:
    text = 'a = 1\n[defaults] # of all\nimage = "x"\n\n [[ shot ]]\n"wind-angle" = 3\n[["shot"]]\nwind_angle = 4\n'
    lines = table_lines(text)
    assert lines["defaults"][0].keys == {"image": 3}
    assert [(each.line, each.keys) for each in lines["shot"]] == [(5, {"wind-angle": 6}), (7, {"wind_angle": 8})]


def test_farms_get_what_they_can_take() -> None:
    shots = [SimpleNamespace(name=f"s{n}", on_gpu=n == 0) for n in range(1025)]
    job = json.loads(openjd_template(shots, listed="/a/l.toml", out="/a/out", template="/a/job.yaml"))  # type: ignore[arg-type]
    ranges = [step["parameterSpace"]["taskParameterDefinitions"][0]["range"] for step in job["steps"]]
    assert [len(each) for each in ranges] == [1024, 1]  # the most values of a parameter
    assert job["steps"][0]["hostRequirements"]["amounts"] == [{"name": "amount.worker.gpu", "min": 1}]
    assert "hostRequirements" not in job["steps"][1]
    assert [each.get("default") for each in job["parameterDefinitions"][:3]] == ["l.toml", ".", "out"]
    elsewhere = json.loads(openjd_template(shots, listed="/a/l.toml", out="/b", template="/a/job.yaml"))  # type: ignore[arg-type]
    assert "default" not in elsewhere["parameterDefinitions"][2]
    with pytest.raises(InvalidInputError, match=r"without \{\{"):
        openjd_template([SimpleNamespace(name="{{x", on_gpu=False)], listed="l.toml", out="o", template="j.yaml")  # type: ignore[list-item]
    line = command_lines(shots[:1], listed="l.toml", out="it's", program="nice physanimator")  # type: ignore[arg-type]
    assert line.startswith("nice physanimator shots ")
    assert line.count("\n") == 1


def test_cores_are_shared_out_where_shots_are_fewer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(THREADS, raising=False)
    monkeypatch.setattr(cluster, "_cores", lambda: 8)
    monkeypatch.setattr("distributed.system.MEMORY_LIMIT", 64 << 30)
    assert cluster.usual_workers() == 8
    assert [cluster.threads_each(each) for each in (1, 2, 3, 8, 20)] == [8, 4, 2, 1, 1]
    monkeypatch.setattr("distributed.system.MEMORY_LIMIT", 4 << 30)
    assert cluster.usual_workers() == 3
    monkeypatch.setattr("distributed.system.MEMORY_LIMIT", 64 << 30)
    monkeypatch.setenv(THREADS, "4")
    assert cluster.usual_workers() == 2
    assert cluster.threads_each(1) == cluster.threads_each(8) == 4
