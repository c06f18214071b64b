"""What Time-to-Move is given: one size, one length, masks that lose nothing whichever pixel of a cell is taken."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.control import (
    AREAS,
    TIMINGS,
    ModelFormat,
    Timing,
    suitable_length,
    suitable_size,
    time_to_move,
    timed,
    told_rules,
)

WIDTH, HEIGHT = 200, 120
Y, X = np.mgrid[:HEIGHT, :WIDTH] + 0.5
DISC = np.hypot(X - 60, Y - 60) < 20
SHIFT = 60.0


def motion(frames: int = 3, mask: np.ndarray = DISC, shift: tuple[float, float] = (SHIFT, 0.0)) -> Motion:
    """The part slides by so much."""
    body = Body(mesh_from_mask(mask, spacing=8), preset("jelly"))
    steps = np.linspace(0, 1, frames)
    positions = [body.mesh.vertices + step * np.array(shift) for step in steps]
    return Motion((body,), np.stack(positions).astype(np.float32), 24.0)


def image(mask: np.ndarray = DISC) -> np.ndarray:
    ground = np.stack([0.4 + X / 800, 0.5 + Y / 800, np.full_like(X, 0.6)], axis=-1)
    return np.where(mask[..., None], (0.9, 0.1, 0.1), ground).astype(np.float32)


def clip(form: ModelFormat, moved: Motion, mask: np.ndarray = DISC, **options: object) -> tuple[np.ndarray, np.ndarray]:
    """All frames, and the mask of each."""
    steps = list(time_to_move(image(mask), [mask], moved, form, **options))  # type: ignore[arg-type]
    masks = [step.mask for step in steps for _ in step.frames]
    return np.concatenate([step.frames for step in steps]), np.stack(masks)


@pytest.mark.parametrize("frames", range(1, 201))
def test_any_length_comes_to_a_length_of_the_model(frames: int) -> None:
    still = Motion(motion(1).bodies, np.repeat(motion(1).positions, frames, axis=0), 24.0)
    own = suitable_length(frames)
    assert own % 4 == 1
    assert frames <= own < frames + 4
    for timing, length in (("whole motion", 81), ("frame by frame", 81), ("own length", own)):
        assert len(timed(still, ModelFormat(frames=length), timing)) == length  # type: ignore[arg-type]


@given(st.integers(1, 20_000), st.integers(1, 20_000), st.sampled_from(sorted(AREAS)))
@settings(max_examples=200, deadline=None)
def test_sizes_keep_the_proportions_and_the_area(width: int, height: int, area: str) -> None:
    found = suitable_size(width, height, AREAS[area])
    assert ModelFormat(1, *found).width % 16 == 0, "and the form takes them"
    assert found[0] * found[1] <= AREAS[area]
    if 1 / 4 <= width / height <= 4:
        apart = found[0] * height / (found[1] * width)
        assert min(apart, 1 / apart) > 0.96, "at most a few pixels are cut off"
        assert found[0] * found[1] > 0.88 * AREAS[area]


@pytest.mark.parametrize("timing", TIMINGS)
@pytest.mark.parametrize(("width", "height"), [(208, 112), (64, 160), (320, 192)])
def test_animation_mask_and_first_frame_have_one_size_and_length(timing: Timing, width: int, height: int) -> None:
    form = ModelFormat(frames=5, width=width, height=height)
    frames, masks = clip(form, motion(4), timing=timing)
    assert frames.shape == (5, height, width, 3)
    assert masks.shape == (5, height, width)
    assert set(np.unique(masks)) <= {0.0, 1.0}
    cells = masks.reshape(5, height // 8, 8, width // 8, 8)
    assert (cells.min(axis=(2, 4)) == cells.max(axis=(2, 4))).all(), "one value for each latent"
    assert (masks[1:5] == masks[1]).all(), "and for the frames of each step"


def test_the_first_frame_is_the_illustration() -> None:
    frames, _ = clip(ModelFormat(frames=5, width=208, height=128), motion())
    want = ModelFormat(frames=5, width=208, height=128).resized(image())
    assert np.abs(frames[0] - want).max() < 0.01


def test_the_mask_is_where_the_part_is_and_not_where_it_was() -> None:
    """All three resampled alike: what is red is inside, and little else is."""
    form = ModelFormat(frames=9, width=400, height=240)
    frames, masks = clip(form, motion(9))
    red = (frames[..., 0] > 0.8) & (frames[..., 1] < 0.2)
    assert red.any(axis=(1, 2)).all()
    assert (masks[red] == 1).all()
    for start, end in ((0, 1), (1, 5), (5, 9)):
        seen = red[start:end].any(axis=0)
        rows, columns = np.nonzero(masks[start] > 0)
        near = np.pad(seen, 12)
        reached = np.array([near[r : r + 25, c : c + 25].any() for r, c in zip(rows[::7], columns[::7], strict=True)])
        assert reached.all(), "within a cell and a half of the part"
    left = (np.hypot(X - 60, Y - 60) < 18).repeat(2, axis=0).repeat(2, axis=1)
    assert masks[-1][left].mean() < 0.2, "what it has left is free"


@pytest.mark.parametrize("offset", [0, 3, 7])
@pytest.mark.parametrize("scale", [0.4, 1.0, 1.6])
def test_a_thin_strand_is_in_every_mask_whichever_pixel_is_taken(offset: int, scale: float) -> None:
    """Nodes take every eighth pixel of every fourth frame; a strand of two pixels falls between them."""
    strand = (np.abs(X - 61 - offset) < 1) & (Y > 20) & (Y < 100)
    form = ModelFormat(9, *(16 * max(1, round(side * scale / 16)) for side in (WIDTH, HEIGHT)))
    _, masks = clip(form, motion(9, strand, (11.0, 3.0)), strand)
    for first in (0, 3, 7):
        taken = masks[:, first::8, first::8]
        assert (taken[::4].reshape(3, -1).sum(axis=1) > 0).all()
        for frame in (0, 4, 8):
            rows = np.nonzero(taken[frame].any(axis=1))[0]
            assert (np.diff(rows) == 1).all(), "in one piece"
            assert len(rows) * 8 >= 70 * form.height / HEIGHT


def test_a_line_between_two_rows_of_pixels_is_in_the_mask() -> None:
    line = (np.abs(Y - 60.5) < 0.6) & (X > 20) & (X < 180)
    moved = motion(5, line, (0.0, 10.0))
    alphas = LayeredRenderer(image(line), [line], moved)
    assert min(alphas.alpha(t).max() for t in range(5)) < 0.7, "no pixel is the line's alone"
    _, masks = clip(ModelFormat(frames=5, width=208, height=128), moved, line, timing="frame by frame")
    assert (masks.any(axis=1)[:, 40:170]).all()


def test_a_part_that_passes_within_a_step_is_in_its_mask() -> None:
    """A swing that is back after four frames, and is only seen between the frames that are taken."""
    still = motion(1).positions[0]
    swung = np.stack([still, still, still + np.float32((SHIFT, 0)), still, still])
    moved = Motion(motion(1).bodies, swung, 24.0)
    frames, masks = clip(ModelFormat(frames=5, width=208, height=128), moved, timing="frame by frame")
    away = (frames[2][..., 0] > 0.8) & (frames[2][..., 1] < 0.2)
    assert (masks[4][away] == 1).all()
    assert not masks[0][64, 125:].any()


def test_the_last_frame_is_held_and_what_is_beyond_is_left_out() -> None:
    short = timed(motion(3), ModelFormat(frames=5), "own length")
    assert (short.positions[2:] == short.positions[2]).all()
    cut = timed(motion(9), ModelFormat(frames=5), "frame by frame")
    assert (cut.positions == motion(9).positions[:5]).all()
    assert cut.frame_rate == 24.0
    spread = timed(motion(9), ModelFormat(frames=5), "whole motion")
    assert spread.duration == pytest.approx(motion(9).duration)
    with pytest.raises(InvalidInputError, match="frames must be 9 for a motion of 8"):
        timed(motion(8), ModelFormat(frames=5), "own length")


def test_the_rules_are_told() -> None:
    form = ModelFormat(frames=5, width=80, height=96)
    assert told_rules(motion(9), form, "frame by frame")[0] == (
        "The first 5 of 9 frames are taken, 4 are left out; 24 a second."
    )
    assert "last is held for 2 more" in told_rules(motion(3), form, "own length")[0]
    assert "9 frames at 24 a second are drawn as 5 at 12" in told_rules(motion(9), form, "whole motion")[0]
    assert told_rules(motion(9), form, "whole motion")[1] == (
        "200 x 120 px become 80 x 96 px; 25.0 % are cut off at left and right, each."
    )


def test_what_stands_in_front_is_no_part_of_the_mask() -> None:
    bar = np.abs(X - 90) < 12

    def drawing(moved: Motion) -> LayeredRenderer:
        return LayeredRenderer(image(), [DISC], moved, in_front=bar)

    form = ModelFormat(frames=1, width=208, height=128)
    far = Motion(motion().bodies, motion().positions[1:2], 24.0)
    (step,) = time_to_move(image(), [DISC], far, form, renderer=drawing)
    assert step.mask[64, 115] == 1, "beside the bar"
    assert not step.mask[:, 90:96].any()


def test_a_grown_mask_reaches_further() -> None:
    form = ModelFormat(frames=5, width=208, height=128)
    assert clip(form, motion(), grow=16)[1].sum() > 1.5 * clip(form, motion())[1].sum()
    with pytest.raises(InvalidInputError, match="grow"):
        clip(form, motion(), grow=-1)
