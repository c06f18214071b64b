"""Motion vectors from the command line: written, refused before the work, and never over what others wrote."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from command_status import status
from physanimator.rendering.pictures import save_image

GIVEN = ("animate", "girl.png", "--mask", "hair.png", "--frames", "5", "-o", "clip.gif", "-q")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a picture and a mask."""
    monkeypatch.chdir(tmp_path)
    y, x = np.mgrid[0:48, 0:64]
    save_image("girl.png", np.stack([80 + x, 200 - y, 160 + 0 * x], axis=-1).astype(np.uint8))
    save_image("hair.png", ((np.abs(x - 30) < 6) & (y > 4) & (y < 40)).astype(np.uint8) * 255)
    return tmp_path


def test_vectors_are_of_the_frames_that_are_written() -> None:
    openexr = pytest.importorskip("OpenEXR")
    assert status(*GIVEN, "--skip", "2", "--save-vectors", "out", "--vector-channels", "blender") == 0
    assert sorted(path.name for path in Path("out").glob("*.exr")) == [
        f"vectors_000{number}.exr" for number in range(3)
    ]
    with openexr.File("out/vectors_0001.exr", separate_channels=True) as file:
        vectors = {name: channel.pixels for name, channel in file.channels().items()}
    assert set(vectors) == {f"ViewLayer.Vector.{name}" for name in "XYZW"}
    assert np.abs(vectors["ViewLayer.Vector.X"]).max() > 0.01
    assert vectors["ViewLayer.Vector.X"].shape == (48, 64)
    assert status(*GIVEN, "--save-vectors", "out") == 0, "its own files are replaced"
    Path("out/vectors_0000.exr").write_bytes(b"changed")
    assert status(*GIVEN, "--save-vectors", "out") == 2


def test_what_cannot_be_is_said_before_the_work(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("physanimator.rendering.pipeline.simulate", lambda *_, **__: pytest.fail("work had begun"))
    assert status(*GIVEN, "--vector-channels", "nuke") == 2
    assert "--vector-channels must be left out without --save-vectors" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    assert status(*GIVEN, "--save-vectors", "out") == 2
    assert "pip install OpenEXR" in capsys.readouterr().err
    assert not Path("out").exists()


@pytest.mark.parametrize("place", ["girl.png", "clip.gif"])
def test_the_folder_is_no_other_file(place: str, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("OpenEXR")
    assert status(*GIVEN, "--save-vectors", place) == 2
    assert "--save-vectors" in capsys.readouterr().err
