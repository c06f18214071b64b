"""Pictures with transparency taken apart: they move on transparency."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.composite import (
    LayeredRenderer,
    background_of,
    renderer_of,
    shown_frame,
    shown_frame_and_alpha,
    sprite_plate,
)
from physanimator.rendering.pictures import over

HEIGHT, WIDTH = 150, 200
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
SKIN, HAIR, WHITE = (0.95, 0.8, 0.7), (0.2, 0.1, 0.5), (1.0, 1.0, 1.0)
GROUNDS = ((0, 0, 0), (255, 255, 255), (255, 0, 255), (0, 160, 0))


def head() -> np.ndarray:
    return np.clip(40.5 - np.hypot(X - 80, Y - 80), 0, 1)


def lock(shift: float = 0.0) -> np.ndarray:
    """A band that lies half over the head and half beside it, anti-aliased."""
    return np.clip(np.minimum(12.5 - np.abs(X - 112 - shift), 45.5 - np.abs(Y - 75)), 0, 1)


def sprite(*, shift: float = 0.0, hair: tuple[float, ...] = HAIR, hidden: bool = False) -> np.ndarray:
    """Straight RGBA, uint8."""
    front, behind = lock(shift), head()
    alpha = front + (1 - front) * behind
    colour = front[..., None] * np.array(hair) + ((1 - front) * behind)[..., None] * np.array(SKIN)
    image = np.dstack([colour / np.maximum(alpha, 1e-9)[..., None], alpha])
    image = np.rint(255 * image).astype(np.uint8)
    image[image[..., 3] == 0] = (30, 200, 90, 0) if hidden else 0
    return image


def moved(mesh: TriangleMesh, *shifts: tuple[float, float]) -> Motion:
    frames = [mesh.vertices + np.array(shift) for shift in ((0, 0), *shifts)]
    return Motion((Body(mesh),), np.stack(frames).astype(np.float32), 24.0)


def drawn(
    image: np.ndarray, mask: np.ndarray, *shifts: tuple[float, float], plate: np.ndarray | None = None
) -> LayeredRenderer:
    renderer = renderer_of(image, [mask], moved(mesh_from_mask(lock()), *shifts), plate=plate)
    assert isinstance(renderer, LayeredRenderer)
    return renderer


@pytest.mark.parametrize("mask", [lock(), lock() > 0.5, lock() > 0.99, np.clip(lock() * 0.6, 0, 1)], ids=range(4))
@pytest.mark.parametrize("hidden", [False, True])
def test_the_rest_frame_is_the_picture_to_the_bit(mask: np.ndarray, hidden: bool) -> None:
    image = sprite(hidden=hidden)
    image[70:90:3, 100:120:4, 3] = 200  # not quite opaque inside
    frame = drawn(image, mask).frame(0)
    seen = image[..., 3] > 0
    assert (frame[..., 3] == image[..., 3]).all()
    assert (frame[seen] == image[seen]).all()
    assert (frame[~seen] == 0).all()


@pytest.mark.parametrize("hair", [HAIR, WHITE], ids=["dark", "white"])
@pytest.mark.parametrize("hard", [False, True], ids=["soft", "hard"])
def test_what_moves_off_leaves_transparency_and_no_rim(hair: tuple[float, ...], hard: bool) -> None:
    mask = lock() > 0.5 if hard else lock()
    frame = drawn(sprite(hair=hair), mask, (15.0, 0.0)).frame(1)
    truth = sprite(shift=15, hair=hair)
    beside = (X > 123) & (np.abs(Y - 75) < 60)  # where only the lock has ever been
    for ground in GROUNDS:
        apart = np.abs(over(frame, ground).astype(int) - over(truth, ground))[beside]
        assert apart.max() <= 24
        assert apart.mean() < 0.5
    # Around the lock nothing is left but what had been there.
    assert frame[(Y < 25) | (Y > 125)].max() == 0


def made(kind: str) -> np.ndarray:
    """The lock's mask as people make it."""
    hard, square = (lock() > 0.5).astype(np.float32), np.ones((3, 3), np.uint8)
    return {
        "blurred": lambda: cv2.GaussianBlur(hard, (0, 0), 3),
        "shrunk": lambda: cv2.erode(hard, square, iterations=3),
        "grown": lambda: cv2.dilate(hard, square, iterations=4),
        "shrunk and blurred": lambda: cv2.GaussianBlur(cv2.erode(hard, square, iterations=2), (0, 0), 2),
    }[kind]()


@pytest.mark.parametrize("kind", ["blurred", "shrunk", "grown", "shrunk and blurred"])
@pytest.mark.parametrize("hair", [HAIR, WHITE], ids=["dark", "white"])
def test_any_mask_leaves_as_little_behind_as_the_parts_own_alpha(hair: tuple[float, ...], kind: str) -> None:
    """Neither opacity where only the lock was, nor the lock's colour over the body."""
    moved_off = [drawn(sprite(hair=hair), mask, (60.0, 0.0)).frame(1) for mask in (lock(), made(kind))]
    beside, over_body = (np.hypot(X - 80, Y - 80) > 46) & (X < 140), (np.hypot(X - 80, Y - 80) < 37) & (X < 106)
    ghosts = [int((frame[..., 3][beside] > 38).sum()) for frame in moved_off]
    stains = [int((np.abs(frame[..., :3] / 255 - SKIN).max(axis=2) > 0.15)[over_body].sum()) for frame in moved_off]
    assert ghosts[1] <= 2 * max(ghosts[0], 10)
    assert stains[1] <= 2 * max(stains[0], 10)


def test_what_moves_off_bares_the_body_and_no_more() -> None:
    frame = drawn(sprite(), lock(), (40.0, 0.0)).frame(1)
    from_middle = np.hypot(X - 80, Y - 80)
    # The lock hides how far the head goes on; half its width is a fair guess.
    body, beside = (from_middle < 37) & (X < 106), (from_middle > 43) & (X < 136)
    assert frame[body][:, 3].min() > 180
    assert np.abs(frame[body][:, :3] / 255 - SKIN).max() < 0.1
    assert frame[beside & (X > 112)][:, 3].max() == 0
    assert frame[beside][:, 3].mean() < 3


def test_a_silhouette_goes_on_behind_what_crosses_it() -> None:
    band = np.clip(10.5 - np.abs(X + 0.4 * Y - 120), 0, 1)
    body = np.clip(0.5 + 0.9 * (Y - 70) + 0.2 * (X - 100), 0, 1)  # a slanted shoulder
    alpha = band + (1 - band) * body
    image = np.dstack([np.where(band[..., None] > 0, HAIR, SKIN), alpha])
    plate = sprite_plate(image.astype(np.float32), band.astype(np.float32))
    assert np.abs(plate[..., 3] - body)[20:-20].mean() < 0.003


def test_hidden_colours_have_no_effect() -> None:
    plain, painted = (drawn(sprite(hidden=hidden), lock(), (9.5, 3.25)).frame(1) for hidden in (False, True))
    assert (plain == painted).all()


def test_the_four_backgrounds() -> None:
    image = sprite()
    renderer = drawn(image, lock(), (15.0, 0.0))
    picture, sky, whole, parts = (
        shown_frame(renderer, 1, background_of(each)) for each in ("picture", "#4080c0", "transparent", "parts")
    )
    corner = (0, 0)
    assert picture[corner].tolist() == [255, 255, 255]
    assert sky[corner].tolist() == [64, 128, 192]
    assert whole[corner].tolist() == [0, 0, 0, 0]
    assert whole[80, 70].tolist() == [*np.rint(255 * np.array(SKIN)).astype(int), 255]
    assert parts[80, 70].tolist() == [0, 0, 0, 0]
    assert (parts[75, 127] == whole[75, 127]).all()
    assert parts[75, 127, 3] == 255
    assert (over(whole, (64, 128, 192)) == sky).all()
    for name, expected in (("transparent", whole), ("parts", parts)):
        frame, alpha = shown_frame_and_alpha(renderer, 1, background_of(name))
        assert (frame == expected).all()
        assert np.allclose(alpha, expected[..., 3] / 255)


def test_transparent_shows_the_parts_of_an_opaque_picture() -> None:
    renderer = drawn(over(sprite()), lock())
    shown = (shown_frame(renderer, 0, background_of(name)) for name in ("transparent", "parts"))
    assert (next(shown) == next(shown)).all()


def test_a_plate_may_bring_its_own_transparency_or_none() -> None:
    clear = np.dstack(
        [np.broadcast_to(np.array([0, 200, 0], np.uint8), (HEIGHT, WIDTH, 3)), np.zeros((HEIGHT, WIDTH), np.uint8)]
    )
    frame = drawn(sprite(), lock(), (60.0, 0.0), plate=clear).frame(1)
    assert frame[75, 112].tolist() == [0, 0, 0, 0]
    green = np.ascontiguousarray(clear[..., :3])
    frame = drawn(sprite(), lock(), (60.0, 0.0), plate=green).frame(1)
    assert frame[75, 105].tolist() == [0, 200, 0, 255]
    assert frame[75, 123, 3] == 0


def test_two_parts_one_over_the_other() -> None:
    masks = [lock(), np.clip(10.5 - np.hypot(X - 112, Y - 60), 0, 1)]
    image = sprite()
    front = masks[1][..., None]
    image = np.rint(np.where(front > 0, front * (255, 40, 40, 255) + (1 - front) * image, image)).astype(np.uint8)
    meshes = [mesh_from_mask(each) for each in masks]
    rest = np.concatenate([mesh.vertices for mesh in meshes])
    step = np.concatenate([np.zeros_like(meshes[0].vertices), np.full_like(meshes[1].vertices, (0, 40.0))])
    motion = Motion(
        tuple(Body(mesh, layer=number) for number, mesh in enumerate(meshes)),
        np.stack([rest, rest + step]).astype(np.float32),
        24.0,
    )
    renderer = LayeredRenderer(image, masks, motion)
    assert (renderer.frame(0)[image[..., 3] > 0] == image[image[..., 3] > 0]).all()
    bared = renderer.frame(1)[60, 112]
    assert bared[3] == 255
    assert np.abs(bared[:3] / 255 - HAIR).max() < 0.05


def test_a_plate_of_a_sprite_is_one() -> None:
    plate = sprite_plate(sprite().astype(np.float32) / 255, lock().astype(np.float32))
    assert plate.shape == (HEIGHT, WIDTH, 4)
    assert plate[75, 123, 3] == 0
    assert plate[75, 102, 3] == 1


def test_unusable_pictures_are_refused() -> None:
    image, motion = sprite(), moved(mesh_from_mask(lock()))
    with pytest.raises(InvalidInputError, match=r"^masks must leave some of the picture"):
        LayeredRenderer(image, [np.ones((HEIGHT, WIDTH))], motion)
    with pytest.raises(InvalidInputError, match=r"^plate must have the image's size"):
        LayeredRenderer(image, [lock()], motion, plate=image[:-1])
    with pytest.raises(InvalidInputError, match=r"^image must be an RGB or RGBA picture"):
        LayeredRenderer(np.dstack([image, image]), [lock()], motion)


@pytest.mark.parametrize("grown", [0, 2, 4, 8])
def test_where_a_sprite_is_transparent_nothing_is_behind(grown: int) -> None:
    """A lock beside the head with a slit between, which a grown mask covers."""
    beside = np.clip(np.minimum(6.5 - np.abs(X - 130), 45.5 - np.abs(Y - 75)), 0, 1)
    front = np.maximum(beside, np.clip(np.minimum(3.5 - np.abs(Y - 34), 25.5 - np.abs(X - 110)), 0, 1))
    behind = head()
    alpha = front + (1 - front) * behind
    colour = (front[..., None] * np.array(HAIR) + ((1 - front) * behind)[..., None] * np.array(SKIN)) / np.maximum(
        alpha, 1e-9
    )[..., None]
    image = np.dstack([colour, alpha]).astype(np.float32)
    mask = (front > 0.5).astype(np.float32)
    if grown:
        mask = cv2.dilate(mask, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * grown + 1,) * 2))
    plate = sprite_plate(image, mask)
    assert (plate[..., 3] <= alpha + 1e-6).all()
    slit = (X > 121.5) & (X < 123) & (Y > 50) & (Y < 110)
    assert plate[..., 3][slit & (alpha < 0.01)].max() < 0.01
