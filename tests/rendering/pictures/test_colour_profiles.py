"""Colour profiles against Little CMS, which converts 8 bits, and against their own formulas for 16."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from colour_profiles import P3, grey_profile, rgb_profile, table_profile
from physanimator.rendering.pictures import load_image
from physanimator.rendering.pictures.colour_profiles import as_srgb, is_srgb
from physanimator.rendering.pictures.icc_curves import curves_and_matrix
from PIL import Image, ImageCms

SRGB = ((0.43607, 0.22249, 0.01392), (0.38515, 0.71687, 0.09708), (0.14307, 0.06061, 0.71410))


def noise(dtype: Any, channels: int = 4) -> np.ndarray:
    most = np.iinfo(dtype).max
    return np.random.default_rng(3).integers(0, most, (40, 30, channels), dtype, endpoint=True)


def by_little_cms(pixels: np.ndarray, profile: bytes) -> np.ndarray:
    source = ImageCms.ImageCmsProfile(io.BytesIO(profile))
    made = ImageCms.profileToProfile(Image.fromarray(pixels), source, ImageCms.createProfile("sRGB"), outputMode="RGB")
    return np.asarray(made)


def encoded(light: np.ndarray) -> np.ndarray:
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)


@pytest.mark.parametrize(("gamma", "colours"), [(2.2, P3), (1.8, P3), (1.0, SRGB)])
def test_16_bits_are_what_little_cms_makes_of_8_and_finer(gamma: float, colours: Any) -> None:
    profile, fine = rgb_profile(gamma, colours), noise(np.uint16)
    fine[..., :3] = fine[..., :3] // 257 * 257
    made, told = as_srgb(fine, profile)
    assert told == ""
    coarse = by_little_cms((fine[..., :3] // 257).astype(np.uint8), profile)
    assert np.abs(made[..., :3] / 257 - coarse).max() <= 1
    np.testing.assert_array_equal(made[..., 3], fine[..., 3])
    ramp = np.arange(20000, 20200, dtype=np.uint16)[None, :, None].repeat(3, axis=2)
    assert len(np.unique(as_srgb(ramp, profile)[0][..., 0])) > 100, "finer than 8 bits"


def test_linear_light_in_16_bits_is_encoded() -> None:
    """Krita's linear sRGB is called sRGB as well."""
    profile, fine = rgb_profile(1.0, SRGB, name="sRGB-elle-V2-g10"), noise(np.uint16, 3)
    assert not is_srgb(profile)
    wanted = 65535 * encoded(fine / 65535)
    assert np.abs(as_srgb(fine, profile)[0] - wanted).max() < 80  # 0.3 of 255: the primaries are rounded


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_grey_is_converted(dtype: Any) -> None:
    grey = noise(dtype, 1).repeat(4, axis=2)
    made, told = as_srgb(grey, grey_profile(1.4))
    most = np.iinfo(dtype).max
    wanted = most * encoded((grey[..., :3] / most) ** 1.4)
    assert told == ""
    assert np.abs(made[..., :3] - wanted).max() <= (0.51 if dtype == np.uint8 else 30)
    np.testing.assert_array_equal(made[..., 3], grey[..., 3])


def test_tables_give_16_bits_as_fine_as_8_and_say_so() -> None:
    fine, profile = noise(np.uint16, 3), table_profile()
    made, told = as_srgb(fine, profile)
    assert "as finely as 8 bits" in told
    eight = np.rint(fine / 257).astype(np.uint8)
    np.testing.assert_array_equal(made, by_little_cms(eight, profile) * np.uint16(257))
    assert np.abs(made.astype(int) - fine).max() > 5000, "it changes colours"


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_srgb_and_what_is_no_profile_change_nothing(dtype: Any) -> None:
    pixels = noise(dtype)
    own = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    assert as_srgb(pixels, own) == (pixels, "")
    same, told = as_srgb(pixels, b"no profile")
    assert same is pixels
    assert "cannot be applied" in told


@pytest.mark.parametrize("cut", [0, 60, 131, 140, 200, 300, 400])
def test_damaged_profiles_do_no_harm(cut: int) -> None:
    profile, rng = rgb_profile(2.2), np.random.default_rng(cut)
    damaged = bytearray(profile)
    damaged[cut : cut + 8] = rng.bytes(len(damaged[cut : cut + 8]))
    for each in (profile[:cut], bytes(damaged)):
        made, _ = as_srgb(noise(np.uint16), each)
        assert made.shape == (40, 30, 4)
        assert made.dtype == np.uint16
    enormous = profile.replace(b"curv\0\0\0\0\0\0\0\1", b"curv\0\0\0\0\xff\xff\xff\xff")
    assert curves_and_matrix(enormous) is None


@pytest.mark.parametrize("mode", ["L", "LA", "P", "RGB", "RGBA", "I;16"])
def test_flat_pictures_of_every_mode(tmp_path: Path, mode: str) -> None:
    grey = np.arange(256, dtype=np.uint8)[None].repeat(4, axis=0)
    if mode == "I;16":
        picture = Image.fromarray(grey.astype(np.uint16) * np.uint16(257))
    else:
        picture = Image.fromarray(grey).convert(mode)
    profile = rgb_profile(1.0, SRGB) if mode in ("P", "RGB", "RGBA") else grey_profile(1.0)
    picture.save(tmp_path / "picture.png", icc_profile=profile)
    wanted = np.rint(255 * encoded(grey / 255))
    assert np.abs(load_image(tmp_path / "picture.png") - wanted[..., None]).max() <= 1


def test_16_bit_layers_in_files(tmp_path: Path) -> None:
    from physanimator.rendering.artwork import load_artwork

    fine = noise(np.uint16, 3)
    cv2.imwrite(str(tmp_path / "1 hair.png"), fine[..., ::-1])
    data, profile = (tmp_path / "1 hair.png").read_bytes(), table_profile()
    (tmp_path / "1 hair.png").write_bytes(with_chunk(data, rgb_profile(2.2)))
    (tmp_path / "2 face.png").write_bytes(with_chunk(data, profile))
    artwork = load_artwork(tmp_path)
    np.testing.assert_array_equal(artwork.layers[0].pixels[..., :3], as_srgb(fine, rgb_profile(2.2))[0])
    np.testing.assert_array_equal(artwork.layers[1].pixels[..., :3], as_srgb(fine, profile)[0])
    (told,) = artwork.warnings
    assert "2 face.png: the colour profile is one of tables" in told


def with_chunk(png: bytes, profile: bytes) -> bytes:
    """A PNG file with a profile embedded."""
    import struct
    import zlib

    body = b"iCCPprofile\0\0" + zlib.compress(profile)
    chunk = struct.pack(">I", len(body) - 4) + body + struct.pack(">I", zlib.crc32(body))
    return png[:33] + chunk + png[33:]
