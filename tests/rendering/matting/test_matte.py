"""Soft alpha of parts on synthetic pictures whose true alpha is known."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.rendering.matting import fitting_plate, in_levels, soft_alpha, with_outline
from physanimator.rendering.pictures import window_around

SIZE = 96
Y, X = np.mgrid[:SIZE, :SIZE] + 0.5
RADIUS = np.hypot(X - 48.3, Y - 47.6)
RED = np.array([0.9, 0.35, 0.3], dtype=np.float32)
DARK = np.array([0.15, 0.05, 0.1], dtype=np.float32)


def disc(radius: float) -> np.ndarray:
    """Coverage of a disc, with edges as soft as a pixel."""
    return np.clip(radius - RADIUS + 0.5, 0, 1).astype(np.float32)


def over(background: np.ndarray, colour: np.ndarray, alpha: np.ndarray) -> np.ndarray:
    return (background + alpha[..., None] * (colour - background)).astype(np.float32)


def textured_background() -> np.ndarray:
    noise = np.random.default_rng(0).uniform(-0.08, 0.08, (SIZE, SIZE, 3))
    return np.clip(0.6 + 0.003 * X[..., None] + noise, 0, 1).astype(np.float32)


def test_an_outline_outside_a_hard_mask_is_found() -> None:
    picture = over(over(textured_background(), DARK, disc(28)), RED, disc(25))
    support = with_outline(picture, (disc(25) > 0.5).astype(np.float32))
    assert support[RADIUS < 27.5].all()
    assert not support[RADIUS > 30.5].any()


def test_an_outline_is_found_that_leaves_the_mask_for_a_stretch() -> None:
    """A light rim lies between the mask and the line, which is found at either end of it."""
    row, column = np.mgrid[:80, :120]
    picture = np.full((80, 120, 3), 0.65, np.float32)
    picture[40:] = RED
    rim = (np.abs(column - 60) < 10) & (row >= 38)
    line = np.where(np.abs(column - 60) < 10, (row >= 36) & (row < 38), (row >= 38) & (row < 40))
    picture[rim & (row < 40)], picture[line] = (0.9, 0.85, 0.7), DARK
    assert with_outline(picture, (row >= 40).astype(np.float32))[line].all()


def test_faint_pixels_of_a_mask_behind_an_outline_are_the_parts() -> None:
    """A slightly blurred mask has some that are hardly any of it: their dark would be left in the plate."""
    picture, background = over(over(textured_background(), DARK, disc(29)), RED, disc(25)), textured_background()
    mask = (disc(25) > 0.5).astype(np.float32)
    rim = (mask == 0) & (RADIUS < 26.5) & ((np.arange(SIZE) % 3) == 0)
    mask[rim] = 0.06
    support = with_outline(picture, mask)
    assert soft_alpha(picture, background, mask, support)[rim].min() > 0.8


def test_a_line_that_only_passes_by_is_not_taken_along() -> None:
    row, column = np.mgrid[:80, :120]
    picture = np.full((80, 120, 3), 0.65, np.float32)
    picture[40:] = RED
    line = np.where(column < 30, (row >= 38) & (row < 40), (row >= 36) & (row < 38))
    picture[line] = DARK
    assert not with_outline(picture, (row >= 40).astype(np.float32))[line & (column > 50)].any()


def test_nothing_is_added_where_there_is_no_outline() -> None:
    picture = over(textured_background(), RED, disc(25))
    support = with_outline(picture, disc(25))
    assert (support == (disc(25) > 0.02)).all()


def test_a_soft_mask_is_taken_at_its_word() -> None:
    mask = disc(25)
    line = disc(28) * (np.arange(SIZE) < 0.35 * SIZE)
    outlined = over(over(textured_background(), DARK, line), RED, mask)
    assert (with_outline(outlined, mask) == (mask > 0.02)).all()
    plain = over(textured_background(), RED, mask)
    alpha = soft_alpha(plain, textured_background()[::-1], mask, mask > 0.02)
    assert np.abs(alpha - mask).max() < 0.15


def test_a_soft_mask_inside_an_outline_all_around_takes_it_along() -> None:
    outlined = over(over(textured_background(), DARK, disc(28)), RED, disc(25))
    support = with_outline(outlined, disc(25))
    assert support[disc(28) > 0.5].all()
    assert not support[disc(31) == 0].any()


def test_a_hard_edge_gets_its_true_shares_back() -> None:
    background = np.full((SIZE, SIZE, 3), 0.75, dtype=np.float32)
    picture = over(background, RED, disc(25))
    mask = (disc(25) > 0.5).astype(np.float32)
    alpha = soft_alpha(picture, background, mask, mask > 0.5)
    assert np.abs(alpha - disc(25)).max() < 0.16
    assert np.abs(alpha - disc(25)).mean() < 0.1 * np.abs(mask - disc(25)).mean()


@pytest.mark.parametrize("change", [0, 1], ids=["exact", "a pixel too large"])
def test_an_outlined_part_has_no_halo_over_another_background(change: int) -> None:
    """The part is cut out by a hard mask and laid over white; what it had been drawn over must not show."""
    background, alpha = textured_background(), disc(28)
    colour = over(np.broadcast_to(DARK, (SIZE, SIZE, 3)), RED, disc(25))
    picture = over(background, colour, alpha)
    mask = (disc(28 + change) > 0.5).astype(np.float32)
    support = with_outline(picture, mask)
    found = soft_alpha(picture, background, mask, support)
    near = abs(RADIUS - 28) < 4
    assert np.abs(found - alpha)[near].mean() < 0.02
    assert np.abs(found - alpha)[near].mean() < 0.35 * np.abs(mask - alpha)[near].mean()
    cut_out = picture - (1 - found[..., None]) * fitting_plate(picture, background, found)
    over_white = cut_out + 1 - found[..., None]
    assert np.abs(over_white - over(np.ones((SIZE, SIZE, 3)), colour, alpha))[near].mean() < 0.012


def test_a_tip_thinner_than_the_mask_knows_keeps_its_shares() -> None:
    """A hair that tapers off: a hard mask jumps where the true coverage fades."""
    width = np.clip((80 - X) / 12, 0, None)
    alpha = np.clip(width / 2 - abs(Y - 48) + 0.5, 0, 1).astype(np.float32) * (X < 80)
    picture = over(np.full((SIZE, SIZE, 3), 0.85, np.float32), DARK, alpha)
    mask = (alpha > 0.5).astype(np.float32)
    plate = np.full((SIZE, SIZE, 3), 0.85, np.float32)
    found = soft_alpha(picture, plate, mask, with_outline(picture, mask))
    assert np.abs(found - alpha).sum() < 0.4 * np.abs(mask - alpha).sum()


def test_a_soft_edge_that_denies_much_of_the_part_is_corrected() -> None:
    background = np.full((SIZE, SIZE, 3), 0.75, dtype=np.float32)
    picture = over(background, RED, disc(25))
    feathered = np.clip((25 - RADIUS) / 4 + 0.2, 0, 1).astype(np.float32)
    alpha = soft_alpha(picture, background, feathered, feathered > 0.02)
    assert np.abs(alpha - disc(25)).mean() < 0.75 * np.abs(feathered - disc(25)).mean()


def test_a_mask_that_is_a_pixel_too_large_gives_the_background_back() -> None:
    background = np.full((SIZE, SIZE, 3), 0.75, dtype=np.float32)
    alpha = soft_alpha(over(background, RED, disc(25)), background, disc(26), disc(26) > 0.02)
    assert np.abs(alpha - disc(25)).mean() < 0.5 * np.abs(disc(26) - disc(25)).mean()


def test_a_light_rim_within_the_mask_is_the_parts() -> None:
    background = np.full((SIZE, SIZE, 3), 0.5, dtype=np.float32)
    picture = over(over(background, np.ones(3, np.float32), disc(25)), DARK, disc(22.5))
    mask = (disc(25) > 0.5).astype(np.float32)
    alpha = soft_alpha(picture, background, mask, mask > 0.5)
    assert alpha[disc(25) == 1].min() > 0.9


def test_an_outline_keeps_its_ink_where_a_line_of_the_same_ink_runs_behind() -> None:
    """Colours alone say that the outline goes on in the line; a bit of it would stay behind when the part moves."""
    white, ink = np.ones((SIZE, SIZE, 3), np.float32), np.zeros(3, np.float32)
    line = np.clip(1.5 - abs(X - 30), 0, 1).astype(np.float32)
    background = over(white, ink, line)
    picture = over(over(background, ink, disc(28)), np.ones(3, np.float32), disc(25))
    mask = (disc(28) > 0.5).astype(np.float32)
    # The clean plate does not know that the line goes on.
    plate = np.where((disc(29) > 0)[..., None], white, background)
    alpha = soft_alpha(picture, plate, mask, with_outline(picture, mask))
    crossing = (abs(X - 30) < 6) & (disc(28) == 1)
    assert alpha[crossing].min() > 0.99
    changed = np.abs(fitting_plate(picture, plate, alpha) - plate).max(axis=2)
    assert (changed[crossing] > 0.1).sum() == 0


def test_the_fitting_plate_is_the_nearest_that_real_colours_allow() -> None:
    random = np.random.default_rng(1)
    image, plate = random.uniform(0, 1, (2, 40, 40, 3)).astype(np.float32)
    alpha = random.choice([0, 0.2, 0.9, 1], (40, 40)).astype(np.float32)
    fitting = fitting_plate(image, plate, alpha)
    colour = image - (1 - alpha[..., None]) * fitting
    assert (fitting[alpha == 0] == image[alpha == 0]).all()
    assert (fitting[alpha == 1] == plate[alpha == 1]).all()
    assert colour.min() > -1e-6
    assert (colour - alpha[..., None]).max() < 1e-6
    changed = (fitting != plate) & (alpha > 0)[..., None]
    slack = np.minimum(colour, alpha[..., None] - colour)
    assert changed.any()
    assert np.abs(slack[changed]).max() < 1e-6


def test_a_rounded_picture_changes_the_plate_less_and_comes_out_rounded_the_same() -> None:
    random = np.random.default_rng(2)
    image = (random.integers(0, 256, (40, 40, 3)) / 255).astype(np.float32)
    plate = random.uniform(0, 1, (40, 40, 3)).astype(np.float32)
    alpha = random.choice([0.2, 0.9], (40, 40)).astype(np.float32)
    assert in_levels(image)
    assert not in_levels(plate)
    exact, rounded = fitting_plate(image, plate, alpha), fitting_plate(image, plate, alpha, rounded=True)
    assert np.abs(rounded - plate).sum() < np.abs(exact - plate).sum()
    share = alpha[..., None]
    shown = (1 - share) * rounded + np.clip(image - (1 - share) * rounded, 0, share)
    assert (np.rint(shown * 255) == np.rint(image * 255)).all()


def test_empty_and_full_masks_stay_so() -> None:
    picture = textured_background()
    assert not with_outline(picture, np.zeros((SIZE, SIZE), np.float32)).any()
    assert with_outline(picture, np.ones((SIZE, SIZE), np.float32)).all()


def test_window_stays_within_the_picture() -> None:
    mask = np.zeros((SIZE, SIZE), dtype=bool)
    mask[3:10, 80:90] = True
    assert window_around(mask, margin=8) == (slice(0, 18), slice(72, 96))
