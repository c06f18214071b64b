"""``physanimator layers``: what it lists and writes, and what it refuses before the work."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
from physanimator.rendering.artwork import ArtLayer, Artwork, load_artwork, save_psd
from physanimator.rendering.command import main


@pytest.fixture
def psd(tmp_path: Path) -> Path:
    pixels = np.full((6, 8, 4), 200, np.uint8)
    layers = (
        ArtLayer("顔", pixels, left=2),
        ArtLayer("前髪", pixels, left=-3, top=1, opacity=0.6),
        ArtLayer("thing", pixels, visible=False),
    )
    save_psd(Artwork(20, 16, layers), tmp_path / "girl.psd")
    return tmp_path / "girl.psd"


def test_layers_are_listed_from_front_to_back(psd: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["layers", str(psd)]) == 0
    head, columns, *rows = capsys.readouterr().out.splitlines()
    assert head == "20 x 16 px, 8 bits, 3 layers from front to back, 1 of them would move"
    assert columns.split() == ["layer", "size", "at", "drawn", "moves", "preset", "why"]
    assert [row.split()[:2] for row in rows] == [["3", "thing"], ["2", "前髪"], ["1", "顔"]]
    assert "8 x 6" in rows[1]
    assert "-3, 1" in rows[1]
    assert "normal 60%" in rows[1]
    assert "hair, held at its top" in rows[1]
    assert rows[1].endswith("the name says front hair")
    assert rows[0].endswith("hidden")


def test_the_users_word(psd: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["layers", str(psd), "--move", "thing=jelly", "--still", "前髪", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)["layers_from_back_to_front"]
    assert [(each["name"], each["moves"], each["preset"]) for each in listed] == [
        ("顔", False, None),
        ("前髪", False, None),
        ("thing", True, "jelly"),
    ]


def test_layers_are_written(psd: Path, tmp_path: Path) -> None:
    assert main(["layers", str(psd), "--save-psd", str(tmp_path / "o.psb"), "--save-png", str(tmp_path / "pngs")]) == 0
    assert load_artwork(tmp_path / "o.psb").names == ("顔", "前髪", "thing")
    assert load_artwork(tmp_path / "pngs").names == ("顔", "前髪", "thing")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["girl.psd", "--save-psd", "girl.psd"], "--save-psd must not be a file that is read"),
        (["girl.psd", "--save-psd", "girl.png"], "--save-psd must be that of a .psd or .psb file"),
        (["girl.psd", "--save-psd", "none/o.psd"], "--save-psd: the folder for none/o.psd must exist"),
        (["girl.psd", "--save-png", "girl.psd"], "--save-png must not be a file that is read"),
        (["girl.psd", "--save-png", "pictures"], "--save-png pictures must hold no PNG files yet. Got: mine.png"),
        (["pictures", "--save-png", "pictures/"], "--save-png pictures/ must hold no PNG files yet"),
        (["girl.psd", "--move", "hat"], "there must be a layer hat"),
        (["girl.jpg"], "artwork must be a .psd, .psb, .ora file"),
        (["none.psd"], "artwork must be an existing file"),
        (["empty"], "must hold PNG files"),
        (["--move", "hat", "girl.psd"], "FILE must be given"),
    ],
)
def test_what_is_refused(
    psd: Path,
    options: list[str],
    said: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(psd.parent)
    Path("pictures").mkdir()
    Path("empty").mkdir()
    Path("pictures/mine.png").write_bytes(b"mine")
    before = {path: path.read_bytes() for path in psd.parent.rglob("*") if path.is_file()}
    with pytest.raises(SystemExit) if "FILE" in said else nullcontext():
        assert main(["layers", *options]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert {path: path.read_bytes() for path in psd.parent.rglob("*") if path.is_file()} == before
