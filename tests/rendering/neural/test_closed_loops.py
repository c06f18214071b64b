"""Loops by video models: whether they are told to close, and what is left of a drift of their colours at the wrap."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import random_networks
from numpy.typing import NDArray
from physanimator.rendering.animation import Animation
from physanimator.rendering.evaluation.columns.loop_residual import LOOP_RESIDUAL
from physanimator.rendering.inbetweens import Clip
from physanimator.rendering.neural import NetworkOptions
from physanimator.rendering.options import Timing
from physanimator.rendering.pictures import as_uint8
from physanimator.rendering.pictures.lab import lab_to_rgb, rgb_to_lab
from physanimator.rendering.pipeline import animate
from physanimator.rendering.svd import SVDOptions
from physanimator.rendering.svd.renderer import SVDRenderer
from physanimator.rendering.tooncrafter import ToonCrafterOptions
from physanimator.rendering.tooncrafter.interpolator import ToonCrafterInterpolator

Image = NDArray[Any]
BAR = np.pad(np.ones((48, 24)), ((10, 14), (30, 42)))
PICTURE = np.where(BAR[..., None] > 0, (200, 90, 40), (150, 190, 220)).astype(np.uint8)
LOOP = {"loop": 0.5, "frame_rate": 24}


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return random_networks.write(tmp_path_factory.mktemp("weights"), "folder")


@pytest.fixture
def drawing(files: dict[str, Path]) -> NetworkOptions:
    options = SVDOptions(steps=2, area=64 * 64)
    return NetworkOptions(renderer="svd", svd=files["svd"], lvcd=files["lvcd"], svd_options=options, soft_edge=2)


def looping(networks: NetworkOptions = NetworkOptions(), **timing: Any) -> Animation:  # noqa: B008
    return animate(PICTURE, [BAR], timing=Timing(**(LOOP | timing)), networks=networks)


def frames(animation: Animation, **how: Any) -> Image:
    return np.stack([np.asarray(each, np.float32) for each in animation.frames(**how)])


def wrap(clip: Image) -> float:
    """The metric of loops: the jump from the last frame to the first, beyond that of the steps beside it."""
    told = LOOP_RESIDUAL.begin(SimpleNamespace(loops=True), SimpleNamespace())  # type: ignore[arg-type]
    for frame in clip:
        told.add(as_uint8(frame))
    return float(told.values()[LOOP_RESIDUAL.key] or 0)


class Drifting:
    """In the renderer's place: the composite's own frames, whose colours drift away until the loop begins again."""

    def __init__(self, clip: Image, monkeypatch: pytest.MonkeyPatch) -> None:
        self.clip, self.closes = clip / 255, list[bool]()
        told = self

        def drawn(self: object, image: Image, sketches: list[Image], *, loops: bool = False, **how: Any) -> Any:
            told.closes.append(loops)
            return told.frames(np.asarray(image, np.float32) / 255, len(sketches))

        monkeypatch.setattr(SVDRenderer, "frames", drawn)

    def frames(self, image: Image, count: int) -> Iterator[Image]:
        for number in range(count):
            frame = image if number == 0 else self.clip[number - 1]
            share = number / (count - 1)
            lab = rgb_to_lab(frame.astype(np.float32)) * (1 - np.float32([0.1, 0.2, 0.2]) * share)
            yield lab_to_rgb(lab.astype(np.float32) + np.float32(share) * np.float32([8, 5, -6]))


def test_a_drift_and_its_jump_at_the_wrap_go(drawing: NetworkOptions, monkeypatch: pytest.MonkeyPatch) -> None:
    composite = frames(looping())
    model = Drifting(composite, monkeypatch)
    free = replace(drawing, still_parts=False)
    drifted, matched, half = (frames(looping(replace(free, colour_match=share))) for share in (0, 1, 0.5))
    assert drifted.shape == matched.shape == composite.shape
    assert model.closes == [True] * 3
    assert wrap(drifted) > 0.02
    assert abs(wrap(matched) - wrap(composite / 255)) < 0.003
    errors = [np.abs(each - composite / 255).mean(axis=(1, 2, 3)).max() for each in (drifted, half, matched)]
    assert errors[0] > 1.6 * errors[1] > 4 * errors[2], "the worst frame"


def test_a_clip_that_is_right_stays_so(drawing: NetworkOptions, monkeypatch: pytest.MonkeyPatch) -> None:
    composite = frames(looping())
    model = Drifting(composite, monkeypatch)
    monkeypatch.setattr(model, "frames", lambda image, count: iter([image, *model.clip.astype(np.float32)]))
    np.testing.assert_allclose(frames(looping(replace(drawing, still_parts=False))), composite / 255, atol=1e-5)


@pytest.mark.parametrize(
    ("timing", "close", "closes"),
    [
        ({}, True, True),
        ({}, False, False),
        ({"skip": 3}, True, True),
        ({"frames": 24}, True, True),
        ({"frames": 15}, True, False),
        ({"loop": None, "frames": 12}, True, False),
    ],
)
def test_only_whole_loops_close(
    drawing: NetworkOptions, monkeypatch: pytest.MonkeyPatch, timing: dict[str, Any], close: bool, closes: bool
) -> None:
    model = Drifting(frames(looping(**timing)), monkeypatch)
    drawn = frames(looping(replace(drawing, close_loop=close), **timing))
    assert model.closes == [closes]
    assert len(drawn) == len(model.clip)


def test_real_networks_close_a_loop(drawing: NetworkOptions) -> None:
    closed, opened = (frames(looping(replace(drawing, close_loop=close))) for close in (True, False))
    assert closed.shape == opened.shape == (12, *PICTURE.shape)
    assert np.abs(closed[-1] - opened[-1]).max() > 1e-3


@pytest.mark.parametrize("how", [{"every": 5}, {"keyframes_at": [2, 7]}])
def test_in_betweens_close_a_loop(how: dict[str, Any]) -> None:
    whole = frames(looping())
    filled = frames(looping(), **how)
    assert filled.shape == whole.shape
    for t in how.get("keyframes_at", (0, 5, 10)):
        np.testing.assert_array_equal(filled[t], whole[t])
    assert np.abs(filled - whole).mean(axis=(1, 2, 3)).max() < 1, "along the motion, around the wrap as well"
    still = frames(looping(NetworkOptions(close_loop=False)), every=5)
    np.testing.assert_array_equal(still[-1], whole[-1])


@pytest.fixture
def filling(files: dict[str, Path], monkeypatch: pytest.MonkeyPatch) -> NetworkOptions:
    random_networks.small_sizes(monkeypatch)
    return NetworkOptions(
        interpolate_with="tooncrafter",
        tooncrafter=files["tooncrafter"],
        sketch_encoder=files["sketch_encoder"],
        tooncrafter_options=ToonCrafterOptions(steps=1, area=64 * 64, control_scale=2.0),
    )


def test_the_model_is_given_the_pair_of_last_and_first(
    filling: NetworkOptions, monkeypatch: pytest.MonkeyPatch
) -> None:
    pairs: list[tuple[int, int, float, float]] = []
    kept = ToonCrafterInterpolator.in_betweens

    def noting(self: ToonCrafterInterpolator, clip: Clip, number: int) -> Iterator[Image]:
        assert len(clip.sketches) == 13
        np.testing.assert_array_equal(clip.sketches[12], clip.sketches[0])
        pairs.append(
            (*clip.indices[number : number + 2], *(each.sum() for each in clip.keyframes[number : number + 2]))
        )
        return kept(self, clip, number)

    monkeypatch.setattr(ToonCrafterInterpolator, "in_betweens", noting)
    whole, filled = frames(looping()), frames(looping(filling), every=6)
    assert len(filled) == 12
    assert [pair[:2] for pair in pairs] == [(0, 6), (6, 12)]
    assert pairs[-1][2:] == (whole[6].sum(), whole[0].sum())
    np.testing.assert_array_equal(filled[[0, 6]], whole[[0, 6]])


def test_in_betweens_have_colours_between_those_of_their_keyframes(filling: NetworkOptions) -> None:
    """Random networks paint anything; what is left of it is where, not which colours."""
    animation = looping(filling)
    keyframe = frames(looping())[[0, 6]].mean(axis=(0, 1, 2))
    matched = frames(animation, every=6)[[3, 9]].mean(axis=(1, 2))
    free = frames(replace(animation, networks=replace(filling, colour_match=0)), every=6)[[3, 9]].mean(axis=(1, 2))
    assert np.abs(matched - keyframe).max() < np.abs(free - keyframe).max() / 2
