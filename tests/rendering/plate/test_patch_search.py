"""The search for patches and the vote of what has been found, against plain versions of both."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physanimator.physics.threads import THREADS
from physanimator.rendering.plate.patch_search import RADIUS, Finds, Level, PatchSearch
from physanimator.rendering.plate.patch_synthesis import _voted


def level_of(seed: int, height: int = 40, width: int = 34) -> Level:
    """A pattern that repeats, with some noise, and a hole that may reach the border."""
    random = np.random.default_rng(seed)
    pattern = np.kron(random.random((2, 2, 3)), np.ones((4, 4, 1)))
    picture = np.tile(pattern, (height // 8 + 1, width // 8 + 1, 1))[:height, :width]
    picture = (picture + 0.03 * random.random(picture.shape)).astype(np.float32)
    hole = np.zeros((height, width), dtype=bool)
    top, left = random.integers(0, 20, 2)
    hole[top : top + 13, left : left + 11] = True
    return Level(picture, hole, hole, picture, picture)


def plain_cost(search: PatchSearch, source: np.ndarray) -> np.ndarray:
    """What each target's match costs, from all that it is compared by."""
    difference = search.features[source] - search.wanted
    row, column = np.divmod(source, search.shape[1])
    away = (row - search.row) ** 2 + (column - search.column) ** 2
    return np.einsum("ij,ij->i", difference, difference) + np.float32(1e-4) * away.astype(np.float32)


class PlainSearch(PatchSearch):
    """Compares every usable source that is proposed, however far away."""

    def _try(self, source: np.ndarray, of: np.ndarray | None, _aside: np.ndarray) -> None:
        every = self.source.copy()
        every[slice(None) if of is None else of] = np.clip(source, 0, self.usable.size - 1)
        cost = np.where(self.usable[every], plain_cost(self, every), np.inf).astype(np.float32)
        better = cost < self.cost
        self.source[better], self.cost[better] = every[better], cost[better]


@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 2**31))
def test_what_is_not_compared_would_not_have_won(seed: int) -> None:
    level = level_of(seed)
    current = np.where(level.hole[..., None], level.guide, level.picture)
    found, searches = [], []
    for kind in (PatchSearch, PlainSearch):
        search = kind(level, None, np.random.default_rng(seed))
        searches.append(search)
        found.append([search.round(current) for _ in range(2)][-1])
    np.testing.assert_array_equal(found[0].source, found[1].source)
    np.testing.assert_array_equal(found[0].trust, found[1].trust)
    np.testing.assert_array_equal(searches[0].cost, plain_cost(searches[0], searches[0].source))
    assert searches[0].usable[searches[0].source].all()
    assert found[0].trust.max() > 0


@pytest.mark.parametrize("threads", ["1", "3"])
@pytest.mark.parametrize("seed", range(3))
def test_each_pixel_is_the_weighted_mean_of_what_patches_propose(
    seed: int, threads: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(THREADS, threads)
    random, level = np.random.default_rng(seed), level_of(seed, 90, 90)
    hole = np.zeros_like(level.hole)
    hole[5:85, 10:80] = True
    level = Level(level.picture, hole, hole, level.guide, level.smooth)
    height, width = hole.shape
    trust = np.where(random.random(hole.shape) < 0.8, random.random(hole.shape), 0).astype(np.float32)
    trust[:RADIUS] = trust[-RADIUS:] = trust[:, :RADIUS] = trust[:, -RADIUS:] = 0
    rows, columns = random.integers(RADIUS, (height - RADIUS, width - RADIUS), (height, width, 2)).transpose(2, 0, 1)
    voted = _voted(level, 1 - level.guide, Finds(rows * width + columns, trust))
    for row, column in np.argwhere(hole)[::37]:
        total, weight = np.zeros(3), 0.0
        for down in range(-RADIUS, RADIUS + 1):
            for right in range(-RADIUS, RADIUS + 1):
                centre = row - down, column - right
                if 0 <= centre[0] < height and 0 <= centre[1] < width and trust[centre] > 0:
                    total += trust[centre] * level.picture[rows[centre] + down, columns[centre] + right]
                    weight += trust[centre]
        np.testing.assert_allclose(voted[row, column], total / weight, atol=1e-5)
    np.testing.assert_array_equal(voted[~hole], 1 - level.guide[~hole])
