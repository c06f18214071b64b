"""Motion vectors between frames: what a frame shows, carried along them, is what the next one shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import FlowSequence, FrameFlow, LoopReport, Motion
from physanimator.physics.scene import Body

SIDE = 90
Y, X = np.mgrid[:SIDE, :SIDE] + 0.5
CENTRE = np.array([40.0, 45.0])
DISC = np.hypot(X - 40, Y - 45) < 18


def turned(points: np.ndarray, angle: float, shift: tuple[float, float]) -> np.ndarray:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return (points - CENTRE) @ turn.T + CENTRE + shift


def motion(loop: LoopReport | None = None) -> Motion:
    """The disc turns and slides, unevenly."""
    body = Body(mesh_from_mask(DISC, spacing=6), preset("jelly"))
    poses = [(0.0, (0, 0)), (0.2, (4, -2)), (0.3, (9, 1)), (0.1, (5, 5))]
    positions = np.stack([turned(body.mesh.vertices, angle, shift) for angle, shift in poses])
    return Motion((body,), positions.astype(np.float32), 24.0, loop)


def test_the_vectors_are_those_of_the_rigid_motion() -> None:
    """A pixel of frame 1, brought to rest and to its place in frame 2, has gone along its vector."""
    flow = FrameFlow(motion())
    vectors = flow.vectors(1)
    points = np.stack([X, Y], axis=-1)[vectors.inside]
    back = (points - CENTRE - (4, -2)) @ np.array([[np.cos(0.2), -np.sin(0.2)], [np.sin(0.2), np.cos(0.2)]]) + CENTRE
    assert np.abs(points + vectors.forward[vectors.inside] - turned(back, 0.3, (9, 1))).max() < 1e-3
    assert np.abs(points + vectors.backward[vectors.inside] - back).max() < 1e-3
    assert vectors.inside.sum() == pytest.approx(DISC.sum(), rel=0.1)
    assert not vectors.forward[~vectors.inside].any()


def test_the_first_frame_s_vectors_are_the_flow_from_the_drawing() -> None:
    moved = motion()
    flow, vectors = FlowSequence(moved).flow(1), FrameFlow(moved).vectors(0)
    both = flow.inside & vectors.inside
    assert both.sum() == flow.inside.sum()
    assert np.abs(flow.displacement - vectors.forward)[both].max() < 1e-4


def test_the_ends_go_on_as_beside_them_and_a_loop_closes() -> None:
    first, last = FrameFlow(motion()).vectors(0), FrameFlow(motion()).vectors(3)
    assert np.abs(first.forward + first.backward).max() < 1e-4
    assert np.abs(last.forward + last.backward).max() < 1e-4
    closed = FrameFlow(motion(LoopReport(1.0, 4, 1, 0.0, 0.0))).vectors(3)
    points = np.stack([X, Y], axis=-1)[closed.inside]
    arrived = points + closed.forward[closed.inside]
    assert np.hypot(*(arrived - CENTRE).T).max() < 20, "in its place at rest"
    assert np.abs(closed.forward + closed.backward).max() > 1
    still = FrameFlow(Motion(motion().bodies, motion().positions[:1], 24.0)).vectors(0)
    assert not still.forward.any()
    assert not still.backward.any()
    with pytest.raises(InvalidInputError, match="frame"):
        FrameFlow(motion()).vectors(4)


def test_the_body_in_front_counts_and_what_stands_before_it_stands() -> None:
    front = np.hypot(X - 60, Y - 45) < 14
    bodies = motion().bodies[0], Body(mesh_from_mask(front, spacing=6), preset("jelly"), layer=1)
    rest = np.concatenate([body.mesh.vertices for body in bodies])
    speed = np.repeat([3.0, 7.0], [len(body.mesh.vertices) for body in bodies])
    moved = np.stack([rest, rest + np.stack([speed, 0 * speed], axis=1)]).astype(np.float32)
    vectors = FrameFlow(Motion(bodies, moved, 24.0)).vectors(0)
    assert vectors.forward[45, 53] == pytest.approx((7, 0), abs=1e-3)
    assert vectors.forward[45, 35] == pytest.approx((3, 0), abs=1e-3)
    bar = np.abs(X - 35) < 3
    covered = tuple(replace(body, cover=bar) for body in bodies)
    seen = FrameFlow(Motion(covered, moved, 24.0)).vectors(0)
    assert not seen.inside[bar].any()
    assert seen.forward[45, 53] == pytest.approx((7, 0), abs=1e-3)
