"""Tracks against motions known in closed form."""

from __future__ import annotations

import json

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import Motion, Tracks, frame_at, sample_times, tracks
from physanimator.physics.motion.farthest_points import farthest_points
from physanimator.physics.scene import Body

WIDTH, HEIGHT, FRAMES = 200, 120, 9


def block(left: float, top: float, right: float, bottom: float, *, cells: int = 6) -> TriangleMesh:
    x, y = np.meshgrid(np.linspace(left, right, cells + 1), np.linspace(top, bottom, cells + 1))
    number = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (part.reshape(-1) for part in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return TriangleMesh(np.stack([x.reshape(-1), y.reshape(-1)], axis=1), triangles, WIDTH, HEIGHT)


def sliding(*bodies: tuple[TriangleMesh, tuple[float, float], int], frames: int = FRAMES) -> Motion:
    """Bodies of a mesh, a speed [px/frame] and a layer."""
    time = np.arange(frames)[:, None, None]
    positions = [mesh.vertices + time * np.array(speed) for mesh, speed, _ in bodies]
    return Motion(
        tuple(Body(mesh, layer=layer) for mesh, _, layer in bodies),
        np.concatenate(positions, axis=1).astype(np.float32),
        24.0,
    )


def leaning(frames: int = FRAMES) -> Motion:
    """A block whose right side moves, its left stands: displacement grows with x."""
    mesh = block(20, 20, 120, 100)
    lift = np.stack([np.zeros(len(mesh.vertices)), (mesh.vertices[:, 0] - 20) / 10], axis=1)
    positions = mesh.vertices - np.arange(frames)[:, None, None] * lift * 0.2
    return Motion((Body(mesh),), positions.astype(np.float32), 24.0)


def test_points_ride_on_the_body_and_the_background_stands_still() -> None:
    found = tracks(sliding((block(30, 30, 80, 90), (5.0, -2.0), 0)), points=20, static_points=6)
    assert found.path.shape == (FRAMES, 26, 2)
    assert found.path.dtype == np.float32
    assert found.visibility.shape == (FRAMES, 26)
    assert found.visibility.dtype == np.bool_
    expected = found.path[0] + np.arange(FRAMES)[:, None, None] * np.array([5.0, -2.0])
    assert np.abs(found.path[:, :20] - expected[:, :20]).max() < 1e-3
    assert (found.path[:, 20:] == found.path[0, 20:]).all()
    assert found.visibility.all()


def test_positions_follow_an_affine_deformation_inside_triangles() -> None:
    mesh = block(30, 30, 90, 90)
    matrix, shift = np.array([[1.2, 0.3], [-0.2, 0.8]]), np.array([4.0, 9.0])
    motion = Motion((Body(mesh),), np.stack([mesh.vertices, mesh.vertices @ matrix.T + shift]).astype(np.float32), 24.0)
    path = tracks(motion, points=40, static_points=0).path
    assert np.abs(path[1] - (path[0] @ matrix.T + shift)).max() < 1e-3


def test_background_points_keep_clear_of_the_whole_way() -> None:
    found = tracks(sliding((block(20, 30, 60, 90), (10.0, 0.0), 0)), points=4, static_points=12)
    still = found.path[0, 4:]
    assert len(still) == 12
    swept = (still[:, 0] > 20) & (still[:, 0] < 140) & (still[:, 1] > 30) & (still[:, 1] < 90)
    assert not swept.any()
    assert (still >= 0).all()
    assert (still < (WIDTH, HEIGHT)).all()
    distance = np.hypot(*(still[:, None] - still[None]).transpose(2, 0, 1)) + 1e9 * np.eye(12)
    assert distance.min() > 15


def test_points_gather_where_the_movement_is() -> None:
    even = tracks(leaning(), points=40, static_points=0, weighting=0).path[0, :, 0]
    weighted = tracks(leaning(), points=40, static_points=0, weighting=1).path[0, :, 0]
    assert 0.35 < (even > 70).mean() < 0.65
    assert (weighted > 70).mean() > 0.75


def test_even_points_cover_the_body() -> None:
    start = tracks(leaning(), points=40, static_points=0, weighting=0).path[0]
    x, y = np.meshgrid(np.arange(24, 117, 4), np.arange(24, 97, 4))
    nearest = np.hypot(x[..., None] - start[:, 0], y[..., None] - start[:, 1]).min(axis=-1)
    assert nearest.max() < 14  # 40 discs of this radius cover the 100 x 80 px three times over


def test_a_body_in_front_hides_and_one_behind_does_not() -> None:
    still, wide = block(90, 40, 130, 80), block(10, 30, 60, 90)
    found = tracks(sliding((wide, (10.0, 0.0), 1), (still, (0.0, 0.0), 0)), points=30, static_points=0, weighting=0)
    on_still = found.path[0, :, 0] > 80
    assert 3 < on_still.sum() < 27
    time = np.arange(FRAMES)[:, None]
    x = found.path[0, on_still, 0]
    covered = (x > 10 + 10 * time) & (x < 60 + 10 * time)
    assert covered.any()
    assert (found.visibility[:, on_still] == ~covered).all()
    assert found.visibility[:, ~on_still].all()
    behind = tracks(sliding((wide, (10.0, 0.0), 0), (still, (0.0, 0.0), 1)), points=30, static_points=0, weighting=0)
    assert behind.visibility[:, behind.path[0, :, 0] > 80].all()
    assert not behind.visibility[:, behind.path[0, :, 0] < 80].all()


def test_points_begin_only_where_they_can_be_seen() -> None:
    motion = sliding((block(20, 20, 120, 100), (0.0, 1.0), 0), (block(60, 0, 160, 110), (0.0, 0.0), 1))
    found = tracks(motion, points=50, static_points=0)
    assert found.visibility[0].all()
    moves = found.path[-1, :, 1] > found.path[0, :, 1]
    assert moves.any()
    assert (found.path[0, moves, 0] < 60).all()


def test_what_leaves_the_picture_is_hidden_but_keeps_its_position() -> None:
    found = tracks(sliding((block(120, 30, 170, 90), (10.0, 0.0), 0)), points=12, static_points=0)
    outside = found.path[..., 0] >= WIDTH
    assert outside.any()
    assert (found.visibility == ~outside).all()


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
@pytest.mark.parametrize("frames", [1, 2, 5, 9, 17, 121])
def test_resampling_in_time_keeps_the_ends_and_the_speed(interpolation: str, frames: int) -> None:
    motion = sliding((block(30, 30, 80, 90), (5.0, -2.0), 0))
    whole = tracks(motion, points=5, static_points=1)
    found = tracks(motion, points=5, static_points=1, frames=frames, interpolation=interpolation)
    assert len(found) == frames
    assert (found.path[0] == whole.path[0]).all()
    if frames > 1:
        assert np.abs(found.path[-1] - whole.path[-1]).max() < 1e-4
        assert np.abs(np.diff(found.path[:, :5], axis=0) - np.array([5.0, -2.0]) * 8 / (frames - 1)).max() < 1e-3
        assert found.frame_rate == pytest.approx(24 * (frames - 1) / 8)


def test_cubic_interpolation_is_smooth_where_linear_has_corners() -> None:
    circle = np.stack([np.cos(np.arange(13) * np.pi / 6), np.sin(np.arange(13) * np.pi / 6)], axis=1)[:, None]
    errors = {}
    for kind in ("linear", "cubic"):
        between = [frame_at(circle, time, kind)[0] for time in sample_times(13, 97)[8:-8]]
        errors[kind] = np.abs(np.hypot(*np.transpose(between)) - 1).max()
    assert errors["linear"] == pytest.approx(1 - np.cos(np.pi / 12), rel=1e-6)
    assert errors["cubic"] < 0.1 * errors["linear"]


def test_stretching_scales_each_axis() -> None:
    motion = leaning()
    whole, other = tracks(motion), tracks(motion, width=400, height=60, fit="stretch")
    assert (other.width, other.height) == (400, 60)
    assert np.abs(other.path - whole.path * (2.0, 0.5)).max() < 1e-4
    assert (other.visibility == whole.visibility).all()


def test_cropping_scales_evenly_about_the_middle_and_begins_inside() -> None:
    found = tracks(leaning(), points=30, width=240, height=240, static_points=8)
    assert ((found.path[0] >= 0) & (found.path[0] < 240)).all()
    assert found.visibility[0].all()
    source = found.path[0] / 2 + (40.0, 0.0)  # 120 x 120 px from the middle, twice as large
    assert (source[:30] > (39.9, 19.9)).all()
    assert (source[:30] < (120.1, 100.1)).all()
    lift = found.path[0, :30, 1] - found.path[-1, :30, 1]
    assert np.abs(lift - 2 * (source[:30, 0] - 20) / 10 * 0.2 * 8).max() < 1e-3


def test_tracks_are_the_same_every_time() -> None:
    first, second = tracks(leaning(), frames=21), tracks(leaning(), frames=21)
    assert (first.path == second.path).all()
    assert (first.visibility == second.visibility).all()


def test_a_later_part_of_a_motion_begins_where_its_bodies_are() -> None:
    motion = sliding((block(20, 30, 60, 90), (10.0, 0.0), 0))[5:]
    found = tracks(motion, points=10, static_points=0)
    assert (found.path[0, :, 0] > 70).all()
    assert (found.path[0, :, 0] < 110).all()


def test_a_body_that_has_come_into_the_picture_has_tracks() -> None:
    motion = sliding((block(-60, 30, -20, 90), (10.0, 0.0), 0))
    with pytest.raises(InvalidInputError, match="none can be seen"):
        tracks(motion)
    assert tracks(motion[8:], points=10, static_points=0).visibility.all()


def test_json_is_a_list_of_points_for_each_track() -> None:
    found = tracks(leaning(), points=3, static_points=2, frames=121)
    read = json.loads(found.to_json())
    assert len(read) == 5
    assert {len(line) for line in read} == {121}
    again = np.array([[[point["x"], point["y"]] for point in line] for line in read]).transpose(1, 0, 2)
    assert np.abs(again - found.path).max() <= 0.0051
    assert set(read[0][0]) == {"x", "y"}


def test_fewer_points_where_there_is_no_room() -> None:
    whole = sliding((block(-10, -10, 210, 130), (0.0, 0.0), 0))
    assert tracks(whole, points=4, static_points=9).count == 4
    speck = sliding((block(50, 50, 53, 53, cells=1), (0.0, 0.0), 0))
    found = tracks(speck, points=64, static_points=0)
    assert 1 <= found.count <= 9
    assert len(np.unique(found.path[0], axis=0)) == found.count


def test_a_body_that_never_moves_has_tracks_too() -> None:
    found = tracks(sliding((block(30, 30, 80, 90), (0.0, 0.0), 0), frames=1), points=8, static_points=3, frames=5)
    assert found.path.shape == (5, 11, 2)
    assert np.isfinite(found.path).all()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"points": 0}, "points must be 1 to 4096. Got: 0"),
        ({"static_points": -1}, "static_points must be 0 to"),
        ({"frames": 0}, "frames must be 1 to"),
        ({"width": 0}, "width must be 1 to 16384 px"),
        ({"height": 100_000}, "height must be"),
        ({"fit": "letterbox"}, "fit must be one of crop, stretch"),
        ({"weighting": -1.0}, "weighting must be 0 to 8"),
        ({"weighting": float("nan")}, "weighting must be 0 to 8"),
        ({"interpolation": "spline"}, "interpolation must be one of"),
    ],
)
def test_bad_options_are_named(options: dict[str, object], words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        tracks(leaning(), **options)


def test_a_body_outside_the_picture_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="none can be seen"):
        tracks(sliding((block(300, 30, 340, 90), (0.0, 0.0), 0)))


def test_farthest_points_of_a_line() -> None:
    line = np.stack([np.arange(11.0), np.zeros(11)], axis=1)
    assert farthest_points(line, 4).tolist() == [0, 10, 5, 2]
    assert sorted(farthest_points(line, 99).tolist()) == list(range(11))
    assert sorted(farthest_points(np.zeros((3, 2)), 3).tolist()) == [0, 1, 2]
    weights = np.where(np.arange(11) == 7, 5.0, 1.0)
    assert farthest_points(line, 1, weights=weights).tolist() == [7]


def test_tracks_know_their_size() -> None:
    found = tracks(leaning(), points=3, static_points=2)
    assert isinstance(found, Tracks)
    assert (len(found), found.count, found.width, found.height) == (FRAMES, 5, WIDTH, HEIGHT)
