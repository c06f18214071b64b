"""A still part in front of moving ones in a flat picture: an arm before hair."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.composite import LayeredRenderer, behind_still
from physanimator.rendering.options import Timing
from physanimator.rendering.pipeline import animate

HAIR, ARM, WALL = (120, 60, 20), (250, 210, 180), (200, 220, 240)


def scene(*, transparent: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A strand that hangs from y = 10 to 110 behind a level arm at y = 50 to 65."""
    picture = np.full((120, 160, 3), WALL, np.uint8)
    hair, arm = np.zeros((2, 120, 160), np.float32)
    hair[10:110, 60:85] = 1
    arm[50:65, 20:140] = 1
    picture[hair > 0] = HAIR
    picture[arm > 0] = ARM
    if transparent:
        picture = np.dstack([picture, np.where((hair + arm) > 0, 255, 0)]).astype(np.uint8)
    return picture, hair * (1 - arm), arm


@pytest.mark.parametrize("transparent", [False, True])
def test_hair_swings_behind_the_arm(transparent: bool) -> None:
    picture, hair, arm = scene(transparent=transparent)
    whole = behind_still(hair, arm > 0)
    mesh = mesh_from_mask(whole, spacing=8)
    positions = np.float32([mesh.vertices, mesh.vertices + (15, 0)])
    motion = Motion((Body(mesh, cover=arm > 0),), positions, frame_rate=24.0)
    renderer = LayeredRenderer(picture, [whole], motion, in_front=arm)
    seen = picture[..., -1] > 0 if transparent else np.ones(picture.shape[:2], bool)
    assert (renderer.frame(0) == picture)[seen].all()
    frame = renderer.frame(1)
    assert np.abs(frame[52:63, 22:138, :3].astype(int) - ARM).max() <= 2
    assert np.abs(frame[30, 92, :3].astype(int) - HAIR).max() <= 2
    assert np.abs(frame[90, 92, :3].astype(int) - HAIR).max() <= 2
    if transparent:
        assert frame[30, 66, 3] == 0
    else:
        assert np.abs(frame[30, 66].astype(int) - WALL).max() <= 2


def test_a_part_goes_on_behind_what_crosses_it_but_not_all_of_what_it_touches() -> None:
    _, hair, arm = scene()
    whole = behind_still(hair, arm > 0)
    assert whole[50:65, 62:83].all()
    assert not whole[50:65, :55].any()
    beside = np.zeros_like(hair)
    beside[10:110, 85:160] = 1
    behind = behind_still(hair * (1 - arm), beside > 0)
    assert behind[30:45, 86:100].all()
    assert not behind[:, 115:].any()


def test_the_whole_way_takes_what_is_in_front() -> None:
    picture, hair, arm = scene()
    animation = animate(picture, [hair], in_front=arm, timing=Timing(frames=4), spacing=8)
    assert animation.motion.bodies[0].cover is not None
    assert animation.motion.bodies[0].mesh.components.max() == 0  # joined behind the arm
    for frame in animation.frames():
        assert np.abs(frame[52:63, 22:138].astype(int) - ARM).max() <= 2


def test_pixel_art_has_no_parts_in_front() -> None:
    picture, hair, arm = scene()
    with pytest.raises(InvalidInputError, match="in_front must be left out with pixel_art"):
        animate(picture, [hair], in_front=arm, pixel_art=True, timing=Timing(frames=2))
