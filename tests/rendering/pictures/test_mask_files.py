"""Which part a painted picture means: white, one colour, or the opacity; and what cannot mean one part."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.pictures import load_mask
from physanimator.rendering.pictures.mask_files import read_mask
from PIL import Image, ImageFilter

HEIGHT, WIDTH = 90, 120
COLOURS = {
    "white": (255, 255, 255),
    "red": (255, 0, 0),
    "green": (0, 255, 0),
    "blue": (0, 0, 255),
    "dark blue": (0, 0, 128),
    "dark red": (128, 0, 0),
    "pink": (230, 120, 140),
    "grey": (128, 128, 128),
    "dark grey": (40, 40, 40),
    "one": (1, 1, 1),
}


def disc(soft: float = 0.0) -> np.ndarray:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    picture = Image.fromarray(((np.hypot(x - 50, y - 40) < 25) * 255).astype(np.uint8))
    return np.asarray(picture.filter(ImageFilter.GaussianBlur(soft)) if soft else picture) / 255.0


def painted(shares: np.ndarray, part: tuple[int, ...], rest: tuple[int, ...]) -> np.ndarray:
    return np.rint(shares[..., None] * np.array(part) + (1 - shares[..., None]) * np.array(rest)).astype(np.uint8)


def read(path: Path, picture: np.ndarray, **options: object) -> np.ndarray:
    Image.fromarray(picture).save(path, **options)
    return load_mask(path, width=WIDTH, height=HEIGHT)


def labels() -> np.ndarray:
    areas = np.zeros((HEIGHT, WIDTH), int)
    areas[10:40, 10:50], areas[50:80, 10:50], areas[20:70, 70:110] = 1, 2, 3
    return areas


@pytest.mark.parametrize("colour", COLOURS)
@pytest.mark.parametrize("soft", [0.0, 2.0])
def test_one_colour_on_black_is_the_part_as_soft_as_it_was(tmp_path: Path, colour: str, soft: float) -> None:
    if (colour, soft) == ("one", 2.0):
        pytest.skip("one level cannot be soft")
    mask = read(tmp_path / "a.png", painted(disc(soft), COLOURS[colour], (0, 0, 0)))
    assert np.abs(mask - disc(soft)).max() < 0.04


@pytest.mark.parametrize("colour", [each for each in COLOURS if each not in ("white", "dark grey", "one")])
@pytest.mark.parametrize("soft", [0.0, 2.0])
def test_one_colour_on_white_is_the_part_and_says_so(tmp_path: Path, colour: str, soft: float) -> None:
    Image.fromarray(painted(disc(soft), COLOURS[colour], (255, 255, 255))).save(tmp_path / "a.png")
    found = read_mask(tmp_path / "a.png", width=WIDTH, height=HEIGHT)
    assert np.abs(found.coverage - disc(soft)).max() < 0.04
    assert "on white was taken as the part" in found.notes[0]


def test_white_on_a_colour_is_the_part(tmp_path: Path) -> None:
    mask = read(tmp_path / "a.png", painted(disc(), (255, 255, 255), (200, 30, 30)))
    assert ((mask > 0.5) == (disc() > 0.5)).all()


@pytest.mark.parametrize("colour", ["white", "red", "blue", "pink"])
@pytest.mark.parametrize("quality", [60, 95])
def test_noise_of_jpeg_is_no_colour(tmp_path: Path, colour: str, quality: int) -> None:
    mask = read(tmp_path / "a.jpg", painted(disc(1.0), COLOURS[colour], (0, 0, 0)), quality=quality)
    assert ((mask > 0.5) != (disc() > 0.5)).mean() < 0.01


@pytest.mark.parametrize("colour", COLOURS)
def test_on_nothing_the_opacity_is_the_part(tmp_path: Path, colour: str) -> None:
    opacity = np.rint(disc(2.0) * 255).astype(np.uint8)
    rgba = np.dstack([np.broadcast_to(np.array(COLOURS[colour], np.uint8), (HEIGHT, WIDTH, 3)), opacity])
    assert np.abs(read(tmp_path / "a.png", rgba) - disc(2.0)).max() < 0.004


def test_a_cut_out_drawing_of_many_colours_counts_by_its_opacity(tmp_path: Path) -> None:
    colours = np.random.default_rng(0).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)
    rgba = np.dstack([colours, (disc() * 255).astype(np.uint8)])
    assert (read(tmp_path / "a.png", rgba) == disc()).all()


@pytest.mark.parametrize("opacity", [254, 0])
def test_a_pixel_that_is_not_opaque_decides_nothing(tmp_path: Path, opacity: int) -> None:
    rgba = np.dstack([painted(disc(), (255, 255, 255), (0, 0, 0)), np.full((HEIGHT, WIDTH), 255, np.uint8)])
    rgba[3, 3, 3] = opacity
    assert (read(tmp_path / "a.png", rgba) == disc()).all()


def test_white_counts_among_white_and_black_on_nothing(tmp_path: Path) -> None:
    opacity = np.zeros((HEIGHT, WIDTH), np.uint8)
    opacity[5:80, 10:100] = 255
    rgba = np.dstack([painted(disc(), (255, 255, 255), (0, 0, 0)), opacity])
    Image.fromarray(rgba).save(tmp_path / "a.png")
    found = read_mask(tmp_path / "a.png", width=WIDTH, height=HEIGHT)
    assert (found.coverage == disc()).all()
    assert "white was taken as the part" in found.notes[0]


def test_lines_drawn_in_a_white_part_do_not_make_it_a_mask(tmp_path: Path) -> None:
    rgba = np.dstack([painted(disc(), (255, 255, 255), (255, 255, 255)), (disc() * 255).astype(np.uint8)])
    rgba[::8, :, :3] = 0
    assert (read(tmp_path / "a.png", rgba) == disc()).all()


@pytest.mark.parametrize(
    ("colours", "message"),
    [
        ([0, 1, 2, 3], "3 grey levels besides black: 1 on .*, 2 on .*, 3 on"),
        ([0, 85, 170, 255], "3 grey levels besides black: 85 on"),
        ([0, 100, 200, 0], "2 grey levels"),
        ([(0, 0, 0), (255, 0, 0), (0, 255, 0), (0, 0, 255)], "4 colours: black [56].* blue 1. %, .*(green|red) 1. %"),
        ([(0, 0, 0), (128, 0, 0), (255, 0, 0), (0, 0, 0)], "2 shades of red"),
        ([(0, 0, 0), (255, 255, 255), (255, 0, 0), (0, 0, 0)], r"colours: black [78]\d %, .*red"),
        ([(0, 0, 255), (255, 0, 0), (0, 0, 255), (0, 0, 255)], r"colours: blue [789]\d %, red"),
        ([(255, 0, 0)] * 4, "one colour: red 100 %"),
        ([0] * 4, "black all over"),
    ],
)
@pytest.mark.parametrize("form", ["png", "jpg", "palette", "16 bits"])
def test_several_parts_are_refused_with_what_was_seen(
    tmp_path: Path, colours: list[int | tuple[int, int, int]], message: str, form: str
) -> None:
    picture = np.array(colours, np.uint8)[labels()]
    path = tmp_path / ("a.jpg" if form == "jpg" else "a.png")
    image = Image.fromarray(picture)
    if form == "jpg" and (picture.max() < 16 or "shades" in message):
        pytest.skip("JPEG does not keep them")
    if form == "16 bits":
        if picture.ndim == 3:
            pytest.skip("a plane only")
        image = Image.fromarray(picture.astype(np.uint16) * np.uint16(257 if picture.max() > 3 else 1))
    (image.quantize(16) if form == "palette" else image).save(path)
    with pytest.raises(InvalidInputError, match=message) as caught:
        load_mask(path, width=WIDTH, height=HEIGHT)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize("noise", [1, 2, 3])
@pytest.mark.parametrize("greys", [(85, 170, 255), (100, 200, 0), (40, 80, 120)])
def test_labels_with_noise_are_labels(tmp_path: Path, greys: tuple[int, ...], noise: int) -> None:
    picture = np.array([0, *greys])[labels()]
    picture += np.random.default_rng(0).integers(-noise, noise + 1, picture.shape)
    with pytest.raises(InvalidInputError, match=f"{np.count_nonzero(greys)} grey levels besides black: {greys[0]} on"):
        read(tmp_path / "a.png", np.clip(picture, 0, 255).astype(np.uint8))


@pytest.mark.parametrize("noise", [0, 1])
@pytest.mark.parametrize("greys", [4, 5, 6])
@pytest.mark.parametrize("form", ["across", "radial", "inside of a hard outline"])
def test_a_gradient_in_a_few_steps_is_one_soft_mask_and_says_so(
    tmp_path: Path, form: str, greys: int, noise: int
) -> None:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    if form == "radial":
        if greys > 4:
            pytest.skip("steps as narrow as these are read without a word")
        shares = np.clip(1.1 - np.hypot(x - 60, y - 45) / 44, 0, 1)
    else:
        shares = np.clip((x - 10) / 90, 0, 1)
    levels = np.rint(shares * (greys - 1)) / (greys - 1)
    if form.startswith("inside"):
        if greys == 4:
            pytest.skip("too few to tell")
        levels = np.where(abs(y - 45) < 30, levels, 0)
    picture = np.rint(levels * 255).astype(int)
    if noise:
        picture += np.random.default_rng(0).integers(-noise, noise + 1, picture.shape)
    Image.fromarray(np.clip(picture, 0, 255).astype(np.uint8)).save(tmp_path / "a.png")
    found = read_mask(tmp_path / "a.png", width=WIDTH, height=HEIGHT)
    assert np.abs(found.coverage - levels).max() < 0.04
    assert f"shows {greys - 1} shades in order" in found.notes[0]


def strands_that_fade(greys: int) -> np.ndarray:
    """Three slanting strands of unlike widths in shades across all of them, 0 on black."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    inside = ((abs(x - 25 - 0.2 * y) < 3) | (abs(x - 50 + 0.1 * y) < 9) | (abs(x - 80 - 0.3 * y) < 2)) & (y > 6)
    across = 1 - (x / WIDTH + y / HEIGHT) / 2
    return np.where(inside, (np.floor(np.clip(across, 0, 0.999) * greys) + 1) / greys, 0)


@pytest.mark.parametrize("greys", [24, 32])
def test_strands_that_fade_in_many_shades_are_one_part(tmp_path: Path, greys: int) -> None:
    shares = strands_that_fade(greys)
    Image.fromarray(np.rint(shares * 255).astype(np.uint8)).save(tmp_path / "a.png")
    found = read_mask(tmp_path / "a.png", width=WIDTH, height=HEIGHT)
    assert np.abs(found.coverage / found.coverage.max() - shares / shares.max()).max() < 0.04


def test_too_few_shades_to_tell_say_what_to_do(tmp_path: Path) -> None:
    Image.fromarray(np.rint(strands_that_fade(3) * 255).astype(np.uint8)).save(tmp_path / "a.png")
    with pytest.raises(InvalidInputError, match="of labels, save one as a mask of its own, and what fades in more"):
        load_mask(tmp_path / "a.png", width=WIDTH, height=HEIGHT)


@pytest.mark.parametrize("greys", [4, 6, 8, 16, 32])
@pytest.mark.parametrize("colour", ["white", "red"])
@pytest.mark.parametrize("highest", [1, 0.6])
def test_a_soft_mask_of_few_greys_is_one_part(tmp_path: Path, greys: int, colour: str, highest: float) -> None:
    soft = cv2.GaussianBlur(disc().astype(np.float32), (0, 0), 6)
    soft = highest * np.rint(soft * (greys - 1)) / (greys - 1)
    picture = np.rint(soft[..., None] * np.array(COLOURS[colour])).astype(np.uint8)
    found = read(tmp_path / "a.png", picture)
    assert np.abs(found / found.max() - soft / highest).max() < 0.04


def test_steps_that_lie_in_each_other_by_chance_are_labels(tmp_path: Path) -> None:
    picture = np.zeros((HEIGHT, WIDTH), np.uint8)
    for side, grey in ((0.9, 85), (0.5, 170), (0.2, 255)):
        picture[10 : int(HEIGHT * side), 10 : int(WIDTH * side)] = grey
    with pytest.raises(InvalidInputError, match=r"[23] grey levels"):
        read(tmp_path / "a.png", picture)


@pytest.mark.parametrize("form", ["gif", "png", "webp", "tiff"])
def test_the_first_of_several_is_used_and_told(tmp_path: Path, form: str) -> None:
    first, second = (Image.fromarray((each * 255).astype(np.uint8)).convert("RGB") for each in (disc(), 1 - disc()))
    for several in (False, True):
        path = tmp_path / f"{several}.{form}"
        more = {"save_all": True, "append_images": [second]} if several else {}
        first.save(path, **({"lossless": True} if form == "webp" else {}), **more)
        found = read_mask(path, width=WIDTH, height=HEIGHT)
        assert np.abs(found.coverage - disc()).max() < 0.05
        assert ["only the first is used" in note for note in found.notes] == [True] * several


def test_a_photograph_is_no_mask(tmp_path: Path) -> None:
    colours = np.random.default_rng(0).integers(0, 256, (HEIGHT // 10, WIDTH // 10, 3), dtype=np.uint8)
    Image.fromarray(colours).resize((WIDTH, HEIGHT), Image.Resampling.BICUBIC).save(tmp_path / "a.png")
    with pytest.raises(InvalidInputError, match="must show a mask, not a picture"):
        load_mask(tmp_path / "a.png", width=WIDTH, height=HEIGHT)


def test_a_grey_beside_white_and_black_counts_in_part_and_says_so(tmp_path: Path) -> None:
    picture = np.array([0, 128, 255, 0], np.uint8)[labels()]
    Image.fromarray(picture).save(tmp_path / "a.png")
    found = read_mask(tmp_path / "a.png", width=WIDTH, height=HEIGHT)
    assert np.abs(found.coverage - picture / 255).max() < 1e-6
    assert "grey (128 of 255) on" in found.notes[0]


@pytest.mark.parametrize("soft", [0.0, 1.0, 4.0])
def test_soft_masks_keep_every_level(tmp_path: Path, soft: float) -> None:
    mask = np.rint(disc(soft) * 255).astype(np.uint8)
    assert (np.rint(read(tmp_path / "a.png", mask) * 255) == mask).all()
    assert not read_mask(tmp_path / "a.png", width=WIDTH, height=HEIGHT).notes


@pytest.mark.parametrize(("colour", "said"), [(255, True), (0, False)])
def test_what_covers_most_of_the_picture_may_be_inverted(tmp_path: Path, colour: int, said: bool) -> None:
    Image.fromarray(np.where(disc() > 0.5, 255 - colour, colour).astype(np.uint8)).save(tmp_path / "a.png")
    found = read_mask(tmp_path / "a.png", width=WIDTH, height=HEIGHT)
    assert ["invert it" in note for note in found.notes] == [True] * said
    assert not said or "covers 82 % of the picture" in found.notes[0]


@pytest.mark.parametrize(("share", "said"), [(0.5, True), (0.0, False)])
def test_a_mask_of_noise_is_said_to_be_one_and_one_of_many_leaves_is_not(
    tmp_path: Path, share: float, said: bool
) -> None:
    size = 480, 640
    y, x = np.mgrid[: size[0], : size[1]]
    picture = (np.hypot(x % 24 - 12, y % 20 - 10) < 7) * 255 if not share else np.zeros(size)
    picture[np.random.default_rng(0).random(size) < share] = 255
    Image.fromarray(picture.astype(np.uint8)).save(tmp_path / "a.png")
    notes = read_mask(tmp_path / "a.png", width=size[1], height=size[0]).notes
    assert [note for note in notes if "specks of white" in note] == list(notes)
    assert bool(notes) == said
