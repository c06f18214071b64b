"""What is chosen for a part follows the part: neither an empty margin nor the scale of the art changes its motion."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.errors import MeshingError
from physanimator.physics.material import preset
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.scene import Body, automatic_scene
from physanimator.physics.simulation import simulate

FRAMES = 16


def strand() -> NDArray[np.bool_]:
    """A bent lock of hair on a picture of 240x160, with a gap in it."""
    y, x = np.mgrid[:160, :240] + 0.5
    middle = 110 + 20 * np.sin(y / 30)
    return (np.abs(x - middle) < 14) & (np.abs(x - middle - 3) > 3 * (y > 80)) & (y > 20) & (y < 140)


def moved(
    masks: list[NDArray[np.bool_]], *, turbulence: float | None = None
) -> tuple[list[TriangleMesh], NDArray[np.float64]]:
    """The meshes, and how far every vertex moves from frame 0 [px], shape [f, v, 2]."""
    meshes = [mesh_from_mask(mask) for mask in masks]
    scene = automatic_scene([Body(mesh, preset("hair")) for mesh in meshes], turbulence=turbulence)
    motion = simulate(scene, frames=FRAMES)
    positions = motion.positions.astype(np.float64)
    return meshes, positions - positions[0]


def rounding(*sizes: float) -> float:
    """How far apart two movements may be of which both ends are float32 positions on a picture of these sizes [px]."""
    return 2 * float(np.spacing(np.float32(max(sizes))))


@pytest.fixture(scope="module")
def alone() -> tuple[list[TriangleMesh], NDArray[np.float64]]:
    return moved([strand()])


@pytest.fixture(scope="module")
def alone_in_eddies() -> tuple[list[TriangleMesh], NDArray[np.float64]]:
    return moved([strand()], turbulence=0.8)


@pytest.mark.parametrize("turbulence", [None, 0.8])
@pytest.mark.parametrize(
    "margins",
    [
        ((0, 80), (0, 0)),
        ((160, 0), (0, 0)),
        ((0, 0), (120, 120)),
        ((0, 480), (0, 720)),
        ((900, 2000), (13, 7)),
        ((11000, 840), (500, 60)),
    ],
    ids=["below", "above", "beside", "four times as large", "a long page", "the end of a page of 800x12000"],
)
def test_an_empty_margin_changes_nothing(
    margins: tuple[tuple[int, int], ...], turbulence: float | None, request: pytest.FixtureRequest
) -> None:
    (mesh,), expected = request.getfixturevalue("alone" if turbulence is None else "alone_in_eddies")
    page = np.pad(strand(), margins)
    (padded,), motion = moved([page], turbulence=turbulence)
    shift = [margins[1][0], margins[0][0]]
    np.testing.assert_array_equal(padded.triangles, mesh.triangles)
    np.testing.assert_allclose(padded.vertices, mesh.vertices + shift, atol=1e-9)
    assert np.abs(expected).max() > 2
    np.testing.assert_allclose(motion, expected, atol=rounding(*page.shape))


@pytest.mark.parametrize(("size", "tolerance"), [(1, 0.1), (4, 0.02)])
def test_the_same_art_twice_as_large_moves_twice_as_far(size: int, tolerance: float) -> None:
    # Of small art triangles are larger in its units, because none is smaller than some pixels.
    masks = [np.kron(strand(), np.ones((scale, scale), bool)) for scale in (size, 2 * size)]
    wanted, got = (np.linalg.norm(moved([mask])[1], axis=2).max(axis=1) for mask in masks)
    np.testing.assert_allclose(got[1:], 2 * wanted[1:], rtol=tolerance)


def test_a_small_part_keeps_its_relation_to_a_large_one_on_any_page() -> None:
    small = np.zeros((160, 240), bool)
    small[40:80, 180:190] = True
    _, expected = moved([strand(), small])
    _, motion = moved([np.pad(each, ((0, 320), (0, 0))) for each in (strand(), small)])
    np.testing.assert_allclose(motion, expected, atol=rounding(480))


@pytest.mark.parametrize(("width", "height"), [*product((3, 6, 20), (4, 11, 20)), (1, 9)])
def test_parts_of_a_few_pixels_bend_by_a_fraction_of_themselves(width: int, height: int) -> None:
    mask = np.zeros((32, 32), bool)
    mask[6 : 6 + height, 5 : 5 + width] = True
    (mesh,), motion = moved([mask])
    size = np.hypot(width, height)
    assert len(mesh.triangles) >= 12
    assert np.all(np.ptp(mesh.vertices, axis=0) == pytest.approx((width, height), abs=0.6))
    largest = np.linalg.norm(motion, axis=2).max()
    assert 0.002 * size < largest < 0.6 * size


def test_single_pixels_beside_a_small_part_are_dropped_and_a_small_part_beside_a_large_one() -> None:
    mask = np.zeros((64, 64), bool)
    mask[10:16, 10:14] = True
    mask[40, 40] = True
    assert mesh_from_mask(mask).components.max() == 0
    mask[20:60, 20:60] = True
    assert mesh_from_mask(mask).components.max() == 1
    assert mesh_from_mask(mask, smallest_part=30).components.max() == 0
    with pytest.raises(MeshingError, match="white part of at least 2000 px"):
        mesh_from_mask(mask, smallest_part=2000)
