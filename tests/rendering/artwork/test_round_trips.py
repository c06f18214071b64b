"""Random artworks, written and read in every form: the pixels that are seen stay, and so does the picture."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from openraster_files import write_artwork
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.artwork import (
    ArtLayer,
    Artwork,
    flattened,
    from_layers_dictionary,
    load_artwork,
    save_layer_pngs,
    save_psd,
    to_layers_dictionary,
)

SETTINGS = settings(max_examples=25, deadline=None)
MODES = ("normal", "multiply", "screen", "overlay", "add")


@st.composite
def artworks(draw: st.DrawFn, *, deep: bool = True) -> Artwork:
    width, height = draw(st.integers(1, 30)), draw(st.integers(1, 30))
    dtype = np.uint16 if deep and draw(st.booleans()) else np.uint8
    layers = []
    for index in range(draw(st.integers(1, 6))):
        random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
        shape = draw(st.integers(1, 20)), draw(st.integers(1, 20)), 4
        pixels = random.integers(0, np.iinfo(dtype).max + 1, shape).astype(dtype)
        # Whole pixels at two corners, so that nothing is trimmed; elsewhere, holes and hard and soft edges.
        pixels[..., 3] *= random.random(shape[:2]) > 0.2
        pixels[[0, -1], [0, -1], 3] = np.iinfo(dtype).max
        pixels[pixels[..., 3] == 0] = 0
        layers.append(
            ArtLayer(
                name=draw(st.sampled_from(["hair", "前髪", "裙子", 'a "quoted" & <odd> name', "x" * 90])) + str(index),
                pixels=pixels,
                left=draw(st.integers(-25, 35)),
                top=draw(st.integers(-25, 35)),
                opacity=draw(st.integers(0, 255)) / 255,
                blend=draw(st.sampled_from(MODES)),
                visible=draw(st.integers(0, 4)) > 0,
            )
        )
    return Artwork(width, height, tuple(layers))


def premultiplied(picture: np.ndarray) -> np.ndarray:
    return np.concatenate([picture[..., :3] * picture[..., 3:], picture[..., 3:]], axis=2)


def assert_same(found: Artwork, wanted: Artwork) -> None:
    assert found.warnings == ()
    assert (found.width, found.height) == (wanted.width, wanted.height)
    for one, other in zip(found.layers, wanted.layers, strict=True):
        assert (one.name, one.box, one.blend, one.visible) == (other.name, other.box, other.blend, other.visible)
        assert one.opacity == pytest.approx(other.opacity, abs=1e-6)
        assert np.array_equal(one.pixels, other.pixels)
    assert np.array_equal(flattened(found), flattened(wanted))


@SETTINGS
@given(artworks(), st.sampled_from([".psd", ".psb"]))
def test_psd(artwork: Artwork, suffix: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "art" + suffix)
        save_psd(artwork, path)
        assert_same(load_artwork(path), artwork)


@SETTINGS
@given(artworks(deep=False))
def test_openraster(artwork: Artwork) -> None:
    with tempfile.TemporaryDirectory() as folder:
        assert_same(load_artwork(write_artwork(artwork, Path(folder, "art.ora"))), artwork)


@SETTINGS
@given(artworks())
def test_layers_of_comfyui(artwork: Artwork) -> None:
    found = from_layers_dictionary(to_layers_dictionary(artwork))
    if found.dtype == artwork.dtype:  # deep pixels may happen to be ones of 8 bits
        assert_same(found, artwork)


@SETTINGS
@given(artworks())
def test_folder(artwork: Artwork) -> None:
    """Blend modes, visibility and what lies beyond the canvas are not in a folder."""
    plain = [ArtLayer(each.name, each.pixels, each.left, each.top, each.opacity) for each in artwork.layers]
    wanted = Artwork(artwork.width, artwork.height, tuple(plain))
    with tempfile.TemporaryDirectory() as folder:
        paths = save_layer_pngs(wanted, folder)
        found = load_artwork(folder)
        assert [path.name for path in paths] == sorted(path.name for path in Path(folder).iterdir())
    most = np.iinfo(wanted.dtype).max
    difference = premultiplied(flattened(found) / most) - premultiplied(flattened(wanted) / most)
    assert np.abs(difference).max() <= len(plain) / most


@SETTINGS
@given(artworks(deep=False))
def test_flattened_is_what_pillow_lays_over(artwork: Artwork) -> None:
    """Normal layers in another's compositing: Pillow rounds at each layer."""
    from PIL import Image

    picture = Image.new("RGBA", (artwork.width, artwork.height))
    for layer in artwork.layers:
        own = np.zeros((120, 120, 4), np.uint8)
        own[layer.top + 40 : layer.box[3] + 40, layer.left + 40 : layer.box[2] + 40] = layer.pixels
        own = own[40 : 40 + artwork.height, 40 : 40 + artwork.width]
        picture = Image.alpha_composite(picture, Image.fromarray(own))
    plain = Artwork(
        artwork.width,
        artwork.height,
        tuple(ArtLayer(each.name, each.pixels, each.left, each.top) for each in artwork.layers),
    )
    difference = premultiplied(flattened(plain) / 255) - premultiplied(np.asarray(picture) / 255)
    assert np.abs(difference).max() * 255 <= 4


def test_psd_files_are_readable_by_others(tmp_path: Path) -> None:
    from PIL import Image
    from psd_tools import PSDImage

    pixels = np.random.default_rng(1).integers(0, 256, (9, 7, 4), dtype=np.uint8)
    artwork = Artwork(16, 12, (ArtLayer("紙", np.full((12, 16, 4), 255, np.uint8)), ArtLayer("髪", pixels, 3, 2)))
    save_psd(artwork, tmp_path / "art.psd")
    wanted = flattened(artwork)[..., :3]
    with Image.open(tmp_path / "art.psd") as picture:
        assert np.array_equal(np.asarray(picture.convert("RGB")), wanted)
    document = PSDImage.open(tmp_path / "art.psd")
    assert [layer.name for layer in document] == ["紙", "髪"]
    assert np.abs(np.asarray(document.composite(force=True).convert("RGB")).astype(int) - wanted).max() <= 1


def test_places_are_checked_and_files_of_others_left_alone(tmp_path: Path) -> None:
    artwork = Artwork(4, 4, (ArtLayer("hair/front", np.full((4, 4, 4), 255, np.uint8)),))
    with pytest.raises(InvalidInputError, match=r"that of a \.psd or \.psb file"):
        save_psd(artwork, tmp_path / "art.png")
    with pytest.raises(InvalidInputError, match="must exist"):
        save_psd(artwork, tmp_path / "none" / "art.psd")
    (tmp_path / "photo.png").write_bytes(b"mine")
    with pytest.raises(InvalidInputError, match="must hold no PNG files yet"):
        save_layer_pngs(artwork, tmp_path)
    assert [path.name for path in save_layer_pngs(artwork, tmp_path / "new")] == ["00 hair_front.png"]
