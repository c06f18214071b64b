"""OpenRaster files in Krita's layout: places, order, stacks, and what hostile ones are told."""

from __future__ import annotations

import zipfile
import zlib
from pathlib import Path

import cv2
import numpy as np
import pytest
from openraster_files import png, write
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.artwork import flattened, load_artwork
from PIL import Image

RED, BLUE = (np.full((6, 8, 4), colour, np.uint8) for colour in ((255, 0, 0, 255), (0, 0, 255, 255)))


def image(inner: str, size: str = 'w="20" h="10"') -> str:
    return f"<?xml version='1.0' encoding='UTF-8'?><image {size}><stack>{inner}</stack></image>"


def test_the_top_layer_comes_first_in_the_file(tmp_path: Path) -> None:
    inner = '<layer src="data/a.png" name="前髪" x="2" y="1"/><layer src="data/b.png" name="顔" x="-3" y="5"/>'
    artwork = load_artwork(write(tmp_path / "art.ora", image(inner), a=png(RED), b=png(BLUE)))
    assert [(layer.name, layer.box) for layer in artwork.layers] == [("顔", (-3, 5, 5, 11)), ("前髪", (2, 1, 10, 7))]
    picture = flattened(artwork)
    assert picture[6, 3].tolist() == [255, 0, 0, 255]
    assert picture[8, 1].tolist() == [0, 0, 255, 255]


def test_a_stack_hands_its_place_opacity_and_visibility_down(tmp_path: Path) -> None:
    inner = (
        '<stack x="3" y="2" opacity="0.5" name="g"><layer src="data/a.png" x="1" name="in"/></stack>'
        '<stack visibility="hidden"><layer src="data/b.png" name="out"/></stack>'
    )
    hidden, shown = load_artwork(write(tmp_path / "art.ora", image(inner), a=png(RED), b=png(BLUE))).layers
    assert (hidden.name, hidden.visible) == ("out", False)
    assert (shown.box, shown.opacity, shown.visible) == ((4, 2, 12, 8), 0.5, True)


def test_modes_and_what_has_no_pixels(tmp_path: Path) -> None:
    inner = (
        '<filter name="blur"/><layer src="data/a.png" name="a" composite-op="svg:color-dodge"/>'
        '<layer src="data/a.png" name="b" composite-op="svg:multiply"/>'
    )
    artwork = load_artwork(write(tmp_path / "art.ora", image(inner), a=png(RED)))
    assert [layer.blend for layer in artwork.layers] == ["multiply", "normal"]
    assert set(artwork.warnings) == {
        "layer a: blend mode color-dodge is drawn as normal",
        "layer blur (filter) is left out: it has no pixels",
    }


def test_16_bits_are_kept_and_shared(tmp_path: Path) -> None:
    deep = np.random.default_rng(3).integers(1, 65536, (6, 8, 4), dtype=np.uint16)
    data = cv2.imencode(".png", deep[..., [2, 1, 0, 3]])[1].tobytes()
    inner = '<layer src="data/a.png" name="a"/><layer src="data/b.png" name="b"/>'
    artwork = load_artwork(write(tmp_path / "art.ora", image(inner), a=data, b=png(BLUE)))
    assert np.array_equal(artwork.layers[1].pixels, deep)
    assert artwork.layers[0].pixels[0, 0].tolist() == [0, 0, 65535, 65535]


@pytest.mark.parametrize("mode", ["L", "LA", "P", "RGB", "1"])
def test_pictures_of_every_kind(tmp_path: Path, mode: str) -> None:
    picture = Image.fromarray(RED).convert(mode)
    file = tmp_path / "a.png"
    picture.save(file)
    artwork = load_artwork(write(tmp_path / "art.ora", image('<layer src="data/a.png"/>'), a=file.read_bytes()))
    assert np.array_equal(artwork.layers[0].pixels, np.asarray(picture.convert("RGBA")))


@pytest.mark.parametrize(
    ("xml", "said"),
    [
        (image("", 'w="1000000000" h="1000000000"'), "must have from 1 to 67 million pixels"),
        (image("", 'w="0" h="9"'), "must have from 1 to"),
        (image("", 'w="nan" h="9"'), "w in stack.xml must be a number"),
        (image("", ""), "w in stack.xml must be a number"),
        (image('<layer src="../../etc/passwd"/>'), "must name a picture in the file"),
        (image('<layer src="/etc/passwd"/>'), "must name a picture in the file"),
        (image("<layer/>"), "must name a picture in the file"),
        (image('<layer src="mimetype"/>'), "must be a PNG file"),
        (image('<layer src="data/a.png" x="1e300"/>'), "x of a layer must be at most"),
        (image('<layer src="data/a.png" opacity="much"/>'), "opacity in stack.xml must be a number"),
        (image("<stack>" * 5000 + "</stack>" * 5000), "stacks in stacks"),
        (image('<layer src="data/a.png"/>' * 5000), "at most 64 stacks in stacks and 1000 layers"),
        ("<svg/>", "must describe an image"),
        ("", "damaged"),
        ("<image", "damaged"),
        (
            '<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;">]><image w="4" h="4"><stack name="&b;"/></image>',
            "must have no document type",
        ),
        ('<!DOCTYPE x SYSTEM "file:///etc/passwd"><image w="4" h="4"/>', "must have no document type"),
    ],
)
def test_hostile_lists_get_one_sentence(tmp_path: Path, xml: str, said: str) -> None:
    with pytest.raises(InvalidInputError, match=said):
        load_artwork(write(tmp_path / "art.ora", xml, a=png(RED)))


def test_an_entity_in_another_encoding_is_seen(tmp_path: Path) -> None:
    text = '<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE x [<!ENTITY a "b">]><image w="4" h="4"/>'.encode("utf-16")
    with zipfile.ZipFile(tmp_path / "art.ora", "w") as archive:
        archive.writestr("stack.xml", text)
    with pytest.raises(InvalidInputError, match="must have no document type"):
        load_artwork(tmp_path / "art.ora")


@pytest.mark.parametrize("name", ["stack.xml", "data/a.png"])
def test_a_zip_bomb_is_not_unpacked(tmp_path: Path, name: str) -> None:
    with zipfile.ZipFile(tmp_path / "art.ora", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("stack.xml", image('<layer src="data/a.png" name="hair"/>')) if name != "stack.xml" else None
        with archive.open(name, "w", force_zip64=True) as file:
            for _ in range(300):
                file.write(bytes(2**20))
    with pytest.raises(InvalidInputError, match=r"must have at most (4|256) MiB"):
        load_artwork(tmp_path / "art.ora")


def test_a_picture_of_too_many_pixels_is_not_decoded(tmp_path: Path) -> None:
    head = b"IHDR" + (10**9).to_bytes(4, "big") * 2 + bytes([8, 6, 0, 0, 0])
    data = b"\x89PNG\r\n\x1a\n" + (13).to_bytes(4, "big") + head + zlib.crc32(head).to_bytes(4, "big")
    with pytest.raises(InvalidInputError, match=r"layer hair must have .*Got: 1000000000 x 1000000000 px"):
        load_artwork(write(tmp_path / "art.ora", image('<layer src="data/a.png" name="hair"/>'), a=data))


@pytest.mark.parametrize("kind", ["cut", "flip"])
def test_a_damaged_file_gets_one_sentence(tmp_path: Path, kind: str) -> None:
    noise = np.random.default_rng(4).integers(0, 256, (12, 14, 4), dtype=np.uint8)
    deep = cv2.imencode(".png", noise.astype(np.uint16) * 257)[1].tobytes()
    inner = '<layer src="data/a.png"/><stack opacity="0.4"><layer src="data/b.png"/></stack>'
    whole = write(tmp_path / "art.ora", image(inner), a=png(noise), b=deep).read_bytes()
    random = np.random.default_rng(5)
    path, refused = tmp_path / "art.ora", 0
    for place in random.integers(0, len(whole), 250):
        damaged = bytearray(whole)
        if kind == "cut":
            del damaged[place:]
        else:
            damaged[place : place + 3] = random.bytes(3)
        path.write_bytes(damaged)
        try:
            flattened(load_artwork(path))
        except InvalidInputError:
            refused += 1
    assert refused > 100


def test_stacks_as_layers_on_request(tmp_path: Path) -> None:
    inner = (
        '<stack opacity="0.5" name="hair"><stack><layer src="data/a.png" x="1"/></stack>'
        '<layer src="data/b.png"/></stack>'
        '<layer src="data/a.png" name="face" y="3"/>'
    )
    path = write(tmp_path / "art.ora", image(inner), a=png(RED), b=png(BLUE))
    whole, apart = load_artwork(path, groups=True), load_artwork(path)
    assert whole.names == ("face", "hair")
    assert whole.layers[1].opacity == 0.5
    assert len(apart.layers) == 3
    assert np.abs(flattened(whole).astype(int) - flattened(apart)).max() <= 1
