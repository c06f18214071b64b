"""Means over pictures and their intervals."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from physanimator.rendering.evaluation.columns import Summary, mean_of_samples, summary
from physanimator.rendering.evaluation.columns.statistics import summary_of_whole


def test_samples_of_a_picture_are_averaged_without_those_that_have_no_value() -> None:
    assert mean_of_samples([1.0, None, 3.0]) == 2.0
    assert mean_of_samples([1.0, float("nan")]) == 1.0
    assert mean_of_samples([None]) is None
    assert mean_of_samples([]) is None


def test_one_picture_has_no_interval_and_none_has_no_mean() -> None:
    assert summary([4.0, None]) == Summary(4.0, None, None, 1)
    assert summary([None]) == Summary(None, None, None, 0)


def test_the_interval_is_that_of_the_mean() -> None:
    values = np.random.default_rng(3).normal(10, 2, 400)
    found = summary(values)
    assert found.mean == pytest.approx(values.mean())
    error = 1.96 * values.std() / 20
    assert found.low == pytest.approx(values.mean() - error, abs=0.02)
    assert found.high == pytest.approx(values.mean() + error, abs=0.02)


def test_the_interval_holds_the_truth_about_as_often_as_it_says() -> None:
    random = np.random.default_rng(5)
    held = [(found := summary(random.normal(0, 1, 20))).low <= 0 <= found.high for _ in range(200)]
    assert 0.85 < np.mean(held) < 0.99


def test_the_seed_decides() -> None:
    values = [1.0, 2.0, 4.0, 8.0, 16.0]
    assert summary(values, seed=1) == summary(values, seed=1)
    assert summary(values, seed=1) != summary(values, seed=2)


def test_a_whole_value_has_the_interval_of_the_mean_if_it_is_a_mean() -> None:
    values = np.random.default_rng(3).normal(10, 2, 30)
    found = summary_of_whole(range(30), lambda chosen: float(values[list(chosen)].mean()))
    error = 1.96 * values.std(ddof=1) / 30**0.5
    assert found.mean == pytest.approx(values.mean())
    assert (found.low, found.high) == (
        pytest.approx(values.mean() - error, rel=1e-4),
        pytest.approx(values.mean() + error, rel=1e-4),
    )


def test_a_whole_value_that_needs_all_pictures_has_no_interval() -> None:
    def of_two(chosen: Sequence[int]) -> float | None:
        return 5.0 if len(chosen) > 1 else None

    assert summary_of_whole([0, 1], of_two) == Summary(5.0, None, None, 2)
    assert summary_of_whole([0], of_two) == Summary(None, None, None, 0)
