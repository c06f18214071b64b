"""Forward warping: what rests stays, what moves goes, and what is left empty is known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.motion import FlowField
from physanimator.rendering.sketch import forward_warp, warp_sketch
from physanimator.rendering.sketch.warp import SPLAT_MODES

HEIGHT, WIDTH = 60, 90


def field_of(inside: NDArray[np.bool_], u: object, v: object) -> FlowField:
    displacement = np.zeros((*inside.shape, 2), np.float32)
    displacement[..., 0], displacement[..., 1] = np.broadcast_to(u, inside.shape), np.broadcast_to(v, inside.shape)
    displacement[~inside] = 0
    return FlowField(displacement, inside)


def noise(*shape: int) -> NDArray[np.float32]:
    return np.random.default_rng(1).random(shape, dtype=np.float32)


def body() -> NDArray[np.bool_]:
    inside = np.zeros((HEIGHT, WIDTH), bool)
    inside[20:40, 30:50] = True
    return inside


@pytest.mark.parametrize("mode", SPLAT_MODES)
def test_no_motion_is_the_identity_exactly(mode: str) -> None:
    sketch = noise(HEIGHT, WIDTH)
    warped = warp_sketch(sketch, field_of(body(), 0, 0), mode=mode, blur_sigma=0)
    np.testing.assert_array_equal(warped.sketch, 1 - (1 - sketch))
    assert not warped.holes.any()


def test_no_body_is_the_identity() -> None:
    sketch = noise(HEIGHT, WIDTH)
    warped = warp_sketch(sketch, field_of(np.zeros((HEIGHT, WIDTH), bool), 0, 0), blur_sigma=0)
    np.testing.assert_allclose(warped.sketch, sketch, atol=1e-7)


def test_a_shift_by_whole_pixels_is_exact() -> None:
    values, shift = noise(HEIGHT, WIDTH, 3), (7, -4)
    displacement = np.broadcast_to(np.float32(shift), (HEIGHT, WIDTH, 2))
    warped, coverage = forward_warp(values, displacement, noise(HEIGHT, WIDTH) + 0.1)
    np.testing.assert_array_equal(warped[:-4, 7:], values[4:, :-7])
    np.testing.assert_array_equal(coverage[:-4, 7:], 1)
    assert not coverage[-4:].any()
    assert not warped[:, :7].any()


def test_half_a_pixel_shares_between_neighbours() -> None:
    values = np.zeros((5, 9), np.float32)
    values[2, 4] = 1
    displacement = np.full((5, 9, 2), (0.5, 0), np.float32)
    warped, _ = forward_warp(values, displacement, np.ones((5, 9), np.float32))
    np.testing.assert_allclose(warped[2], [0, 0, 0, 0, 0.5, 0.5, 0, 0, 0], atol=1e-6)


def test_the_heavier_of_two_pixels_that_meet_shows() -> None:
    values, displacement = np.float32([[1, 0, 5]]), np.zeros((1, 3, 2), np.float32)
    displacement[0, 0, 0] = 2
    warped, coverage = forward_warp(values, displacement, np.float32([[3, 1, 1]]))
    assert warped[0, 2] == pytest.approx((3 * 1 + 5) / 4)
    np.testing.assert_array_equal(coverage, [[0, 1, 2]])


@pytest.mark.parametrize("mode", SPLAT_MODES)
def test_lines_at_rest_survive_and_old_lines_do_not_stay(mode: str) -> None:
    sketch = np.ones((HEIGHT, WIDTH), np.float32)
    sketch[10] = 0  # above the body
    sketch[:, 70] = 0  # where nothing goes
    sketch[20:40, 35] = 0  # on the body
    warped = warp_sketch(sketch, field_of(body(), 15, 3), mode=mode, blur_sigma=0)
    assert (warped.sketch[10] == 0).all()
    assert (warped.sketch[:, 70] == 0).all()
    np.testing.assert_allclose(warped.sketch[23:43, 50], 0, atol=1e-4)
    assert (warped.sketch[20:40, 35] == 1).all()
    assert warped.holes[20:40, 30:45].all()
    assert not warped.holes[:, 50:].any()


def test_a_body_covers_the_lines_behind_it() -> None:
    sketch = np.ones((HEIGHT, WIDTH), np.float32)
    sketch[:, 60] = 0
    warped = warp_sketch(sketch, field_of(body(), 20, 0), blur_sigma=0)
    assert (warped.sketch[20:40, 60] > 0.99).all()
    assert (warped.sketch[:20, 60] == 0).all()


def test_a_contour_that_stands_out_of_the_mask_goes_with_the_body() -> None:
    sketch = np.ones((HEIGHT, WIDTH), np.float32)
    sketch[20:40, 28:32] = 0  # the left contour, half outside
    field = field_of(body(), 15, 0)
    assert (warp_sketch(sketch, field, blur_sigma=0).sketch[20:40, 28:32] == 1).all()
    assert (warp_sketch(sketch, field, blur_sigma=0, border=0).sketch[20:40, 28:30] == 0).all()


@pytest.mark.parametrize("stretch", [1.5, 2.5, 3.5])
def test_a_stretched_line_has_no_gaps(stretch: float) -> None:
    inside = np.zeros((HEIGHT, 120), bool)
    inside[20:40, 30:55] = True
    sketch = np.ones((HEIGHT, 120), np.float32)
    sketch[30, 30:55] = 0
    columns = np.arange(120, dtype=np.float32)[None, :]
    warped = warp_sketch(sketch, field_of(inside, (stretch - 1) * (columns - 29.5), 0), blur_sigma=0)
    end = int(29.5 + 25 * stretch) - 1
    assert (warped.sketch[30, 31:end] < 0.05).all()
    assert not warped.holes[20:40, 31:end].any()


def test_a_rotating_body_stays_closed() -> None:
    rows, columns = np.mgrid[:HEIGHT, :WIDTH].astype(np.float32)
    dx, dy, angle = columns - 45, rows - 30, np.deg2rad(37)
    inside = np.hypot(dx, dy) < 20
    u, v = np.cos(angle) * dx - np.sin(angle) * dy - dx, np.sin(angle) * dx + np.cos(angle) * dy - dy
    warped = warp_sketch(np.ones((HEIGHT, WIDTH), np.float32), field_of(inside, u, v), blur_sigma=0)
    assert not warped.holes[np.hypot(dx, dy) < 18].any()


def test_a_body_that_leaves_the_picture_leaves_a_hole() -> None:
    sketch = np.ones((HEIGHT, WIDTH), np.float32)
    sketch[body()] = 0
    warped = warp_sketch(sketch, field_of(body(), 500, 0), blur_sigma=0)
    np.testing.assert_array_equal(warped.holes, body())
    assert (warped.sketch == 1).all()


@pytest.mark.parametrize(("shift", "is_hole"), [(0.3, False), (0.7, True)])
def test_a_pixel_covered_by_less_than_a_half_is_a_hole(shift: float, is_hole: bool) -> None:
    warped = warp_sketch(np.ones((HEIGHT, WIDTH), np.float32), field_of(body(), shift, 0))
    assert (warped.holes[20:40, 30] == is_hole).all()
    assert warped.holes.sum() == 20 * is_hole


def test_blur_softens_lines_and_keeps_their_ink() -> None:
    sketch = np.ones((HEIGHT, WIDTH), np.float32)
    sketch[30, :] = 0
    still = field_of(body(), 0, 0)
    blurred = warp_sketch(sketch, still, blur_sigma=1.5).sketch
    assert 0.5 < blurred[30, 5] < 0.9
    assert (1 - blurred).sum() == pytest.approx((1 - sketch).sum(), rel=1e-4)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"mode": "nearest"}, "mode must be one of paper, softmax"),
        ({"blur_sigma": -1}, "blur_sigma must be"),
        ({"alpha": 0}, "alpha must be"),
        ({"border": 50}, "border must be"),
        ({"sketch": np.ones((10, 10), np.float32)}, "flow must be of the sketch's size, 10 x 10 px"),
        ({"sketch": np.ones((10, 10, 3), np.float32)}, "sketch must be of shape"),
    ],
)
def test_bad_input(changes: dict[str, object], message: str) -> None:
    arguments = {"sketch": np.ones((HEIGHT, WIDTH), np.float32), **changes}
    with pytest.raises(InvalidInputError, match=message):
        warp_sketch(arguments.pop("sketch"), field_of(body(), 1, 1), **arguments)


def test_flow_that_is_not_finite_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="displacement must be finite"):
        forward_warp(np.ones((4, 4)), np.full((4, 4, 2), np.nan), np.ones((4, 4)))
