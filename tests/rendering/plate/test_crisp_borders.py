"""Borders in a hole are drawn, not fogged: as sharp as the nearest known ones, between the areas that belong there."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.plate import fill_hole
from physanimator.rendering.plate.border_softness import carried, most_unsure
from physanimator.rendering.plate.patch_synthesis import continue_texture

HEIGHT, WIDTH = 200, 260
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
WALL, SLEEVE, BOW, INK = (0.95, 0.92, 0.85), (0.55, 0.7, 0.55), (0.9, 0.6, 0.15), (0.2, 0.08, 0.15)
PART = np.float32((0.1, 0.1, 0.6))


def drawn(*layers: tuple[np.ndarray, tuple[float, ...]], ground: tuple[float, ...], noise: float = 0.0) -> np.ndarray:
    """Areas one over the other, with the edges of drawn art."""
    picture = np.broadcast_to(np.float32(ground), (HEIGHT, WIDTH, 3)).copy()
    for where, colour in layers:
        picture[where] = colour
    picture = cv2.GaussianBlur(picture, (0, 0), 0.6)
    picture += np.random.default_rng(0).normal(0, noise, picture.shape).astype(np.float32)
    return np.clip(picture, 0, 1).astype(np.float32)


def filled(picture: np.ndarray, hole: np.ndarray) -> np.ndarray:
    return fill_hole(np.where(hole[..., None], PART, picture).astype(np.float32), hole)


def border_width(picture: np.ndarray, where: np.ndarray, one: tuple[float, ...], other: tuple[float, ...]) -> float:
    """Mean deviation of the blur of all borders between two colours [px], wherever they run.

    With t the share of the one: over a border of length l the sum of t (1 - t) is l sigma / sqrt(pi), and that of the
    slope of t is l.
    """
    way = np.float32(other) - np.float32(one)
    share = np.clip(cv2.GaussianBlur((picture - np.float32(one)) @ way / (way @ way), (0, 0), 0.5), 0, 1)
    slope = np.hypot(cv2.Sobel(share, -1, 1, 0, scale=1 / 8), cv2.Sobel(share, -1, 0, 1, scale=1 / 8))
    return float(np.sqrt(np.pi) * (share * (1 - share))[where].sum() / slope[where].sum())


@pytest.fixture(autouse=True)
def _without_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave the border to the areas: a line with both ends in sight would be drawn in its own profile."""
    monkeypatch.setattr(
        "physanimator.rendering.plate.plate.continue_lines", lambda picture, hole: (picture, np.zeros_like(hole))
    )


def corner(*, noise: float = 0.0) -> np.ndarray:
    """A sleeve's lower corner: one border comes in level, the other one upright."""
    return drawn(((X < 130) & (Y < 100), SLEEVE), ground=WALL, noise=noise)


AROUND_CORNER = np.hypot(X - 130, Y - 100) < 50
WITHIN = np.hypot(X - 130, Y - 100) < 46


@pytest.mark.parametrize(("noise", "most"), [(0.0, 2.6), (0.008, 3.6)])
@pytest.mark.parametrize("square", [40, 50])
def test_sharp_borders_of_unsure_course_are_no_haze(square: int, noise: float, most: float) -> None:
    """Borders come in both ways everywhere, so that none of them is sure. The truth is .6 px wide."""
    truth = drawn(((X // square + Y // square) % 2 > 0, SLEEVE), ground=WALL, noise=noise)
    hole = np.hypot(X - 130, Y - 100) < 40
    inner = np.hypot(X - 130, Y - 100) < 36
    assert border_width(truth, inner, WALL, SLEEVE) < 1.1
    assert border_width(filled(truth, hole), inner, WALL, SLEEVE) < most


def test_a_soft_border_of_unsure_course_stays_soft() -> None:
    soft = cv2.GaussianBlur(corner(), (0, 0), 5)
    widths = [border_width(filled(each, AROUND_CORNER), WITHIN, WALL, SLEEVE) for each in (corner(), soft)]
    assert widths[1] > max(4, 1.7 * widths[0])


def test_how_unsure_a_border_may_look_grows_with_the_depth_alone() -> None:
    limit = most_unsure(np.maximum(80 - np.hypot(X - 130, Y - 100), 0).astype(np.float32))
    assert limit[100, 52] < 2
    assert (np.diff(limit[100, 52:130]) >= 0).all()
    assert limit[100, 130] > 2 * limit[100, 52]


def test_a_few_soft_profiles_do_not_soften_a_sharp_border() -> None:
    """Nine of the known pieces of a border are sharp, and two met something else."""
    known = np.full(11, 100), np.arange(40, 62, 2)
    pairs = np.tile(np.int32([1, 2]), (11, 1))
    soft = np.where(np.isin(np.arange(11), (4, 8)), 6.0, 0.5)
    wanted = np.full(20, 100), np.arange(64, 84)
    assert carried(soft, known, pairs, wanted, np.tile(np.int32([1, 2]), (20, 1)))[4:] == pytest.approx(0.5)


def textured(scale: float = 5.0) -> np.ndarray:
    """A ground without flat areas: windows and shrubs far behind."""
    rng = np.random.default_rng(3)
    noise = cv2.GaussianBlur(rng.normal(0, 1, (HEIGHT, WIDTH, 3)), (0, 0), scale / 3)
    return np.clip(np.array((0.4, 0.45, 0.75)) + 0.12 * noise / noise.std(), 0, 1).astype(np.float32)


def test_an_area_is_known_again_in_a_narrow_gap() -> None:
    """A sleeve before a textured ground; in its middle seams leave some pixels of it beside the hole.

    Its colour there goes on as an area, and does not run out into the ground.
    """
    upright, level = (np.abs(X - 110) < 1.5), (X > 108) & (X < 120) & ((Y - 97) % 12 < 2.5)
    seams = (upright | level) & (Y > 96) & (Y < 136)
    truth = np.where((X < 150)[..., None], drawn((X < 150, SLEEVE), (seams, INK), ground=WALL), textured())
    hole = (np.abs(Y - 100) < 60) & (X > 117) & (X < 190)
    plate = filled(truth.astype(np.float32), hole)
    like = np.abs(plate - SLEEVE).max(axis=2) < 0.03
    assert like[hole & (np.abs(Y - 116.5) < 17) & (X < 127)].mean() > 0.97


def bow(*, open_end: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """A bow with its outline, before the sky; its lower side lies before the hole, its outline known."""
    inside = 26 - np.hypot((X - 130) / 1.6, Y - 60)
    picture = drawn((inside > 0, INK), (inside > 3, BOW), ground=WALL)
    hole = (np.abs(X - 130) < 34) & (Y > 60) & (Y < 150) & (inside < (8 if open_end else 0))
    return picture, hole


def orange(plate: np.ndarray, hole: np.ndarray) -> int:
    return int((hole & (plate[..., 2] < 0.5) & (plate[..., 0] > 0.6)).sum())


def test_what_ends_with_its_own_outline_does_not_go_on_behind_the_part() -> None:
    picture, hole = bow()
    assert orange(filled(picture, hole), hole) < 20


def test_what_meets_the_part_without_an_outline_does() -> None:
    picture, hole = bow(open_end=True)
    assert orange(filled(picture, hole), hole) > 60


def test_a_rest_of_the_parts_outline_encloses_nothing() -> None:
    """A mask without the part's outline leaves it along all of the rim, where only light areas show it."""
    hole = np.hypot(X - 130, Y - 100) < 40
    truth = drawn((Y > 110, (0.3, 0.12, 0.2)), ground=WALL)
    line = (np.hypot(X - 130, Y - 100) < 42) & ~hole
    plate = filled(np.where(line[..., None], np.float32(INK), truth), hole)
    above = (np.hypot(X - 130, Y - 100) < 32) & (Y < 95)
    assert (np.abs(plate - WALL).max(axis=2) < 0.15)[above].mean() > 0.8


def test_patches_come_from_what_is_of_the_same_kind() -> None:
    """Bright dots on both sides, of two kinds in grey and in red: a guide in between leaves open which to take."""
    rng = np.random.default_rng(1)
    picture = np.full((80, 120, 3), 0.5, np.float32)
    dots = rng.random((80, 120)) < 0.25
    picture[dots] = (0.9, 0.2, 0.2)
    picture[dots & (np.arange(120) < 60)] = (0.55, 0.55, 0.55)
    hole = np.zeros((80, 120), bool)
    hole[20:60, 30:90] = True
    guide = np.broadcast_to(np.float32((0.56, 0.46, 0.46)), picture.shape).copy()
    kind = np.broadcast_to(np.float32(np.arange(120) < 80), (80, 120)).copy()
    red = [
        int((hole & (np.arange(120) < 76) & (result[..., 0] - result[..., 1] > 0.15)).sum())
        for result in (continue_texture(picture, hole, guide, kind=each) for each in (kind, None))
    ]
    assert red[0] < 0.9 * red[1]
