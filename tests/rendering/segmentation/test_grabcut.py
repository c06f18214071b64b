"""Masks from clicks: near-exact on flat art, and never against a click."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from painted_art import DAMAGES, PARTS, TECHNIQUES, painted, points_in
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.pictures import load_image, load_mask
from physanimator.rendering.segmentation import segment
from physanimator.rendering.segmentation.noise import sharpness_of
from physanimator.rendering.segmentation.outline_cuts import without_foreign_lines

EXAMPLE = Path(__file__).resolve().parents[3] / "workflows" / "example"
WIDTH, HEIGHT = 200, 150
Mask = NDArray[np.bool_]


def overlap(a: Mask, b: Mask) -> float:
    """Intersection over union."""
    return float((a & b).sum() / (a | b).sum())


def page(noise: float = 0.0) -> NDArray[np.uint8]:
    picture = np.full((HEIGHT, WIDTH, 3), (120, 160, 220), np.float32)
    picture[:, 120:] = (200, 190, 120)
    picture += np.random.default_rng(0).normal(0, noise, picture.shape)
    return np.clip(picture, 0, 255).astype(np.uint8)


def disc(x: int, y: int, radius: int) -> Mask:
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    return np.hypot(columns + 0.5 - x, rows + 0.5 - y) <= radius


@pytest.mark.parametrize("noise", [0.0, 4.0])
def test_a_flat_shape_from_one_click(noise: float) -> None:
    picture, shape = page(noise), disc(90, 70, 40)
    picture[shape] = (220, 80, 70)
    mask = segment(picture, [(90, 70)], [1])
    assert mask.dtype == bool
    assert mask.shape == (HEIGHT, WIDTH)
    assert overlap(mask, shape) > 0.97


def test_the_outline_belongs_to_the_object() -> None:
    picture, shape = page(), disc(90, 70, 42)
    picture[shape] = (40, 20, 30)
    picture[disc(90, 70, 40)] = (220, 80, 70)
    assert overlap(segment(picture, [(90, 70)], [1]), shape) > 0.97


def test_a_shaded_shape_in_two_halves_from_two_clicks() -> None:
    picture, shape = page(), disc(90, 70, 40)
    light = (np.linspace(0.6, 1.0, WIDTH)[None, :, None] * np.array([220.0, 80.0, 70.0])).astype(np.uint8)
    picture[shape] = np.broadcast_to(light, picture.shape)[shape]
    picture[shape & (np.arange(WIDTH) // 2 == 45)] = 30
    assert overlap(segment(picture, [(70, 70), (110, 70)], [1, 1]), shape) > 0.95


def test_a_shape_that_fills_most_of_the_picture() -> None:
    picture, shape = page(), disc(100, 75, 74)
    picture[shape] = (220, 80, 70)
    assert overlap(segment(picture, [(90, 70)], [1]), shape) > 0.97


def test_only_the_clicked_one_of_two_equal_shapes() -> None:
    picture = page()
    left, right = disc(50, 70, 30), disc(150, 70, 30)
    picture[left | right] = (220, 80, 70)
    assert overlap(segment(picture, [(50, 70)], [1]), left) > 0.97


def test_a_small_gap_is_closed_and_a_large_one_stays() -> None:
    picture, shape = page(), disc(90, 70, 50)
    picture[shape] = (220, 80, 70)
    speck, window = disc(60, 70, 2), disc(110, 70, 15)
    picture[speck | window] = (250, 250, 250)
    mask = segment(picture, [(90, 40)], [1], largest_hole=0.001)
    assert mask[speck].all()
    assert not mask[disc(110, 70, 10)].any()


@pytest.mark.parametrize("seed", range(4))
def test_every_click_is_obeyed_whatever_the_colours_say(seed: int) -> None:
    generator = np.random.default_rng(seed)
    picture = cv2.GaussianBlur(generator.integers(0, 255, (HEIGHT, WIDTH, 3), np.uint8), (0, 0), 3)
    picture = cv2.normalize(picture, None, 0, 255, cv2.NORM_MINMAX)
    cells = generator.permutation(WIDTH * HEIGHT)[:8]
    points = np.stack([cells % WIDTH, cells // WIDTH], axis=1) + 0.5
    labels = [1, 0, 1, 0, 1, 0, 1, 0]
    mask = segment(picture, points, labels)
    rows, columns = points.astype(int)[:, 1], points.astype(int)[:, 0]
    assert mask[rows, columns].tolist() == [bool(label) for label in labels]


def test_a_picture_of_one_colour_still_obeys() -> None:
    mask = segment(np.full((HEIGHT, WIDTH, 3), 90, np.uint8), [(10, 10), (150, 100)], [1, 0])
    assert mask[10, 10]
    assert not mask[100, 150]


def test_a_box_alone_finds_the_shape_in_it() -> None:
    picture, shape = page(), disc(90, 70, 30)
    picture[shape] = (220, 80, 70)
    mask = segment(picture, np.zeros((0, 2)), [], box=(50, 30, 130, 110))
    assert overlap(mask, shape) > 0.95


def test_nothing_outside_a_box_is_selected() -> None:
    picture, shape = page(), disc(90, 70, 40)
    picture[shape] = (220, 80, 70)
    mask = segment(picture, [(80, 70)], [1], box=(0, 0, 90, HEIGHT))
    assert not mask[:, 90:].any()
    assert overlap(mask, shape & (np.arange(WIDTH) < 90)) > 0.95


def test_equal_clicks_give_equal_masks_and_float_pictures_too() -> None:
    generator = np.random.default_rng(3)
    picture = cv2.GaussianBlur(generator.integers(0, 255, (HEIGHT, WIDTH, 3), np.uint8), (0, 0), 6)
    picture = cv2.normalize(picture, None, 0, 255, cv2.NORM_MINMAX)
    clicks = [(60, 60), (120, 90), (20, 20)], [1, 1, 0]
    first = segment(picture, *clicks)
    for seed in range(5):
        cv2.setRNGSeed(seed)
        np.testing.assert_array_equal(first, segment(picture, *clicks))
    np.testing.assert_array_equal(first, segment(picture.astype(np.float32) / 255, *clicks))


def test_a_large_picture_is_cut_at_its_own_resolution() -> None:
    picture, shape = cv2.resize(page(), None, fx=6, fy=6), np.zeros((6 * HEIGHT, 6 * WIDTH), np.uint8)
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    tips = np.where(np.arange(24) % 2, 120, 330)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    cv2.fillPoly(shape, [np.rint(tips + np.array([560, 450])).astype(np.int32)], 1)
    picture[shape > 0] = (220, 80, 70)
    assert overlap(segment(picture, [(560, 450)], [1]), shape > 0) > 0.985


@pytest.mark.parametrize(
    ("points", "labels", "options", "message"),
    [
        ([(10, 10)], [0], {}, "with one on the part at least"),
        ([], [], {}, "with one on the part at least"),
        ([(10, 10), (300, 10)], [1, 1], {}, r"points\[1\] must lie inside the picture of 200 x 150 px"),
        ([(10, 10)], [1, 0], {}, r"labels must be one per point \(1\)"),
        ([(10.2, 10), (10.7, 10.4)], [1, 0], {}, "not both at one pixel"),
        ([(0.4, 0.5), (0.7, 0.5)], [1, 0], {}, "if these are normalised, multiply x by the picture's width"),
        ([(10, 10)], [1], {"box": (300, 0, 400, 10)}, "box must be"),
        ([(10, 10), (50, 50)], [1, 1], {"box": (0, 0, 20, 20)}, r"points\[1\] must lie inside the box"),
    ],
)
def test_bad_input(points: Any, labels: Any, options: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        segment(page(), points, labels, **options)


def test_a_grey_picture_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="image must be an RGB picture"):
        segment(np.zeros((10, 10), np.uint8), [(5, 5)], [1])


CLICKS = {
    "cape": ([(690, 540), (650, 520), (360, 420), (535, 410)], [1, 1, 0, 0], 0.8),
    "ribbon": ([(490, 70), (600, 110), (700, 50), (760, 85)], [1, 1, 1, 1], 0.92),
    "hair": ([(720, 160), (760, 220), (780, 310), (445, 90), (450, 260)], [1, 1, 1, 0, 0], 0.78),
}


@pytest.mark.parametrize("part", CLICKS)
def test_parts_of_the_example_from_at_most_five_clicks(part: str) -> None:
    picture = load_image(EXAMPLE / "illustration.png")
    truth = load_mask(EXAMPLE / f"mask_{part}.png", width=1280, height=720) > 0.5
    points, labels, least = CLICKS[part]
    assert overlap(segment(picture, points, labels), truth) > least


def test_strands_between_drawn_lines_are_one_lock() -> None:
    """Six strands of one colour with lines between them, beside a wall of another: one click and one beside."""
    picture, lock = page(), np.zeros((HEIGHT, WIDTH), bool)
    lock[20:130, 30:102] = True
    picture[lock] = (200, 110, 60)
    for x in range(30, 103, 12):
        picture[20:130, x - 1 : x + 1] = (60, 20, 20)
    assert overlap(segment(picture, [(36, 70), (60, 70), (96, 70), (170, 70)], [1, 1, 1, 0]), lock) > 0.9


def test_a_line_that_goes_on_outside_stays_with_its_neighbour() -> None:
    """A dark shape that a dark line of another thing runs into: the line is left out, a tip of the shape is not."""
    mask, lines = disc(90, 70, 40), np.zeros((HEIGHT, WIDTH), bool)
    lines[69:72, 125:190] = True  # runs on to the right
    lines[20:35, 89:92] = True  # ends in a tip
    cut = mask.copy()
    cut[69:72, 125:145] = True
    cut[20:35, 89:92] = True
    kept = without_foreign_lines(cut, lines, widest=2)
    assert not kept[69:72, 136:145].any()
    assert kept[20:35, 89:92].all()
    assert kept[mask].all()


def test_crumbs_without_a_click_are_left_out() -> None:
    """Dark lines of a neighbour that has the part's colour, next to it but not of it."""
    picture, shape = page(), disc(70, 70, 40)
    picture[shape] = (40, 24, 30)
    for x in (118, 126, 134):
        picture[60:66, x : x + 2] = (40, 24, 30)
    mask = segment(picture, [(70, 70)], [1])
    assert overlap(mask, shape) > 0.95
    assert not mask[:, 116:].any()


@pytest.mark.parametrize("scale", [1, 2, 5])
def test_parts_of_a_few_pixels_are_cut_from_a_sprite(scale: int) -> None:
    sprite, parts = np.full((32, 32, 3), (92, 148, 252), np.uint8), {}
    sprite[24:] = (0, 168, 0)
    sprite[8:26, 10:22] = (248, 184, 136)
    places = {
        "gem": (15, 18, 3, 3, (216, 40, 200)),
        "eye": (12, 14, 2, 2, (0, 0, 0)),
        "foot": (10, 26, 4, 3, (60,) * 3),
    }
    for name, (x, y, columns, rows, colour) in places.items():
        parts[name] = np.zeros((32, 32), bool)
        parts[name][y : y + rows, x : x + columns] = True
        sprite[parts[name]] = colour
    large = sprite.repeat(scale, axis=0).repeat(scale, axis=1)
    for name, (x, y, columns, rows, _) in places.items():
        click = ((x + columns / 2) * scale, (y + rows / 2) * scale)
        truth = parts[name].repeat(scale, axis=0).repeat(scale, axis=1)
        assert overlap(segment(large, [click], [1]), truth) > (0.99 if scale < 5 else 0.75), name


def test_a_box_in_a_sprite() -> None:
    sprite = np.full((32, 32, 3), (92, 148, 252), np.uint8)
    sprite[10:16, 10:16] = (216, 40, 200)
    mask = segment(sprite, np.zeros((0, 2)), [], box=(8, 8, 18, 18))
    assert mask.sum() == 36


@pytest.mark.parametrize("technique", TECHNIQUES)
@pytest.mark.parametrize("part", PARTS)
def test_art_without_outlines_gives_a_usable_first_cut(technique: str, part: str) -> None:
    picture, truth = painted(technique, part, width=240, height=180, seed=5)
    for on, beside, least in ((1, 0, 0.3), (7, 7, 0.7)):
        points = points_in(truth, on, beside, seed=on)
        assert overlap(segment(picture, points[:, :2], points[:, 2]), truth) > least, (on, beside)


@pytest.mark.parametrize("damage", ["repainted", "noisy", "photo", "jpeg20", "posterised"])
def test_damaged_art_gives_a_usable_cut(damage: str) -> None:
    picture, shape = page(), disc(90, 70, 40)
    picture[shape] = (220, 80, 70)
    damaged, _ = DAMAGES[damage](picture, shape)
    assert overlap(segment(damaged, [(90, 70)], [1]), shape) > 0.85


@pytest.mark.parametrize("on", [1, 3])
def test_an_airbrushed_part_does_not_leak_over_its_soft_edge(on: int) -> None:
    """From points on it alone; small steps of colour lead out of it everywhere."""
    picture, truth = painted("airbrush", "wing", width=640, height=480, seed=1)
    points = points_in(truth, on, 0, seed=100 * on)
    assert overlap(segment(picture, points[:, :2], points[:, 2]), truth) > 0.85


def test_sharpness_is_that_of_the_edges_whatever_their_number() -> None:
    picture = cv2.cvtColor(page(), cv2.COLOR_RGB2Lab)
    picture[:, 120:, 0] = 60
    assert sharpness_of(picture) == 1
    assert 0.15 < sharpness_of(cv2.GaussianBlur(picture, (0, 0), 2.5)) < 0.3
    assert sharpness_of(np.full((20, 20, 3), 90, np.uint8)) == 1
    row = np.where(np.arange(20) < 10, 40, 200).astype(np.uint8)[None, :, None].repeat(3, axis=2)
    assert sharpness_of(row) == sharpness_of(row.transpose(1, 0, 2).copy()) == 1


def test_strokes_of_a_brush_are_no_regions() -> None:
    """Texture of three pixels, which no filter of single pixels takes for noise."""
    picture, shape = page(), disc(90, 70, 40)
    picture[shape] = (120, 70, 50)
    strokes = np.random.default_rng(3).normal(0, 30, (HEIGHT // 3, WIDTH // 3)).repeat(3, axis=0).repeat(3, axis=1)
    picture = np.clip(picture + np.pad(strokes, ((0, 0), (0, WIDTH - strokes.shape[1])))[..., None], 0, 255)
    mask = segment(picture.astype(np.uint8), [(90, 70), (70, 60), (100, 90)], [1, 1, 1])
    assert overlap(mask, shape) > 0.8


def folded(width: int, noise: float) -> tuple[NDArray[np.uint8], Mask]:
    """A disc with an outline, and with a fold that begins at its top and ends within it, at columns from 86 on."""
    picture, shape = page(), disc(90, 70, 42)
    picture[shape] = (60, 30, 30)
    picture[disc(90, 70, 42 - width)] = (220, 80, 70)
    picture[30:90, 86 : 86 + width] = (90, 25, 30)
    shaken = picture + np.random.default_rng(1).normal(0, noise, picture.shape)
    return np.clip(shaken, 0, 255).astype(np.uint8), shape


@pytest.mark.parametrize("noise", [0.0, 5.0])
@pytest.mark.parametrize("width", [1, 2, 3, 4, 5])
def test_a_click_on_a_line_means_what_the_line_is_drawn_on(width: int, noise: float) -> None:
    """On a fold and on the outline, on their middles and on both of their edges."""
    picture, shape = folded(width, noise)
    for along in {0.5, width / 2, width - 0.5}:
        for click in ((86 + along, 60), (48 + along, 70)):
            mask = segment(picture, [click], [1])
            assert overlap(mask, shape) > 0.8, click
            assert mask[int(click[1]), int(click[0])]


def test_a_click_on_a_line_between_two_colours_means_one_side() -> None:
    picture, left = page(), disc(90, 70, 42)
    right = left & (np.arange(WIDTH) >= 92)
    picture[left] = (220, 80, 70)
    picture[right] = (60, 140, 70)
    picture[left & (np.arange(WIDTH) >= 89) & (np.arange(WIDTH) < 92)] = 20
    assert overlap(segment(picture, [(89.2, 70)], [1]), left & ~right) > 0.85
    assert overlap(segment(picture, [(91.8, 70)], [1]), right) > 0.85


def test_a_click_on_a_line_never_takes_what_a_point_beside_excludes() -> None:
    picture, shape = folded(3, 0.0)
    picture[30:112, 86:89][shape[30:112, 86:89]] = (90, 25, 30)
    mask = segment(picture, [(87.5, 60), (110, 70)], [1, 0])
    assert not mask[70, 110]
    assert mask[70, 65]
    assert mask[60, 87]


def test_a_rope_before_the_sky_is_no_line() -> None:
    picture = page()
    picture[:] = (120, 160, 220)
    rope = np.zeros((HEIGHT, WIDTH), bool)
    rope[:, 98:102] = True
    picture[rope] = (60, 30, 30)
    assert overlap(segment(picture, [(100, 70)], [1]), rope) > 0.7


@pytest.mark.parametrize("technique", TECHNIQUES)
def test_a_click_on_a_line_over_paint(technique: str) -> None:
    picture, truth = painted(technique, "skirt", width=320, height=240, seed=2)
    usable = 0
    for x, y in points_in(truth, 5, 0, seed=3)[:, :2]:
        lined = picture.copy()
        cv2.line(lined, (int(x), int(y) - 25), (int(x), int(y) + 25), (25, 15, 15), 3, cv2.LINE_AA)
        mask = segment(lined, [(x, y)], [1])
        usable += mask.sum() > 0.1 * truth.sum() and (mask & truth).sum() > 0.7 * mask.sum()
    assert usable >= 3
