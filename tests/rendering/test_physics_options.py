"""Materials and the integrator as options of animate() and of the command line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from command_status import status
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import PRESETS, Material, preset, with_values
from physanimator.physics.scene import Scene, StrokesAs
from physanimator.rendering.animation import Animation
from physanimator.rendering.command.physics_options import STROKES_AS
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.physics_options import PhysicsOptions
from physanimator.rendering.pictures import save_image
from physanimator.rendering.pipeline import animate

PICTURE = np.full((90, 120, 3), 220, np.uint8)
LEFT, RIGHT = np.zeros((90, 120), bool), np.zeros((90, 120), bool)
LEFT[10:80, 20:40], RIGHT[10:80, 80:100] = True, True


def animated(physics: PhysicsOptions, **options: Any) -> Animation:
    timing, wind = Timing(frames=13), AutomaticWind(strength=3.0)
    return animate(PICTURE, [LEFT, RIGHT], timing=timing, wind=wind, spacing=10.0, physics=physics, **options)


def way(animation: Animation) -> float:
    return float(np.linalg.norm(animation.motion.positions - animation.motion.positions[0], axis=2).max())


def test_motion_is_the_same_by_lame_parameters_and_by_young_and_poisson() -> None:
    lame = animated(PhysicsOptions(mu=2.0, lambda_=3.0))
    young = animated(PhysicsOptions(youngs_modulus=5.2, poisson_ratio=0.3))
    np.testing.assert_allclose(lame.motion.positions, young.motion.positions, atol=1e-3)
    assert way(lame) > 1
    assert [body.material.lame for body in lame.scene.bodies] == [(2.0, 3.0)] * 2
    assert [body.material.sway_frequency for body in young.scene.bodies] == [None, None]


def test_lambda_may_be_0_and_each_part_have_its_own_values() -> None:
    bodies = animated(PhysicsOptions(mu=(50.0, 5000.0), lambda_=0.0, stretch_limit=0.0)).scene.bodies
    assert [body.material.lame for body in bodies] == [(50.0, 0.0), (5000.0, 0.0)]
    assert [body.material.stretch_limit for body in bodies] == [None, None]
    assert [body.material.root_stiffness for body in bodies] == [PRESETS["hair"].root_stiffness] * 2


def test_time_step_strokes_and_sag_reach_the_scene() -> None:
    soft = {"mu": 3.0, "lambda_": 2.0, "root_stiffness": 1.0, "stretch_limit": 0.0}
    scene = animated(PhysicsOptions(**soft, time_step=0.001, strokes_as="force", sag=True)).scene
    assert (scene.time_step, scene.strokes_as, scene.sag) == (0.001, "force", True)
    again = animated(PhysicsOptions(time_step=0.0), scene=scene).scene
    assert (again.time_step, again.strokes_as) == (None, "force")
    assert again.bodies[0].material.lame == (3.0, 2.0)


def test_values_stand_above_what_a_scene_says_and_leave_the_rest() -> None:
    first = animated(PhysicsOptions(mu=200.0, lambda_=300.0))
    second = animated(PhysicsOptions(density=4.0), scene=first.scene)
    assert [body.material.lame for body in second.scene.bodies] == [(200.0, 300.0)] * 2
    assert [body.material.density for body in second.scene.bodies] == [4.0, 4.0]
    third = animated(PhysicsOptions(lambda_=10.0), scene=first.scene)
    assert third.scene.bodies[0].material.lame == (200.0, 10.0)
    fourth = animated(PhysicsOptions(), scene=first.scene, sway=2.0)
    assert fourth.scene.bodies[0].material.mu is None


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"mu": 0.0, "lambda_": 1.0}, "mu must be above 0"),
        ({"mu": 1.0, "lambda_": (1.0, -1.0)}, "lambda must be 0 to"),
        ({"mu": 1.0, "lambda_": 1.0, "youngs_modulus": 5.0}, "youngs_modulus must be left out where mu and lambda are"),
        ({"mu": 1.0, "lambda_": 1.0, "poisson_ratio": 0.1}, "poisson_ratio must be left out"),
        ({"density": ()}, "density must be a number for all parts"),
        ({"density": "4"}, "density must be above 0"),
        ({"time_step": 1.0}, "time_step must be 1e-05 to"),
        ({"strokes_as": "wind"}, "strokes_as must be one of acceleration, force, vertex_force"),
        ({"sag": 1}, "sag must be True or False"),
    ],
)
def test_wrong_values_are_refused_before_any_work(values: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidInputError, match=f"^{words}"):
        PhysicsOptions(**values)


@pytest.mark.parametrize(
    ("values", "options", "words"),
    [
        ({"mu": 1.0}, {}, "lambda must be given together with mu"),
        (
            {"density": (1.0, 2.0, 3.0)},
            {},
            "density must be one number for all parts, or one for each of the 2. Got: 3",
        ),
        ({"mu": 1.0, "lambda_": 1.0}, {"sway": 1.0}, "sway_frequency must be left out where mu and lambda are given"),
        ({"youngs_modulus": 1.0}, {"sway": 1.0}, "sway_frequency must be left out where youngs_modulus is given"),
    ],
)
def test_values_that_do_not_suit_the_parts_are_refused(
    values: dict[str, Any], options: dict[str, Any], words: str
) -> None:
    with pytest.raises(InvalidInputError, match=f"^{words}"):
        animated(PhysicsOptions(**values), **options)


def test_what_says_how_stiff_it_is_takes_the_place_of_what_said_so_before() -> None:
    hair = preset("hair")
    assert with_values(hair, youngs_modulus=9.0).sway_frequency is None
    assert with_values(hair, poisson_ratio=0.1).sway_frequency == hair.sway_frequency
    lame = with_values(hair, mu=200.0, lambda_=300.0)
    assert (lame.sway_frequency, lame.damping) == (None, hair.damping)
    assert with_values(lame, sway_frequency=2.0).mu is None
    assert with_values(lame, poisson_ratio=0.0).lame == pytest.approx((260.0, 0.0))
    assert with_values(lame, damping=None, density=3.0).lame == (200.0, 300.0)
    assert with_values(Material(), mu=1.0, lambda_=0.0).lame == (1.0, 0.0)


def test_command_takes_them_and_names_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    save_image(tmp_path / "girl.png", PICTURE)
    save_image(tmp_path / "hair.png", LEFT.astype(np.uint8) * 255)
    picture, out, said = (str(tmp_path / name) for name in ("girl.png", "out.gif", "scene.json"))
    begin = ("animate", picture, "--mask", str(tmp_path / "hair.png"), "-o", out, "-q", "--frames", "3")
    lame = ("--mu", "3", "--lambda", "0", "--density", "2", "--root-stiffness", "1", "--spacing", "10")
    assert status(*begin, *lame, "--time-step", "0.001", "--strokes-as", "force", "--sag", "--save-scene", said) == 0
    document = json.loads(Path(said).read_text(encoding="utf-8"))
    material = document["bodies"][0]["material"]
    assert (material["mu"], material["lambda"], material["density"]) == (3, 0, 2)
    assert (document["time_step"], document["strokes_as"], document["sag"]) == (0.001, "force", True)
    assert status(*begin, "--scene", said, "--spacing", "10") == 0
    assert status(*begin, "--mu", "3000", "--lambda", "0", "--time-step", "0.001") == 2
    (message,) = [line for line in capsys.readouterr().err.splitlines() if "warning:" not in line]
    assert message.startswith("physanimator: --time-step must be at most 0.000")
    assert get_args(StrokesAs) == STROKES_AS
    assert Scene.__dataclass_fields__["strokes_as"].default == STROKES_AS[0]
