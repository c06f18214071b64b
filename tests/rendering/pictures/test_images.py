"""Pictures of every kind arrive as the same array, and what cannot be used is refused in one sentence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.pictures import as_uint8, load_image, load_mask, save_image
from physanimator.rendering.pictures.images import LONGEST_SIDE
from PIL import Image, ImageCms


def drawing(height: int = 12, width: int = 20) -> np.ndarray:
    y, x = np.mgrid[0:height, 0:width]
    return np.stack([x * 12, y * 20, np.full_like(x, 90)], axis=-1).astype(np.uint8)


@pytest.mark.parametrize(("name", "tolerance"), [("a.png", 0), ("a.jpg", 6), ("a.webp", 6)])
def test_rgb_files(tmp_path: Path, name: str, tolerance: int) -> None:
    save_image(tmp_path / name, drawing())
    loaded = load_image(tmp_path / name)
    assert loaded.dtype == np.uint8
    assert loaded.shape == (12, 20, 3)
    assert np.abs(loaded.astype(int) - drawing()).mean() <= tolerance


def test_orientation_of_a_photograph_is_applied(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.fromarray(drawing()).save(tmp_path / "turned.png", exif=exif)
    assert (load_image(tmp_path / "turned.png") == np.rot90(drawing(), -1)).all()


def test_transparent_areas_are_laid_over_white(tmp_path: Path) -> None:
    rgba = np.dstack([drawing(), np.full((12, 20), 255, np.uint8)])
    rgba[:6, :, 3] = 0
    rgba[6, :, 3] = 128
    save_image(tmp_path / "sprite.png", rgba)
    loaded = load_image(tmp_path / "sprite.png")
    assert (loaded[:6] == 255).all()
    assert (loaded[7:] == drawing()[7:]).all()
    assert np.abs(loaded[6] - (drawing()[6] * 128.0 + 255 * 127.0) / 255).max() <= 1


def test_alpha_is_kept_where_it_is_wanted_and_there_is_some(tmp_path: Path) -> None:
    pixels = np.array([[[200, 100, 50, 255], [10, 20, 30, 128], [250, 0, 250, 0]]], np.uint8)
    Image.fromarray(pixels).save(tmp_path / "clear.png")
    assert load_image(tmp_path / "clear.png", alpha=True).tolist() == [
        [[200, 100, 50, 255], [10, 20, 30, 128], [0] * 4]
    ]
    pixels[..., 3] = 255
    Image.fromarray(pixels).save(tmp_path / "full.png")
    assert load_image(tmp_path / "full.png", alpha=True).tolist() == pixels[..., :3].tolist()


def test_palette_with_a_transparent_colour(tmp_path: Path) -> None:
    picture = Image.fromarray(np.array([[0, 1], [1, 0]], np.uint8)).convert("P")
    picture.putpalette([10, 20, 30, 200, 100, 50])
    picture.save(tmp_path / "p.png", transparency=0)
    assert (load_image(tmp_path / "p.png")[0] == [[255, 255, 255], [200, 100, 50]]).all()


def test_grey_and_sixteen_bit_pictures(tmp_path: Path) -> None:
    Image.fromarray(np.full((4, 5), 77, np.uint8)).save(tmp_path / "grey.png")
    assert (load_image(tmp_path / "grey.png") == 77).all()
    Image.fromarray(np.full((4, 5), 77 * 257, np.uint16)).save(tmp_path / "deep.png")
    assert (load_image(tmp_path / "deep.png") == 77).all()


def test_a_transparent_grey_among_sixteen_bits(tmp_path: Path) -> None:
    values = np.array([[0, 1, 30_000, 60_000, 65_535]], dtype=np.uint16)
    Image.fromarray(values).save(tmp_path / "deep.png", transparency=0)
    assert load_image(tmp_path / "deep.png")[0, :, 0].tolist() == [255, 0, 117, 233, 255]
    mask = load_mask(tmp_path / "deep.png", width=5, height=1)
    assert mask.tolist() == [[0, 1, 1, 1, 1]]


@pytest.mark.parametrize("dtype", [np.uint16, np.uint8])
def test_colour_and_opacity_of_any_depth(tmp_path: Path, dtype: type) -> None:
    import cv2

    rgba = np.dstack([drawing(), np.full((12, 20), 255, np.uint8)])
    rgba[:3, :, 3] = 0
    factor = 257 if dtype == np.uint16 else 1
    cv2.imwrite(str(tmp_path / "a.png"), rgba[..., [2, 1, 0, 3]].astype(dtype) * dtype(factor))
    loaded = load_image(tmp_path / "a.png")
    assert (loaded[3:] == drawing()[3:]).all()
    assert (loaded[:3] == 255).all()


@pytest.mark.parametrize("mode", ["1", "L", "LA", "P", "CMYK", "YCbCr", "LAB"])
def test_every_mode_becomes_rgb(tmp_path: Path, mode: str) -> None:
    white = Image.new("RGB", (9, 7), "white")
    lab = [ImageCms.createProfile(each) for each in ("sRGB", "LAB")]
    converted = ImageCms.profileToProfile(white, *lab, outputMode="LAB") if mode == "LAB" else white.convert(mode)
    name = tmp_path / ("a.tif" if mode in ("CMYK", "YCbCr", "LAB") else "a.png")
    converted.save(name)
    loaded = load_image(name)
    assert loaded.shape == (7, 9, 3)
    assert loaded.min() > 250


def test_a_picture_of_one_pixel(tmp_path: Path) -> None:
    save_image(tmp_path / "one.png", np.full((1, 1, 3), 200, np.uint8))
    assert load_image(tmp_path / "one.png").tolist() == [[[200] * 3]]
    assert load_mask(tmp_path / "one.png", width=1, height=1).shape == (1, 1)


def test_a_turned_mask_fits_the_turned_picture(tmp_path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 8
    grey = drawing()[..., 0]
    Image.fromarray(grey).save(tmp_path / "turned.png", exif=exif)
    mask = load_mask(tmp_path / "turned.png", width=12, height=20)
    assert (np.rint(mask * 255) == np.rot90(grey)).all()
    with pytest.raises(InvalidInputError, match="20 x 12"):
        load_mask(tmp_path / "turned.png", width=20, height=12)


def test_colour_profile_is_converted_and_srgb_left_alone(tmp_path: Path) -> None:
    srgb = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    # sRGB with red and green exchanged, under another name: its (255, 0, 0) is green.
    other = srgb.replace(b"rXYZ", b"____").replace(b"gXYZ", b"rXYZ").replace(b"____", b"gXYZ")
    other = other.replace("sRGB".encode("utf-16-be"), "wide".encode("utf-16-be")).replace(b"sRGB", b"wide")
    picture = Image.fromarray(drawing())
    for name, profile in (("srgb", srgb), ("broken", b"no profile"), ("other", other)):
        picture.save(tmp_path / f"{name}.png", icc_profile=profile)
    assert (load_image(tmp_path / "srgb.png") == drawing()).all()
    assert (load_image(tmp_path / "broken.png") == drawing()).all()
    assert np.abs(load_image(tmp_path / "other.png").astype(int) - drawing()[..., [1, 0, 2]]).max() <= 2


def test_mask_by_brightness(tmp_path: Path) -> None:
    grey = np.zeros((6, 8), np.uint8)
    grey[2:4] = 255
    grey[4] = 51
    save_image(tmp_path / "mask.png", grey)
    mask = load_mask(tmp_path / "mask.png", width=8, height=6)
    assert mask.dtype == np.float32
    assert (mask[2:4] == 1).all()
    assert mask[4, 0] == pytest.approx(0.2)
    assert (mask[:2] == 0).all()


@pytest.mark.parametrize("mode", ["1", "RGB", "P", "I;16", "RGBA"])
def test_mask_of_any_mode(tmp_path: Path, mode: str) -> None:
    inside = np.zeros((6, 8), bool)
    inside[2:4] = True
    if mode == "I;16":
        picture = Image.fromarray(inside.astype(np.uint16) * 65535)
    else:
        picture = Image.fromarray(inside.astype(np.uint8) * 255).convert(mode)
    picture.save(tmp_path / "mask.png")
    assert ((load_mask(tmp_path / "mask.png", width=8, height=6) == 1) == inside).all()


@pytest.mark.parametrize("colour", [0, 255])
def test_cut_out_part_is_its_own_mask(tmp_path: Path, colour: int) -> None:
    rgba = np.full((6, 8, 4), colour, np.uint8)
    rgba[..., 3] = 0
    rgba[2:4, :, 3] = 255
    save_image(tmp_path / "part.png", rgba)
    mask = load_mask(tmp_path / "part.png", width=8, height=6)
    assert (mask[2:4] == 1).all()
    assert mask.sum() == 16


def test_mask_of_another_size(tmp_path: Path) -> None:
    save_image(tmp_path / "mask.png", np.pad(np.full((3, 8), 255, np.uint8), ((0, 3), (0, 0))))
    mask = load_mask(tmp_path / "mask.png", width=16, height=12)
    assert mask.shape == (12, 16)
    assert mask[:5].min() > 0.9
    assert mask[7:].max() < 0.1
    with pytest.raises(
        InvalidInputError, match=r"mask .*mask.png must have .*proportions \(16 x 16 px\)\. Got: 8 x 6 px"
    ):
        load_mask(tmp_path / "mask.png", width=16, height=16)


def test_empty_mask(tmp_path: Path) -> None:
    save_image(tmp_path / "mask.png", np.zeros((6, 8), np.uint8))
    with pytest.raises(InvalidInputError, match="empty mask"):
        load_mask(tmp_path / "mask.png", width=8, height=6)


def test_missing_broken_and_foreign_files(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="existing file"):
        load_image(tmp_path / "none.png")
    (tmp_path / "text.png").write_text("no picture")
    with pytest.raises(InvalidInputError, match="PNG, JPEG or WebP"):
        load_image(tmp_path / "text.png")
    save_image(tmp_path / "whole.png", np.random.default_rng(0).integers(0, 255, (64, 64, 3), np.uint8))
    (tmp_path / "half.png").write_bytes((tmp_path / "whole.png").read_bytes()[:3000])
    with pytest.raises(InvalidInputError, match="cannot be read"):
        load_image(tmp_path / "half.png")
    with pytest.raises(InvalidInputError, match="picture"):
        load_image(tmp_path)


@pytest.mark.parametrize("size", [(LONGEST_SIDE + 1, 2), (12000, 9000), (20000, 20000)])
def test_too_large_pictures_are_refused_without_decoding(tmp_path: Path, size: tuple[int, int]) -> None:
    Image.new("1", size).save(tmp_path / "large.png")
    with pytest.raises(
        InvalidInputError, match=rf"at most 67 million pixels .* {LONGEST_SIDE} px on a side\. Got: ({size[0]}|more)"
    ):
        load_image(tmp_path / "large.png")


def test_long_pages_are_taken(tmp_path: Path) -> None:
    Image.new("1", (800, 12000), 1).save(tmp_path / "page.png")
    assert load_image(tmp_path / "page.png").shape == (12000, 800, 3)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        (np.array([[0, 100, 255]], np.int32), [0, 100, 255]),
        (np.array([[0, 100 * 257, 65535]], np.int32), [0, 100, 255]),
        (np.array([[0, 100 << 23, 2**31 - 1]], np.int32), [0, 100, 255]),
        (np.array([[0, 100 / 255, 1]], np.float32), [0, 100, 255]),
        (np.array([[0, 100, 255]], np.float32), [0, 100, 255]),
        (np.array([[-0.1, 100 / 255, 1.1]], np.float32), [0, 100, 255]),
    ],
)
def test_planes_of_thirty_two_bits(tmp_path: Path, values: np.ndarray, expected: list[int]) -> None:
    Image.fromarray(values).save(tmp_path / "deep.tif")
    assert load_image(tmp_path / "deep.tif")[0, :, 0].tolist() == expected


@pytest.mark.parametrize(
    ("value", "message"), [(np.nan, "finite numbers"), (np.inf, "finite"), (-3.0, "Got: -3 to 1"), (4.0, "Got: 0 to 4")]
)
def test_planes_that_cannot_be_told(tmp_path: Path, value: float, message: str) -> None:
    values = np.zeros((8, 9), np.float32)
    values[2:6, 2:6], values[0, 0] = 1, value
    Image.fromarray(values).save(tmp_path / "deep.tif")
    for load in (load_image, lambda path: load_mask(path, width=9, height=8)):
        with pytest.raises(InvalidInputError, match="deep.tif must.*" + message):
            load(tmp_path / "deep.tif")


@pytest.mark.parametrize("most", [256, 1023, 4095, 2**24 - 1, 100_000_000])
@pytest.mark.parametrize("kind", [np.int32, np.float32])
def test_a_range_that_no_value_comes_near_is_not_guessed(tmp_path: Path, most: int, kind: type) -> None:
    """Taken for the next wider one, the picture would be nearly black."""
    Image.fromarray(np.linspace(0, most, 72).reshape(8, 9).astype(kind)).save(tmp_path / "deep.tif")
    with pytest.raises(InvalidInputError, match=r"deep\.tif must hold numbers from 0 to"):
        load_image(tmp_path / "deep.tif")


def test_page_descriptions_are_not_opened(tmp_path: Path) -> None:
    (tmp_path / "page.png").write_bytes(b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\nshowpage\n")
    with pytest.raises(InvalidInputError, match="PNG, JPEG or WebP"):
        load_image(tmp_path / "page.png")


def test_save_refuses_unknown_suffix_and_missing_folder(tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="must end in"):
        save_image(tmp_path / "a.xyz", drawing())
    with pytest.raises(InvalidInputError, match="must exist"):
        save_image(tmp_path / "none" / "a.png", drawing())


def test_failed_save_keeps_the_earlier_file(tmp_path: Path) -> None:
    save_image(tmp_path / "a.png", drawing())
    with pytest.raises((TypeError, ValueError)):
        save_image(tmp_path / "a.png", np.zeros((4, 4, 7), np.uint8))
    assert (load_image(tmp_path / "a.png") == drawing()).all()
    assert len(list(tmp_path.iterdir())) == 1


def test_as_uint8_rounds_and_clips() -> None:
    assert as_uint8(np.array([-0.1, 0.0, 0.5, 0.9999, 1.1])).tolist() == [0, 0, 128, 255, 255]
    same = drawing()
    assert as_uint8(same) is same
