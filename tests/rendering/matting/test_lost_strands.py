"""Strands that a shrunk mask has lost, drawn with an outline, and what must not be taken for one."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.matting import regular_mask

WIDTH, HEIGHT, FINE = 240, 180, 4
SKY, RED, INK, PAPER = (0.62, 0.77, 0.9), (0.8, 0.3, 0.25), (0.12, 0.06, 0.1), (0.95, 0.95, 0.9)
GREEN = (0.45, 0.75, 0.4)
BODY = [(30, 40), (90, 30), (110, 80), (95, 140), (40, 150), (22, 90)]
# Leaves the body to the right and bends; a little narrower than what shrinking takes off.
STRAND = [(100, 70), (130, 66), (160, 72), (185, 88), (205, 112)]

Mask = np.ndarray


def stroked(points: list[tuple[int, int]], width: float, fine: np.ndarray) -> np.ndarray:
    cv2.polylines(fine, [np.int32(points) * FINE], False, 1, round(width * FINE), cv2.LINE_AA)
    return fine


def coverage(fine: np.ndarray) -> Mask:
    return cv2.resize(fine.astype(np.float32), (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)


def blank() -> np.ndarray:
    return np.zeros((HEIGHT * FINE, WIDTH * FINE), np.uint8)


def body() -> np.ndarray:
    return cv2.fillPoly(blank(), [np.int32(BODY) * FINE], 1)


def outlined(fine: np.ndarray, width: float = 1.5) -> Mask:
    """Coverage of a shape with a line around it."""
    away = cv2.distanceTransform(1 - fine, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return coverage(away <= width * FINE)


def laid(
    picture: np.ndarray, fine: np.ndarray, colour: tuple[float, ...], ink: tuple[float, ...] | None = INK
) -> np.ndarray:
    """A shape over a picture, with its outline."""
    if ink is not None:
        picture = picture + outlined(fine)[..., None] * (np.float32(ink) - picture)
    return picture + coverage(fine)[..., None] * (np.float32(colour) - picture)


def sky(colour: tuple[float, ...] = SKY) -> np.ndarray:
    random = np.random.default_rng(0)
    spots = cv2.GaussianBlur(random.normal(0, 1, (HEIGHT, WIDTH, 3)).astype(np.float32), (0, 0), 2) * 0.08
    return np.clip(np.float32(colour) + spots, 0, 1).astype(np.float32)


def shrunk(mask: Mask, radius: int = 4) -> Mask:
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1,) * 2)
    return cv2.erode((mask > 0.5).astype(np.float32), disc)


def regular(picture: np.ndarray, mask: Mask) -> Mask:
    rounded = np.rint(np.clip(picture, 0, 1) * 255).astype(np.float32) / 255
    return regular_mask(rounded, mask) > 0.5


@pytest.mark.parametrize(
    ("colour", "ink", "behind"),
    [(RED, INK, SKY), (GREEN, INK, SKY), ((0.3, 0.2, 0.45), PAPER, (0.1, 0.12, 0.2))],
    ids=["red", "green", "light outline on dark"],
)
def test_an_outlined_strand_is_found_to_its_end(
    colour: tuple[float, ...], ink: tuple[float, ...], behind: tuple[float, ...]
) -> None:
    fine = stroked(STRAND, 4, body())
    picture = laid(sky(behind), fine, colour, ink)
    truth = outlined(fine)
    mask = shrunk(truth)
    strand = (coverage(stroked(STRAND, 4, blank())) > 0.5) & (np.arange(WIDTH) > 118)
    assert mask[strand].max() == 0
    found = regular(picture, mask)
    assert found[strand].mean() > 0.95
    # With its outline, and without what is behind: nothing is wrong but pixels along the very edge.
    wrong = cv2.erode((found != (truth > 0.5)).astype(np.uint8), np.ones((2, 2), np.uint8))
    assert wrong.sum() < 0.005 * truth.sum()


def test_a_strand_of_two_colours_is_found() -> None:
    """Shaded from the part's one colour to its other."""
    fine = stroked(STRAND, 4, body())
    shade = np.clip((np.arange(WIDTH) - 130) / 40, 0, 1)[None, :, None]
    shade = np.where(np.arange(HEIGHT)[:, None, None] > 110, 1, shade)  # the part's foot has the other colour
    colours = np.float32(RED) + shade * (np.float32((0.75, 0.5, 0.2)) - np.float32(RED))
    picture = laid(sky(), fine, RED)
    picture += coverage(fine)[..., None] * (colours - np.float32(RED))
    truth = outlined(fine)
    found = regular(picture, shrunk(truth))
    assert (found & (truth > 0.5) & (np.arange(WIDTH) > 118)).sum() > 0.8 * (truth > 0.5)[:, 119:].sum()


def test_a_neighbours_strand_of_the_same_colour_is_not_taken() -> None:
    """A line divides them."""
    neighbour = stroked([(116, 60), (150, 40), (215, 40)], 5, blank())
    picture = laid(laid(sky(), neighbour, RED), body(), RED)
    found = regular(picture, shrunk(outlined(body())))
    beyond = (outlined(body()) < 0.02) & (np.arange(WIDTH) > 118)
    assert not found[beyond].any()


def test_lines_that_start_at_the_part_are_not_followed() -> None:
    picture = laid(sky(), body(), RED)
    line = coverage(stroked([(104, 70), (160, 66), (220, 90)], 2, blank()))[..., None]
    picture = picture + line * (np.float32(INK) - picture)
    found = regular(picture, shrunk(outlined(body())))
    assert not found[:, 125:].any()


def test_a_wide_limb_that_was_cut_off_stays_off() -> None:
    """Were it the part's, something of it would be in the shrunk mask."""
    whole = stroked([(90, 85), (230, 85)], 26, body())
    picture = laid(sky(), whole, RED)
    cut = np.where(np.arange(WIDTH) < 116, outlined(whole), np.float32(0)).astype(np.float32)
    found = regular(picture, shrunk(cut))
    assert not found[:, 132:].any()


@pytest.mark.parametrize("width", [14, 18])
def test_a_wide_limb_that_strands_lead_to_stays_off(width: int) -> None:
    """However long the strands are that have been found: the mask has been shrunk by no more than before."""
    block, limb = blank(), stroked([(214, 30), (214, 150)], width, blank())
    cv2.rectangle(block, (20 * FINE, 20 * FINE), (60 * FINE, 160 * FINE), 1, -1)
    strands = blank()
    for y in (40, 80, 120):
        stroked([(50, y), (215, y + 4)], 4, strands)
    beside = np.arange(WIDTH) < 200 - width / 2
    found = regular(laid(sky(), block | strands | limb, RED), shrunk(outlined(block | strands)) * beside)
    assert not found[coverage(limb) > 0.9].any()
    assert found[:, 70:190][coverage(strands)[:, 70:190] > 0.5].mean() > 0.95


def test_a_mask_that_is_not_too_small_ends_where_it_ends() -> None:
    """Whoever left the strand out of a mask that fits meant to."""
    picture = laid(sky(), stroked(STRAND, 4, body()), RED)
    found = regular(picture, outlined(body()))
    assert not found[:, 128:].any()


def test_a_mask_that_is_wrong_both_ways_has_not_been_shrunk() -> None:
    """As a lasso is, too tight at more of its edge than too wide: whoever drew it left the strand out."""
    whole, disc = outlined(body()), np.ones((9, 9), np.uint8)
    mask = np.where(np.arange(WIDTH) < 60, cv2.dilate((whole > 0.5).astype(np.float32), disc), shrunk(whole))
    found = regular(laid(sky(), stroked(STRAND, 4, body()), RED), mask)
    assert not found[:, 128:].any()


def test_what_no_outline_runs_along_is_not_taken() -> None:
    """A wire of the part's colour, behind a gap in its outline."""
    picture = laid(sky(), body(), RED)
    wire = coverage(stroked([(90, 70), (150, 66), (215, 80)], 5, blank()))[..., None]
    picture = picture + wire * (np.float32(RED) - picture)
    found = regular(picture, shrunk(outlined(body())))
    assert not found[:, 125:].any()


def blurred(mask: Mask, sigma: float) -> Mask:
    return cv2.GaussianBlur(mask, (0, 0), sigma)


def tip(picture: np.ndarray, points: list[tuple[int, int]]) -> tuple[np.ndarray, Mask]:
    """A picture with a line of ink over it, and where the line is."""
    line = coverage(stroked(points, 2, blank()))
    return picture + line[..., None] * (np.float32(INK) - picture), line


@pytest.mark.parametrize("radius", [0, 1])
def test_a_strand_is_found_that_blurring_has_left_less_than_half_of(radius: int) -> None:
    fine = stroked(STRAND, 4, body())
    mask = blurred(shrunk(outlined(fine), radius), 6)
    strand = (coverage(stroked(STRAND, 4, blank())) > 0.5) & (np.arange(WIDTH) > 125)
    assert mask[strand].max() < 0.5
    assert regular(laid(sky(), fine, RED), mask)[strand].mean() > 0.9


@pytest.mark.parametrize("sigma", [2, 4, 6])
def test_a_strand_stays_that_a_blurred_mask_has_no_trace_of(sigma: float) -> None:
    """Whoever blurred the mask had left the strand out."""
    found = regular(laid(sky(), stroked(STRAND, 4, body()), RED), blurred(outlined(body()), sigma))
    assert not found[:, 128:].any()


TIP = [(104, 70), (118, 68), (140, 74)]


def test_the_tip_of_a_strand_is_found_that_blurring_has_left_less_than_half_of() -> None:
    picture, line = tip(laid(sky(), body(), RED), TIP)
    mask = blurred(np.maximum(outlined(body()), line), 2)
    beyond = (line > 0.5) & (np.arange(WIDTH) > 114)
    assert mask[beyond].max() < 0.5
    assert regular(picture, mask)[beyond].mean() > 0.9


def test_the_line_of_a_neighbour_stays_that_touches_a_part_with_a_blurred_mask() -> None:
    picture, _ = tip(laid(sky(), body(), RED), [*TIP, (220, 90)])
    assert not regular(picture, blurred(outlined(body()), 2))[:, 114:].any()
