"""Layered sketches: still lines stay, moved ones leave nothing behind, and the body in front hides what is behind."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import FlowSequence, Motion
from physanimator.physics.scene import Body
from physanimator.rendering.sketch import WARP_MODES, LayeredSketch, warped_sketches

HEIGHT, WIDTH = 90, 140


def square(left: int, top: int, side: int = 30) -> NDArray[np.bool_]:
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[top : top + side, left : left + side] = True
    return mask


def flow_of(*masks: NDArray[np.bool_], moves: list[tuple[float, float]], stretch: float = 1.0) -> FlowSequence:
    """Two frames: at rest, and each body stretched to the right from its left side and moved."""
    bodies = [Body(mesh_from_mask(mask, spacing=6), preset("hair"), layer) for layer, mask in enumerate(masks)]
    rest = [body.mesh.vertices for body in bodies]
    moved = []
    for vertices, move in zip(rest, moves, strict=True):
        left = vertices[:, :1].min()
        moved.append(np.hstack([left + (vertices[:, :1] - left) * stretch, vertices[:, 1:]]) + move)
    return FlowSequence(Motion(tuple(bodies), np.stack([np.concatenate(rest), np.concatenate(moved)]), 24))


def paper() -> NDArray[np.float32]:
    return np.ones((HEIGHT, WIDTH), np.float32)


def warped(sketch: NDArray[np.float32], flow: FlowSequence, **options: object) -> NDArray[np.float32]:
    return LayeredSketch(sketch, flow, **options).frame(1, blur_sigma=0).sketch


def test_a_frame_at_rest_is_the_sketch() -> None:
    sketch = np.random.default_rng(1).random((HEIGHT, WIDTH), dtype=np.float32)
    frame = LayeredSketch(sketch, flow_of(square(30, 30), square(50, 40), moves=[(0, 0), (0, 0)])).frame(
        1, blur_sigma=0
    )
    np.testing.assert_allclose(frame.sketch, sketch, atol=1e-5)
    assert not frame.holes.any()


def test_a_moved_contour_goes_whole_and_leaves_no_ghost() -> None:
    sketch = paper()
    sketch[28:62, 28:62] = 0
    sketch[31:59, 31:59] = 1  # a contour of 3 px, two of them outside the body
    got = warped(sketch, flow_of(square(30, 30), moves=[(50, 10)]))
    expected = paper()
    expected[38:72, 78:112] = 0
    expected[41:69, 81:109] = 1
    np.testing.assert_allclose(got, expected, atol=1e-4)


def test_still_lines_are_not_touched_where_no_body_goes() -> None:
    sketch = np.random.default_rng(1).random((HEIGHT, WIDTH), dtype=np.float32)
    got = warped(sketch, flow_of(square(30, 30), moves=[(0, 8)]))
    np.testing.assert_allclose(got[:24], sketch[:24], atol=1e-6)
    np.testing.assert_allclose(got[:, 70:], sketch[:, 70:], atol=1e-6)


def test_a_still_line_that_runs_into_the_body_loses_no_more_than_a_contour_s_half_width() -> None:
    sketch = paper()
    sketch[45:47, 60:] = 0  # runs into the body from the right
    got = warped(sketch, flow_of(square(30, 30), moves=[(-20, 0)]))
    assert (got[45:47, 62:] == 0).all()
    assert (got[45:47, :60] < 0.5).sum() <= 2 * 2


def test_a_body_hides_the_lines_behind_its_new_place() -> None:
    sketch = paper()
    sketch[:, 100:102] = 0
    got = warped(sketch, flow_of(square(30, 30), moves=[(55, 0)]))
    assert (got[32:58, 100:102] > 0.999).all()
    assert (got[:28, 100:102] == 0).all()
    assert (got[62:, 100:102] == 0).all()


def test_the_front_body_hides_the_lines_of_the_one_behind() -> None:
    sketch = paper()
    sketch[40:42, 12:38] = 0  # on the body behind
    sketch[60:62, 82:108] = 0  # on the body in front
    back, front = square(10, 30), square(80, 35)
    got = warped(sketch, flow_of(back, front, moves=[(70, 0), (0, 0)]))
    assert (got[40:42, 82:108] > 0.999).all()
    assert (got[60:62, 82:108] == 0).all()
    turned = warped(sketch, flow_of(front, back, moves=[(0, 0), (70, 0)]))
    assert (turned[40:42, 82:108] < 1e-3).all()


def test_holes_are_what_a_body_has_left_and_show_what_is_behind() -> None:
    behind = paper()
    behind[44:46] = 0
    layers = LayeredSketch(paper(), flow_of(square(30, 30), moves=[(20, 0)]), behind=behind)
    frame = layers.frame(1, blur_sigma=0)
    assert frame.holes[32:58, 31:48].all()
    assert not frame.holes[:, 52:].any()
    assert (frame.sketch[44:46, 31:48] == 0).all()
    assert (frame.sketch[44:46, 52:78] > 0.999).all()
    assert (frame.sketch[44:46, 82:] == 1).all()


@pytest.mark.parametrize("stretch", [1.5, 2.5])
def test_a_stretched_line_stays_closed(stretch: float) -> None:
    sketch = paper()
    sketch[44:46, 30:60] = 0
    got = warped(sketch, flow_of(square(30, 30), moves=[(0, 0)], stretch=stretch))
    assert (got[44:46, 32 : int(28 + 30 * stretch)] < 0.02).all()


def test_a_body_that_leaves_the_picture() -> None:
    sketch = paper()
    sketch[square(30, 30)] = 0
    frame = LayeredSketch(sketch, flow_of(square(30, 30), moves=[(400, 0)])).frame(1)
    assert (frame.sketch == 1).all()
    assert frame.holes[32:58, 32:58].all()


@pytest.mark.parametrize("mode", WARP_MODES)
def test_every_mode_gives_every_frame(mode: str) -> None:
    sketch = paper()
    sketch[44:46, 30:60] = 0
    flow = flow_of(square(30, 30), moves=[(40, 0)])
    still, moved = warped_sketches(sketch, flow, mode=mode, blur_sigma=0)
    np.testing.assert_allclose(still.sketch, sketch, atol=1e-5)
    assert (moved.sketch[44:46, 72:98] < 0.01).all()
    assert (moved.sketch[44:46, 30:66] > 0.99).all()
    (alone,) = warped_sketches(sketch, flow, [1], mode=mode, blur_sigma=0)
    np.testing.assert_array_equal(alone.sketch, moved.sketch)


def test_blur_softens() -> None:
    sketch = paper()
    sketch[10] = 0
    layers = LayeredSketch(sketch, flow_of(square(30, 30), moves=[(0, 0)]))
    assert layers.frame(0, blur_sigma=0).sketch[10, 5] == 0
    assert 0.3 < layers.frame(0, blur_sigma=1.5).sketch[10, 5] < 0.9


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"mode": "nearest"}, "mode must be one of layered, paper, softmax"),
        ({"sketch": np.ones((10, 10), np.float32)}, "flow must be of the sketch's size"),
        ({"sketch": np.ones((10, 10, 3), np.float32)}, "sketch must be of shape"),
        ({"behind": np.ones((10, 10), np.float32)}, "behind must be of the sketch's shape"),
        ({"mode": "paper", "behind": paper()}, "behind must be left out unless mode is layered"),
        ({"blur_sigma": -1}, "blur_sigma must be"),
        ({"frames": [2]}, "frame must be 0 to 1"),
    ],
)
def test_bad_input(changes: dict[str, object], message: str) -> None:
    arguments = {"sketch": paper(), "flow": flow_of(square(30, 30), moves=[(1, 0)]), **changes}
    with pytest.raises(InvalidInputError, match=message):
        list(warped_sketches(arguments.pop("sketch"), arguments.pop("flow"), **arguments))
