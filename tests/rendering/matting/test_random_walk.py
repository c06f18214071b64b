"""What divides pixels near the edge of a mask: what hangs together, and what colours tell."""

from __future__ import annotations

import cv2
import numpy as np
from physanimator.rendering.matting.edge_search import found_shape
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
