"""Where soft inpainting may change a frame: the holes of a motion, with soft edges."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.inpainting import change_map

HOLE = np.zeros((60, 80), np.float32)
HOLE[20:40, 30:50] = 1


def distance(size: tuple[int, int]) -> np.ndarray:
    """Of each pixel's centre from the hole's sides [px]."""
    rows, columns = np.mgrid[: size[0], : size[1]] + 0.5
    return np.hypot(np.maximum(abs(rows - 30) - 10, 0), np.maximum(abs(columns - 40) - 10, 0))


def test_1_in_the_hole_and_falling_beside_it() -> None:
    found, away = change_map(HOLE, grow=3, soft_edge=10), distance(HOLE.shape)
    assert (found[away <= 2.5] == 1).all()
    assert (found[away >= 14] == 0).all()
    order = np.argsort(away[away > 0], kind="stable")
    assert np.diff(found[away > 0][order]).max() < 0.12
    between = found[30, 53:63]
    assert (np.diff(between) < 0).all()
    assert abs(float(found[30, 57] + found[30, 58]) / 2 - 0.5) < 0.08


def test_a_hard_edge_and_no_growth_are_the_hole() -> None:
    assert np.array_equal(change_map(HOLE, grow=0, soft_edge=0), HOLE)


def test_nothing_uncovered_changes_nothing() -> None:
    assert not change_map(np.zeros((9, 9), np.float32)).any()
    assert not change_map(np.full((9, 9), 0.3, np.float32)).any()


def test_everything_uncovered() -> None:
    assert (change_map(np.ones((9, 9), np.float32)) == 1).all()


def test_holes_do_not_grow_into_what_lies_over_them() -> None:
    covered = np.zeros_like(HOLE)
    covered[:, 50:] = 1
    found = change_map(HOLE, covered, grow=6, soft_edge=0)
    assert np.array_equal(found[:, 50:] > 0, np.zeros_like(found[:, 50:], dtype=bool))
    assert found[30, 25] == 1
    assert change_map(HOLE, covered, grow=6, soft_edge=8)[30, 51] > 0.5


def test_it_lands_where_a_part_was() -> None:
    picture = np.full((90, 120, 3), 230, np.uint8)
    mask = np.zeros((90, 120), np.float32)
    mask[20:70, 30:60] = 1
    picture[mask > 0] = (200, 60, 40)
    mesh = mesh_from_mask(mask, spacing=10)
    motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (18, 0)]), frame_rate=24.0)
    renderer = LayeredRenderer(picture, [mask], motion)
    assert not change_map(renderer.uncovered(0), renderer.alpha(0)).any()
    found = change_map(renderer.uncovered(1), renderer.alpha(1), grow=2, soft_edge=6)
    assert (found[24:66, 32:46] == 1).all()
    assert (found[:, 58:] == 0).all()
    assert (found[:, :20] == 0).all()


@pytest.mark.parametrize("given", [{"grow": -1}, {"soft_edge": -1}, {"soft_edge": float("nan")}, {"grow": 1e9}])
def test_unusable_widths(given: dict[str, float]) -> None:
    with pytest.raises(InvalidInputError, match=next(iter(given))):
        change_map(HOLE, **given)
