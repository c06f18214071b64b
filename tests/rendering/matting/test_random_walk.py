"""What divides pixels near the edge of a mask: what hangs together, and what colours tell."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.rendering.matting.edge_search import _best_of, explained, found_shape
from physanimator.rendering.matting.like_regions import like_regions
from physanimator.rendering.matting.random_walk import chance_of_core

WALL, HAIR, BLACK, RED = (0.75, 0.75, 0.85), (0.3, 0.3, 0.32), (0.03, 0.03, 0.03), (0.7, 0.2, 0.2)


def test_a_black_strand_is_not_taken_for_the_black_box_beside_it() -> None:
    picture = np.full((160, 160, 3), WALL, np.float32)
    picture[60:110, 8:26] = BLACK
    picture[:, 60:140] = HAIR
    picture[:, 60:72] = BLACK
    # Where the hair's end is well inside of the mask, it is black as well.
    picture[110:, 60:110] = BLACK
    part = np.zeros((160, 160), bool)
    part[:, 60:140] = True
    mask = cv2.dilate(part.astype(np.float32), np.ones((9, 9), np.uint8))
    shape, _ = found_shape(picture, mask, np.full(mask.shape, 20, np.float32))
    assert (shape != part).sum() < 0.02 * part.sum()


def test_a_flat_area_tells_no_more_than_a_few_of_its_pixels() -> None:
    # A band of one colour between the core, which is alike, and the rest, which is not.
    picture = np.full((40, 60, 3), RED, np.float32)
    picture[:, 45:] = WALL
    core = np.zeros((40, 60), bool)
    core[:, :15] = True
    band = np.zeros((40, 60), bool)
    band[:, 15:45] = True
    chance = chance_of_core(picture, core.astype(np.float32), band, core, np.full(int(band.sum()), 0.1, np.float32))
    assert chance.min() > 0.5


def test_regions_end_where_colours_step() -> None:
    ramp = np.linspace(0, 1, 50, dtype=np.float32)
    picture = np.repeat(np.tile(ramp, (10, 1))[..., None], 3, axis=2)
    assert len(np.unique(like_regions(picture, np.ones((10, 50), bool), step=0.05))) == 1
    picture[:, 25:] = np.minimum(picture[:, 25:] + 0.2, 1)
    region = like_regions(picture, np.ones((10, 50), bool), step=0.05)
    assert region[0, 24] != region[0, 25]
    free = np.ones((10, 50), bool)
    free[5] = False
    region = like_regions(picture, free, step=0.05)
    assert (region[5] == 0).all()
    assert region[4, 0] != region[6, 0]


@pytest.mark.parametrize("seed", range(3))
def test_chances_solve_the_system_of_the_walk(seed: int) -> None:
    """Against a dense system, put together pair by pair."""
    random = np.random.default_rng(seed)
    picture = (np.linspace(0.2, 0.8, 14)[:, None, None] + 0.08 * random.random((14, 11, 3))).astype(np.float32)
    mask = random.random((14, 11)).astype(np.float32)
    band, core = np.zeros((14, 11), bool), np.zeros((14, 11), bool)
    band[3:11, :9], core[:3] = True, True
    said = random.random(int(band.sum())).astype(np.float32)
    number = {tuple(place): index for index, place in enumerate(np.argwhere(band))}
    region = like_regions(picture, band, step=0.05)
    told = 0.05 * np.minimum(1, 5 / np.bincount(region.ravel())[region[band]])
    matrix, target = np.diag(told), told * said
    for (row, column), index in number.items():
        for down, right in ((0, 1), (1, 0), (1, 1), (1, -1), (0, -1), (-1, 0), (-1, -1), (-1, 1)):
            other = row + down, column + right
            if not (0 <= other[0] < 14 and 0 <= other[1] < 11):
                continue
            near = 1.0 if 0 in (down, right) else 0.7
            alike = np.exp(-((picture[row, column] - picture[other]) ** 2).sum() / (2 * 0.05**2))
            ease = near * (alike + 0.002) * (0.4 if abs(mask[row, column] - mask[other]) > 0.4 else 1)
            matrix[index, index] += ease
            target[index] += ease * core[other]
            if other in number:
                matrix[index, number[other]] -= ease
    chance = chance_of_core(picture, mask, band, core, said)
    np.testing.assert_allclose(chance, np.linalg.solve(matrix, target), atol=5e-3)


@pytest.mark.parametrize("channels", [3, 4])
def test_the_best_samples_are_the_nearest_colours(channels: int) -> None:
    random = np.random.default_rng(channels)
    picture = random.random((channels, 500)).astype(np.float32)
    own = random.random((channels, 60)).astype(np.float32)
    beside, places, away = random.integers(0, 500, 900), random.integers(100, 800, 60), random.integers(-100, 100, 36)
    best = _best_of(list(own), list(picture), beside, places, away)
    samples = picture[:, beside[places + away[:, None]]]
    squares = np.sort(((samples - own[:, None]) ** 2).sum(axis=0), axis=0)
    np.testing.assert_allclose(best, squares[:3], rtol=1e-5)


def test_colours_explain_themselves_alone() -> None:
    picture = np.full((70, 120, 3), HAIR, np.float32)
    picture[:, 80:] = RED
    left, band = np.zeros((70, 120), bool), np.zeros((70, 120), bool)
    left[:, :40], band[:, 40:] = True, True
    share = explained(picture, band, left).reshape(70, 80)
    assert share[:, :40].min() > 0.99
    assert share[:, 40:].max() < 0.01
