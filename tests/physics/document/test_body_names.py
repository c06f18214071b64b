"""Bodies of scene documents found by their names, whatever order they come in, and what speaks of them by number."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physanimator.physics.document import (
    arranged_for,
    dumps,
    given_scene,
    loads,
    rig_points_kept,
    scene_from_dict,
    scene_over,
    scene_to_dict,
)
from physanimator.physics.errors import InvalidInputError, SceneError
from physanimator.physics.material import Material, preset
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import Circle, Polygon, RigPoint
from physanimator.physics.scene import Body, Collider, LayerRegion, Paint, Scene, advice

NAMES = ["hair", "前髪", "tail", "ribbon", "cape", "skirt"]
AREA = Polygon(((0, 0), (50, 0), (50, 50)))


def mesh(at: float) -> TriangleMesh:
    return TriangleMesh(np.array([[at, 10.0], [at + 10, 10], [at, 30]]), np.array([[0, 1, 2]]), 100, 100)


def meshes(count: int) -> list[TriangleMesh]:
    return [mesh(5.0 + 10 * number) for number in range(count)]


def scene_of(names: list[str]) -> Scene:
    """Bodies whose damping, pin and paint all tell their name."""
    numbers = [NAMES.index(name) for name in names]
    return Scene(
        tuple(
            Body(each, preset("hair", damping=1.0 + number), layer, NAMES[number])
            for layer, (each, number) in enumerate(zip(meshes(len(names)), numbers, strict=True))
        ),
        rig_points=(
            RigPoint((1.0, 1.0), Circle(5)),
            *(RigPoint((10.0 + number, 1.0), Circle(2), body=place) for place, number in enumerate(numbers)),
        ),
        paint=tuple(Paint(AREA, stiffness=2.0 + number, body=place) for place, number in enumerate(numbers)),
    )


def checked(scene: Scene, before: list[str], now: list[str]) -> None:
    """Everything is at the body of its name."""
    assert [body.name for body in scene.bodies] == now
    assert [body.layer for body in scene.bodies] == sorted(body.layer for body in scene.bodies)
    kept = [name for name in now if name in before]
    for body in scene.bodies:
        if body.name in before:
            assert body.material.damping == 1.0 + NAMES.index(body.name)
        else:
            assert (body.material.name, body.material.damping) == (Material().name, Material().damping)
    held = {now[point.body]: point.position[0] - 10 for point in scene.rig_points if point.body is not None}
    assert held == {name: NAMES.index(name) for name in kept}
    painted = {now[each.body]: each.stiffness - 2 for each in scene.paint if each.body is not None}
    assert painted == {name: NAMES.index(name) for name in kept}
    assert sum(point.body is None for point in scene.rig_points) == 1
    assert scene.absent == tuple(name for name in before if name not in now)


orders = st.lists(st.sampled_from(NAMES), min_size=1, unique=True)


@settings(deadline=None)
@given(before=orders, now=orders)
def test_all_that_is_said_of_a_body_follows_its_name(before: list[str], now: list[str]) -> None:
    document = scene_to_dict(scene_of(before), meshes=False)
    found = given_scene(document, meshes(len(now)), names=now, preset=None, sway=None, frame_rate=None)
    checked(found, before, now)
    again = given_scene(
        json.loads(dumps(found, meshes=False)), meshes(len(now)), names=now, preset=None, sway=None, frame_rate=None
    )
    assert scene_to_dict(again) == scene_to_dict(found)
    bodies = [
        Body(each, layer=layer, name=name) for layer, (each, name) in enumerate(zip(meshes(len(now)), now, strict=True))
    ]
    checked(scene_over(document, bodies), before, now)


@settings(deadline=None)
@given(before=orders, count=st.integers(1, 6))
def test_parts_without_names_take_bodies_in_order_as_ever(before: list[str], count: int) -> None:
    document = scene_to_dict(scene_of(before), meshes=False)
    assert arranged_for(document, [""] * count) == (document, ())
    if count >= len(before):
        found = scene_from_dict(document, meshes=meshes(count))
        assert [body.name for body in found.bodies[: len(before)]] == before


@settings(deadline=None)
@given(now=orders, count=st.integers(0, 4))
def test_documents_of_numbers_only_are_left_as_they_are(now: list[str], count: int) -> None:
    document = {"version": 1, "width": 100, "height": 100, "bodies": [{"material": {"preset": "leaf"}}] * count}
    document["rig_points"] = [{"position": [1, 1], "body": 0}]
    assert arranged_for(document, now)[0] is document


def test_numbers_beyond_the_documents_bodies_go_on_with_the_parts_it_does_not_know() -> None:
    points = [{"position": [number, 1], "body": number} for number in range(4)]
    document = {"version": 2, "width": 100, "height": 100, "bodies": [{"name": "tail"}], "rig_points": points}
    arranged, _ = arranged_for(document, ["hair", "tail", "cape"])
    assert [point["body"] for point in arranged["rig_points"]] == [1, 0, 2, 3]
    with pytest.raises(SceneError, match=r"rig_points\[3\].body: must be below the number of bodies"):
        scene_over(document, [Body(each, name=name) for each, name in zip(meshes(3), NAMES, strict=False)])


def test_a_body_without_a_name_among_named_ones_takes_the_next_part_that_is_free() -> None:
    document = {"version": 2, "width": 9, "height": 9, "bodies": [{"layer": 3}, {"name": "hair"}]}
    assert arranged_for(document, ["hair", "tail"])[0]["bodies"] == [{"name": "hair"}, {}]


def test_later_bodies_of_one_name_take_the_next_parts_that_are_free() -> None:
    document = {"version": 2, "width": 9, "height": 9, "bodies": [{"name": "lock", "layer": 1}, {"name": "lock"}]}
    assert arranged_for(document, ["tail", "lock"]) == (
        {**document, "bodies": [{"name": "lock"}, {"name": "lock"}]},
        (),
    )


def test_names_that_no_part_has_are_told_once() -> None:
    document = scene_to_dict(scene_of(["hair", "tail"]), meshes=False)
    scene = scene_over(document, [Body(mesh(5), name="hair")])
    (sentence,) = [line for line in advice(scene) if "tail" in line]
    assert sentence == (
        "the scene names a body that is no moving part: tail; what it says of it is left out. The parts are hair"
    )


def shoulder(name: str) -> np.ndarray:
    if name != "shoulder":
        raise InvalidInputError(f"layer must be one that stands still; there are shoulder. Got: {name}")
    return np.pad(np.ones((20, 20), bool), 40)


def with_collider(name: str) -> dict[str, Any]:
    region = {"type": "layer", "name": name}
    return {"version": 2, "width": 200, "height": 200, "contact": {}, "colliders": [{"region": region}]}


def test_a_collider_is_what_is_drawn_on_a_layer_at_any_size() -> None:
    scene = scene_from_dict(with_collider("shoulder"), meshes=[mesh(5)], layers=shoulder)
    region = scene.colliders[0].region
    assert isinstance(region, LayerRegion)
    np.testing.assert_array_equal(region.mask, shoulder("shoulder"))
    assert json.loads(dumps(scene))["colliders"] == [{"region": {"type": "layer", "name": "shoulder"}}]
    assert loads(dumps(scene), layers=shoulder).colliders[0].region.name == "shoulder"


def test_colliders_of_layers_that_are_not_there() -> None:
    with pytest.raises(SceneError, match=r"colliders\[0\].region.name.*stands still; there are shoulder. Got: arm"):
        scene_from_dict(with_collider("arm"), meshes=[mesh(5)], layers=shoulder)
    with pytest.raises(SceneError, match=r"polygon or a mask where the picture is not in layers. Got: layer arm"):
        scene_from_dict(with_collider("arm"), meshes=[mesh(5)])
    with pytest.raises(SceneError, match="name: is missing"):
        scene_from_dict({**with_collider("arm"), "colliders": [{"region": {"type": "layer"}}]}, meshes=[mesh(5)])
    with pytest.raises(SceneError, match="paint"):
        scene_from_dict(
            {"version": 2, "width": 9, "height": 9, "paint": [{"region": {"type": "layer", "name": "arm"}}]},
            meshes=[mesh(5)],
            layers=shoulder,
        )


def test_still_layers_are_kept() -> None:
    scene = Scene((Body(mesh(5)),), still=("ribbon", "前髪"))
    assert loads(dumps(scene)).still == ("ribbon", "前髪")
    assert "still" not in scene_to_dict(Scene((Body(mesh(5)),)))
    with pytest.raises(SceneError, match=r"still\[0\]: must be a text"):
        scene_from_dict({"version": 2, "width": 9, "height": 9, "still": [3]}, meshes=[mesh(5)])


def test_a_collider_of_a_mask_has_no_name() -> None:
    assert not isinstance(Collider.from_mask(np.pad(np.ones((20, 20), bool), 40)).region, LayerRegion)


def test_rig_points_that_are_left_keep_their_numbers() -> None:
    points = [{"position": [1, 1], "body": 0}, {"position": [2, 2]}, {"position": [3, 3], "body": 1}]
    size = {"version": 2, "width": 9, "height": 9}
    document = {**size, "bodies": [{"name": "tail"}, {"name": "hair"}], "rig_points": points}
    assert rig_points_kept(document, ["hair"]) == [1, 2]
    assert rig_points_kept(document, ["hair", "tail"]) == [0, 1, 2]
    assert rig_points_kept(document, ["", ""]) == [0, 1, 2]
    assert rig_points_kept(size, ["hair"]) == []
