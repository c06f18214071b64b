"""What scenes are made of, built with values of the wrong type, shape or size: each is refused with one sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from mutations import patches
from physanimator.physics.assembly import plan, with_paint, work_of_minutes
from physanimator.physics.checks import is_whole, within
from physanimator.physics.document import loads, scene_from_dict
from physanimator.physics.errors import InvalidInputError, SimulationError
from physanimator.physics.forces import EnergyStroke, Wind
from physanimator.physics.material import Material, preset
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import Motion
from physanimator.physics.rig import (
    Circle,
    Combined,
    KeyedPath,
    MaskRegion,
    Polygon,
    Pulse,
    RigPoint,
    Rotation,
    Squash,
    Swing,
    Wave,
)
from physanimator.physics.scene import Body, Collider, Contact, Paint, QueryPoint, Scene
from physanimator.physics.simulation import simulate

ODD: list[Any] = [
    "circle",
    "",
    None,
    [],
    [1, 2, 3],
    (1, 0, 0),
    {},
    object(),
    np.zeros((2, 2)),
    float("nan"),
    1e400,
    10**629,
    b"x",
    True,
]
BODIES = tuple(patches())
TRIANGLE = ((0.0, 0.0), (9.0, 0.0), (0.0, 9.0))

KINDS: list[tuple[Callable[..., Any], dict[str, Any]]] = [
    (EnergyStroke, {"path": TRIANGLE}),
    (Material, {}),
    (Body, {"mesh": BODIES[0].mesh}),
    (Scene, {"bodies": BODIES}),
    (Wind, {}),
    (Collider, {"region": Polygon(TRIANGLE)}),
    (Contact, {}),
    (Paint, {"region": Polygon(TRIANGLE)}),
    (TriangleMesh, {"vertices": np.array(TRIANGLE), "triangles": np.array([[0, 1, 2]]), "width": 9, "height": 9}),
    (Motion, {"bodies": BODIES[:1], "positions": np.zeros((1, 49, 2)), "frame_rate": 24.0}),
    (RigPoint, {"position": (0.0, 0.0)}),
    (Circle, {"radius": 2.0}),
    (Polygon, {"points": TRIANGLE}),
    (MaskRegion, {"mask": np.ones((2, 2), bool)}),
    (KeyedPath, {"times": (0.0, 1.0, 2.0), "points": TRIANGLE}),
    (Wave, {}),
    (Combined, {"motions": (Wave(),)}),
    (Rotation, {"times": (0.0, 1.0), "angles": (0.0, 9.0)}),
    (Swing, {}),
    (Squash, {"times": (0.0, 1.0), "factors": (1.0, 2.0)}),
    (Pulse, {}),
    (QueryPoint, {"x": 0.0, "y": 0.0}),
]


def sentence(build: Callable[[], Any]) -> str | None:
    """What is said of bad input; None where it is taken. Any other error goes on."""
    try:
        build()
    except InvalidInputError as error:
        return str(error)
    return None


@pytest.mark.parametrize(("kind", "good"), KINDS, ids=lambda value: getattr(value, "__name__", ""))
def test_every_field_takes_what_it_means_and_refuses_the_rest_in_a_sentence(
    kind: Callable[..., Any], good: dict[str, Any]
) -> None:
    kind(**good)
    refused = 0
    for name in kind.__dataclass_fields__:  # type: ignore[attr-defined]
        for odd in ODD:
            told = sentence(lambda: kind(**{**good, name: odd}))  # noqa: B023
            assert told is None or "Got" in told
            refused += told is not None
    assert refused >= 5 * (kind is not MaskRegion)


@pytest.mark.parametrize(
    "build",
    [
        lambda: RigPoint((0, 0), region="circle"),  # type: ignore[arg-type]
        lambda: RigPoint((0, 0), motion="wave"),  # type: ignore[arg-type]
        lambda: Wave(direction=(1, 0, 0)),  # type: ignore[arg-type]
        lambda: EnergyStroke(path=["12", "34"]),  # type: ignore[arg-type]
        lambda: EnergyStroke(radius="200"),  # type: ignore[arg-type]
        lambda: Scene(BODIES[0]),  # type: ignore[arg-type]
        lambda: Scene(BODIES, strokes=EnergyStroke()),  # type: ignore[arg-type]
        lambda: Scene(BODIES, wind=1.0),  # type: ignore[arg-type]
        lambda: preset(["hair"]),  # type: ignore[arg-type]
        lambda: simulate(Scene(BODIES)),
        lambda: simulate(Scene(BODIES), frames=2, max_minutes=float("nan")),
        lambda: simulate(Scene(BODIES), frames=2, max_minutes="5"),  # type: ignore[arg-type]
    ],
)
def test_slips_of_the_caller(build: Callable[[], Any]) -> None:
    with pytest.raises(InvalidInputError, match=r"must .*\. Got: "):
        build()


def test_numbers_of_any_kind_are_told_from_other_things() -> None:
    assert within(np.float32(0.5), 0, 1)
    assert within(10**400, 0, float("inf"))
    assert not any(within(odd, 0, 5) for odd in (True, "1", None, float("nan"), np.bool_(True), 10**400))
    assert (is_whole(3.0, 0, 5), is_whole(3.5, 0, 5), is_whole(np.int64(3), 0, 5)) == (True, False, True)


def document(**material: Any) -> dict[str, Any]:
    return {"version": 2, "width": 100, "height": 80, "bodies": [{"material": material}]}


def test_a_preset_may_be_named_otherwise() -> None:
    meshes = [body.mesh for body in BODIES]
    made = scene_from_dict(document(preset="hair", name="fringe", damping=3), meshes=meshes).bodies[0].material
    assert (made.name, made.damping, made.sway_frequency) == ("fringe", 3.0, preset("hair").sway_frequency)
    assert preset("hair", name="fringe").name == "fringe"


@pytest.mark.parametrize(
    "material",
    [
        {"density": 1e-300},
        {"density": 1e-30},
        {"density": 5e-324, "sway_frequency": 3},
        {"youngs_modulus": 1e-300, "sway_frequency": 1000},
        {"youngs_modulus": 1e12, "density": 1e-12},
        {"youngs_modulus": 1e12, "stiffness_scale": [1e6] * 72, "density_scale": [1e-300] * 72},
        {"poisson_ratio": 0.49999999999999994},
    ],
)
def test_ratios_that_leave_no_step_are_refused(material: dict[str, Any]) -> None:
    scene = scene_from_dict(document(**material), meshes=[body.mesh for body in BODIES])
    held = Scene(scene.bodies, rig_points=(RigPoint((20, 20), Circle(9)),))
    with pytest.raises(SimulationError):
        simulate(held, frames=25)


def test_meshes_too_fine_for_floats_are_refused() -> None:
    for size in (1e-9, 1e-100, 1e-150):
        mesh = TriangleMesh(size * np.array(TRIANGLE), np.array([[0, 1, 2]]), 100, 80)
        with pytest.raises(SimulationError):
            simulate(Scene((Body(mesh),)), frames=25)


@pytest.mark.parametrize("version", [10**629, 10**6])
def test_messages_hold_no_number_of_hundreds_of_digits(version: int) -> None:
    with pytest.raises(InvalidInputError, match="newer PhysAnimator") as caught:
        scene_from_dict({**document(), "version": version})
    assert len(str(caught.value)) < 250


def test_messages_hold_no_newline_of_a_key() -> None:
    with pytest.raises(InvalidInputError, match="is not known here") as caught:
        loads('{"version": 2, "width": 9, "height": 9, "a\\nb' + "k" * 4000 + '": 1}')
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 400


def test_minutes_that_are_allowed_decide() -> None:
    stiff = tuple(Body(body.mesh, Material(youngs_modulus=3e9)) for body in BODIES)
    scene = Scene(stiff)
    needed = plan(scene, frames=2400).estimated_seconds / 60
    with pytest.raises(SimulationError, match=r"set max_minutes to [\d.]+ \(now 0\.01\)"):
        simulate(scene, frames=2400, max_minutes=0.01)
    assert work_of_minutes(needed) == pytest.approx(plan(scene, frames=2400).work)
    with pytest.raises(SimulationError) as caught:
        simulate(scene, frames=2400, max_work=1e3)
    assert "max_minutes" not in str(caught.value), "a preview has a limit of its own"


def test_paint_is_rasterised_once_for_all_bodies(monkeypatch: pytest.MonkeyPatch) -> None:
    from physanimator.physics.assembly import painted_bodies

    made, mask = [], painted_bodies._mask
    monkeypatch.setattr(painted_bodies, "_mask", lambda region, mesh: made.append(region) or mask(region, mesh))
    entries = (Paint(Polygon(((0, 0), (99, 0), (99, 79))), stiffness=2.0, density=3.0), Paint(Polygon(TRIANGLE)))
    painted = with_paint(BODIES, entries)
    assert len(made) == 1
    assert painted[1].material.density_scale.max() == 3.0  # type: ignore[union-attr]
