"""What the command line reads is never written over, by whatever option and under whatever name."""

from __future__ import annotations

import argparse
import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from command_status import status
from physanimator.rendering.command import EXAMPLE
from physanimator.rendering.command.commands import command_parser
from physanimator.rendering.command.files import INPUTS, OUTPUTS
from physanimator.rendering.command.shots import BESIDES
from physanimator.rendering.pictures import save_image

WIDTH, HEIGHT = 96, 72

Output = pytest.CaptureFixture[str]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with every kind of input under names that results could have, too."""
    monkeypatch.chdir(tmp_path)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    strip = (np.abs(x - 40) < 8) & (y > 8) & (y < 60)
    image = np.stack([80 + x, 200 - y, 160 + 0 * x], axis=-1).astype(np.uint8)
    for name in ("girl.webp", "plate.gif", "girl.png"):
        save_image(name, image)
    save_image("hair.apng", strip.astype(np.uint8) * 255)
    save_image("hair.png", strip.astype(np.uint8) * 255)
    save_image("wall.webp", (x > 90).astype(np.uint8) * 255)
    (tmp_path / "wind.json").write_text(json.dumps({"version": 1, "width": WIDTH, "height": HEIGHT}))
    (tmp_path / "points.json").write_text("[[40, 30, 1]]")
    (tmp_path / "sub").mkdir()
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def unworked(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fails the test if anything is read or simulated."""

    def never(*_: object, **__: object) -> None:
        pytest.fail("work had begun")

    monkeypatch.setattr("physanimator.rendering.pictures.load_image", never)
    monkeypatch.setattr("physanimator.rendering.pipeline.animate", never)


INPUT_FILES = {
    "IMAGE": ["girl.webp", "--mask", "hair.apng"],
    "--mask": ["girl.webp", "--mask", "hair.apng"],
    "--plate": ["girl.webp", "--mask", "hair.apng", "--plate", "plate.gif"],
    "--collider": ["girl.webp", "--mask", "hair.apng", "--collider", "wall.webp"],
    "--scene": ["girl.webp", "--mask", "hair.apng", "--scene", "wind.json"],
    "--points": ["girl.webp", "--points", "points.json"],
}
NAMES = {
    "IMAGE": "girl.webp",
    "--mask": "hair.apng",
    "--plate": "plate.gif",
    "--collider": "wall.webp",
    "--scene": "wind.json",
    "--points": "points.json",
}
CLIPS = ("--output", "--save-sketch", "--save-flow", "--preview")
TEXTS = ("--save-tracks", "--save-motion")


def with_output(option: str, path: str) -> list[str]:
    return ["--output", path] if option == "--output" else ["--output", "o.mp4", option, path]


@pytest.mark.usefixtures("unworked")
@pytest.mark.parametrize("source", NAMES)
def test_no_output_takes_the_place_of_an_input(folder: Path, capsys: Output, source: str) -> None:
    before = contents(folder)
    name = NAMES[source]
    for option in TEXTS if name.endswith(".json") else CLIPS:
        assert status("animate", *INPUT_FILES[source], *with_output(option, name)) == 2
        said = capsys.readouterr().err
        assert f"{option} must not be a file that is read" in said
        assert f"{name} ({source})" in said
    assert contents(folder) == before


def soft(source: Path, name: str) -> str:
    Path(name).symlink_to(source)
    return name


def hard(source: Path, name: str) -> str:
    os.link(source, name)
    return name


SPELLINGS: dict[str, Callable[[Path], str]] = {
    "dot": lambda file: f"./{file.name}",
    "up and down": lambda file: f"sub/../{file.name}",
    "slashes": lambda file: f".//{file.name}",
    "absolute": str,
    "symbolic link": lambda file: soft(file, "link.webp"),
    "link to a link": lambda file: soft(Path(soft(file, "first.webp")).absolute(), "second.webp"),
    "hard link": lambda file: hard(file, "twin.webp"),
    "folder link": lambda file: soft(file.parent, "same") + "/" + file.name,
}


@pytest.mark.usefixtures("unworked")
@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize("reading", [False, True], ids=["written so", "read so"])
def test_other_spellings_of_an_input_are_known(folder: Path, capsys: Output, spelling: str, reading: bool) -> None:
    name = SPELLINGS[spelling](folder / "girl.webp")
    before = contents(folder)
    image, output = (name, "girl.webp") if reading else ("girl.webp", name)
    assert status("animate", image, "--mask", "hair.apng", "--output", output) == 2
    assert "must not be a file that is read" in capsys.readouterr().err
    assert contents(folder) == before


@pytest.mark.usefixtures("unworked")
def test_folder_that_holds_an_input_frame(folder: Path, capsys: Output) -> None:
    (folder / "shots").mkdir()
    for number in range(3):
        shutil.copy("girl.png", f"shots/frame_{number:04d}.png")
    Path("start.png").symlink_to(folder / "shots" / "frame_0001.png")
    before = contents(folder)
    for image in ("shots/frame_0001.png", "start.png"):
        for option in CLIPS:
            assert status("animate", image, "--mask", "hair.png", *with_output(option, "shots/")) == 2
            assert f"{option} must not be a file that is read" in capsys.readouterr().err
    assert contents(folder) == before


def test_own_frame_is_not_replaced_while_it_is_read(folder: Path, capsys: Output) -> None:
    assert status("animate", "girl.png", "--mask", "hair.png", "--frames", "2", "-q", "--output", "out/") == 0
    before = contents(folder)
    arguments = ["animate", "out/frame_0001.png", "--mask", "hair.png", "--frames", "2", "-q", "--output", "out/"]
    assert status(*arguments) == 2
    assert "out/frame_0001.png (IMAGE)" in capsys.readouterr().err
    assert contents(folder) == before


@pytest.mark.usefixtures("unworked")
@pytest.mark.parametrize(
    "pair",
    [
        ("--output a.webm", "--preview a.webm"),
        ("--output a.webm", "--preview ./a.webm"),
        ("--output a.webm", "--preview sub/../a.webm"),
        ("--output a.webm", "--save-flow A.webm"),
        ("--output caf\u00e9.webm", "--save-flow cafe\u0301.webm"),
        ("--output new/", "--save-sketch new/"),
        ("--output sub/", "--save-sketch sub/./"),
        ("--output new.mp4/", "--preview new.mp4"),
        ("--output a.webm", "--preview twin.webm"),
        ("--output sub/", "--save-tracks sub/.physanimator.json"),
        ("--output o.mp4 --save-tracks a.json", "--save-motion a.json"),
    ],
)
def test_results_do_not_replace_one_another(folder: Path, capsys: Output, pair: tuple[str, str]) -> None:
    if "twin" in pair[1]:
        (folder / "a.webm").touch()
        hard(folder / "a.webm", "twin.webm")
    assert status("animate", "girl.png", "--mask", "hair.png", *" ".join(pair).split()) == 2
    assert "every output must have its own name" in capsys.readouterr().err


@pytest.mark.usefixtures("unworked")
def test_bundled_example_is_kept(capsys: Output) -> None:
    before = contents(EXAMPLE)
    for arguments in (
        ["demo", "--save-tracks", str(EXAMPLE / "scene.json")],
        ["figure", "strokes", "--output", str(EXAMPLE / "illustration.png")],
        ["figure", "stiffness", "--output", str(EXAMPLE / "clean_plate.png")],
    ):
        assert status(*arguments) == 2
        assert "the bundled example" in capsys.readouterr().err
    assert contents(EXAMPLE) == before


def test_every_option_that_names_a_file_is_known() -> None:
    """Whoever adds an option that reads or writes a file adds it to the lists that keep files apart."""
    commands = next(
        action.choices for action in command_parser()._actions if isinstance(action, argparse._SubParsersAction)
    ).values()
    actions = [action for command in commands for action in command._actions]
    written = {each.dest for each in actions if str(each.metavar).startswith("OUT")}
    read = {each.dest for each in actions if each.metavar in ("IMAGE", "MASK", "FILE", "CLIP", "FOLDER")}
    assert written == {*OUTPUTS, *BESIDES}
    assert read == set(INPUTS)
