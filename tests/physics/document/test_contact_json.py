"""Contact and colliders in scene documents."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from physanimator.physics.document import dumps, loads, scene_from_dict, scene_to_dict
from physanimator.physics.errors import SceneError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import MaskRegion, Polygon
from physanimator.physics.scene import Body, Collider, Contact, Scene

MESH = TriangleMesh(np.array([[10.0, 10], [90, 10], [50, 80]]), np.array([[0, 1, 2]]), 100, 100)
CORNERS = ((0.0, 90.0), (100.0, 90.0), (100.0, 100.0))


def document(**entries: Any) -> dict[str, Any]:
    return {"version": 1, "width": 100, "height": 100, **entries}


def test_contact_and_colliders_survive_a_round_trip() -> None:
    mask = np.zeros((5, 7), dtype=bool)
    mask[2:4, 1:5] = True
    colliders = (Collider(Polygon(CORNERS)), Collider.from_mask(mask))
    scene = Scene((Body(MESH),), contact=Contact(0.5, 2.5, True), colliders=colliders)
    read = loads(dumps(scene))
    assert read.contact == scene.contact
    assert read.colliders[0].region == Polygon(CORNERS)
    assert isinstance(read.colliders[1].region, MaskRegion)
    np.testing.assert_array_equal(read.colliders[1].region.mask, mask)


def test_a_scene_without_contact_says_nothing_of_it() -> None:
    assert not {"contact", "colliders"} & set(scene_to_dict(Scene((Body(MESH),))))
    assert scene_from_dict(document(), meshes=[MESH]).contact is None
    assert scene_from_dict(document(contact=None), meshes=[MESH]).contact is None


def test_an_empty_contact_is_the_usual_one() -> None:
    assert scene_from_dict(document(contact={}), meshes=[MESH]).contact == Contact()


def test_contact_and_colliders_scale_with_the_picture() -> None:
    polygon = {"region": {"type": "polygon", "points": [list(point) for point in CORNERS]}}
    large = document(width=200, height=200, contact={"thickness": 3}, colliders=[polygon])
    scene = scene_from_dict(large, meshes=[MESH])
    assert scene.contact == Contact(thickness=1.5)
    assert scene.colliders[0].region == Polygon(tuple((x / 2, y / 2) for x, y in CORNERS))


@pytest.mark.parametrize(
    ("entries", "path"),
    [
        ({"contact": {"friction": 2}}, "contact.friction"),
        ({"contact": {"thickness": 0}}, "contact.thickness"),
        ({"contact": {"self_contact": 1}}, "contact.self_contact"),
        ({"contact": {"frction": 0}}, "contact.frction"),
        ({"colliders": [{}]}, "colliders[0].region"),
        ({"colliders": [{"region": {"type": "circle", "radius": 3}}]}, "colliders[0].region.type"),
        (
            {"colliders": [{"region": {"type": "mask", "width": 2, "height": 2, "runs": [3]}}]},
            "colliders[0].region.runs",
        ),
        (
            {"colliders": [{"region": {"type": "mask", "width": 65536, "height": 65536, "runs": [3]}}]},
            "colliders[0].region",
        ),
    ],
)
def test_wrong_entries_are_named(entries: dict[str, Any], path: str) -> None:
    with pytest.raises(SceneError) as caught:
        scene_from_dict(document(**entries), meshes=[MESH])
    assert caught.value.path == path
