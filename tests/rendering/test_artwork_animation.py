"""The whole way from layered artwork, or a picture with something in front, to every kind of clip."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.motion import FlowSequence, tracks
from physanimator.rendering.animation import Animation
from physanimator.rendering.artwork import ArtLayer, Artwork, flattened
from physanimator.rendering.control import ModelFormat, line_frames
from physanimator.rendering.metrics import measure_clip
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.pipeline import animate

WIDTH, HEIGHT = 144, 112
HAIR, BAND, WALL = (120, 60, 20), (250, 210, 180), (200, 220, 240)


def layer(name: str, colour: tuple[int, int, int], corners: list[tuple[int, int]], lines: int = 0) -> ArtLayer:
    """A polygon with an outline and upright lines."""
    fine = np.zeros((4 * HEIGHT, 4 * WIDTH, 4), np.float32)
    points = np.int32(corners) * 4
    cv2.fillPoly(fine, [points], (*colour, 255))
    cv2.polylines(fine, [points], True, (20, 20, 30, 255), 8)
    (left, top), (right, bottom) = points.min(axis=0), points.max(axis=0)
    for k in range(1, lines + 1):
        x = int(left + (right - left) * k / (lines + 1))
        cv2.line(fine, (x, int(top) + 40), (x, int(bottom) - 40), (60, 30, 10, 255), 6)
    small = cv2.resize(fine, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
    straight = small[..., :3] * 255 / np.maximum(small[..., 3:], 1)
    return ArtLayer(name, np.rint(np.clip(np.dstack([straight, small[..., 3]]), 0, 255)).astype(np.uint8))


def artwork(*, paper: bool = True) -> Artwork:
    """Hair that hangs behind a level band."""
    wall = ArtLayer("wall", np.dstack([np.full((HEIGHT, WIDTH, 3), WALL), np.full((HEIGHT, WIDTH), 255)]).astype("u1"))
    layers = (
        layer("back hair", HAIR, [(50, 8), (90, 8), (96, 104), (44, 104)], lines=3),
        layer("band", BAND, [(10, 40), (134, 40), (134, 62), (10, 62)]),
    )
    return Artwork(WIDTH, HEIGHT, (wall, *layers) if paper else layers)


@pytest.fixture(scope="module")
def animation() -> Animation:
    return animate(artwork(), wind=AutomaticWind(strength=4), timing=Timing(frames=13), spacing=8)


def in_band() -> np.ndarray:
    """What is surely of the band, bool, shape [h, w]."""
    return artwork().layers[-1].pixels[..., 3] == 255


def test_the_hair_moves_behind_the_band(animation: Animation) -> None:
    whole = flattened(artwork())[..., :3]
    frames = list(animation.frames())
    assert (frames[0] == whole).all()
    assert (frames[-1] != whole).any(axis=2).sum() > 200
    assert all((frame == whole)[in_band()].all() for frame in frames)


def test_in_betweens_leave_what_is_in_front_and_come_close_to_the_frames(animation: Animation) -> None:
    drawn, filled = list(animation.frames()), list(animation.frames(every=3))
    moved = np.abs(drawn[6].astype(int) - drawn[5]).sum()
    assert moved > 0
    for one, other in zip(drawn, filled, strict=True):
        assert np.abs(other[in_band()].astype(int) - one[in_band()]).max() <= 2
        assert 10 * np.log10(255**2 / max(((one.astype(float) - other) ** 2).mean(), 1e-6)) > 30


def test_flow_and_tracks_belong_to_what_is_seen(animation: Animation) -> None:
    field = FlowSequence(animation.motion).flow(12)
    assert not field.inside[in_band()].any()
    assert (field.displacement[in_band()] == 0).all()
    assert np.abs(field.displacement).max() > 1
    found = tracks(animation.motion, points=60, static_points=0)
    assert found.visibility[0].all()
    x, y = np.clip(np.rint(found.path[0] - 0.5).astype(int), 0, (WIDTH - 1, HEIGHT - 1)).T
    assert not in_band()[y, x].any()


def test_sketches_keep_the_lines_of_the_band_and_hide_the_hair_behind_it(animation: Animation) -> None:
    sketches = list(animation.sketches())
    inner = cv2.erode(in_band().astype(np.uint8), np.ones((9, 9))) > 0
    for sketch in sketches:
        assert sketch[inner].min() > 0.9
    at_edge = cv2.dilate(inner.astype(np.uint8), np.ones((15, 15))) > inner
    assert np.abs(sketches[-1] - sketches[0])[at_edge & (np.arange(WIDTH) < 36)].max() < 0.05
    assert np.abs(sketches[-1] - sketches[0]).max() > 0.3


def test_pictures_of_layers_alone_are_made_when_they_are_looked_at(animation: Animation) -> None:
    assert len(animation.own) == 1
    assert (animation.own[0] == flattened(artwork(), [artwork().layers[1]])).all()
    assert (animation.own[0:1][0] == animation.own[-1]).all()


def test_a_clip_is_measured_as_still_where_the_band_is(animation: Animation) -> None:
    frames = [frame.copy() for frame in animation.frames()]
    good = measure_clip(frames, animation.motion, sketches=list(animation.sketches()))
    assert good.static_drift == 0
    assert good.sketch_adherence is not None
    for frame in frames[1:]:
        frame[in_band()] = 255 - frame[in_band()]
    assert measure_clip(frames, animation.motion).static_drift > 0.02


def test_line_videos_hide_moving_lines_behind_the_band(animation: Animation) -> None:
    sketch = next(iter(animation.sketches()))
    form = ModelFormat(5, WIDTH, HEIGHT)
    inner = cv2.erode(in_band().astype(np.uint8), np.ones((13, 13))) > 0
    for lines in line_frames(sketch, animation.motion, form):
        assert lines[inner].max() < 0.1


def test_the_clip_without_paper_is_transparent_and_whole() -> None:
    clip = animate(artwork(paper=False), wind=AutomaticWind(strength=4), timing=Timing(frames=5), spacing=8)
    frames = list(clip.frames())
    assert frames[0].shape[2] == 4
    assert np.abs(frames[0].astype(int) - flattened(artwork(paper=False)))[frames[0][..., 3] > 20].max() <= 2
    assert all((frame[..., 3] == 255)[in_band()].all() for frame in frames)


def test_artwork_of_16_bits_goes_all_the_way() -> None:
    deep = [replace(each, pixels=each.pixels.astype(np.uint16) * np.uint16(257)) for each in artwork().layers]
    clip = animate(
        Artwork(WIDTH, HEIGHT, tuple(deep)), wind=AutomaticWind(strength=4), timing=Timing(frames=4), spacing=8
    )
    frames = list(clip.frames())
    assert frames[0].dtype == np.float32
    assert np.abs(frames[0] * 255 - flattened(artwork())[..., :3]).max() < 0.51
    assert len(list(clip.sketches())) == len(list(clip.frames(every=3))) == 4
    bent = clip.layers(3).layers[1].pixels
    assert bent.dtype == np.uint16
    assert bent[..., 3].max() == 65535


def flat() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The artwork as one picture, a mask of the hair that is seen, and one of the band."""
    whole = artwork()
    band = (whole.layers[-1].pixels[..., 3] > 127).astype(np.float32)
    hair = (whole.layers[1].pixels[..., 3] > 127) * (1 - band)
    return flattened(whole)[..., :3].copy(), hair, band


@pytest.mark.parametrize("kind", ["sharp", "soft", "faint", "empty"])
def test_any_mask_in_front_gives_the_picture_at_rest_and_stands_still(kind: str) -> None:
    picture, hair, band = flat()
    front = {
        "sharp": band,
        "soft": cv2.GaussianBlur(band, (0, 0), 3),
        "faint": band * 0.3,
        "empty": band * 0,
    }[kind]
    clip = animate(picture, [hair], in_front=front, wind=AutomaticWind(strength=4), timing=Timing(frames=5), spacing=8)
    frames = list(clip.frames())
    assert (frames[0] == picture).all()
    solid = cv2.erode((front > 0.99).astype(np.uint8), np.ones((13, 13))) > 0  # its rim is partly see-through
    for frame in frames:
        assert np.abs(frame.astype(int) - picture)[solid].max(initial=0) <= 2


@pytest.mark.parametrize("kind", ["all white", "wholly"])
def test_what_hides_a_part_wholly_is_refused(kind: str) -> None:
    picture, hair, band = flat()
    front = np.ones_like(band) if kind == "all white" else cv2.dilate(hair, np.ones((9, 9)))
    with pytest.raises(InvalidInputError, match=r"in_front must leave some of every moving part in sight\. Got: "):
        animate(picture, [hair], in_front=front, timing=Timing(frames=3), spacing=8)
