"""The figures: what they claim in words holds in their simulations, and they are whole pictures."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from physanimator.physics.document import read_json, scene_from_dict
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Scene
from physanimator.rendering.command import EXAMPLE
from physanimator.rendering.figures import figures
from physanimator.rendering.figures.ball import draw_ball, draw_sand, draw_stage
from physanimator.rendering.figures.contact_sheet import contact_sheet
from physanimator.rendering.pictures import load_mask

PICTURES = [[np.full((40, 60, 3), shade, np.uint8) for shade in (10, 90)] for _ in range(3)]


def strain(motion: Motion) -> float:
    """Largest change of an edge's length in the last frame, relative to it."""
    edges = motion.bodies[0].mesh.edges
    first, last = (np.hypot(*np.diff(motion.positions[t][edges], axis=1)[:, 0].T) for t in (0, -1))
    return float(np.abs(last / first - 1).max())


def test_stiffer_balls_deform_less() -> None:
    strains = [strain(motion) for motion in figures.ball_motions()]
    assert all(soft > 1.2 * stiff for soft, stiff in pairwise(strains))
    assert strains[0] > 5 * strains[-1]


def test_the_ball_stands_on_its_foot() -> None:
    motion = figures.ball_motions((50.0,))[0]
    held = motion.positions[0, :, 1] > figures._SAND
    assert held.sum() > 5
    assert np.abs(motion.positions[-1] - motion.positions[0])[held].max() < 1e-3


def example_at(width: int, height: int) -> Scene:
    document = read_json((EXAMPLE / "scene.json").read_text(encoding="utf-8"))
    masks = [load_mask(EXAMPLE / f"mask_{body['name']}.png", width=1280, height=720) for body in document["bodies"]]
    meshes = [mesh_from_mask(mask, spacing=28) for mask in masks[:1]]
    document["bodies"], document["rig_points"] = document["bodies"][:1], document["rig_points"][:1]
    return scene_from_dict(document, meshes=meshes).rescaled(width, height)


def test_stronger_strokes_push_further_along_their_direction_at_any_size() -> None:
    moved = []
    for scale in (1.0, 0.5):
        scene = example_at(round(1280 * scale), round(720 * scale))
        motions = figures.stroke_motions(scene)
        moved.append([[(each.positions[-1] - each.positions[0]) / scale for each in row] for row in motions])
    for row, direction in zip(moved[0], ((-1, 0), (0, -1), (0, 1)), strict=True):
        along = [float((each @ np.array(direction)).mean()) for each in row]
        assert along[0] > 2
        assert all(weak < strong for weak, strong in pairwise(along))
    assert np.abs(np.array(moved[0]) - np.array(moved[1])).max() < 1.0


def test_stiffness_figure_is_a_sheet_of_balls() -> None:
    steps: list[tuple[int, int]] = []
    sheet = figures.stiffness_figure(progress=lambda done, total: steps.append((done, total)))
    assert steps == [(number, len(figures.MODULI)) for number in range(1, len(figures.MODULI) + 1)]
    assert sheet.dtype == np.uint8
    assert sheet.shape[1] > len(figures.MODULI) * 360
    assert sheet.shape[0] > 4 * 360


def test_contact_sheet_holds_every_picture_under_its_captions() -> None:
    sheet = contact_sheet(PICTURES, title="Title", note="Note", columns=["one", "two"], row_names=["a", "b\nb", "c"])
    assert sheet.dtype == np.uint8
    for shade in (10, 90):
        assert (sheet == shade).all(axis=2).sum() >= 3 * 40 * 60
    assert (sheet[0] == 255).all()
    rows = np.flatnonzero((sheet == 10).all(axis=2).any(axis=1))
    above = sheet[: rows[0] - 2]
    assert (above < 128).any()


@pytest.mark.parametrize(("columns", "rows"), [(["one"], ["a", "b", "c"]), (["one", "two"], ["a"])])
def test_contact_sheet_refuses_missing_captions(columns: list[str], rows: list[str]) -> None:
    with pytest.raises(InvalidInputError, match=r"columns|row_names"):
        contact_sheet(PICTURES, title="", note="", columns=columns, row_names=rows)


def test_the_ball_is_drawn_where_its_mask_is() -> None:
    stage = draw_stage(160, 120, floor=80)
    picture, mask = draw_ball(stage, (70.0, 60.0), 30.0)
    assert mask.sum() == pytest.approx(np.pi * 30**2, rel=0.01)
    changed = (picture != stage).any(axis=2)
    assert (changed <= (mask > 0)).all()
    assert changed[mask == 1].mean() > 0.98
    assert len(np.unique(picture[mask == 1], axis=0)) > 8


def test_sand_covers_only_what_is_below_its_top() -> None:
    stage = draw_stage(160, 120, floor=80)
    sand = draw_sand(stage, top=100)
    assert (sand[:92] == stage[:92]).all()
    assert (sand[108:] != stage[108:]).any(axis=2).all()
