"""Folders of PNG files, with and without a list of layers."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from openraster_files import png
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.artwork import flattened, is_artwork_file, load_artwork


def drawn(left: int, colour: int = 255) -> np.ndarray:
    pixels = np.zeros((10, 20, 4), np.uint8)
    pixels[2:6, left : left + 4] = (colour, 0, 0, 255)
    return pixels


def test_names_give_the_order_numbers_by_their_value(tmp_path: Path) -> None:
    for name in ("10 hair", "9 face", "2 sky"):
        (tmp_path / f"{name}.png").write_bytes(png(drawn(3)))
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    (tmp_path / "._10 hair.png").write_bytes(b"what macOS leaves")
    artwork = load_artwork(tmp_path)
    assert artwork.names == ("sky", "face", "hair")
    assert artwork.layers[0].box == (3, 2, 7, 6)
    assert np.array_equal(flattened(artwork), drawn(3))


def test_pictures_of_two_sizes(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(png(drawn(3)))
    (tmp_path / "b.png").write_bytes(png(drawn(3)[1:]))
    with pytest.raises(InvalidInputError, match=r"b.png must be as large as a.png, 20 x 10 px. Got: 20 x 9 px"):
        load_artwork(tmp_path)


def listed(folder: Path, *entries: Any, **more: Any) -> Path:
    path = folder / "girl_layers.json"
    path.write_text(json.dumps({"width": 20, "height": 10, "layers": list(entries), **more}), encoding="utf-8")
    return path


def test_a_list_of_see_through(tmp_path: Path) -> None:
    (tmp_path / "girl_hair.png").write_bytes(png(drawn(3)[2:6, 3:7]))
    (tmp_path / "girl_face.png").write_bytes(png(drawn(3, 9)[2:6, 3:7]))
    (tmp_path / "unrelated.png").write_bytes(png(drawn(3)[1:]))
    where = {"left": 5, "top": 1, "right": 9, "bottom": 5}
    path = listed(
        tmp_path,
        {"name": "front hair", "filename": "girl_hair.png", "depth_median": 0.1, **where},
        {"name": "face", "filename": "girl_face.png", "depth_median": 0.3, **where},
    )
    for given in (tmp_path, path):
        artwork = load_artwork(given)
        assert (artwork.width, artwork.height, artwork.names) == (20, 10, ("face", "front hair"))
        assert artwork.layers[1].box == (5, 1, 9, 5)
        assert artwork.layers[1].depth == 0.1
        assert flattened(artwork)[2, 6].tolist() == [255, 0, 0, 255]
    assert is_artwork_file(path)


@pytest.mark.parametrize(
    "name", ["../secret.png", "/etc/passwd", "a\\..\\b.png", "C:secret.png", "..", "", "a\0b.png", "sub/a.png"]
)
def test_a_list_names_only_files_beside_it(tmp_path: Path, name: str) -> None:
    (tmp_path / "inner").mkdir()
    (tmp_path / "secret.png").write_bytes(png(drawn(3)))
    with pytest.raises(InvalidInputError, match="filename must be that of a file beside the list"):
        load_artwork(listed(tmp_path / "inner", {"name": "a", "filename": name}))


@pytest.mark.parametrize(
    ("entry", "more", "said"),
    [
        ({"filename": "none.png"}, {}, "existing file"),
        ({"filename": 3}, {}, "must name its file"),
        ("a.png", {}, "must name its file"),
        ({"filename": "a.png", "left": 1e300}, {}, "left must be a number"),
        ({"filename": "a.png", "left": float("nan")}, {}, "left must be a number"),
        ({"filename": "a.png", "depth_median": "far"}, {}, "depth_median must be a number"),
        ({"filename": "a.png"}, {"width": 10**9}, "width must be a number"),
        ({"filename": "a.png"}, {"width": 20_000, "height": 20_000}, "must have from 1 to"),
        ({"filename": "a.png"}, {"width": None}, "width must be a number"),
        ({"filename": "a.png"}, {"layers": 3}, "must be a list of layers"),
        ({"filename": "girl_layers.json"}, {}, "must be a PNG file"),
    ],
)
def test_hostile_lists(tmp_path: Path, entry: Any, more: dict[str, Any], said: str) -> None:
    (tmp_path / "a.png").write_bytes(png(drawn(3)))
    with pytest.raises(InvalidInputError, match=said):
        load_artwork(listed(tmp_path, entry, **more))


@pytest.mark.parametrize("text", ["", "[", "[" * 100_000, '"text"', "{}", "\xff", '{"layers": [' + "9" * 5000 + "]}"])
def test_lists_that_are_none(tmp_path: Path, text: str) -> None:
    (tmp_path / "layers.json").write_text(text, encoding="latin-1")
    with pytest.raises(InvalidInputError):
        load_artwork(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_pipes_and_links(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.png")
    with pytest.raises(InvalidInputError, match="a named pipe"):
        load_artwork(tmp_path)
    (tmp_path / "a.png").unlink()
    (tmp_path / "a.png").symlink_to("/dev/zero")
    with pytest.raises(InvalidInputError, match="a device"):
        load_artwork(tmp_path)
    (tmp_path / "a.png").unlink()
    (tmp_path / "a.png").symlink_to(tmp_path / "a.png")
    with pytest.raises(InvalidInputError):
        load_artwork(tmp_path)


def test_what_is_a_layered_file_by_its_name(tmp_path: Path) -> None:
    wanted = {"a.psd": True, "a.PSB": True, "a.ora": True, "x_layers.json": True, "a.png": False, "scene.json": False}
    assert {name: is_artwork_file(name) for name in wanted} == wanted
    assert is_artwork_file(tmp_path)
    with pytest.raises(InvalidInputError, match=r"artwork must be a .psd, .psb, .ora file"):
        load_artwork("a.png")
