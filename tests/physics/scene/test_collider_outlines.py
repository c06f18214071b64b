"""Colliders that are drawn far out, ragged or crowded: what they are near the bodies counts, and it is counted."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mutations import patches
from physanimator.nodes.preview import PreviewRequest, preview_scene
from physanimator.physics.assembly import assemble, plan
from physanimator.physics.contact import contact_surface
from physanimator.physics.errors import Cancelled, InvalidInputError, SimulationError
from physanimator.physics.interruption import interruptible
from physanimator.physics.mesh import signed_distances, within_reach
from physanimator.physics.rig import Circle, KeyedPath, MaskRegion, Polygon, RigPoint
from physanimator.physics.scene import Collider, Contact, Scene, count_outlines, spacing_of, window_of
from physanimator.physics.simulation import simulate

FAR = Polygon(((0, 0), (1e6, 1), (1e6, 60)))
GROUND = Polygon(((-150, 66), (250, 66), (250, 170), (-150, 170)))
WIDE = Polygon(((-1e5, 66), (1e5, 66), (1e5, 170), (-1e5, 170)))


def falling(*regions: Polygon | MaskRegion, **changes: Any) -> Scene:
    colliders = tuple(Collider(region) for region in regions)
    return Scene(tuple(patches()), gravity=(0.0, 3.0), contact=Contact(), colliders=colliders, **changes)


def test_a_ground_drawn_far_out_acts_as_one_that_ends_near_by() -> None:
    near, wide = (simulate(falling(region), frames=20).positions for region in (GROUND, WIDE))
    assert np.abs(near[-1] - near[0]).max() > 4, "they fall"
    assert near[-1, :, 1].max() < 67, "onto the ground"
    np.testing.assert_allclose(wide, near, atol=0.3)


@pytest.mark.parametrize("count", [2, 40])
def test_the_work_does_not_grow_with_what_is_far_off(count: int) -> None:
    scene = falling(*[FAR] * count)
    surface, still = contact_surface(scene, assemble(scene), scene.contact or Contact())
    assert len(still) < 700 * count
    assert np.abs(still).max() < 6, "sides: nothing of it lies beyond the window"
    assert plan(scene, frames=5).outline_points == pytest.approx(len(still), rel=0.05)
    assert len(surface.points) < 800 * count


def test_a_polygon_keeps_its_inside_within_the_window() -> None:
    random = np.random.default_rng(4)
    scene = falling()
    window = window_of(scene)
    probes = random.uniform(window.low, window.high, (400, 2))
    for _ in range(20):
        polygon = Polygon(tuple(map(tuple, random.uniform(-2000, 2000, (7, 2)))))
        corners = np.array(polygon.points)
        inside = signed_distances(probes, corners, np.roll(corners, -1, axis=0)) < 0
        _, still = contact_surface(replace(scene, colliders=(Collider(polygon),)), assemble(scene), Contact())
        starts = still * scene.width
        found = (
            signed_distances(probes, starts, np.roll(starts, -1, axis=0)) < 0 if len(starts) else np.zeros(400, bool)
        )
        assert (found == inside).mean() > 0.995


def test_where_bodies_are_led_the_window_reaches_farther() -> None:
    led = RigPoint((40, 40), Circle(20), KeyedPath((0, 1), ((40, 40), (140, 40))))
    assert (window_of(falling(rig_points=(led,))).high == window_of(falling()).high + 100).all()


def test_only_what_is_near_an_outline_is_found_and_exactly_as_far() -> None:
    random = np.random.default_rng(1)
    for _ in range(10):
        corners = random.uniform(0, 1, (60, 2))
        ends, points = np.roll(corners, -1, axis=0), random.uniform(-0.2, 1.2, (500, 2))
        exact = signed_distances(points, corners, ends)
        found, distances = within_reach(points, corners, ends, 0.03)
        np.testing.assert_array_equal(found, np.flatnonzero(exact < 0.03))
        np.testing.assert_array_equal(distances, exact[found])


def zigzag(count: int, width: float = 100.0) -> Polygon:
    return Polygon(tuple((width * k / count, 80.0 * (k % 2)) for k in range(count)))


def test_colliders_count_as_work() -> None:
    bare, ragged = (plan(falling(*regions), frames=25).work for regions in ((), (zigzag(60),)))
    assert ragged > 2 * bare


@pytest.mark.parametrize(
    ("regions", "words"),
    [
        ([zigzag(9000)] * 2, "at most 200,000 points together; draw the colliders with fewer corners"),
        ([MaskRegion(np.indices((3000, 3000)).sum(axis=0) % 2 == 0)], "must pass at most"),
    ],
)
def test_more_than_can_be_prepared_is_refused_before(regions: list[Any], words: str) -> None:
    with pytest.raises(SimulationError, match=words):
        simulate(falling(*regions), frames=2)


@pytest.mark.parametrize(
    ("region", "words"),
    [
        ({"type": "polygon", "points": zigzag(700).points}, "points of colliders' outlines"),
        ({"type": "polygon", "points": zigzag(400).points}, "close upon each other"),
        ({"type": "mask", "width": 600.0, "height": 600.0, "runs": [1] * 360_000}, "colliders"),
    ],
)
def test_a_preview_shows_less(region: dict[str, Any], words: str) -> None:
    document = {"version": 2, "width": 100, "height": 80, "contact": {}, "colliders": [{"region": region}]}
    document["colliders"][0]["region"]["points"] = [list(p) for p in region.get("points", [])]  # type: ignore[index]
    if region["type"] == "mask":
        del document["colliders"][0]["region"]["points"]  # type: ignore[index]
    with pytest.raises(InvalidInputError, match=words):
        preview_scene(PreviewRequest("one", "0" * 64, document, 5), patches())


def test_long_preparations_can_be_given_up() -> None:
    scene, asked = falling(*[zigzag(200)] * 3), 0
    system = assemble(scene)

    def stop() -> None:
        nonlocal asked
        asked += 1
        if asked == 5:
            raise Cancelled("enough")

    with interruptible(stop), pytest.raises(Cancelled):
        contact_surface(scene, system, Contact())
    assert asked == 5


def test_an_ordinary_outline_is_not_crowded() -> None:
    scene = falling(GROUND)
    points, crossings, crowding = count_outlines(scene, spacing_of(scene.bodies))
    assert (crossings, crowding < 6 * points) == (0, True)


def test_an_outline_of_no_size_contains_nothing() -> None:
    """Even one whose height is the smallest number that there is."""
    starts = np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 2e-311]])
    points = np.random.default_rng(0).uniform(-8, 8, (200, 2))
    assert (signed_distances(points, starts, np.roll(starts, -1, axis=0)) > 0).all()
