"""Loops and wind through the whole way, from masks to files."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.scene import Body, automatic_scene
from physanimator.rendering.command import main
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.pipeline import animate

WIDTH, HEIGHT = 160, 120


def strip() -> np.ndarray:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    return (np.abs(x - 70) < 10) & (y > 15) & (y < 95)


def picture() -> np.ndarray:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    image = np.stack([80 + x * 0.8, 200 - y * 0.9, 160 + 0 * x], axis=-1)
    image[strip()] = (70, 40, 30)
    return image.astype(np.uint8)


def test_a_loop_has_its_own_number_of_frames() -> None:
    looped = animate(picture(), [strip()], timing=Timing(loop=1.5, frame_rate=12.0), wind=AutomaticWind(strength=2.0))
    assert len(looped) == 18
    assert looped.motion.loop is not None
    frames = [frame.astype(int) for frame in looped.frames()]
    steps = [np.abs(a - b).mean() for a, b in zip(frames, [*frames[1:], frames[0]], strict=True)]
    assert steps[-1] < 1.5 * max(steps[:-1])
    assert max(steps) > 0.05
    skipped = animate(
        picture(), [strip()], timing=Timing(loop=1.5, skip=3, frame_rate=12.0), wind=AutomaticWind(strength=2.0)
    )
    assert len(skipped) == 18


def test_turbulence_blows_a_field_instead_of_strokes() -> None:
    body = Body(TriangleMesh(np.array([[20.0, 10.0], [60.0, 10.0], [40.0, 90.0]]), np.array([[0, 1, 2]]), 160, 120))
    scene = automatic_scene([body], wind_strength=2.0, wind_angle=90.0, turbulence=0.25)
    assert scene.strokes == ()
    assert scene.wind is not None
    assert (scene.wind.angle, scene.wind.turbulence) == (90.0, 0.25)
    assert scene.wind.strength == pytest.approx(2.0 * np.hypot(40, 80) / 0.46 / 160)  # of the body's own unit
    assert scene.wind.turbulence_size == pytest.approx(32.0)
    assert automatic_scene([body]).wind is None


def test_the_command_line_loops(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cv2.imwrite(str(tmp_path / "picture.png"), picture())
    cv2.imwrite(str(tmp_path / "mask.png"), strip().astype(np.uint8) * 255)
    wind = ["--turbulence", "0.3", "--wind", "2", "--loop", "1", "--fps", "12", "--verbose"]
    out = str(tmp_path / "out") + "/"
    given = ["animate", str(tmp_path / "picture.png"), "--mask", str(tmp_path / "mask.png"), "-o", out]
    assert main([*given, *wind]) == 0
    assert len(list((tmp_path / "out").glob("*.png"))) == 12
    assert "loop of 1 s after" in capsys.readouterr().err
    assert main([*given, "--loop", "0"]) == 2
    assert "loop must be" in capsys.readouterr().err
    assert main([*given, "--turbulence", "2"]) == 2
    assert "turbulence must be 0 to 1" in capsys.readouterr().err


def test_a_frame_count_is_still_checked() -> None:
    with pytest.raises(InvalidInputError, match="skip must be"):
        animate(picture(), [strip()], timing=Timing(skip=72))
