"""Skeletons and scenes from the command line: what is refused before the work, and what is never written over."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from command_status import status
from physanimator.rendering.artwork import ArtLayer, Artwork, save_layer_pngs
from physanimator.rendering.pictures import save_image

Output = pytest.CaptureFixture[str]
GIVEN = ("animate", "girl.png", "--mask", "hair.png", "--frames", "3", "-o", "clip.gif")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a picture and a mask, and the same as a folder of layers."""
    monkeypatch.chdir(tmp_path)
    y, x = np.mgrid[0:48, 0:64]
    strip = ((np.abs(x - 30) < 6) & (y > 4) & (y < 40)).astype(np.uint8) * 255
    picture = np.stack([80 + x, 200 - y, 160 + 0 * x], axis=-1).astype(np.uint8)
    save_image("girl.png", picture)
    save_image("hair.png", strip)
    layers = [ArtLayer("wall", np.dstack([picture, np.full((48, 64), 255, np.uint8)]))]
    layers.append(ArtLayer("hair", np.dstack([picture // 2, strip])))
    save_layer_pngs(Artwork(64, 48, tuple(layers)), "art")
    return tmp_path


@pytest.fixture
def unsimulated(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        pytest.fail("work had begun")

    monkeypatch.setattr("physanimator.rendering.pipeline.simulate", refuse)


def files(folder: str) -> list[str]:
    return sorted(path.relative_to(folder).as_posix() for path in Path(folder).rglob("*") if path.is_file())


SKELETON = [".physanimator-spine.json", "images/background.png", "images/part 1.png", "puppet.atlas", "puppet.json",
            "puppet.png"]  # fmt: skip


def test_both_are_written_and_replaced_and_other_files_stay(capsys: Output) -> None:
    assert status(*GIVEN, "--save-spine", "puppet", "--save-gltf", "puppet.glb") == 0
    said = capsys.readouterr().out
    assert "puppet: 2 slots" in said
    assert "puppet.glb: 2 meshes" in said
    assert files("puppet") == SKELETON
    Path("puppet/girl.spine").write_text("mine")
    Path("puppet/images/notes.txt").write_text("mine")
    Path("puppet/moved.json").write_text("{}")
    before = Path("puppet/puppet.json").read_bytes()
    stormy = (*GIVEN[:5], "12", "-o", "clip.gif", "--wind", "3", "-q")
    assert status(*stormy, "--save-spine", "puppet/", "--tolerance", "0.1") == 0
    assert Path("puppet/puppet.json").read_bytes() != before
    assert files("puppet") == sorted([*SKELETON, "girl.spine", "images/notes.txt", "moved.json"])


@pytest.mark.usefixtures("unsimulated")
@pytest.mark.parametrize("name", ["puppet.json", "puppet.atlas", "puppet.png", "puppet_3.png", "images/hat.png"])
def test_a_skeleton_of_others_is_never_replaced(name: str, capsys: Output) -> None:
    Path("puppet/images").mkdir(parents=True)
    Path("puppet", name).write_text("mine")
    assert status(*GIVEN, "--save-spine", "puppet") == 2
    said = capsys.readouterr().err
    assert f"{name}, which PhysAnimator did not write" in said
    assert said.startswith("physanimator: --save-spine")
    assert files("puppet") == [name]


def test_an_image_that_was_painted_on_is_kept(capsys: Output) -> None:
    assert status(*GIVEN, "--save-spine", "puppet", "-q") == 0
    save_image("puppet/images/part 1.png", np.zeros((4, 4, 3), np.uint8))
    before = {name: Path("puppet", name).read_bytes() for name in files("puppet")}
    assert status(*GIVEN, "--save-spine", "puppet", "-q") == 2
    assert "images/part 1.png, which was changed after it was written" in capsys.readouterr().err
    assert {name: Path("puppet", name).read_bytes() for name in files("puppet")} == before


@pytest.mark.usefixtures("unsimulated")
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("--save-gltf puppet.gltf", "--save-gltf must end in .glb"),
        ("--save-gltf missing/puppet.glb", "--save-gltf: the folder for missing/puppet.glb must exist"),
        ("--save-spine girl.png", "--save-spine must not be a file that is read"),
        ("--save-spine clip.gif", "every output must have its own name"),
        ("--save-spine puppet --save-motion puppet/puppet.json", "--save-motion must not be named as the skeleton's"),
        ("--save-spine puppet --save-sketch puppet/images/", "--save-sketch must not be named as the skeleton's"),
        ("--save-spine puppet --tolerance 0", "--tolerance must be 0.01 to 10 px. Got: 0"),
        ("--save-spine puppet --tolerance nan", "--tolerance must be 0.01 to 10 px. Got: nan"),
        ("--tolerance 1", "--tolerance must be left out without --save-spine or --save-gltf"),
        ("--save-spine puppet --pixel-art", "--save-spine must be left out with --pixel-art"),
        ("--save-gltf puppet.glb --pixel-art", "--save-gltf must be left out with --pixel-art"),
    ],
)
def test_what_cannot_be_is_said_before_the_work(arguments: str, said: str, capsys: Output) -> None:
    assert status(*GIVEN, *arguments.split()) == 2
    printed = capsys.readouterr().err
    assert said in printed
    assert printed.count("\n") == 1
    assert not Path("puppet").exists()


@pytest.mark.usefixtures("unsimulated")
def test_a_skeleton_is_not_written_among_the_layers_that_are_read(capsys: Output) -> None:
    before = files("art")
    assert status("animate", "art", "-o", "clip.gif", "--save-spine", "art", "-q") == 2
    assert "--save-spine must not be a file that is read" in capsys.readouterr().err
    assert files("art") == before


def test_other_results_may_be_written_into_the_new_folder() -> None:
    assert status(*GIVEN, "--save-spine", "puppet", "--save-motion", "puppet/motion.json", "--save-sketch",
                  "puppet/lines/", "-q") == 0  # fmt: skip
    assert {"motion.json", "lines/frame_0002.png", *SKELETON} <= set(files("puppet"))
    assert status(*GIVEN[:-1], "all/", "--save-spine", "all/puppet", "-q") == 0
    assert {"frame_0002.png", "puppet/puppet.json"} <= set(files("all"))
