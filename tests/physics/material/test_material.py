"""Materials and presets."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import PRESETS, Material, preset


def test_lame_parameters_by_hand() -> None:
    mu, lam = Material(youngs_modulus=520.0, poisson_ratio=0.3).lame
    assert mu == pytest.approx(200.0)
    assert lam == pytest.approx(300.0)


def test_lame_parameters_without_narrowing() -> None:
    assert Material(youngs_modulus=10.0, poisson_ratio=0.0).lame == (5.0, 0.0)


@pytest.mark.parametrize("ratio", [0.0, 0.2, 0.45])
def test_lame_parameters_give_back_young_and_poisson(ratio: float) -> None:
    mu, lam = Material(youngs_modulus=77.0, poisson_ratio=ratio).lame
    assert mu * (3 * lam + 2 * mu) / (lam + mu) == pytest.approx(77.0)
    assert lam / (2 * (lam + mu)) == pytest.approx(ratio)


def test_lame_parameters_given_are_kept_to_the_last_bit() -> None:
    """They are those of the paper's energy; Young and Poisson follow, up to what is almost incompressible."""
    for mu, lam in ((0.1, 0.3), (1 / 3, 0.0), (1e-3, 1e12), (3e11, 0.1)):
        material = Material(mu=mu, lambda_=lam)
        assert material.lame == (mu, lam)
        assert replace(material, damping=3.0).lame == (mu, lam)
        assert material.poisson_ratio < 0.5
        assert material.youngs_modulus == pytest.approx(mu * (3 * lam + 2 * mu) / (lam + mu))
    assert Material(mu=5.0, lambda_=0.0).youngs_modulus == 10.0
    back = replace(Material(mu=200.0, lambda_=300.0), mu=None, lambda_=None)
    assert (back.youngs_modulus, back.poisson_ratio) == (pytest.approx(520.0), pytest.approx(0.3))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"mu": 1.0}, "lambda must be given together with mu"),
        ({"lambda_": 1.0}, "mu must be given together with lambda"),
        ({"mu": 1.0, "lambda_": 0.0, "sway_frequency": 2.0}, "sway_frequency must be left out"),
        ({"mu": 0.0, "lambda_": 0.0}, "mu must be above 0"),
        ({"mu": 1.0, "lambda_": -0.1}, "lambda must be 0 to"),
        ({"mu": 1.0, "lambda_": math.nan}, "lambda must be 0 to"),
    ],
)
def test_lame_parameters_that_cannot_be_are_refused(given: dict[str, float], words: str) -> None:
    with pytest.raises(InvalidInputError, match=f"^{words}.*Got: "):
        Material(**given)


def test_triangles_that_are_stiffer_have_both_lame_parameters_so() -> None:
    for material in (Material(mu=200.0, lambda_=300.0), Material(youngs_modulus=520.0, poisson_ratio=0.3)):
        mu, lam = material.lame_at(np.array([520.0, 1560.0]))
        np.testing.assert_allclose(mu, [200, 600])
        np.testing.assert_allclose(lam, [300, 900])


def test_every_preset_is_itself_and_knows_its_name() -> None:
    for name, material in PRESETS.items():
        assert preset(name).lame == material.lame
        assert preset(name).name == name


def test_preset_with_changes() -> None:
    changed = preset("hair", damping=9.0, sway_frequency=None)
    assert (changed.damping, changed.sway_frequency) == (9.0, None)
    assert changed.youngs_modulus == PRESETS["hair"].youngs_modulus
    assert PRESETS["hair"].damping != 9.0


def test_unknown_preset_names_the_known_ones() -> None:
    with pytest.raises(InvalidInputError, match=r"preset must be one of hair, ribbon, .*Got: 'wood'"):
        preset("wood")


def test_stiffness_scale_is_a_copy_that_nobody_changes() -> None:
    factors = np.array([1.0, 2.0])
    material = Material(stiffness_scale=factors)
    factors[0] = 99.0
    assert material.stiffness_scale is not None
    assert material.stiffness_scale.tolist() == [1.0, 2.0]
    with pytest.raises(ValueError, match="read-only"):
        material.stiffness_scale[0] = 3.0


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("youngs_modulus", 0),
        ("youngs_modulus", math.nan),
        ("youngs_modulus", 1e13),
        ("poisson_ratio", 0.5),
        ("poisson_ratio", -0.1),
        ("density", 0),
        ("density", math.inf),
        ("damping", -1),
        ("damping", math.inf),
        ("sway_frequency", 0),
        ("sway_frequency", 1e-200),
        ("sway_frequency", math.nan),
        ("stiffness_scale", [[1.0]]),
        ("stiffness_scale", [1.0, 0.0]),
        ("stiffness_scale", [1.0, math.nan]),
    ],
)
def test_bad_values_are_named(name: str, value: object) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{name} must be .*Got: "):
        Material(**{name: value})
