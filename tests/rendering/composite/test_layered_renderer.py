"""The layered renderer against pictures that are drawn anew in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.composite.layered_renderer import render_frames

WIDTH, HEIGHT = 160, 120
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
CENTRE = np.array([70.0, 60.0])
RADIUS = 25.0


def background() -> np.ndarray:
    return np.stack([0.2 + X / 400, 0.7 - Y / 400, 0.4 + (X + Y) / 900], axis=-1).astype(np.float32)


def disc(matrix: np.ndarray, shift: np.ndarray, *, radius: float = RADIUS) -> tuple[np.ndarray, np.ndarray]:
    """Coverage and colour of a dotted disc under x -> A (x - c) + c + d, anti-aliased by 4 x 4 samples."""
    inverse = np.linalg.inv(matrix)
    alpha, colour = np.zeros((HEIGHT, WIDTH)), np.zeros((HEIGHT, WIDTH, 3))
    for dy in (np.arange(4) + 0.5) / 4:
        for dx in (np.arange(4) + 0.5) / 4:
            at = np.stack([X - 0.5 + dx, Y - 0.5 + dy], axis=-1) - CENTRE - shift
            u, v = np.moveaxis(at @ inverse.T, 2, 0)
            inside = np.hypot(u, v) < radius
            shade = 0.5 + 0.3 * np.sin(u / 4) * np.cos(v / 5)
            alpha += inside / 16
            colour += inside[..., None] * np.stack([shade, 0.2 * shade, 0.9 - shade], axis=-1) / 16
    return alpha, colour


def picture(matrix: np.ndarray, shift: np.ndarray, *, ground: np.ndarray | None = None) -> np.ndarray:
    alpha, colour = disc(matrix, shift)
    return (colour + (1 - alpha[..., None]) * (background() if ground is None else ground)).astype(np.float32)


def round_mesh(radius: float = RADIUS - 1, *, centre: np.ndarray = CENTRE, corners: int = 20) -> TriangleMesh:
    """A polygon of rings about a centre; its edges cut off a little of the disc."""
    angle = np.arange(corners) * 2 * np.pi / corners
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([[centre], *(centre + ring * radius * part for part in (0.34, 0.67, 1.0))])
    following = np.roll(np.arange(corners), -1)
    triangles = [np.stack([np.zeros(corners, int), 1 + np.arange(corners), 1 + following], axis=1)]
    for inner in (1, 1 + corners):
        a, b = inner + np.arange(corners), inner + following
        triangles += [np.stack([a, b, b + corners], axis=1), np.stack([a, b + corners, a + corners], axis=1)]
    return TriangleMesh(vertices, np.concatenate(triangles), WIDTH, HEIGHT)


def motion_of(mesh: TriangleMesh, *moves: tuple[np.ndarray, np.ndarray]) -> Motion:
    frames = [(mesh.vertices - CENTRE) @ matrix.T + CENTRE + shift for matrix, shift in moves]
    return Motion((Body(mesh),), np.stack([mesh.vertices, *frames]).astype(np.float32), 24.0)


STILL = np.eye(2), np.zeros(2)
SLIDE = np.eye(2), np.array([14.5, -6.25])
SWAY = np.array([[1.1, 0.35], [-0.1, 0.9]]), np.array([8.0, 5.0])
MASK = disc(*STILL)[0]


def as_uint8(image: np.ndarray) -> np.ndarray:
    return np.rint(image * 255).astype(np.uint8)


def psnr(a: np.ndarray, b: np.ndarray) -> float:
    return float(-10 * np.log10(np.mean((a.astype(float) - b) ** 2)))


@pytest.fixture(scope="module")
def renderer() -> LayeredRenderer:
    return LayeredRenderer(picture(*STILL), [MASK], motion_of(round_mesh(), STILL, SLIDE, SWAY))


def test_a_frame_at_rest_is_the_illustration(renderer: LayeredRenderer) -> None:
    assert np.abs(renderer.frame(0) - picture(*STILL)).max() < 1e-5
    assert (renderer.frame(1) == renderer.frame(0)).all()


@pytest.mark.parametrize("mask", [MASK, MASK > 0.5, MASK > 0.99, disc(*STILL, radius=28)[0]], ids=str)
def test_a_frame_at_rest_is_exact_for_any_mask(mask: np.ndarray) -> None:
    image = as_uint8(picture(*STILL))
    image[::3, ::5] = (255, 0, 255)
    assert (LayeredRenderer(image, [mask], motion_of(round_mesh())).frame(0) == image).all()


@pytest.mark.parametrize(("frame", "move"), [(2, SLIDE), (3, SWAY)], ids=["slide", "sway"])
def test_moved_frames_are_as_if_drawn_anew(renderer: LayeredRenderer, frame: int, move: tuple) -> None:
    truth = picture(*move)
    assert psnr(renderer.frame(frame), truth) > 38
    alpha = disc(*move)[0]
    assert np.abs(renderer.alpha(frame) - alpha).mean() < 0.003
    solid = np.hypot(*np.moveaxis((np.stack([X, Y], -1) - CENTRE - move[1]) @ np.linalg.inv(move[0]).T, 2, 0)) < 23
    assert renderer.alpha(frame)[solid].min() > 0.995


def test_pixels_that_no_body_covers_are_untouched() -> None:
    noise = np.random.default_rng(0).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)
    image = np.where(MASK[..., None] > 0, as_uint8(picture(*STILL)), noise)
    renderer = LayeredRenderer(image, [MASK], motion_of(round_mesh(), SLIDE))
    covered = (renderer.alpha(0) > 0) | (renderer.alpha(1) > 0)
    assert (renderer.frame(1)[~covered] == image[~covered]).all()
    assert covered.mean() < 0.25


@pytest.mark.parametrize("hard", [False, True], ids=["soft", "hard"])
def test_no_halo_and_no_ghost_around_a_white_disc_on_black(hard: bool) -> None:
    alpha = disc(*STILL)[0].astype(np.float32)
    image = as_uint8(np.repeat(alpha[..., None], 3, axis=2))
    mask = alpha > 0.5 if hard else alpha
    frame = LayeredRenderer(image, [mask], motion_of(round_mesh(), SLIDE)).frame(1)[..., 0] / 255
    distance = np.hypot(X - CENTRE[0] - SLIDE[1][0], Y - CENTRE[1] - SLIDE[1][1])
    assert frame[distance > RADIUS + 2].max() < 0.03
    assert frame[distance < RADIUS - 2].min() > 0.97


def test_an_outline_outside_the_mask_moves_along() -> None:
    wide = disc(*STILL, radius=RADIUS + 2.5)[0][..., None]
    ground = background() * (1 - wide) + 0.05 * wide
    image = picture(*STILL, ground=ground)
    frame = LayeredRenderer(image, [MASK > 0.5], motion_of(round_mesh(), SLIDE)).frame(1)
    left = (np.hypot(X - CENTRE[0], Y - CENTRE[1]) > 20) & (X < 55)
    assert np.abs(frame - background())[left].max() < 0.06
    ring = np.abs(np.hypot(X - CENTRE[0] - SLIDE[1][0], Y - CENTRE[1] - SLIDE[1][1]) - RADIUS - 1.2) < 0.5
    assert frame[ring].max() < 0.25


def test_a_body_at_the_border_goes_on_beyond_it() -> None:
    image = background()
    image[:, :40] = (0.9, 0.1, 0.1)
    mask = X < 40
    x, y = np.meshgrid(np.linspace(-30, 40, 8), np.linspace(-30, 150, 12))
    number = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (each.reshape(-1) for each in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    mesh = TriangleMesh(np.stack([x.reshape(-1), y.reshape(-1)], axis=1), triangles, WIDTH, HEIGHT)
    frame = LayeredRenderer(image, [mask], motion_of(mesh, (np.eye(2), np.array([12.0, 7.0])))).frame(1)
    assert np.abs(frame[:, :50] - (0.9, 0.1, 0.1)).max() < 0.01


def two_discs(layers: tuple[int, int]) -> tuple[np.ndarray, list[np.ndarray], Motion]:
    colours = np.array([[0.9, 0.2, 0.2], [0.2, 0.3, 0.9]], dtype=np.float32)
    centres = np.array([[60.0, 60], [85, 60]])
    masks = [np.clip(20.5 - np.hypot(X - x, Y - y), 0, 1).astype(np.float32) for x, y in centres]
    image = background()
    for k in np.argsort(layers, kind="stable"):
        image = image + masks[k][..., None] * (colours[k] - image)
    meshes = [round_mesh(19, centre=centre) for centre in centres]
    rest = np.concatenate([mesh.vertices for mesh in meshes])
    apart = rest + np.repeat([[-2.0, 0], [30, 0]], [len(mesh.vertices) for mesh in meshes], axis=0)
    bodies = tuple(Body(mesh, layer=layer) for mesh, layer in zip(meshes, layers, strict=True))
    return image.astype(np.float32), masks, Motion(bodies, np.stack([rest, apart]).astype(np.float32), 24.0)


def test_the_body_behind_is_whole_when_the_one_in_front_moves_off() -> None:
    image, masks, motion = two_discs((0, 1))
    renderer = LayeredRenderer(image, masks, motion)
    assert np.abs(renderer.frame(0) - image).max() < 1e-5
    hidden = (np.hypot(X - 58, Y - 60) < 18) & (np.hypot(X - 115, Y - 60) > 22)
    assert np.abs(renderer.frame(1)[hidden] - (0.9, 0.2, 0.2)).max() < 0.05
    assert np.abs(renderer.plate - background()).max() < 0.2


def test_layers_decide_what_is_in_front() -> None:
    image, masks, motion = two_discs((1, 0))
    renderer = LayeredRenderer(image, masks, motion)
    assert np.abs(renderer.frame(0) - image).max() < 1e-5
    assert renderer.frame(0)[60, 72] == pytest.approx((0.9, 0.2, 0.2), abs=1e-4)


def test_a_given_plate_is_used() -> None:
    image = as_uint8(picture(*STILL))
    plate = as_uint8(background())
    frame = LayeredRenderer(image, [MASK], motion_of(round_mesh(), SLIDE), plate=plate).frame(1)
    truth = as_uint8(picture(*SLIDE))
    assert psnr(frame / 255, truth / 255) > 40
    uncovered = (MASK > 0) & (disc(*SLIDE, radius=28)[0] == 0)
    assert np.abs(frame[uncovered].astype(int) - plate[uncovered]).max() <= 1


def test_the_cutout_laid_over_the_plate_is_the_frame(renderer: LayeredRenderer) -> None:
    cutout = renderer.cutout(3)
    assert cutout.shape == (HEIGHT, WIDTH, 4)
    assert cutout[..., 3] == pytest.approx(renderer.alpha(3), abs=1e-6)
    alpha = cutout[..., 3:]
    assert np.abs(cutout[..., :3] * alpha + (1 - alpha) * renderer.plate - renderer.frame(3)).max() < 1e-4


def test_frame_and_alpha_at_once_are_those_of_each_alone() -> None:
    image, masks, motion = two_discs((0, 1))
    drawn = LayeredRenderer(image, masks, motion)
    for t in range(len(motion)):
        frame, alpha = drawn.frame_and_alpha(t)
        np.testing.assert_array_equal(frame, drawn.frame(t))
        np.testing.assert_array_equal(alpha, drawn.alpha(t))
        np.testing.assert_allclose(alpha, drawn.cutout(t)[..., 3], atol=1e-6)


def test_dtypes_are_kept_and_frames_repeat() -> None:
    image = as_uint8(picture(*STILL))
    renderer = LayeredRenderer(image, [MASK], motion_of(round_mesh(), SWAY))
    assert renderer.frame(1).dtype == np.uint8
    assert renderer.cutout(1).dtype == np.uint8
    again = LayeredRenderer(image, [MASK], motion_of(round_mesh(), SWAY))
    assert (renderer.frame(1) == again.frame(1)).all()
    floats = LayeredRenderer(image.astype(np.float32) / 255, [MASK], motion_of(round_mesh(), SWAY))
    assert np.abs(floats.frame(1) * 255 - renderer.frame(1)).max() < 1


def test_a_body_that_leaves_the_picture_uncovers_the_plate() -> None:
    image = as_uint8(picture(*STILL))
    renderer = LayeredRenderer(image, [MASK], motion_of(round_mesh(), (np.eye(2), np.array([500.0, 0]))))
    assert (renderer.frame(1) == renderer.plate).all()
    assert not renderer.alpha(1).any()


def test_an_empty_mask_moves_nothing() -> None:
    image = as_uint8(picture(*STILL))
    renderer = LayeredRenderer(image, [np.zeros_like(MASK)], motion_of(round_mesh(), SLIDE))
    assert (renderer.frame(1) == image).all()


def test_frames_come_one_by_one_with_progress(renderer: LayeredRenderer) -> None:
    done: list[tuple[int, int]] = []

    def progress(frame: int, total: int) -> None:
        done.append((frame, total))
        if frame == 2:
            raise KeyboardInterrupt

    frames = render_frames(renderer, progress=progress)
    assert (next(frames) == renderer.frame(0)).all()
    assert done == []
    with pytest.raises(KeyboardInterrupt):
        list(frames)
    assert done == [(1, 4), (2, 4)]
    assert len(list(render_frames(renderer))) == 4


def test_unusable_input_is_refused(renderer: LayeredRenderer) -> None:
    image, motion = picture(*STILL), motion_of(round_mesh())
    with pytest.raises(InvalidInputError, match="image must be as large as the motion's"):
        LayeredRenderer(image[:-1], [MASK], motion)
    with pytest.raises(InvalidInputError, match="masks must be one for each"):
        LayeredRenderer(image, [MASK, MASK], motion)
    with pytest.raises(InvalidInputError, match="mask must have the picture's size"):
        LayeredRenderer(image, [MASK[:, :-40]], motion)
    with pytest.raises(InvalidInputError, match="plate must have the image's size"):
        LayeredRenderer(image, [MASK], motion, plate=as_uint8(image)[:, 1:])
    with pytest.raises(InvalidInputError, match="masks must leave some"):
        LayeredRenderer(image, [np.ones_like(MASK)], motion)
    with pytest.raises(InvalidInputError, match="frame must be 0 to 3"):
        renderer.frame(4)
