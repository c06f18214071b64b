"""The presets differ as an animator expects: measured on the strip of the figure. Bounds are within 20 % of that."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.motion import Motion
from physanimator.rendering.figures import presets_figure
from physanimator.rendering.figures.preset_figure import preset_motions, tip_path


@pytest.fixture(scope="module")
def motions() -> dict[str, Motion]:
    return preset_motions()


@pytest.fixture(scope="module")
def tips(motions: dict[str, Motion]) -> dict[str, np.ndarray]:
    return {name: tip_path(motion)[:, 0] for name, motion in motions.items()}


def frequency(tip: np.ndarray) -> float:
    """At which the tip swings most once the gust is over [Hz]."""
    calm = tip[18:] * np.hanning(len(tip) - 18)
    return float(np.fft.rfftfreq(4096, 1 / 24)[np.abs(np.fft.rfft(calm, 4096)).argmax()])


def remains(tip: np.ndarray) -> float:
    """What is left of the swing in the second second of the motion in the fourth."""
    return float(np.abs(tip[72:97]).max() / np.abs(tip[24:49]).max())


def test_they_swing_from_slow_cloth_to_quick_leaf(tips: dict[str, np.ndarray]) -> None:
    found = {name: frequency(tip) for name, tip in tips.items()}
    assert found["cloth"] < 0.65
    assert 0.65 < found["hair"] < 0.85
    assert 1.3 < found["jelly"] < 1.7
    assert 1.8 < found["ribbon"] < 2.4
    assert 2.5 < found["leaf"] < 3.1


def test_jelly_rings_on_hair_follows_through_and_cloth_settles(tips: dict[str, np.ndarray]) -> None:
    found = {name: remains(tip) for name, tip in tips.items()}
    assert found["jelly"] > 0.55
    assert 0.28 < found["hair"] < 0.45
    assert 0.2 < found["ribbon"] < 0.32
    assert found["leaf"] < 0.12
    assert found["cloth"] < 0.03


def test_hair_lags_and_a_ribbon_answers_at_once(tips: dict[str, np.ndarray]) -> None:
    turning = {name: np.abs(tip).argmax() / 24 for name, tip in tips.items()}
    assert turning["ribbon"] < turning["jelly"] < turning["hair"] < turning["cloth"]
    assert turning["hair"] > 1.6 * turning["ribbon"]


def test_only_the_leaf_keeps_close_to_the_drawing(tips: dict[str, np.ndarray]) -> None:
    reach = {name: float(np.abs(tip).max()) for name, tip in tips.items()}
    leaf = reach.pop("leaf")
    assert 25 < leaf < 50
    assert min(reach.values()) > 2 * leaf


def test_the_figure_shows_each_preset_over_time() -> None:
    calls: list[tuple[int, int]] = []
    figure = presets_figure(progress=lambda *call: calls.append(call))
    assert calls == [(number, 5) for number in range(1, 6)]
    assert figure.dtype == np.uint8
    assert figure.shape[2] == 3
    assert figure.std(axis=(0, 1)).min() > 20
