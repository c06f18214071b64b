"""Trajectories as the public demo scripts of Drag Anything and Motion-I2V read them."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.evaluation.trajectories import body_masks, save_drag_anything, save_motion_i2v
from PIL import Image
from scipy.interpolate import PchipInterpolator

WIDTH, HEIGHT = 400, 300


def box(left: int, top: int, right: int, bottom: int) -> Body:
    mask = np.zeros((HEIGHT, WIDTH))
    mask[top:bottom, left:right] = 1
    return Body(mesh_from_mask(mask, spacing=12))


def moving(speed: tuple[float, float] = (3.0, -1.0), frames: int = 24) -> Motion:
    """Two boxes: the first moves evenly, the second, in front of it, stands still."""
    bodies = (box(100, 120, 180, 200), box(250, 100, 300, 220))
    first = np.arange(sum(len(b.mesh.vertices) for b in bodies)) < len(bodies[0].mesh.vertices)
    rest = np.concatenate([b.mesh.vertices for b in bodies])
    times = np.arange(frames)[:, None, None]
    return Motion(bodies, (rest + times * np.where(first[:, None], speed, 0)).astype(np.float32), frame_rate=24.0)


def picture() -> np.ndarray:
    return np.random.default_rng(0).integers(0, 255, (HEIGHT, WIDTH, 3), dtype=np.uint8)


@pytest.fixture
def motion() -> Motion:
    made = moving()
    assert (made.width, made.height) == (WIDTH, HEIGHT)
    return made


def test_drag_anything_reads_masks_and_pixels_of_its_own_size(motion: Motion, tmp_path: Path) -> None:
    save_drag_anything(motion, picture(), tmp_path / "ship")
    with Image.open(tmp_path / "ship" / "demo.jpg") as opened:
        original = opened.convert("RGB").size
    entries = json.loads((tmp_path / "ship" / "demo.json").read_text(encoding="utf-8"))
    assert len(entries) == 2
    # From here on as get_condition does for its 576 x 320.
    places = [
        [[int(i[0] / original[0] * 576), int(i[1] / original[1] * 320)] for i in each["trajectory"]]
        for each in entries.values()
    ]
    assert [len(each) for each in places] == [20, 20]
    moved = np.subtract(places[0][-1], places[0][0])
    assert moved == pytest.approx((69 * 576 / WIDTH, -23 * 320 / HEIGHT), abs=1.5)
    assert places[1][0] == places[1][-1]
    for entry, trajectory in zip(entries.values(), places, strict=True):
        mask = (cv2.imread(str(tmp_path / "ship" / entry["mask_name"])) / 255).astype(np.uint8)
        mask = cv2.resize(cv2.cvtColor(mask, cv2.COLOR_RGB2GRAY), (576, 320))
        assert set(np.unique(mask)) == {0, 1}
        assert mask[trajectory[0][1], trajectory[0][0]] == 1
        radius = cv2.distanceTransform(mask, cv2.DIST_L2, 5).max()
        assert 20 < radius < 60


def test_motion_i2v_gets_displacements_of_its_own_picture(motion: Motion, tmp_path: Path) -> None:
    save_motion_i2v(motion, picture(), tmp_path / "drag")
    with Image.open(tmp_path / "drag" / "first_frame.png") as opened:
        assert opened.size == (512, 320)
    drags = json.loads((tmp_path / "drag" / "drags.json").read_text(encoding="utf-8"))
    brush = np.asarray(Image.open(tmp_path / "drag" / "brush.png"))
    scale = 512 / WIDTH  # covers; 64 px of height are cut off, 32 above
    found = 0
    for drag in drags:
        points = [tuple(int(value) for value in place) for place in drag]
        t = np.linspace(0, 1, len(points))
        x, y = (PchipInterpolator(t, [p[k] for p in points])(np.linspace(0, 1, 16)) for k in (0, 1))
        assert brush[points[0][1], points[0][0]] == 255
        if 250 * scale <= points[0][0] <= 300 * scale:
            assert np.ptp(x) == np.ptp(y) == 0
        else:
            found += 1
            steps = np.arange(16) * 23 / 15
            assert np.abs(x - x[0] - 3 * scale * steps).max() <= 1
            assert np.abs(y - y[0] + scale * steps).max() <= 1
    assert found >= 3
    assert brush[round((150 - 25) * scale), round(240 * scale)] == 255  # where the body comes to in the end


def test_what_is_behind_another_body_is_not_in_its_mask() -> None:
    bodies = (box(100, 100, 200, 200), box(150, 100, 250, 200))
    rest = np.concatenate([b.mesh.vertices for b in bodies])
    back, front = body_masks(Motion(bodies, np.float32([rest, rest]), frame_rate=24.0))
    assert not (back & front).any()
    assert front[150, 175]
    assert back[150, 125]


def test_files_of_others_stay(motion: Motion, tmp_path: Path) -> None:
    (tmp_path / "demo.json").write_text("mine")
    with pytest.raises(InvalidInputError, match="Got: "):
        save_drag_anything(motion, picture(), tmp_path)
    assert (tmp_path / "demo.json").read_text() == "mine"
    save_motion_i2v(motion, picture(), tmp_path / "new")
    save_motion_i2v(motion, picture(), tmp_path / "new")


def test_a_picture_of_another_size_is_refused(motion: Motion, tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="400 x 300"):
        save_drag_anything(motion, picture()[:100], tmp_path / "x")
