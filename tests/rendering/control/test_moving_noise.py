"""Noise that moves along is noise still: normal, of variance 1 and white; and it goes where the parts go."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.control import ModelFormat, experimental_moving_noise

WIDTH, HEIGHT = 384, 256
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
MASK = (np.abs(X - 120) < 72) & (np.abs(Y - 128) < 72)
FORM = ModelFormat(frames=9, width=WIDTH, height=HEIGHT)


def motion(change: object) -> Motion:
    """Three poses of a square: as drawn, half changed, changed."""
    mesh = mesh_from_mask(MASK, spacing=12)
    poses = [mesh.vertices + share * (change(mesh.vertices) - mesh.vertices) for share in (0, 0.5, 1)]  # type: ignore[operator]
    return Motion((Body(mesh, preset("jelly")),), np.stack(poses).astype(np.float32), 24.0)


CHANGES = {
    "slid": lambda p: p + (64.0, 16.0),
    "slid by parts of cells": lambda p: p + (5.3, -3.7),
    "stretched": lambda p: (p - (48, 56)) * (2.0, 1.25) + (48, 40),
    "squeezed": lambda p: (p - (120, 128)) * (0.3, 0.5) + (120, 128),
    "bent": lambda p: p + np.stack([24 * np.sin(p[:, 1] / 30), 18 * np.cos(p[:, 0] / 25)], axis=1),
    "torn tenfold": lambda p: (p - (120, 128)) * 10 + (120, 128),
}


@pytest.mark.parametrize("name", CHANGES)
@pytest.mark.parametrize("scale", [1, 2])
def test_it_is_white_noise_in_every_frame(name: str, scale: int) -> None:
    form = ModelFormat(frames=9, width=WIDTH * scale, height=HEIGHT * scale)
    noise = experimental_moving_noise(motion(CHANGES[name]), form, channels=24, seed=3)
    assert noise.shape == (3, 24, HEIGHT * scale // 8, WIDTH * scale // 8)
    for frame in noise:
        error = 4.5 / np.sqrt(frame.size)
        assert abs(frame.mean()) < error
        assert abs(frame.var() - 1) < error * np.sqrt(2)
        assert abs((frame**4).mean() - 3) < error * np.sqrt(96), "kurtosis of a normal distribution"
        for shift in ((0, 1), (1, 0), (1, 1), (1, -1), (0, 2), (2, 0), (0, 3)):
            assert abs((frame * np.roll(frame, shift, axis=(1, 2))).mean()) < error, f"correlated at {shift}"
        assert abs((frame[:-1] * frame[1:]).mean()) < error, "channels are independent"
        each = (frame**2).mean(axis=0)
        assert np.abs(each - 1).max() < 6 * np.sqrt(2 / 24), "of variance 1 in every cell, edges of parts as well"


def test_it_goes_along_with_the_part_and_stands_beside_it() -> None:
    noise = experimental_moving_noise(motion(CHANGES["slid"]), FORM, seed=1)
    inside = (slice(None), slice(8, 22), slice(7, 22))
    moved = (slice(None), slice(10, 24), slice(15, 30))
    assert np.abs(noise[2][moved] - noise[0][inside]).max() < 1e-5, "eight cells and two: the very same numbers"
    assert np.abs(noise[2][:, :, 35:] - noise[0][:, :, 35:]).max() < 1e-5, "the ground stands"
    part = experimental_moving_noise(motion(lambda p: p + (4.0, 0.0)), FORM, seed=1)
    kept = (part[2][inside] * part[0][inside]).mean()
    assert kept == pytest.approx(0.5, abs=0.05), "half a cell further, half of the numbers are the same"


def test_it_is_the_same_for_the_same_seed_and_another_for_another() -> None:
    same = [experimental_moving_noise(motion(CHANGES["bent"]), FORM, channels=2, seed=seed) for seed in (5, 5, 6)]
    assert (same[0] == same[1]).all()
    assert abs((same[0] * same[2]).mean()) < 4.5 / np.sqrt(same[0].size)
    with pytest.raises(InvalidInputError, match="channels"):
        experimental_moving_noise(motion(CHANGES["bent"]), FORM, channels=0)
