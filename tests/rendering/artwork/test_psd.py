"""PSD files made by psd-tools, read by us: the picture is psd-tools' own composite, the layers are what was put in."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from colour_profiles import grey_profile, rgb_profile
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.artwork import ArtLayer, Artwork, flattened, read_psd
from physanimator.rendering.pictures.colour_profiles import as_srgb
from PIL import Image, ImageDraw
from psd_tools import PSDImage
from psd_tools.constants import BlendMode, Tag
from psd_tools.psd.layer_and_mask import MaskFlags
from psd_tools.psd.tagged_blocks import TaggedBlock
from psd_tools.psd.vector import ClosedKnotLinked, ClosedPath, PathFillRule, VectorMaskSetting
from psd_tools.psd.vector import Path as Outline

WIDTH, HEIGHT = 48, 32


@pytest.fixture(autouse=True)
def _quiet(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.CRITICAL, "psd_tools")


def noise(seed: int, height: int = 14, width: int = 18) -> Image.Image:
    return Image.fromarray(np.random.default_rng(seed).integers(0, 256, (height, width, 4), dtype=np.uint8))


def opaque(seed: int, height: int = HEIGHT, width: int = WIDTH) -> Image.Image:
    return noise(seed, height, width).convert("RGB")


def hard_edged(seed: int) -> Image.Image:
    """Psd-tools lays a see-through layer more than once over a see-through base, which painting programs do not."""
    picture = noise(seed, 20, 20)
    picture.putalpha(picture.getchannel("A").point(lambda alpha: 255 * (alpha > 60)))
    return picture


def document(mode: str = "RGBA", depth: Any = None, version: int = 1) -> PSDImage:
    psd = PSDImage.new(mode, (WIDTH, HEIGHT), depth=depth)
    psd._record.header.version = version
    psd.create_pixel_layer(opaque(1).convert(mode), name="paper")
    return psd


def saved(psd: PSDImage, folder: Path, name: str = "art.psd") -> Path:
    psd.save(folder / name, encoding="utf-8")
    return folder / name


def as_it_is(psd: PSDImage, path: Path) -> None:
    """Write a document without drawing it first: it may hold what cannot be drawn."""
    with path.open("wb") as file:
        psd._record.write(file)


def own_composite(path: Path) -> np.ndarray:
    """Colours times alpha, 0 to 255."""
    return times_alpha(np.asarray(PSDImage.open(path).composite(force=True).convert("RGBA")))


def times_alpha(picture: np.ndarray) -> np.ndarray:
    numbers = picture.astype(float)
    return np.concatenate([numbers[..., :3] * numbers[..., 3:] / 255, numbers[..., 3:]], axis=2)


def assert_same_picture(path: Path, within: int = 2) -> Artwork:
    artwork = read_psd(path)
    ours = flattened(artwork)
    ours = ours / 257 if ours.dtype == np.uint16 else ours
    assert np.abs(times_alpha(ours) - own_composite(path)).max() <= within
    return artwork


@pytest.mark.parametrize("compression", [0, 1, 2, 3])
def test_layers_come_as_they_were_put_in(tmp_path: Path, compression: int) -> None:
    psd = document()
    drawn = noise(2)
    psd.create_pixel_layer(drawn, name="hair", top=5, left=-7, compression=compression).opacity = 100
    artwork = assert_same_picture(saved(psd, tmp_path))
    hair = artwork.layers[1]
    assert (hair.name, hair.box, hair.opacity) == ("hair", (-7, 5, 11, 19), 100 / 255)
    assert artwork.warnings == ()
    own = np.asarray(drawn)
    seen = own[..., 3] > 0
    assert np.array_equal(hair.pixels[seen], own[seen])


def test_a_greyscale_file(tmp_path: Path) -> None:
    psd = PSDImage.new("LA", (WIDTH, HEIGHT))
    psd.create_pixel_layer(opaque(1).convert("L"), name="paper")
    psd.create_pixel_layer(noise(2).convert("LA"), name="hair", top=5, left=30)
    artwork = assert_same_picture(saved(psd, tmp_path))
    assert np.ptp(artwork.layers[1].pixels[..., :3], axis=2).max() == 0


def test_16_bits_are_kept(tmp_path: Path) -> None:
    psd = document(depth=16)
    psd.create_pixel_layer(noise(2), name="hair", top=5, left=30)
    artwork = assert_same_picture(saved(psd, tmp_path))
    assert artwork.dtype == np.uint16
    assert flattened(artwork).dtype == np.uint16


def test_a_psb_file(tmp_path: Path) -> None:
    psd = document(version=2)
    psd.create_pixel_layer(noise(2), name="hair")
    assert len(assert_same_picture(saved(psd, tmp_path, "art.psb")).layers) == 2


def test_a_colour_profile_is_applied(tmp_path: Path) -> None:
    """Grey colours stay, others become those of sRGB: here from a profile with the primaries in another order."""
    from PIL import ImageCms
    from psd_tools.constants import Resource
    from psd_tools.psd.image_resources import ImageResource

    psd = document()
    profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    swapped = profile.replace(b"rXYZ", b"tmp0").replace(b"bXYZ", b"rXYZ").replace(b"tmp0", b"bXYZ")
    other = swapped.replace("sRGB".encode("utf-16-be"), "mine".encode("utf-16-be"))
    for each, changed in ((profile, False), (other, True), (b"none", False)):
        psd.image_resources[Resource.ICC_PROFILE] = ImageResource(key=Resource.ICC_PROFILE, data=each)
        read = read_psd(saved(psd, tmp_path)).layers[0].pixels[..., :3].astype(int)
        wanted = np.asarray(opaque(1)).astype(int)
        assert np.abs(read - (wanted[..., ::-1] if changed else wanted)).max() <= (3 if changed else 0)


@pytest.mark.parametrize("depth", [8, 16])
@pytest.mark.parametrize("mode", ["RGB", "L"])
def test_a_colour_profile_is_applied_in_16_bits_and_greyscale(tmp_path: Path, depth: int, mode: str) -> None:
    from psd_tools.constants import Resource
    from psd_tools.psd.image_resources import ImageResource

    psd = PSDImage.new(mode, (WIDTH, HEIGHT), depth=depth)
    psd.create_pixel_layer(opaque(1).convert(mode), name="background")
    before = read_psd(saved(psd, tmp_path)).layers[0].pixels
    profile = rgb_profile(1.0) if mode == "RGB" else grey_profile(1.0)
    psd.image_resources[Resource.ICC_PROFILE] = ImageResource(key=Resource.ICC_PROFILE, data=profile)
    artwork = read_psd(saved(psd, tmp_path))
    assert artwork.dtype == (np.uint8 if depth == 8 else np.uint16)
    np.testing.assert_array_equal(artwork.layers[0].pixels, as_srgb(before, profile)[0])
    assert artwork.layers[0].pixels[..., :3].mean() > 1.2 * before[..., :3].mean(), "linear light is brighter than it"
    assert artwork.warnings == ()


@pytest.mark.parametrize(("mode", "word"), [("CMYK", "CMYK"), ("LAB", "Lab")])
def test_other_colours_are_refused_with_the_remedy(tmp_path: Path, mode: str, word: str) -> None:
    psd = PSDImage.new(mode, (WIDTH, HEIGHT))
    psd.create_pixel_layer(Image.new("RGB", (4, 4)), name="hair")
    path = saved(psd, tmp_path)
    with pytest.raises(InvalidInputError, match=f"convert it to RGB .*Got: {word}"):
        read_psd(path)


def test_32_bits_are_refused_with_the_remedy(tmp_path: Path) -> None:
    path = saved(document(depth=32), tmp_path)
    with pytest.raises(InvalidInputError, match=r"8 or 16 bits a channel; convert it .*Got: 32 bits"):
        read_psd(path)


def test_names_of_any_language_and_twice(tmp_path: Path) -> None:
    psd = document()
    for number, name in enumerate(("前髪", "后发", "hair", "hair", "hair")):
        psd.create_pixel_layer(noise(number), name=name)
    artwork = read_psd(saved(psd, tmp_path))
    assert [layer.name for layer in artwork.layers[1:]] == ["前髪", "后发", "hair", "hair", "hair"]
    assert artwork.names == ("paper", "前髪", "后发", "hair", "hair (2)", "hair (3)")


def test_a_name_in_unicode_stands_above_the_short_one(tmp_path: Path) -> None:
    psd = document()
    psd.create_pixel_layer(noise(2), name="x").name = "スカート"
    psd.save(tmp_path / "art.psd")
    assert read_psd(tmp_path / "art.psd").layers[1].name == "スカート"


def test_hidden_layers_stay_hidden(tmp_path: Path) -> None:
    psd = document()
    psd.create_pixel_layer(noise(2), name="hair").visible = False
    inner = psd.create_pixel_layer(noise(3), name="inner", top=9)
    psd.create_group([inner], name="group").visible = False
    artwork = assert_same_picture(saved(psd, tmp_path))
    assert [layer.visible for layer in artwork.layers] == [True, False, False]
    assert artwork.layers[1].pixels.any()


@pytest.mark.parametrize("apart", [True, False])
def test_a_see_through_group_looks_the_same_layer_by_layer(tmp_path: Path, apart: bool) -> None:
    psd = document()
    first = psd.create_pixel_layer(noise(2), name="first", top=2, left=2)
    second = psd.create_pixel_layer(noise(3), name="second", top=8, left=22 if apart else 9)
    second.opacity = 200
    psd.create_group([first, second], name="group").opacity = 120
    artwork = assert_same_picture(saved(psd, tmp_path))
    assert [layer.opacity for layer in artwork.layers[1:]] == pytest.approx([120 / 255, 120 * 200 / 255**2])
    assert len(artwork.warnings) == (not apart)


def test_groups_in_groups(tmp_path: Path) -> None:
    psd = document()
    layers = [psd.create_pixel_layer(noise(n), name=str(n), top=3 * n, left=4 * n) for n in range(4)]
    inner = psd.create_group(layers[:2], name="inner")
    inner.opacity = 128
    psd.create_group([inner, *layers[2:]], name="outer").opacity = 170
    assert len(assert_same_picture(saved(psd, tmp_path)).layers) == 5


@pytest.mark.parametrize("seed", range(16))
def test_random_trees_of_groups(tmp_path: Path, seed: int) -> None:
    random = np.random.default_rng(seed)
    psd = PSDImage.new("RGBA", (WIDTH, HEIGHT), depth=16 if seed % 2 else 8)
    pool: list[Any] = []
    for number in range(int(random.integers(3, 9))):
        height, width = (int(each) for each in random.integers(3, 30, 2))
        top, left = int(random.integers(-12, 30)), int(random.integers(-12, 40))
        layer = psd.create_pixel_layer(noise(100 * seed + number, height, width), name=str(number), top=top, left=left)
        layer.opacity, layer.visible = int(random.integers(0, 256)), bool(random.random() > 0.15)
        pool.append(layer)
        if len(pool) > 1 and random.random() < 0.5:
            count = int(random.integers(1, len(pool) + 1))
            group = psd.create_group(pool[-count:], name=f"group {number}")
            group.opacity, group.visible = int(random.integers(0, 256)), bool(random.random() > 0.1)
            group.blend_mode = BlendMode.NORMAL if random.random() < 0.5 else BlendMode.PASS_THROUGH
            pool[-count:] = [group]
    assert_same_picture(saved(psd, tmp_path))


@pytest.mark.parametrize("outside", [0, 255])
@pytest.mark.parametrize("on", ["layer", "group"])
def test_painted_masks(tmp_path: Path, on: str, outside: int) -> None:
    psd = document()
    layer: Any = psd.create_pixel_layer(noise(2, 20, 30), name="hair", top=3, left=5)
    masked = layer if on == "layer" else psd.create_group([layer], name="group")
    if on == "group":  # psd-tools gives a new group and its end one list of channels, and would add the mask to both
        psd = PSDImage.open(saved(psd, tmp_path))
        masked, layer = psd[1], psd[1][0]
    masked.create_mask(noise(5, 10, 12).getchannel("A"), top=8, left=14)
    masked.mask.data.background_color = outside
    path = saved(psd, tmp_path)
    assert_same_picture(path)
    masked.mask.data.flags = MaskFlags(mask_disabled=True)
    path = saved(psd, tmp_path)
    assert_same_picture(path)
    assert np.array_equal(read_psd(path).layers[1].pixels[..., 3], np.asarray(layer.topil())[..., 3])


def test_clipping_layers_become_part_of_their_base(tmp_path: Path) -> None:
    psd = document()
    psd.create_pixel_layer(hard_edged(2), name="face", top=3, left=5).opacity = 180
    for number, name in enumerate(("shade", "light")):
        above = psd.create_pixel_layer(noise(7 + number, 16, 16), name=name, top=8 - number, left=12)
        above.clipping = True
        above.opacity = 140
    psd.create_pixel_layer(noise(4), name="hair", top=1, left=1)
    artwork = assert_same_picture(saved(psd, tmp_path))
    assert [layer.name for layer in artwork.layers] == ["paper", "face", "hair"]
    assert artwork.warnings == ()


def test_a_multiplied_clipping_layer(tmp_path: Path) -> None:
    psd = document()
    psd.create_pixel_layer(hard_edged(2), name="face", top=3, left=5)
    above = psd.create_pixel_layer(noise(7, 16, 16), name="shade", top=8, left=12)
    above.clipping = True
    above.blend_mode = BlendMode.MULTIPLY
    assert_same_picture(saved(psd, tmp_path))


@pytest.mark.parametrize("mode", ["MULTIPLY", "SCREEN", "OVERLAY", "LINEAR_DODGE"])
def test_blend_modes(tmp_path: Path, mode: str) -> None:
    psd = document()
    psd.create_pixel_layer(noise(2, 20, 20), name="soft", top=3, left=5)
    psd.create_pixel_layer(noise(3, 20, 20), name="over", top=9, left=11).blend_mode = BlendMode[mode]
    assert assert_same_picture(saved(psd, tmp_path)).layers[2].blend != "normal"


def test_an_unknown_blend_mode_is_named(tmp_path: Path) -> None:
    psd = document()
    psd.create_pixel_layer(noise(2), name="glow").blend_mode = BlendMode.VIVID_LIGHT
    artwork = read_psd(saved(psd, tmp_path))
    assert artwork.warnings == ("layer glow: blend mode vivid light is drawn as normal",)
    assert artwork.layers[1].blend == "normal"


def test_an_empty_layer_and_sixty_layers(tmp_path: Path) -> None:
    psd = document()
    for number in range(60):
        psd.create_pixel_layer(noise(number, 4, 5), name=f"layer {number}", top=number % 30, left=number % 45)
    psd[3]._record.right = psd[3]._record.left
    psd[3]._record.bottom = psd[3]._record.top
    for channel in psd[3]._channels:
        channel.data = b""
    path = tmp_path / "art.psd"
    as_it_is(psd, path)
    artwork = read_psd(path)
    assert len(artwork.layers) == 61
    assert artwork.layers[3].pixels.size == 0
    assert flattened(artwork).shape == (HEIGHT, WIDTH, 4)


def test_a_file_without_layers_is_its_picture(tmp_path: Path) -> None:
    picture = opaque(1)
    PSDImage.frompil(picture).save(tmp_path / "flat.psd")
    artwork = read_psd(tmp_path / "flat.psd")
    assert np.array_equal(flattened(artwork)[..., :3], np.asarray(picture))
    assert artwork.warnings == ("the file has no layers that can be read: its picture is taken as one",)


def test_sizes_of_a_thousand_million_are_refused(tmp_path: Path) -> None:
    psd = document()
    psd.create_pixel_layer(noise(2), name="hair")
    psd[1]._record.right = 10**9
    psd[1]._record.bottom = 10**9
    path = tmp_path / "art.psd"
    as_it_is(psd, path)
    with pytest.raises(InvalidInputError, match=r"layer hair must have .*Got: 1000000000 x 1000000000 px"):
        read_psd(path)


def test_layers_that_need_too_much_memory_together_are_refused(tmp_path: Path) -> None:
    psd = document()
    for number in range(40):
        psd.create_pixel_layer(noise(2), name=str(number))
        psd[number + 1]._record.right = psd[number + 1]._record.bottom = 5000
    path = tmp_path / "art.psd"
    as_it_is(psd, path)
    with pytest.raises(InvalidInputError, match="at most 2 GiB for its layers"):
        read_psd(path)


def test_layers_far_away_are_refused_before_anything_is_as_large(tmp_path: Path) -> None:
    psd = document()
    layers = [psd.create_pixel_layer(noise(n), name=f"layer {n}") for n in range(2)]
    group = psd.create_group(layers, name="group")
    group.opacity = 90
    for place, said in (
        (200_000, "layers of a group must lie within"),
        (2_000_000_000, "layer 1 must lie within 300000 px"),
    ):
        psd = PSDImage.open(saved(psd, tmp_path))
        record = psd[1][1]._record
        height, width = record.bottom - record.top, record.right - record.left
        record.left = record.top = place
        record.bottom, record.right = place + height, place + width
        as_it_is(psd, tmp_path / "art.psd")
        with pytest.raises(InvalidInputError, match=said):
            read_psd(tmp_path / "art.psd")
        record.left = record.top = 0
        record.bottom, record.right = height, width


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    psd = document()
    layer = psd.create_pixel_layer(noise(2), name="hair", compression=2)
    layer.create_mask(noise(5, 10, 12).getchannel("A"))
    psd.create_group([layer], name="group")
    psd.create_pixel_layer(noise(3), name="skirt", compression=3).clipping = True
    return saved(psd, tmp_path_factory.mktemp("whole")).read_bytes()


@pytest.mark.parametrize("kind", ["cut", "flip", "fill"])
def test_a_damaged_file_gets_one_sentence(whole: bytes, tmp_path: Path, kind: str) -> None:
    random = np.random.default_rng(8)
    path = tmp_path / "art.psd"
    refused = 0
    for place in random.integers(0, len(whole), 170):
        damaged = bytearray(whole)
        if kind == "cut":
            del damaged[place:]
        else:
            damaged[place : place + 4] = random.bytes(4) if kind == "flip" else b"\x7f\xff\xff\xff"
        path.write_bytes(damaged)
        try:
            flattened(read_psd(path))
        except InvalidInputError:
            refused += 1
    assert refused > 0


def test_what_is_no_psd(tmp_path: Path) -> None:
    (tmp_path / "art.psd").write_bytes(b"not one")
    with pytest.raises(InvalidInputError, match="begins with 8BPS"):
        read_psd(tmp_path / "art.psd")
    with pytest.raises(InvalidInputError, match="existing file"):
        read_psd(tmp_path / "none.psd")
    with pytest.raises(InvalidInputError, match="readable file"):
        read_psd(tmp_path)


def with_path(layer: Any) -> None:
    """Give a layer a path of Photoshop's: a rectangle in shares of the canvas."""
    corners = [(0.25, 0.25), (0.25, 0.75), (0.75, 0.75), (0.75, 0.25)]
    outline = ClosedPath([ClosedKnotLinked(corner, corner, corner) for corner in corners], operation=1)
    setting = VectorMaskSetting(path=Outline([PathFillRule(), outline]))
    layer._record.tagged_blocks[Tag.VECTOR_MASK_SETTING1] = TaggedBlock(key=Tag.VECTOR_MASK_SETTING1, data=setting)


def test_a_drawn_mask(tmp_path: Path) -> None:
    psd = document()
    with_path(psd.create_pixel_layer(opaque(4), name="hair"))
    artwork = read_psd(saved(psd, tmp_path))
    wanted = Image.new("L", (WIDTH, HEIGHT))
    ImageDraw.Draw(wanted).rectangle((WIDTH // 4, HEIGHT // 4, WIDTH * 3 // 4 - 1, HEIGHT * 3 // 4 - 1), 255)
    assert np.array_equal(artwork.layers[1].pixels[..., 3], np.asarray(wanted))


def test_the_soft_edge_of_a_shape_counts_once(tmp_path: Path) -> None:
    """Photoshop writes a shape's coverage as its alpha, as its path, and sometimes as a mask as well."""
    psd = document()
    drawn = noise(4, HEIGHT, WIDTH)
    layer = psd.create_pixel_layer(drawn, name="ribbon")
    layer.create_mask(drawn.getchannel("A"))
    layer.mask.data.flags = MaskFlags(user_mask_from_render=True)
    layer._record.flags.pixel_data_irrelevant = True
    with_path(layer)
    read = read_psd(saved(psd, tmp_path)).layers[1].pixels
    assert np.array_equal(read[..., 3], np.asarray(drawn)[..., 3])


def test_groups_as_layers_on_request(tmp_path: Path) -> None:
    psd = document()
    first, second, third = (psd.create_pixel_layer(noise(n), name=str(n), top=3 * n, left=4 * n) for n in range(3))
    inner = psd.create_group([first], name="inner")
    group = psd.create_group([inner, second], name="hair")
    group.opacity = 120
    third.move_to(psd)
    path = saved(psd, tmp_path)
    artwork = read_psd(path, groups=True)
    assert sorted(artwork.names) == ["2", "hair", "paper"]
    assert artwork.layers[artwork.names.index("hair")].opacity == 120 / 255
    assert artwork.warnings == ()
    assert np.abs(times_alpha(flattened(artwork)) - own_composite(path)).max() <= 2


def test_layers_clipped_to_a_group(tmp_path: Path) -> None:
    psd = document()
    layers = [psd.create_pixel_layer(hard_edged(n), name=str(n), top=3 * n, left=9 * n) for n in range(2)]
    psd.create_group(layers, name="head")
    psd.create_pixel_layer(noise(8, 25, 25), name="shade", top=2, left=2).clipping = True
    artwork = assert_same_picture(saved(psd, tmp_path))
    assert artwork.names == ("paper", "head")
    assert artwork.warnings == ("layers are clipped to group head: it is read as one layer",)


@pytest.mark.parametrize(("mode", "count"), [("NORMAL", 1), ("PASS_THROUGH", 0)])
def test_a_mode_that_its_group_shuts_in_is_told(tmp_path: Path, mode: str, count: int) -> None:
    psd = document()
    layers = [psd.create_pixel_layer(hard_edged(n), name=str(n), top=3 * n, left=9 * n) for n in range(2)]
    layers[1].blend_mode = BlendMode.MULTIPLY
    psd.create_group(layers, name="head").blend_mode = BlendMode[mode]
    warnings = read_psd(saved(psd, tmp_path)).warnings
    assert len(warnings) == count
    assert all("reaches beyond what is drawn in group head" in each for each in warnings)


def test_names_are_never_alike() -> None:
    pixels = np.zeros((0, 0, 4), np.uint8)
    given = ("a", "a (2)", "a", "a", " ", "layer 5", "a (3)", "a")
    names = Artwork(1, 1, tuple(ArtLayer(name, pixels) for name in given)).names
    assert names == ("a", "a (2)", "a (4)", "a (5)", "layer 5", "layer 5 (2)", "a (3)", "a (6)")
