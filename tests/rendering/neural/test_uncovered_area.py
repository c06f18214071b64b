"""What the parts uncover in a whole clip, and the picture that a model paints there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.command import main
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.neural.uncovered_area import extended, uncovered_area
from physanimator.rendering.pictures import load_image, save_image

Y, X = np.mgrid[:90, :150] + 0.5
MASK = (np.abs(X - 60) < 20) & (np.abs(Y - 45) < 20)
PICTURE = np.where(MASK[..., None], (200, 40, 40), (90, 140, 220)).astype(np.uint8)


def layers(*shifts: float, in_front: np.ndarray | None = None) -> LayeredRenderer:
    """A square that is moved to the right by so many pixels, one shift a frame."""
    body = Body(mesh_from_mask(MASK))
    positions = np.stack([body.mesh.vertices + (shift, 0.0) for shift in shifts]).astype(np.float32)
    return LayeredRenderer(PICTURE, [MASK], Motion((body,), positions, 24.0), in_front=in_front)


def test_it_is_all_that_is_bare_in_any_frame_and_nothing_else() -> None:
    area = uncovered_area(layers(0.0, 12.0, 0.0, -7.0), grow=0)
    inner = np.abs(Y[:, 0] - 45) < 16
    row = area[inner].min(axis=0)
    assert (area[inner] == row).all()
    assert sorted(np.unique(area)) == [0.0, 1.0]
    # 40 to 52 when it is at the right, 73 to 80 when it is at the left; a pixel more where edges are soft.
    bare = {*range(40, 52), *range(73, 80)}
    assert bare <= set(np.flatnonzero(row)) <= bare | {39, 52, 72, 80}


def test_half_a_pixel_counts() -> None:
    area = uncovered_area(layers(0.0, 0.5), grow=0)
    assert area[45, 40] == 1
    assert area[45, 42:].max() == 0


def test_it_grows_and_ends_softly_and_not_over_what_stands_in_front() -> None:
    bare, moved = uncovered_area(layers(0.0, 12.0), grow=0), layers(0.0, 12.0)
    grown = uncovered_area(moved, grow=6)
    assert grown[45, 34:].argmax() == 0
    assert grown[45, 33] == 0
    soft = uncovered_area(moved, grow=6, soft_edge=10)
    assert (soft[grown == 1] == 1).all()
    assert 0 < soft[45, 28] < soft[45, 32] < 1
    assert soft[45, 23] == 0
    front = (X > 30) & (X < 38)
    assert not uncovered_area(layers(0.0, 12.0, in_front=front), grow=6)[45, 31:37].any()
    assert (grown >= bare).all()


def test_where_somebody_drew_what_is_behind_it_is_empty() -> None:
    assert not uncovered_area(layers(0.0, 12.0), drawn=True).any()


@pytest.mark.parametrize(("name", "value"), [("grow", -1), ("grow", 1001), ("soft_edge", np.nan)])
def test_widths_out_of_range_are_refused(name: str, value: float) -> None:
    with pytest.raises(InvalidInputError, match=f"{name} must be 0 to 1000 px"):
        uncovered_area(layers(0.0, 1.0), **{name: value})


def test_a_picture_is_extended_by_its_border_and_a_mask_by_nothing() -> None:
    wide = extended(PICTURE, 64)
    assert wide.shape == (128, 192, 3)
    assert (wide[:90, :150] == PICTURE).all()
    assert (wide[90:, 149] == PICTURE[-1, -1]).all()
    assert not extended(MASK.astype(np.float32), 64, by=0.0)[90:].any()
    assert extended(PICTURE, 1).shape == PICTURE.shape
    with pytest.raises(InvalidInputError, match="size_step"):
        extended(PICTURE, 0)


def test_what_is_painted_there_comes_back_by_the_command_line(tmp_path: Path) -> None:
    picture, mask = tmp_path / "girl.png", tmp_path / "hair.png"
    save_image(picture, PICTURE)
    save_image(mask, MASK.astype(np.float32))
    given = ["animate", str(picture), "--mask", str(mask), "--frames", "12", "--wind", "9", "-q", "-o"]
    area, plate = tmp_path / "area.png", tmp_path / "plate.png"
    made = ["--save-uncovered", str(area), "--save-plate", str(plate), "--grow", "3"]
    assert main([*given, f"{tmp_path}/a/", *made]) == 0
    white = load_image(area)[..., 0] > 127
    assert white.any()
    assert not white[:, 100:].any()
    behind = load_image(plate)
    assert (behind[~MASK] == PICTURE[~MASK]).mean() > 0.99
    behind[white] = (10, 250, 10)
    save_image(plate, behind)
    assert main([*given, f"{tmp_path}/b/", "--plate", str(plate)]) == 0
    painted = [load_image(tmp_path / "b" / f"frame_{t:04d}.png") for t in range(12)]
    assert max(int(((frame[..., 1] > 200) & MASK).sum()) for frame in painted) > 5
    assert (painted[0] == PICTURE).all()
