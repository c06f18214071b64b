"""Masks as people make them, on drawn parts of several kinds: what stays behind when the part has moved away."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
import pytest
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.matting import fitting_plate, mixed_rim, regular_mask, soft_alpha, with_outline
from physanimator.rendering.matting.mask_forms import step_of, up_to_white
from physanimator.rendering.plate import fill_hole

WIDTH, HEIGHT, FINE = 220, 180, 4
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
SHIFT = np.float32((23, -11))

Mask = np.ndarray


def shape(grown: float = 0.0) -> np.ndarray:
    """Coverage of a part with five blunt strands, grown by some pixels; anti-aliased."""
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    radius = 44 + 14 * np.sin(5 * angle + 0.7)
    points = np.stack([104 + 1.2 * radius * np.cos(angle), 92 + radius * np.sin(angle)], axis=1)
    fine = np.zeros((HEIGHT * FINE, WIDTH * FINE), np.uint8)
    cv2.fillPoly(fine, [np.rint(points * FINE).astype(np.int32)], 1)
    if grown:
        fine = (cv2.distanceTransform(1 - fine, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) <= grown * FINE).astype(np.uint8)
    return cv2.resize(fine.astype(np.float32), (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)


def tinted(colour: tuple[float, float, float], noise: float, seed: int) -> np.ndarray:
    """A colour with a gradient and soft spots."""
    random = np.random.default_rng(seed)
    spots = cv2.GaussianBlur(random.normal(0, 1, (HEIGHT, WIDTH, 3)).astype(np.float32), (0, 0), 1.5) * 5
    return np.clip(np.float32(colour) + 0.0005 * (X - Y)[..., None] + noise * spots, 0, 1).astype(np.float32)


def over(below: np.ndarray, colour: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    return below + alpha[..., None] * (colour - below)


LIGHT, INK = tinted((0.95, 0.95, 0.9), 0, 0), tinted((0.1, 0.05, 0.08), 0, 0)
SKY, NIGHT, RED = (
    tinted((0.65, 0.78, 0.9), 0.02, 1),
    tinted((0.1, 0.12, 0.2), 0.02, 2),
    tinted((0.8, 0.3, 0.25), 0.01, 3),
)
# Background, part, outline and its width [px].
KINDS = {
    "painted": (SKY, tinted((0.55, 0.4, 0.3), 0.03, 4), INK, 0.0),
    "thick outline": (SKY, RED, INK, 5.0),
    "thin ink": (SKY, RED, INK, 1.2),
    "light outline on dark": (NIGHT, tinted((0.3, 0.2, 0.45), 0.01, 5), LIGHT, 3.0),
    "white on white": (tinted((0.93, 0.93, 0.93), 0, 6), tinted((0.97, 0.96, 0.93), 0, 7), INK, 2.5),
}


def drawn(kind: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Picture, background, the part's alpha and its colour."""
    background, part, outline, width = KINDS[kind]
    alpha = shape(width)
    colour = over(outline, part, shape()) if width else part
    picture = np.rint(over(background, colour, alpha) * 255).astype(np.uint8)
    return picture, background, alpha, colour


def disc(radius: int) -> np.ndarray:
    return cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * radius + 1,) * 2)


def hard(mask: Mask) -> np.ndarray:
    return (mask > 0.5).astype(np.float32)


def scaled(mask: Mask, factor: int, down: int, up: int) -> Mask:
    small = cv2.resize(mask, (WIDTH // factor, HEIGHT // factor), interpolation=down)
    return np.clip(cv2.resize(small, (WIDTH, HEIGHT), interpolation=up), 0, 1)


def lasso(mask: Mask) -> Mask:
    """A polygon through points that miss the edge by several pixels."""
    outline = max(cv2.findContours(hard(mask).astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0], key=len)
    points = outline[::16, 0] + np.random.default_rng(0).uniform(-5, 5, (len(outline[::16]), 2))
    return cv2.fillPoly(np.zeros(mask.shape, np.float32), [np.rint(points).astype(np.int32)], 1)


def brushed(mask: Mask) -> Mask:
    """Painted with a round brush that wavers along the edge, and feathered."""
    outline = max(cv2.findContours(hard(mask).astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)[0], key=len)
    painted = hard(mask)
    for point in outline[::5, 0] + np.random.default_rng(1).normal(0, 2, (len(outline[::5]), 2)):
        cv2.circle(painted, [int(each) for each in np.rint(point)], 4, 1.0, -1)
    return cv2.GaussianBlur(painted, (0, 0), 3)


def compressed(mask: Mask) -> Mask:
    stored = cv2.imencode(".jpg", np.rint(mask * 255).astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, 50])[1]
    return cv2.imdecode(stored, cv2.IMREAD_GRAYSCALE).astype(np.float32) / 255


def lopsided(mask: Mask) -> Mask:
    wide, tight = cv2.dilate(hard(mask), disc(4)), cv2.erode(hard(mask), disc(3))
    return np.where(X < 104, wide, tight).astype(np.float32)


MASKS: dict[str, Callable[[Mask], Mask]] = {
    "blurred by 0.7": lambda mask: cv2.GaussianBlur(mask, (0, 0), 0.7),
    "blurred by 2": lambda mask: cv2.GaussianBlur(mask, (0, 0), 2),
    "blurred by 6": lambda mask: cv2.GaussianBlur(mask, (0, 0), 6),
    "half size": lambda mask: scaled(mask, 2, cv2.INTER_AREA, cv2.INTER_LINEAR),
    "half size, Lanczos": lambda mask: scaled(mask, 2, cv2.INTER_AREA, cv2.INTER_LANCZOS4),
    "quarter size, blocks": lambda mask: scaled(mask, 4, cv2.INTER_NEAREST, cv2.INTER_NEAREST),
    "grown by 4": lambda mask: cv2.dilate(hard(mask), disc(4)),
    "grown by 8": lambda mask: cv2.dilate(hard(mask), disc(8)),
    "shrunk by 2": lambda mask: cv2.erode(hard(mask), disc(2)),
    "shrunk by 4": lambda mask: cv2.erode(hard(mask), disc(4)),
    "grown and blurred": lambda mask: cv2.GaussianBlur(cv2.dilate(mask, disc(3)), (0, 0), 3),
    "shrunk and blurred": lambda mask: cv2.GaussianBlur(cv2.erode(mask, disc(2)), (0, 0), 2),
    "lasso": lasso,
    "brush": brushed,
    "too wide and too tight": lopsided,
    "JPEG": lambda mask: compressed(mask),
    "cut off below 0.4": lambda mask: np.where(cv2.GaussianBlur(mask, (0, 0), 2) < 0.4, 0, mask).astype(np.float32),
    "grey": lambda mask: 0.7 * mask,
}


def moved(picture: np.ndarray, mask: Mask) -> LayeredRenderer:
    """The part at rest in frame 0, moved in frame 1."""
    mesh = mesh_from_mask(mask)
    positions = np.stack([mesh.vertices, mesh.vertices + SHIFT]).astype(np.float32)
    return LayeredRenderer(picture, [mask], Motion((Body(mesh),), positions, 24.0))


def ghost(renderer: LayeredRenderer, background: np.ndarray) -> int:
    """Pixels of the plate that are far from the background."""
    return int((np.abs(renderer.plate / 255 - background).mean(axis=2) > 0.12).sum())


def frame_error(renderer: LayeredRenderer, background: np.ndarray, alpha: np.ndarray, colour: np.ndarray) -> float:
    """Mean difference of frame 1 from the same picture drawn anew."""
    shift = np.float32([[1, 0, SHIFT[0]], [0, 1, SHIFT[1]]])
    there = cv2.warpAffine(alpha, shift, (WIDTH, HEIGHT))
    layer = cv2.warpAffine((alpha[..., None] * colour).astype(np.float32), shift, (WIDTH, HEIGHT))
    truth = layer + (1 - there[..., None]) * background
    return float(np.abs(renderer.frame(1) / 255 - truth).mean())


@pytest.fixture(scope="module")
def clean() -> dict[str, tuple[int, float]]:
    """Ghost and error of a frame with the part's own alpha for a mask, by the kind of part."""
    found = {}
    for kind in KINDS:
        picture, background, alpha, colour = drawn(kind)
        renderer = moved(picture, alpha)
        found[kind] = ghost(renderer, background), frame_error(renderer, background, alpha, colour)
    return found


# Each mask with one kind of part, and each kind of part with several masks.
PAIRS = [
    ("blurred by 0.7", "thick outline"),
    ("blurred by 2", "thin ink"),
    ("blurred by 6", "light outline on dark"),
    ("half size", "white on white"),
    ("quarter size, blocks", "light outline on dark"),
    ("grown by 8", "painted"),
    ("shrunk by 2", "light outline on dark"),
    ("shrunk by 4", "white on white"),
    ("grown and blurred", "thin ink"),
    ("shrunk and blurred", "painted"),
    ("lasso", "thin ink"),
    ("brush", "thick outline"),
    ("too wide and too tight", "light outline on dark"),
    ("JPEG", "light outline on dark"),
    ("grey", "thick outline"),
]
# A ghost of so few pixels nobody sees.
UNSEEN = 24


@pytest.mark.parametrize(("name", "kind"), PAIRS)
def test_any_mask_leaves_as_little_behind_as_the_parts_own_alpha(
    name: str, kind: str, clean: dict[str, tuple[int, float]]
) -> None:
    picture, background, alpha, colour = drawn(kind)
    renderer = moved(picture, MASKS[name](alpha))
    assert ghost(renderer, background) <= 2 * max(clean[kind][0], UNSEEN)
    assert frame_error(renderer, background, alpha, colour) < 1.3 * clean[kind][1] + 0.0005
    assert (renderer.frame(0) == picture).all()


def as_floats(picture: np.ndarray) -> np.ndarray:
    return picture.astype(np.float32) / 255


@pytest.mark.parametrize("kind", KINDS)
def test_a_mask_made_with_care_stays_as_it_is(kind: str) -> None:
    picture, _, alpha, _ = drawn(kind)
    for mask in (alpha, hard(alpha)):
        assert np.abs(regular_mask(as_floats(picture), mask) - mask).max() < 1e-6


@pytest.mark.parametrize("kind", KINDS)
def test_a_slightly_soft_edge_keeps_its_place_between_pixels(kind: str) -> None:
    """Blurred by less than a pixel, the mask still says which share of the edge's pixels is the part's."""
    picture, _, alpha, _ = drawn(kind)
    regular = regular_mask(as_floats(picture), MASKS["blurred by 0.7"](alpha))
    assert np.abs(regular - alpha).sum() < 0.6 * np.abs(hard(alpha) - alpha).sum()


def test_without_an_edge_in_the_picture_a_feathered_mask_keeps_its_feather() -> None:
    """Hair that moves at its ends only: the mask fades where the picture shows nothing."""
    plain = np.full((HEIGHT, WIDTH, 3), 0.5, dtype=np.float32)
    feathered = cv2.GaussianBlur(hard(shape()), (0, 0), 5)
    assert np.abs(regular_mask(plain, feathered) - feathered).max() < 0.5 / 255


def test_a_hole_made_wider_than_it_is_closes() -> None:
    """A shrunk mask has each pinhole of the part as a hole: what is around the pinhole is the part."""
    picture, _, alpha, _ = drawn("thick outline")
    pinhole = np.hypot(X - 104, Y - 92) < 1.5
    picture[pinhole] = (SKY[pinhole] * 255).astype(np.uint8)
    mask = cv2.erode(hard(np.where(pinhole, 0, alpha)), disc(4))
    around = (np.hypot(X - 104, Y - 92) < 8) & (np.hypot(X - 104, Y - 92) > 3)
    assert mask[around].min() == 0
    assert regular_mask(as_floats(picture), mask)[around].min() == 1


@pytest.mark.parametrize("slant", [20, 40, 60, 90])
def test_no_outline_stays_outside_of_the_steps_of_an_enlarged_mask(slant: int) -> None:
    corners = FINE * np.array([[90, 20], [150, 20], [150, 150], [90 - slant, 150]])
    large = cv2.fillPoly(np.zeros((HEIGHT * FINE, WIDTH * FINE), np.float32), [corners], 1)
    whole, inner = (
        cv2.resize(each, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)[..., None]
        for each in (large, cv2.erode(large, np.ones((9, 9))))
    )
    # The dress differs more from the sky than its outline does.
    sky = np.float32([0.45, 0.52, 0.65]) + np.random.default_rng(0).normal(0, 0.02, (HEIGHT, WIDTH, 3))
    picture = (1 - whole) * sky + (whole - inner) * np.float32([0.4, 0.15, 0.3]) + inner * np.float32([0.74, 0.95, 0.6])
    alpha = np.ascontiguousarray(whole[..., 0])
    mask = hard(scaled(alpha, 5, cv2.INTER_AREA, cv2.INTER_NEAREST))
    far = np.abs(mask - alpha) > 0.5
    assert (far & (np.abs(regular_mask(picture.astype(np.float32), mask) - alpha) > 0.9)).sum() < 0.25 * far.sum()


@pytest.mark.parametrize("angle", [0, 10, 45])
def test_only_an_enlarged_mask_goes_in_steps(angle: int) -> None:
    alpha = shape()
    turned = cv2.warpAffine(alpha, cv2.getRotationMatrix2D((WIDTH / 2, HEIGHT / 2), angle, 1), alpha.shape[::-1])
    assert step_of(turned) == 1
    for step in (2, 3, 5):
        assert step_of(scaled(turned, step, cv2.INTER_NEAREST, cv2.INTER_NEAREST)) == step
    square = np.zeros((90, 90), np.float32)
    square[20:60, 20:50] = 1
    assert step_of(square) == 1


def test_pure_black_is_not_left_behind_by_the_last_digit_of_a_mask() -> None:
    """Filters give 0.9999999 for white; whatever stays of black, however little, would have to be black."""
    _, background, alpha, _ = drawn("painted")
    picture = (background * (1 - alpha[..., None])).astype(np.float32)
    for white in (1 - 1e-7, 1 - 1e-3):
        mask = regular_mask(picture, np.float32(white) * hard(alpha))
        support = with_outline(picture, mask)
        plate = fill_hole(picture, support | mixed_rim(mask, support))
        left = fitting_plate(picture, plate, soft_alpha(picture, plate, mask, support))
        assert (np.abs(left - background).mean(axis=2) > 0.12)[alpha > 0.99].mean() < 0.02


@pytest.mark.parametrize("least", [0.96, 0.985, 0.995])
def test_black_is_not_left_behind_where_a_mask_is_not_quite_white(least: float) -> None:
    """As a brush of less than full strength or a blurred pinhole leaves it."""
    _, background, alpha, _ = drawn("painted")
    picture = np.rint(background * (1 - alpha[..., None]) * 255).astype(np.uint8)
    weak = np.where(np.hypot(X - 100, Y - 92) < 20, np.float32(least), hard(alpha)).astype(np.float32)
    renderer = moved(picture, weak)
    clean = moved(picture, hard(alpha))
    assert ghost(renderer, background) <= ghost(clean, background) + UNSEEN
    assert (renderer.frame(0) == picture).all()


@pytest.mark.parametrize(("width", "ink", "missed"), [(3, 1.5, -5), (3, 1.5, 4), (2, 1.5, 4), (2, 4, -3), (1.5, 4, 3)])
@pytest.mark.parametrize("kind", ["thick outline", "light outline on dark"])
def test_a_gap_is_found_where_the_hole_of_a_mask_lies_beside_it(
    kind: str, width: float, ink: float, missed: int
) -> None:
    """A gap between two strands, drawn with ink around it; in the mask it is in two pieces, right and left of it."""
    background, part, outline, _ = KINDS[kind]
    across, along = np.abs(X - 104), np.abs(Y - 92)
    gap = np.clip(width - across, 0, 1) * np.clip(22 - along, 0, 1)
    inked = np.clip(width + ink - across, 0, 1) * np.clip(22 + ink - along, 0, 1)
    colour = over(over(outline, part, shape()), outline, inked)
    picture = over(background, colour, shape(2) * (1 - gap))
    left, right = (np.abs(X - 104 - shift) < 2 for shift in (missed, -(missed // 2)))
    hole = (left & (Y > 72) & (Y < 96)) | (right & (Y > 96) & (Y < 116))
    mask = cv2.dilate(hard(shape(2)), disc(2)) * (1 - hard(hole))
    regular = regular_mask(np.rint(picture * 255).astype(np.float32) / 255, mask)
    assert regular[gap > 0.99].mean() < 0.25
    assert (regular > 0.5)[hole & (gap < 0.01)].mean() > 0.9


@pytest.mark.parametrize("shade", [0.17, 0.3])
@pytest.mark.parametrize("missed", [0, 12])
def test_a_tip_that_a_lasso_cuts_off_says_nothing_about_what_is_around(shade: float, missed: int) -> None:
    """Two curls of black hair, shaded on a side: of one the mask leaves out the tip, of the other some of that side."""
    hair, tip = np.hypot(X - 60, Y - 90) < 45, (np.abs(Y - 70) < 9) & (X > 90) & (X < 128)
    curl = (np.abs(Y - 108) < 11) & (X > 90) & (X < 160)
    shaded = (tip & (X > 100)) | (curl & (Y < 108)) | (hair & (np.abs(X - 66) < 12))
    colour = np.where(shaded[..., None], np.float32(shade), np.float32(0.02))
    part = hair | tip | curl
    picture = np.rint(over(SKY, colour.astype(np.float32), hard(part)) * 255).astype(np.float32) / 255
    mask = hard(hair | (tip & (X < 112)) | (curl & (97 + missed / 2 < Y)))
    regular = regular_mask(picture, np.roll(mask, (3, -4), (0, 1))) > 0.5
    assert regular[curl & (X < 150)].mean() > 0.97
    assert regular[~part].mean() < 0.002


def test_where_a_sprite_shows_nothing_a_grown_mask_has_nothing() -> None:
    inside = shape()
    sprite = np.dstack([np.full((HEIGHT, WIDTH, 3), 0.5, np.float32), inside])
    regular = regular_mask(sprite, cv2.dilate(hard(inside), disc(6)))
    assert regular[cv2.dilate(inside, np.ones((5, 5), np.uint8)) == 0].max() == 0


def test_the_tips_that_nothing_holds_go_with_their_sprite() -> None:
    """Tips narrower than a shrunk mask can show; a hand as wide as the arm stays where the mask ends."""
    fine = np.zeros((HEIGHT * FINE, WIDTH * FINE), np.uint8)
    cv2.circle(fine, (80 * FINE, 90 * FINE), 40 * FINE, 1, -1)
    for end in ((200, 60), (200, 90), (200, 120)):
        cv2.line(fine, (110 * FINE, 90 * FINE), (end[0] * FINE, end[1] * FINE), 1, 5 * FINE)
    inside = cv2.resize(fine.astype(np.float32), (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
    colour = np.where((X > 125)[..., None], INK, RED)
    mask = cv2.erode(hard(inside), disc(4))
    regular = regular_mask(np.dstack([over(np.ones_like(colour), colour, inside), inside]), mask)
    assert (regular > 0.5)[(inside > 0.9) & (X > 130)].mean() > 0.95


def test_a_veil_within_the_part_stays_translucent() -> None:
    picture, _, alpha, _ = drawn("thick outline")
    veiled = np.where(np.hypot(X - 100, Y - 95) < 18, np.float32(0.6), hard(alpha)).astype(np.float32)
    regular = regular_mask(as_floats(picture), veiled)
    assert np.abs(regular[np.hypot(X - 100, Y - 95) < 16] - 0.6).max() < 1e-6


def test_grown_masks_do_not_run_into_a_neighbour_of_the_same_colour() -> None:
    """Nothing in the picture divides the two: the mask's word stands."""
    picture = np.full((HEIGHT, WIDTH, 3), 200, np.uint8)
    picture[60:120, 40:180] = (200, 60, 50)
    mask = np.zeros((HEIGHT, WIDTH), np.float32)
    mask[60:120, 40:100] = 1
    regular = regular_mask(as_floats(picture), mask)
    assert regular[:, 103:].max() == 0
    assert regular[62:118, 42:97].min() == 1


@pytest.mark.parametrize("size", [(1, 1), (1, 40), (2, 2), (3, 5), (24, 24)])
def test_the_smallest_pictures_and_any_masks_pass(size: tuple[int, int]) -> None:
    random = np.random.default_rng(0)
    image = random.uniform(0, 1, (*size, 3)).astype(np.float32)
    for mask in (np.zeros(size), np.ones(size), random.uniform(0, 1, size), random.uniform(0, 1, size) > 0.5):
        regular = regular_mask(image, mask.astype(np.float32))
        assert regular.shape == size
        assert regular.dtype == np.float32
        assert regular.min() >= 0
        assert regular.max() <= 1


@pytest.mark.parametrize("seed", range(40))
def test_white_is_what_a_tenth_of_the_bright_pixels_reach(seed: int) -> None:
    random = np.random.default_rng(seed)
    mask = random.random((random.integers(1, 40), 7)).astype(np.float32)
    mask[random.random(mask.shape) < random.random()] = random.choice([1, 0.97, 0.6])
    mask *= np.float32(random.choice([1, 0.99, 0.5]))
    white = float(np.percentile(mask[mask > 0.5 * mask.max()], 90))
    scaled = mask / np.float32(white) if white < 0.98 else mask
    np.testing.assert_array_equal(up_to_white(mask), np.where(scaled > 1 - 0.5 / 255, np.float32(1), scaled))
