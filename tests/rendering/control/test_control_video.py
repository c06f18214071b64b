"""Clips that lead video models: their form, their holes, their lines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.artwork import ArtLayer, Artwork
from physanimator.rendering.composite import Layer, LayeredRenderer
from physanimator.rendering.control import ModelFormat, first_and_last, line_frames, warped_frames

WIDTH, HEIGHT = 160, 96
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
MASK = np.hypot(X - 60, Y - 48) < 20
SHIFT = 24.0
FORM = ModelFormat(frames=5, width=160, height=96)


def image() -> np.ndarray:
    picture = np.stack([0.4 + X / 800, 0.5 + Y / 800, np.full_like(X, 0.6)], axis=-1)
    return np.where(MASK[..., None], (0.9, 0.1, 0.1), picture).astype(np.float32)


def motion(frames: int = 3) -> Motion:
    """The disc slides to the right."""
    body = Body(mesh_from_mask(MASK), preset("jelly"))
    steps = np.linspace(0, SHIFT, frames)
    positions = [body.mesh.vertices + (step, 0.0) for step in steps]
    return Motion((body,), np.stack(positions).astype(np.float32), 24.0)


@pytest.mark.parametrize(
    ("name", "value"), [("frames", 80), ("frames", 0), ("width", 830), ("height", 0), ("fit", "squeeze")]
)
def test_forms_that_the_model_cannot_take_are_refused(name: str, value: int | str) -> None:
    with pytest.raises(InvalidInputError, match=name):
        ModelFormat(**{name: value})


def test_a_motion_is_sampled_from_its_first_frame_to_its_last() -> None:
    sampled = FORM.sampled(motion())
    assert len(sampled) == 5
    moved = (sampled.positions - sampled.positions[0])[:, :, 0].mean(axis=1)
    assert moved == pytest.approx(np.linspace(0, SHIFT, 5), abs=0.01)
    assert sampled.duration == pytest.approx(motion().duration)
    assert len(ModelFormat(frames=1).sampled(motion())) == 1


def test_holes_are_what_was_uncovered_and_grey() -> None:
    clip = list(warped_frames(image(), [MASK], motion(), FORM, grow=2))
    assert len(clip) == 5
    assert not clip[0][1].any()
    assert np.abs(clip[0][0] - image()).max() < 0.01
    frame, hole = clip[-1]
    moved = np.hypot(X - 60 - SHIFT, Y - 48)
    left = (np.hypot(X - 60, Y - 48) < 18) & (moved > 22)
    assert (hole[left] == 1).all()
    assert (frame[hole == 1] == 0.5).all()
    assert not hole[moved < 17].any()
    assert not hole[np.hypot(X - 60, Y - 48) > 25].any()
    assert np.abs(frame[moved < 17] - (0.9, 0.1, 0.1)).max() < 0.05


def test_a_given_plate_leaves_no_holes() -> None:
    plate = np.full_like(image(), 0.25)
    frame, hole = list(warped_frames(image(), [MASK], motion(), FORM, plate=plate))[-1]
    assert not hole.any()
    assert np.abs(frame[48, 45] - 0.25).max() < 0.01


def test_lines_move_along_and_are_bright_on_request() -> None:
    sketch = np.where(np.abs(np.hypot(X - 60, Y - 48) - 12) < 1.5, 0.0, 1.0)
    bright = list(line_frames(sketch, motion(), FORM))
    dark = list(line_frames(sketch, motion(), FORM, bright_lines=False))
    assert np.abs(bright[-1] + dark[-1] - 1).max() < 1e-6
    assert bright[0][48, 72] > 0.5
    assert bright[-1][48, 48] < 0.2
    assert bright[-1][48, 72 + int(SHIFT)] > 0.5
    assert bright[-1].shape == (96, 160)


def test_first_and_last_frame_come_in_the_wanted_size() -> None:
    form = ModelFormat(width=80, height=48)
    start, end = first_and_last(image(), [MASK], motion(), form)
    assert start.shape == end.shape == (48, 80, 3)
    assert start[24, 22, 0] > 0.8
    assert end[24, 22, 0] < 0.6
    assert end[24, 42, 0] > 0.8
    with pytest.raises(InvalidInputError, match="last_frame"):
        first_and_last(image(), [MASK], motion(), form, last=3)


def test_every_layer_is_drawn_once_a_frame_and_once_at_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[int] = []
    whole = Layer.drawn
    monkeypatch.setattr(Layer, "drawn", lambda *given, **more: (drawn.append(1), whole(*given, **more))[1])
    assert len(list(warped_frames(image(), [MASK], motion(), FORM))) == 5
    assert len(drawn) == 5 + 1


def test_holes_spare_what_stands_still_in_front() -> None:
    bar = (np.abs(Y - 48) < 6) & (X > 20) & (X < 140)
    picture = np.where(bar[..., None], np.float32((0.1, 0.2, 0.8)), image())

    def drawing(moved: Motion) -> LayeredRenderer:
        return LayeredRenderer(picture, [MASK], moved, in_front=bar)

    clip = list(warped_frames(picture, [MASK], motion(), FORM, grow=8, renderer=drawing))
    inside = (np.abs(Y - 48) < 4) & (X > 24) & (X < 136)
    for frame, hole in clip:
        assert not hole[inside].any()
        assert np.abs(frame - picture)[inside].max() < 0.02
    assert clip[-1][1].any(), "beside it there are holes"


def test_layers_leave_no_holes_and_are_shown_over_white() -> None:
    red = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    red[MASK] = (230, 25, 25, 255)
    artwork = Artwork(WIDTH, HEIGHT, (ArtLayer("red", red),))

    def drawing(moved: Motion) -> LayeredRenderer:
        return LayeredRenderer.of_artwork(artwork, [0], moved)

    clip = list(warped_frames(image(), [MASK], motion(), FORM, renderer=drawing))
    assert not any(hole.any() for _, hole in clip)
    first, last = first_and_last(image(), [MASK], motion(), FORM, renderer=drawing)
    assert np.abs(first - clip[0][0]).max() < 1e-6
    assert np.abs(last - clip[-1][0]).max() < 1e-6
    assert last[48, 60 + int(SHIFT)] == pytest.approx((230 / 255, 25 / 255, 25 / 255), abs=0.01)
    assert (last[48, 42] == 1).all(), "what it left is white"


def test_lines_of_layers_come_to_light() -> None:
    sketch, hidden = np.ones((2, HEIGHT, WIDTH), np.float32)
    cover = np.zeros((HEIGHT, WIDTH), bool)
    cover[:, 50:70] = True
    hidden[40:56, 58:62] = 0
    body = replace(motion().bodies[0], cover=cover)
    moved = Motion((body,), motion().positions, 24.0)
    plain = list(line_frames(sketch, moved, FORM, bright_lines=False))
    drawn = list(line_frames(sketch, moved, FORM, bright_lines=False, own=[hidden]))
    assert drawn[0].min() > 0.9, "hidden at rest"
    assert drawn[-1][48, 60 + int(SHIFT)] < 0.2, "and seen where it has come out"
    assert plain[-1].min() > 0.9
