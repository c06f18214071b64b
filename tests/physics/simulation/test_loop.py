"""Loops: the motion repeats, through the seam as well, and what cannot repeat is refused with a sentence."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from physanimator.physics.document import scene_from_dict, scene_to_dict
from physanimator.physics.errors import Cancelled, InvalidInputError, SimulationError
from physanimator.physics.forces import EnergyStroke, particles
from physanimator.physics.material import Material
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.rig import Circle, KeyedPath, Polygon, RigPoint, Wave
from physanimator.physics.scene import Body, Scene
from physanimator.physics.simulation import loop_frames, periodic, simulate

SIZE = 1000
EXAMPLE = Path(__file__).resolve().parents[3] / "workflows" / "example"


def strip(across: int = 2) -> TriangleMesh:
    """A strip of 60 x 300 px that hangs from y = 100."""
    rows = across * 5
    x, y = np.meshgrid(np.linspace(400, 460, across + 1), np.linspace(100, 400, rows + 1))
    triangles = []
    for row in range(rows):
        for column in range(across):
            a = row * (across + 1) + column
            b, c, d = a + 1, a + across + 1, a + across + 2
            triangles += [(a, b, d), (a, d, c)] if (row + column) % 2 else [(a, b, c), (b, d, c)]
    return TriangleMesh(np.column_stack([x.ravel(), y.ravel()]), np.array(triangles), SIZE, SIZE)


PIN = RigPoint((430.0, 100.0), Polygon(((395.0, 95.0), (465.0, 95.0), (465.0, 105.0), (395.0, 105.0))))
GUSTS = EnergyStroke("wind", ((100.0, 260.0), (900.0, 300.0)), 250.0, 700.0, 5.0, 0.2, None, 0.65)


def scene(*, damping: float = 2.0, pinned: bool = True, **others: object) -> Scene:
    body = Body(strip(), Material(sway_frequency=1.5, damping=damping))
    return Scene((body,), **{"rig_points": (PIN,) if pinned else (), "loop": 2.0, **others})  # type: ignore[arg-type]


def assert_seamless(positions: np.ndarray, *, residual: float = 0.1) -> None:
    """Through the seam, velocity and acceleration change no more than they do anywhere else."""
    around = np.concatenate([positions, positions[:4]]).astype(np.float64)
    velocities = np.diff(around, axis=0)
    jerks = np.abs(np.diff(velocities, n=2, axis=0)).max(axis=(1, 2))
    seam = len(positions) - 3
    assert jerks[seam:].max() <= jerks[:seam].max() + 4 * residual


def test_the_motion_repeats_in_place_and_velocity() -> None:
    looping = scene(strokes=(GUSTS,))
    motion = simulate(looping)
    assert len(motion) == 48
    assert motion.loop is not None
    assert motion.loop.cycles >= 3
    assert motion.loop.closed_residual <= motion.loop.residual < 0.05
    assert np.ptp(motion.positions, axis=0).max() > 20
    assert_seamless(motion.positions)

    # The free run of the same forcing, far beyond the start, is the loop: frame N is frame 0, with its neighbours.
    free = simulate(replace(periodic(looping), loop=None), frames=48 * 9 + 2)
    again = free.positions[48 * 8 :]
    assert np.linalg.norm(again[:48] - motion.positions, axis=2).max() < 0.1
    assert np.linalg.norm(again[48:50] - motion.positions[:2], axis=2).max() < 0.1
    velocity = (free.positions[-1] - free.positions[-3]) / 2
    through = (motion.positions[1] - motion.positions[-1]) / 2
    assert np.linalg.norm(velocity - through, axis=1).max() < 0.1


def test_more_frames_are_further_rounds() -> None:
    motion = simulate(scene(strokes=(GUSTS,)), frames=100)
    np.testing.assert_array_equal(motion.positions[48:96], motion.positions[:48])
    np.testing.assert_array_equal(motion.positions[96:], motion.positions[:4])


@pytest.mark.parametrize("rate", [12.0, 25.0, 29.97])
def test_every_frame_rate_loops(rate: float) -> None:
    """Also where a frame or the whole loop ends between two ticks."""
    wave = replace(PIN, motion=Wave(15.0, 0.9))
    motion = simulate(scene(strokes=(GUSTS,), rig_points=(wave,), frame_rate=rate))
    assert motion.loop is not None
    assert motion.loop.residual < 0.6
    assert len(motion) == round(2 * rate)
    assert_seamless(motion.positions)


def test_what_hardly_dies_away_is_closed_by_a_blend() -> None:
    motion = simulate(scene(strokes=(GUSTS,), damping=0.12))
    assert motion.loop is not None
    assert motion.loop.residual > 0.1
    assert motion.loop.closed_residual < 0.05 * motion.loop.residual
    assert_seamless(motion.positions, residual=motion.loop.residual)


def test_what_drifts_away_is_refused() -> None:
    with pytest.raises(SimulationError, match=r"does not repeat: .* px\. Hold every body"):
        simulate(scene(gravity=(0.0, 0.5), pinned=False, damping=0.5))


def test_nothing_acting_stays_the_drawing() -> None:
    motion = simulate(scene())
    assert (motion.positions == strip().vertices.astype(np.float32)).all()


@pytest.mark.parametrize(
    "stroke",
    [
        GUSTS,
        replace(GUSTS, start=7.0),
        replace(GUSTS, end=0.9),
        replace(GUSTS, end=0.5, repeat=0.7),
        replace(GUSTS, end=9.0),
        replace(GUSTS, speed=50.0),
        replace(GUSTS, speed=0.0, end=1.2),
        replace(GUSTS, speed_keys=((0.0, 1.0), (1.0, 0.2))),
    ],
)
def test_the_particles_of_every_stroke_return(stroke: EnergyStroke) -> None:
    looping = periodic(scene(strokes=(stroke,)))
    (made,) = looping.strokes
    times = 80 + np.linspace(0.0013, 1.99, 37)
    seen = 0
    for t in times:
        (here, ahead), (later, then) = particles(made, float(t)), particles(made, float(t) + 2)
        np.testing.assert_allclose(later, here, atol=1e-6)
        np.testing.assert_allclose(then, ahead, atol=1e-6)
        seen += len(here)
    assert seen > 0


def test_rhythms_become_the_nearest_that_fit() -> None:
    (made,) = periodic(scene(strokes=(GUSTS,))).strokes
    assert made.interval == pytest.approx(2 / 3)
    (led,) = periodic(scene(rig_points=(replace(PIN, motion=Wave(9.0, 0.9)),))).rig_points
    assert isinstance(led.motion, Wave)
    assert led.motion.period == pytest.approx(1.0)
    assert loop_frames(scene(frame_rate=25.0)) == 50


def test_a_closed_path_begins_anew_in_each_cycle() -> None:
    there_and_back = KeyedPath((0.0, 0.5, 1.5), ((430.0, 100.0), (470.0, 100.0), (430.0, 100.0)))
    point = RigPoint((430.0, 100.0), Circle(40.0), there_and_back)
    motion = simulate(scene(rig_points=(point,)))
    assert_seamless(motion.positions)
    held = motion.positions[:, 1, 0] - 430
    assert held[[0, 12, 36]] == pytest.approx([0, 40, 0], abs=1e-3)


@pytest.mark.parametrize(
    ("times", "end", "reason"),
    [
        ((0.0, 1.0), 470.0, "must come back to where it began.*40.0 px away"),
        ((0.0, 2.5), 430.0, "within the loop of 2 s"),
    ],
)
def test_a_path_that_does_not_return_is_refused(times: tuple[float, ...], end: float, reason: str) -> None:
    path = KeyedPath(times, ((430.0, 100.0), (end, 100.0)))
    with pytest.raises(InvalidInputError, match=rf"rig_points\[0\]\.motion {reason}|rig_points\[0\]\.motion.*{reason}"):
        simulate(scene(rig_points=(RigPoint((430.0, 100.0), Circle(40.0), path),)))


@pytest.mark.parametrize("loop", [0.0, -1.0, 0.01, math.inf, math.nan, 601.0])
def test_unusable_lengths_are_refused(loop: float) -> None:
    with pytest.raises(InvalidInputError, match="loop must be"):
        scene(loop=loop)


def test_frames_are_needed_without_a_loop() -> None:
    with pytest.raises(InvalidInputError, match="frames must be"):
        simulate(scene(loop=None))


def test_a_loop_can_be_cancelled_and_reports_progress() -> None:
    calls: list[tuple[int, int]] = []
    simulate(scene(strokes=(GUSTS,)), progress=lambda done, total: calls.append((done, total)))
    assert {total for _, total in calls} == {48}
    done = [number for number, _ in calls]
    assert done == sorted(done)
    assert done.count(48) == 1

    def stop(done: int, total: int) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        simulate(scene(strokes=(GUSTS,)), progress=stop)


def test_the_document_keeps_the_loop() -> None:
    document = scene_to_dict(scene())
    assert document["loop"] == 2.0
    assert scene_from_dict(document).loop == 2.0
    assert "loop" not in scene_to_dict(scene(loop=None))


def test_the_bundled_example_loops() -> None:
    """Its ribbon and cape, coarsely meshed, under all of its strokes."""
    document = json.loads((EXAMPLE / "scene.json").read_text(encoding="utf-8"))
    kept = (1, 2)
    meshes = []
    for number in kept:
        mask = cv2.imread(str(EXAMPLE / f"mask_{document['bodies'][number]['name']}.png"), cv2.IMREAD_GRAYSCALE)
        meshes.append(mesh_from_mask(mask, spacing=24.0))
    document["bodies"] = [document["bodies"][number] for number in kept]
    document["rig_points"] = [
        point | {"body": kept.index(point["body"])} for point in document["rig_points"] if point["body"] in kept
    ]
    motion = simulate(scene_from_dict(document | {"loop": 3.0}, meshes=meshes))
    assert len(motion) == 72
    assert motion.loop is not None
    assert motion.loop.residual < 0.1
    assert motion.loop.closed_residual < 0.01
    assert np.ptp(motion.positions, axis=0).max() > 40
    assert_seamless(motion.positions)
