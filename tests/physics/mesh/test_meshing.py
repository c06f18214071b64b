"""mesh_from_mask: conforming meshes, spacing by width, odd masks, and what is refused."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from physanimator.physics.errors import InvalidInputError, MeshingError
from physanimator.physics.mesh import TriangleMesh, area_of, mesh_from_mask, meshing
from physanimator.physics.mesh.contours import perimeter_of
from physanimator.physics.mesh.masks import continued, with_sound_details
from physanimator.physics.mesh.spacing import SpacingField, spacing_field
from physanimator.physics.mesh.triangulation import CrossingEdgesError, morton_order, triangulate
from physanimator.physics.scene import Collider
from scipy.spatial import cKDTree


def blank(height: int = 300, width: int = 400) -> np.ndarray:
    return np.zeros((height, width), np.uint8)


def disc(radius: int = 110) -> np.ndarray:
    return cv2.circle(blank(), (200, 150), radius, 255, -1, cv2.LINE_AA)


def ring() -> np.ndarray:
    return cv2.circle(disc(), (200, 150), 50, 0, -1, cv2.LINE_AA)


def several() -> np.ndarray:
    mask = cv2.circle(blank(), (80, 80), 50, 255, -1, cv2.LINE_AA)
    mask = cv2.circle(mask, (80, 80), 20, 0, -1, cv2.LINE_AA)
    cv2.rectangle(mask, (200, 40), (360, 120), 255, -1)
    return cv2.ellipse(mask, (200, 220), (120, 40), 15, 0, 360, 255, -1, cv2.LINE_AA)


def strands() -> np.ndarray:
    mask = blank()
    for shift in range(0, 200, 26):
        tip = [130 + 1.2 * shift, 290 - 0.3 * shift]
        cv2.fillPoly(mask, [np.array([[100 + shift, 20], [120 + shift, 15], tip]).astype(np.int32)], 255, cv2.LINE_AA)
    cv2.rectangle(mask, (90, 10), (320, 60), 255, -1)
    return mask


def noise(seed: int, sigma: float = 9.0, level: float = 0.0, size: tuple[int, int] = (220, 300)) -> np.ndarray:
    field = np.random.default_rng(seed).standard_normal(size).astype(np.float32)
    field = cv2.GaussianBlur(field, (0, 0), sigma)
    return field > level * field.std()


def has_a_part(mask: np.ndarray, area: int = 16) -> bool:
    """Whether some connected part is large enough to be meshed."""
    statistics = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)[2]
    return bool((statistics[1:, cv2.CC_STAT_AREA] >= area).any())


SHAPES = {
    "disc": (disc(), 1, 0),
    "ring": (ring(), 1, 1),
    "several": (several(), 3, 1),
    "strands": (strands(), 1, None),
    "noise": (noise(4), None, None),
}


def corners(mesh: TriangleMesh) -> np.ndarray:
    return mesh.vertices[mesh.triangles]


def smallest_angles(mesh: TriangleMesh) -> np.ndarray:
    side = np.stack([np.hypot(*(corners(mesh)[:, k] - corners(mesh)[:, k - 1]).T) for k in range(3)], axis=1)
    side.sort(axis=1)
    cosine = (side[:, 1] ** 2 + side[:, 2] ** 2 - side[:, 0] ** 2) / (2 * side[:, 1] * side[:, 2])
    return np.degrees(np.arccos(cosine))


def altitudes(mesh: TriangleMesh) -> np.ndarray:
    """Smallest altitude of each triangle [px]."""
    longest = np.max([np.hypot(*(corners(mesh)[:, k] - corners(mesh)[:, k - 1]).T) for k in range(3)], axis=0)
    return 2 * mesh.areas / longest


def deepest_intrusion(mesh: TriangleMesh) -> float:
    """How far a vertex lies inside any triangle's circumcircle, in radii of that circle."""
    a, b, c = (corners(mesh)[:, k] for k in range(3))
    u, v = b - a, c - a
    double = 2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    uu, vv = (u * u).sum(axis=1), (v * v).sum(axis=1)
    offset = np.stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu], axis=1) / double[:, None]
    radius = np.hypot(*offset.T)
    nearest, _ = cKDTree(mesh.vertices).query(a + offset)
    return float(((radius - nearest) / radius).max())


def boundary_loops(mesh: TriangleMesh) -> list[np.ndarray]:
    follower = dict(mesh.boundary_edges.tolist())
    assert len(follower) == len(mesh.boundary_edges), "a boundary vertex has two ways on"
    loops = []
    while follower:
        start, at = next(iter(follower.items()))
        del follower[start]
        chain = [start]
        while at != start:
            chain.append(at)
            at = follower.pop(at)
        loops.append(mesh.vertices[chain])
    return loops


def euler_characteristic(mesh: TriangleMesh) -> int:
    return len(mesh.vertices) - len(mesh.edges) + len(mesh.triangles)


def coverage_of_mesh(mesh: TriangleMesh) -> np.ndarray:
    image = np.zeros((mesh.height, mesh.width), np.uint8)
    for triangle in corners(mesh):
        cv2.fillPoly(image, [np.rint((triangle - 0.5) * 256).astype(np.int32)], 1, cv2.LINE_8, 8)
    return image > 0


def triangles_across(mesh: TriangleMesh, start: tuple[float, float], end: tuple[float, float]) -> float:
    """How many layers of triangles a straight cut passes: the triangles that it cuts, two to a layer."""
    at = np.linspace(0, 1, 300)[:, None]
    points = np.array(start) * (1 - at) + np.array(end) * at
    a, b, c = (corners(mesh)[:, k] for k in range(3))

    def side(p: np.ndarray, q: np.ndarray) -> np.ndarray:
        d = q - p
        return d[:, 0] * (points[:, None, 1] - p[:, 1]) - d[:, 1] * (points[:, None, 0] - p[:, 0])

    hit = (side(a, b) <= 0) & (side(b, c) <= 0) & (side(c, a) <= 0)
    return np.count_nonzero(hit.any(axis=0)) / 2


@pytest.fixture(scope="module", params=SHAPES)
def shape(request: pytest.FixtureRequest) -> tuple[TriangleMesh, int | None, int | None]:
    mask, components, holes = SHAPES[request.param]
    return mesh_from_mask(mask, spacing=11.0), components, holes


def test_every_circumcircle_is_empty(shape: tuple[TriangleMesh, int | None, int | None]) -> None:
    assert deepest_intrusion(shape[0]) < 1e-7


def test_boundary_is_closed_and_encloses_the_triangles(shape: tuple[TriangleMesh, int | None, int | None]) -> None:
    mesh = shape[0]
    loops = boundary_loops(mesh)
    assert -sum(map(area_of, loops)) == pytest.approx(mesh.areas.sum(), rel=1e-9)


def test_euler_characteristic_is_components_minus_holes(shape: tuple[TriangleMesh, int | None, int | None]) -> None:
    mesh, components, holes = shape
    found = len(set(mesh.components.tolist()))
    found_holes = len(boundary_loops(mesh)) - found
    assert euler_characteristic(mesh) == found - found_holes
    assert found == (components or found)
    assert found_holes == (found_holes if holes is None else holes)


def test_angles_and_winding(shape: tuple[TriangleMesh, int | None, int | None]) -> None:
    mesh = shape[0]
    assert smallest_angles(mesh).min() > 24.99
    a, b, c = (corners(mesh)[:, k] for k in range(3))
    assert (np.cross(np.pad(b - a, ((0, 0), (0, 1))), np.pad(c - a, ((0, 0), (0, 1))))[:, 2] < 0).all()


def test_every_vertex_is_used_and_no_two_coincide(shape: tuple[TriangleMesh, int | None, int | None]) -> None:
    mesh = shape[0]
    assert len(np.unique(mesh.triangles)) == len(mesh.vertices)
    distance, _ = cKDTree(mesh.vertices).query(mesh.vertices, k=2)
    assert distance[:, 1].min() > 1.0


def test_refinement_raises_the_angles_that_bad_seeds_leave() -> None:
    ticks = np.arange(0.0, 120.0, 6.0)
    low, high = np.stack([ticks, 0 * ticks], axis=1), np.stack([120 - ticks, 0 * ticks + 60], axis=1)
    field = SpacingField(np.full((4, 4), 6.0), 40)
    seeds = np.random.default_rng(1).uniform((20, 20), (100, 40), (8, 2))
    raw = TriangleMesh(*triangulate([np.concatenate([low, high])], seeds, field, min_angle=0), 120, 60)
    refined = TriangleMesh(*triangulate([np.concatenate([low, high])], seeds, field, min_angle=25), 120, 60)
    assert smallest_angles(raw).min() < 15
    assert smallest_angles(refined).min() >= 25 - 1e-6
    assert deepest_intrusion(refined) < 1e-7


def test_refinement_leaves_no_low_triangles_in_sharp_tips() -> None:
    random = np.random.default_rng(1)
    for _ in range(120):
        half, length, spacing = np.radians(random.uniform(12.5, 25)), random.uniform(10, 40), random.uniform(2.5, 6)
        tip = np.array([50.0, 5.0])
        left, right = (tip + length * np.array([side * np.sin(half), np.cos(half)]) for side in (-1, 1))
        pieces = [max(1, round(length / spacing * random.uniform(0.8, 1.2))) for _ in range(2)]
        base = max(1, round(2 * length * np.sin(half) / spacing))
        sides = ((tip, left, pieces[0]), (left, right, base), (right, tip, pieces[1]))
        loop = np.concatenate([a + (b - a) * (np.arange(count) / count)[:, None] for a, b, count in sides])
        field = SpacingField(np.full((30, 30), spacing), 4)
        mesh = TriangleMesh(*triangulate([loop], np.empty((0, 2)), field, min_angle=25), 100, 100)
        assert altitudes(mesh).min() > 0.15 * spacing
        assert deepest_intrusion(mesh) < 1e-7


def test_crossing_polygons_are_reported() -> None:
    bow_tie = np.array([[0, 0], [40, 30], [40, 0], [0, 30.0]])
    with pytest.raises(CrossingEdgesError):
        triangulate([bow_tie], np.empty((0, 2)), SpacingField(np.full((2, 2), 9.0), 30), min_angle=25)


def test_outlines_that_cross_are_sampled_more_finely(monkeypatch: pytest.MonkeyPatch) -> None:
    triangulate_once = meshing.triangulate
    spacings: list[float] = []

    def fail_twice(loops: list[np.ndarray], seeds: np.ndarray, field: SpacingField, **options: float) -> object:
        spacings.append(float(field.values.max()))
        if len(spacings) < 3:
            raise CrossingEdgesError("edges cross")
        return triangulate_once(loops, seeds, field, **options)

    monkeypatch.setattr(meshing, "triangulate", fail_twice)
    mesh_from_mask(disc(), spacing=20.0)
    assert spacings == pytest.approx([20.0, 14.0, 9.8])


def test_mesh_keeps_the_polygons_it_was_given(monkeypatch: pytest.MonkeyPatch) -> None:
    given_loops: list[np.ndarray] = []
    triangulate = meshing.triangulate

    def spy(loops: list[np.ndarray], *args: object, **options: object) -> object:
        given_loops.extend(loops)
        return triangulate(loops, *args, **options)

    monkeypatch.setattr(meshing, "triangulate", spy)
    mesh = mesh_from_mask(noise(4), spacing=9.0, border_margin=0)
    found = boundary_loops(mesh)
    assert len(found) == len(given_loops)
    assert sum(map(perimeter_of, found)) == pytest.approx(sum(map(perimeter_of, given_loops)), rel=1e-9)
    assert mesh.areas.sum() == pytest.approx(-sum(map(area_of, given_loops)), rel=1e-9)
    points = np.concatenate(found)
    shift = points.min(axis=0) - np.concatenate(given_loops).min(axis=0)
    for loop in given_loops:
        distance, at = cKDTree(points).query(loop + shift)
        assert distance.max() < 1e-9
        assert len(set(at.tolist())) == len(loop)


def test_thick_shapes_are_sampled_uniformly_at_the_spacing() -> None:
    mesh = mesh_from_mask(disc(), spacing=12.0)
    (loop,) = boundary_loops(mesh)
    steps = np.hypot(*(np.roll(loop, -1, axis=0) - loop).T)
    assert steps.mean() == pytest.approx(12.0, rel=0.02)
    assert np.ptp(steps) < 0.05
    assert np.abs(np.hypot(*(loop - 200.5 + (0, 50)).T) - 110.5).max() < 0.5
    assert altitudes(mesh).min() > 0.5 * 12


@pytest.mark.parametrize("make", [strands, several, lambda: noise(3)], ids=["strands", "several", "noise"])
def test_uniform_outlines_have_their_points_at_one_distance_in_thin_parts_too(make: Callable[[], np.ndarray]) -> None:
    """Chords over corners are shorter, and each outline takes a whole number of them."""
    spacing = 14.0

    def lengths(*, uniform: bool) -> np.ndarray:
        mesh = mesh_from_mask(make(), spacing=spacing, uniform=uniform)
        loops = boundary_loops(mesh)
        return np.concatenate([np.hypot(*(np.roll(loop, -1, axis=0) - loop).T) for loop in loops])

    sides = lengths(uniform=True)
    assert np.median(sides) == pytest.approx(spacing, rel=0.1)
    assert sides.max() < 1.2 * spacing
    assert np.percentile(sides, 10) > 0.7 * spacing
    assert np.percentile(lengths(uniform=False), 10) < 0.66 * spacing


@given(st.integers(0, 2**32 - 1), st.sampled_from([8.0, 14.0, 25.0]))
@settings(max_examples=20, deadline=None)
def test_random_masks_become_uniform_meshes_without_flat_triangles(seed: int, spacing: float) -> None:
    mask = noise(seed)
    if not has_a_part(mask):
        return
    mesh = mesh_from_mask(mask, spacing=spacing, uniform=True)
    assert altitudes(mesh).min() > 0.04 * spacing
    assert mesh.areas.sum() == pytest.approx(mesh_from_mask(mask, spacing=spacing).areas.sum(), rel=0.1)


def test_mask_is_covered_to_within_the_bulge_of_a_chord() -> None:
    mesh = mesh_from_mask(several(), spacing=8.0)
    missed = (several() > 127) & ~coverage_of_mesh(mesh)
    extra = ~(several() > 127) & coverage_of_mesh(mesh)
    depth = cv2.distanceTransform((several() > 127).astype(np.uint8), cv2.DIST_L2, 5)
    outside = cv2.distanceTransform((several() <= 127).astype(np.uint8), cv2.DIST_L2, 5)
    assert depth[missed].max(initial=0) < 3.5
    assert outside[extra].max(initial=0) < 2.0


def test_sixty_pixel_strand_gets_three_elements_across() -> None:
    mask = blank(560, 300)
    mask[80:480, 120:180] = 255
    fine = mesh_from_mask(mask, spacing=30.0)
    coarse = mesh_from_mask(mask, spacing=30.0, elements_across=1)
    for y in range(140, 421, 35):
        assert triangles_across(fine, (110, y), (190, y)) >= 2.5
    assert np.mean([triangles_across(fine, (110, y), (190, y)) for y in range(140, 421, 5)]) >= 3
    assert len(fine.triangles) > 1.8 * len(coarse.triangles)


@pytest.mark.parametrize("across", [3, 5])
def test_slanted_soft_strand_gets_its_elements_across(across: int) -> None:
    mask = cv2.line(blank(), (60, 60), (340, 240), 255, 25, cv2.LINE_AA)
    mesh = mesh_from_mask(mask, spacing=24.0, elements_across=across)
    along, normal = np.array([280, 180]) / np.hypot(280, 180), np.array([-180, 280]) / np.hypot(280, 180)
    cuts = [np.array([200.5, 150.5]) + s * along for s in range(-110, 111, 10)]
    counts = [triangles_across(mesh, tuple(c - 20 * normal), tuple(c + 20 * normal)) for c in cuts]
    assert np.mean(counts) >= across
    assert min(counts) >= across - 0.5


def test_tips_do_not_make_tiny_triangles() -> None:
    mask = blank(400, 600)
    cv2.fillPoly(mask, [np.array([[40, 150], [40, 250], [590, 205]])], 255, cv2.LINE_AA)
    mesh = mesh_from_mask(mask, spacing=15.0, smallest_spacing=4.0)
    assert altitudes(mesh).min() > 0.4 * 4.0
    assert mesh.vertices[:, 0].max() > 560
    length = np.hypot(*(mesh.vertices[mesh.edges[:, 0]] - mesh.vertices[mesh.edges[:, 1]]).T)
    assert length.min() > 0.5 * 4.0


def test_hairlines_are_widened_rather_than_lost() -> None:
    mask = blank()
    mask[50:130, 40:160] = mask[50:130, 240:360] = 255
    mask[90:91, 150:250] = 255
    mesh = mesh_from_mask(mask, spacing=12.0)
    assert len(set(mesh.components.tolist())) == 1
    assert (coverage_of_mesh(mesh)[90, 40:360]).all()
    assert altitudes(mesh).min() > 1.0


def test_spacing_changes_slowly() -> None:
    shape = np.zeros((300, 300), bool)
    shape[100:200, 40:150] = shape[145:155, 140:260] = True
    field = spacing_field(shape, spacing=20.0, floor=3.0, elements_across=3)
    for axis in (0, 1):
        assert np.abs(np.diff(field.values, axis=axis)).max() <= 0.32 * field.cell
    in_strand, in_block = field.at(np.array([[220.0, 150.0], [70.0, 150.0]]))
    assert in_strand == pytest.approx(10 / 3, rel=0.25)
    assert in_block == pytest.approx(20.0)


def test_default_spacing_makes_about_two_thousand_triangles_or_fewer() -> None:
    for mask in (np.ones((720, 1280), bool), disc(), ring(), several(), noise(2, 40.0, size=(600, 800))):
        mesh = mesh_from_mask(mask)
        assert 1000 < len(mesh.triangles) < 2200


def test_default_spacing_does_not_explode_for_thin_parts() -> None:
    for mask in (strands(), noise(2, 14.0, size=(600, 800)), noise(3, 6.0, size=(400, 400))):
        assert len(mesh_from_mask(mask).triangles) < 8000


def test_white_picture_is_continued_past_its_border() -> None:
    mesh = mesh_from_mask(np.ones((120, 200), bool), spacing=10.0)
    assert mesh.vertices.min(axis=0) == pytest.approx([-21, -21], abs=1)
    assert mesh.vertices.max(axis=0) == pytest.approx([221, 141], abs=1)
    assert (mesh.width, mesh.height) == (200, 120)


@pytest.mark.parametrize("margin", [0, 7, 40])
def test_margin_applies_only_where_the_mask_touches(margin: int) -> None:
    mask = blank()
    mask[200:, 100:200] = 255
    mesh = mesh_from_mask(mask, spacing=10.0, border_margin=margin)
    assert mesh.vertices[:, 1].max() == pytest.approx(300 + margin, abs=0.1)
    assert mesh.vertices[:, 1].min() == pytest.approx(200, abs=0.1)
    assert mesh.vertices[:, 0].min() == pytest.approx(100, abs=0.1)
    assert mesh.vertices[:, 0].max() == pytest.approx(200, abs=0.1)


@pytest.mark.parametrize("side", ["left", "right", "top", "bottom"])
def test_each_border_is_continued(side: str) -> None:
    turned = {"left": 0, "bottom": 1, "right": 2, "top": 3}[side]
    mask = np.zeros((100, 100), bool)
    mask[40:60, :50] = True
    mesh = mesh_from_mask(np.rot90(mask, turned), spacing=8.0, border_margin=20)
    beyond = [*(-mesh.vertices.min(axis=0)), *(mesh.vertices.max(axis=0) - 100)]
    expected = {"left": 0, "top": 1, "right": 2, "bottom": 3}[side]
    assert int(np.argmax(beyond)) == expected
    assert beyond[expected] == pytest.approx(20, abs=0.1)


@pytest.mark.parametrize(
    "mask",
    [
        cv2.circle(cv2.circle(blank(), (100, 150), 60, 255, 12), (223, 150), 60, 255, 12),
        cv2.rectangle(cv2.rectangle(blank(), (40, 40), (119, 119), 255, -1), (120, 120), (200, 200), 255, -1),
        (np.indices((120, 120)).sum(axis=0) // 10 % 2 * 255).astype(np.uint8),
        cv2.circle(cv2.circle(blank(), (150, 150), 80, 255, 6), (150, 150), 70, 255, 6),
    ],
    ids=["touching rings", "squares at a corner", "chequers", "nested rings"],
)
@pytest.mark.parametrize("spacing", [None, 4.0, 15.0, 60.0])
def test_touching_parts(mask: np.ndarray, spacing: float | None) -> None:
    mesh = mesh_from_mask(mask, spacing=spacing)
    assert deepest_intrusion(mesh) < 1e-7
    assert mesh.areas.sum() == pytest.approx(-sum(map(area_of, boundary_loops(mesh))), rel=1e-9)


def test_specks_are_dropped_and_pinholes_filled() -> None:
    mask = disc()
    mask[10, 10] = mask[20:22, 300:303] = 255
    mask[148:152, 198:202] = 0
    mesh = mesh_from_mask(mask, spacing=12.0)
    assert len(set(mesh.components.tolist())) == 1
    assert len(boundary_loops(mesh)) == 1
    kept = mesh_from_mask(mask, spacing=12.0, smallest_hole=1.0, smallest_spacing=2.0)
    assert len(boundary_loops(kept)) == 2


@pytest.mark.parametrize(
    ("share", "said"), [(0.02, "of white"), (0.1, "of white"), (0.5, "of white"), (0.9, "of black"), (0.98, "of black")]
)
def test_noise_is_refused(share: float, said: str) -> None:
    mask = np.random.default_rng(0).random((400, 500)) < share
    for refusing in (mesh_from_mask, Collider.from_mask):
        with pytest.raises(MeshingError, match=rf"^mask must show parts in even white. Got: \d+ specks {said}, as"):
            refusing(mask)


@pytest.mark.parametrize("kind", ["salted", "dithered", "hatched", "many leaves"])
def test_parts_that_are_rough_are_no_noise(kind: str) -> None:
    y, x = np.mgrid[:400, :500]
    disc, dice = np.hypot(x - 250, y - 200) < 120, np.random.default_rng(0).random((400, 500))
    masks = {
        "salted": disc | (dice < 0.05),
        "dithered": cv2.GaussianBlur(disc.astype(np.float64), (0, 0), 15) > dice,
        "hatched": disc & (x % 4 < 2),
        "many leaves": np.hypot(x % 12 - 6, y % 10 - 5) < 3.5,
    }
    assert len(mesh_from_mask(masks[kind]).triangles) > 100


def test_single_small_part_is_meshed() -> None:
    mask = blank()
    mask[100:105, 100:105] = 255
    mesh = mesh_from_mask(mask)
    assert mesh.vertices.mean(axis=0) == pytest.approx([102.5, 102.5], abs=1.5)


@pytest.mark.parametrize("scale", [0.5, 2, 0.25])
def test_mask_of_another_size_is_fitted_to_the_picture(scale: float) -> None:
    small = cv2.resize(disc(), None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    mesh = mesh_from_mask(small, spacing=12.0, width=400, height=300)
    assert (mesh.width, mesh.height) == (400, 300)
    assert np.abs(np.hypot(*(boundary_loops(mesh)[0] - 200.5 + (0, 50)).T) - 110.5).max() < 1.5


def test_kinds_of_masks_agree() -> None:
    hard = disc() > 127
    reference = mesh_from_mask(hard, spacing=12.0)
    for same in (hard.astype(np.uint8) * 255, hard.astype(np.uint8), hard.astype(np.int64), hard.astype(np.float64)):
        assert mesh_from_mask(same, spacing=12.0).content_hash == reference.content_hash


def test_soft_masks_are_followed_at_sub_pixel_accuracy() -> None:
    x, y = np.meshgrid(np.arange(400) + 0.5, np.arange(300) + 0.5)
    for radius in (100.0, 100.25, 100.5):
        soft = np.clip(radius - np.hypot(x - 200, y - 150) + 0.5, 0, 1).astype(np.float32)
        (loop,) = boundary_loops(mesh_from_mask(soft, spacing=10.0))
        assert np.hypot(*(loop - (200, 150)).T) == pytest.approx(radius, abs=0.1)


def test_meshes_are_deterministic_and_leave_the_mask_alone() -> None:
    mask = noise(4)
    before = mask.copy()
    assert mesh_from_mask(mask).content_hash == mesh_from_mask(mask).content_hash
    assert (mask == before).all()


def test_neighbours_are_near_in_memory() -> None:
    mesh = mesh_from_mask(disc(), spacing=6.0)
    along = np.hypot(*np.diff(mesh.vertices, axis=0).T)
    assert np.median(along) < 2 * 6.0
    spread = np.ptp(mesh.triangles, axis=1)
    assert np.median(spread) < 0.05 * len(mesh.vertices)
    assert np.median(np.hypot(*np.diff(corners(mesh).mean(axis=1), axis=0).T)) < 6.0


def test_seeds_outside_leave_no_unused_vertices(monkeypatch: pytest.MonkeyPatch) -> None:
    seeds = meshing.interior_seeds
    outside = np.array([[1.0, 1.0], [3.0, 9.0]])
    monkeypatch.setattr(meshing, "interior_seeds", lambda *args: np.concatenate([seeds(*args), outside]))
    mesh = mesh_from_mask(disc(), spacing=12.0)
    assert len(np.unique(mesh.triangles)) == len(mesh.vertices)


def test_morton_order_is_a_z_curve() -> None:
    grid = np.stack(np.meshgrid(np.arange(4.0), np.arange(4.0)), axis=-1).reshape(-1, 2)
    first = grid[morton_order(grid)][:8]
    assert {tuple(p) for p in first[:4]} == {(0, 0), (1, 0), (0, 1), (1, 1)}
    assert {tuple(p) for p in first[4:]} == {(2, 0), (3, 0), (2, 1), (3, 1)}


def test_continued_reports_where_the_crop_lies() -> None:
    mask = np.zeros((50, 60), np.float32)
    mask[20:30, 10:15] = 1
    crop, origin = continued(mask, margin=9, room=4)
    assert np.argwhere(crop > 0.5).min(axis=0).tolist() == [20 - origin[1], 10 - origin[0]]
    assert crop.sum() == mask.sum()


def test_single_pixels_that_filled_gaps_leave_beside_coarsely_meshed_parts_are_no_parts() -> None:
    mask = np.zeros((120, 120), bool)
    for x, y, width, height in ((72, 43, 6, 6), (40, 75, 6, 6), (0, 115, 3, 5)):
        mask[y : y + height, x : x + width] = True
    mesh = mesh_from_mask(mask, spacing=92.116, smallest_spacing=30.705)
    assert mesh.components.max() + 1 == 3
    assert altitudes(mesh).min() > 5


def test_sound_details_leave_sound_masks_alone() -> None:
    soft = np.pad(disc().astype(np.float32) / 255, 8)
    kept = with_sound_details(soft, thinnest=6.0, narrowest=4.0, smallest_hole=50.0)
    np.testing.assert_array_equal(kept, soft)


def test_narrow_gaps_close_and_wide_ones_stay() -> None:
    mask = np.zeros((80, 80), np.float32)
    mask[10:70, 10:70] = 1
    mask[10:60, 30:32] = 0
    mask[10:60, 50:58] = 0
    sound = with_sound_details(mask, thinnest=2.0, narrowest=4.0, smallest_hole=0.0)
    assert (sound[20:60, 30:32] == 1).all()
    assert (sound[10:55, 50:58] == 0).all()


@pytest.mark.parametrize(
    ("mask", "options", "message"),
    [
        (np.zeros((20, 30)), {}, "without any white"),
        (np.full((20, 30), 0.4), {}, "without any white"),
        (np.pad(np.ones((1, 1)), 10), {}, "at least 4 px"),
        (np.ones((4, 20, 30)), {}, r"one plane.*\(4, 20, 30\)"),
        (np.ones(20), {}, "one plane"),
        (np.ones((0, 5)), {}, "one plane"),
        (np.full((20, 30), np.nan), {}, "finite"),
        (np.full((20, 30), 255.0), {}, "from 0 to 1. Got: 255"),
        (np.full((20, 30), -1), {}, "from 0 to 255"),
        (np.full((20, 30), 1000), {}, "from 0 to 255"),
        (np.ones((20, 30), complex), {}, "complex128"),
        (np.full((20, 30), "x"), {}, "booleans, integers or floating"),
        (np.ones((20, 30)), {"width": 30, "height": 30}, "30 x 30 px.*30 x 20 px"),
        (np.ones((900, 900), bool), {"spacing": 2.0, "border_margin": 0}, "larger.*2 px"),
    ],
)
def test_unusable_masks_are_refused(mask: np.ndarray, options: dict[str, float], message: str) -> None:
    with pytest.raises(MeshingError, match=message):
        mesh_from_mask(mask, **options)


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("spacing", 0),
        ("spacing", 1.0),
        ("spacing", -3),
        ("spacing", float("nan")),
        ("spacing", float("inf")),
        ("min_angle", 40),
        ("min_angle", -1),
        ("elements_across", 0),
        ("smallest_spacing", 0.0),
        ("border_margin", -1),
        ("smallest_part", -1),
        ("smallest_hole", float("nan")),
        ("width", 0),
        ("height", -5),
    ],
)
def test_options_out_of_range_are_refused(option: str, value: float) -> None:
    with pytest.raises(InvalidInputError, match=f"{option} must be"):
        mesh_from_mask(disc(), **{option: value})


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    sigma=st.floats(0.7, 14),
    level=st.floats(-1, 1),
    spacing=st.none() | st.floats(2.5, 50),
    size=st.tuples(st.integers(12, 160), st.integers(12, 160)),
)
@example(seed=184263, sigma=14.0, level=0.8847494259196291, spacing=None, size=(69, 90))  # a part of 5x5 px
@example(seed=181345, sigma=3.717507378901792, level=-0.9070979126474499, spacing=43.3, size=(105, 104))  # a sharp tip
def test_random_masks_become_conforming_meshes(
    seed: int, sigma: float, level: float, spacing: float | None, size: tuple[int, int]
) -> None:
    mask = noise(seed, sigma, level, size)
    if not has_a_part(mask):
        return
    mesh = mesh_from_mask(mask, spacing=spacing)
    assert deepest_intrusion(mesh) < 1e-7
    assert mesh.areas.sum() == pytest.approx(-sum(map(area_of, boundary_loops(mesh))), rel=1e-9)
    # White of less than 64 px across, specks aside, is meshed in so much smaller pixels, of which the bound holds.
    across = float(np.linalg.norm(np.ptp(np.clip(mesh.vertices, 0, size[::-1]), axis=0)))
    assert altitudes(mesh).min() > 0.3 / max(1.0, np.ceil(64 / across))


@settings(max_examples=15, deadline=None)
@given(
    rings=st.lists(
        st.tuples(st.integers(0, 150), st.integers(0, 150), st.integers(2, 60), st.integers(1, 9)),
        min_size=1,
        max_size=9,
    ),
    blur=st.floats(0.3, 3),
    spacing=st.none() | st.floats(2.5, 40),
)
def test_random_rings_become_conforming_meshes(
    rings: list[tuple[int, int, int, int]], blur: float, spacing: float | None
) -> None:
    mask = np.zeros((150, 150), np.uint8)
    for x, y, radius, thickness in rings:
        cv2.circle(mask, (x, y), radius, 255, thickness, cv2.LINE_AA)
    mask = cv2.GaussianBlur(mask, (0, 0), blur)
    if not has_a_part(mask > 127.5):
        return
    mesh = mesh_from_mask(mask, spacing=spacing)
    assert deepest_intrusion(mesh) < 1e-7
    assert len(boundary_loops(mesh)) >= len(set(mesh.components.tolist()))


@pytest.mark.parametrize(
    "lengths", [{"spacing": 1e9}, {"spacing": 1e300}, {"spacing": 20000.0}, {"border_margin": 1e9}]
)
def test_lengths_that_no_memory_holds_are_refused(lengths: dict[str, float]) -> None:
    mask = np.zeros((60, 80), np.uint8)
    mask[20:, 30:60] = 255
    with pytest.raises(MeshingError, match=f"{next(iter(lengths))} must be smaller than the part, which is 30 x 40 px"):
        mesh_from_mask(mask, **lengths)


def test_a_spacing_beyond_the_part_gives_its_coarsest_mesh() -> None:
    mask = np.zeros((200, 200), np.uint8)
    mask[60:140, 60:140] = 255
    assert 1 < len(mesh_from_mask(mask, spacing=500.0).triangles) < 60
