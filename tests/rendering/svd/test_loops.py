"""Clips whose last frame leads to the first again."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
import torch
from physanimator.rendering.svd import CLIP_FRAMES, FrameLayout, SVDOptions
from physanimator.rendering.svd.decoding import around_the_wrap
from physanimator.rendering.svd.dual_clock import DualClock
from physanimator.rendering.svd.loop_segments import plan_loop
from physanimator.rendering.svd.models import SVDModels
from physanimator.rendering.svd.noise_schedule import noise_levels
from physanimator.rendering.svd.renderer import SVDRenderer
from physanimator.rendering.svd.sampler import LATENT_SCALE, SampledStep, sample_clip
from physanimator.rendering.svd.segments import Segment
from torch import Tensor

LENGTHS = [*range(2, 41), 97]


@pytest.mark.parametrize("cycle", LENGTHS)
@pytest.mark.parametrize("overlap", [3, 4, 6, 7, 13])
@pytest.mark.parametrize("plain", [False, True])
def test_every_frame_is_made_once_from_its_own_sketch(cycle: int, overlap: int, plain: bool) -> None:
    segments = plan_loop(cycle + 1, overlap, plain=plain)
    made = [segment.sketches[slot] for segment in segments for slot in segment.made]
    assert made == list(range(1, cycle + 1))
    for segment in segments:
        sizes = {len(segment.sketches), len(segment.noise), segment.layout.count}
        assert sizes == {segment.layout.count}
        assert segment.layout.count - segment.layout.references <= CLIP_FRAMES
        assert max(segment.sketches) <= cycle
        keys = [key for run in segment.layout.runs for key in (*run.own, *run.reference)]
        assert 0 <= min(keys) <= max(keys) < segment.layout.count


def frame_of(segments: tuple[Segment, ...], slot: int) -> int:
    """The frame of a slot that the closing segment takes from the one before, or counted on, from the first."""
    before = segments[-2]
    return (*before.sketches, *segments[0].sketches)[slot]


@pytest.mark.parametrize("cycle", LENGTHS)
def test_the_clip_of_the_last_segment_ends_with_the_first_frames(cycle: int) -> None:
    segments = plan_loop(cycle + 1)
    closing = segments[-1]
    clip = closing.sketches[closing.layout.references :]
    begin = clip[0]
    assert list(clip) == [1 + (begin - 1 + number) % cycle for number in range(len(clip))], "one frame after the other"
    assert clip[-closing.closes :] == tuple(range(1, 1 + closing.closes))
    assert [frame_of(segments, slot) for slot in closing.carried] == list(
        closing.sketches[1 : closing.layout.references]
    ), "references are conditioned on the frames whose sketches they have"
    held = [closing.sketches[slot] for slot in closing.held]
    assert [frame_of(segments, slot) for slot in closing.blended] == held
    assert sorted((*closing.held, *closing.made)) == list(range(closing.layout.references, closing.layout.count))
    assert len(clip) == min(CLIP_FRAMES, cycle + closing.closes)


@pytest.mark.parametrize("cycle", LENGTHS)
def test_plain_segments_close_as_well(cycle: int) -> None:
    segments = plan_loop(cycle + 1, plain=True)
    closing = segments[-1]
    assert closing.layout.references == 0
    assert closing.conditioned_on == closing.blended[0]
    assert frame_of(segments, closing.blended[0]) == closing.sketches[0]
    held = [closing.sketches[slot] for slot in closing.held]
    assert [frame_of(segments, slot) for slot in closing.blended] == held
    assert closing.sketches == tuple(
        1 + (closing.sketches[0] - 1 + slot) % cycle for slot in range(len(held) + len(closing.made))
    )
    noise = [(*segments[-2].noise, *segments[0].noise)[slot] for slot in closing.blended]
    assert noise == [closing.noise[slot] for slot in closing.held]


@pytest.mark.parametrize("plain", [False, True])
@pytest.mark.parametrize("cycle", [5, 12, 20, 27])
def test_a_loop_that_follows_an_animation_holds_its_first_frames_too(cycle: int, plain: bool) -> None:
    """Also while latents of the animation are put back: noise and level are those of the first segment."""
    steps, networks, weak = 6, Recorder(), 1
    generator = torch.Generator().manual_seed(1)
    latents = torch.randn(cycle + 1, 4, 2, 2, generator=generator)
    moves = torch.rand(cycle + 1, 1, 2, 2, generator=generator) > 0.5
    segments = plan_loop(cycle + 1, plain=plain)
    noise = torch.randn(segments[0].layout.count, 4, 2, 2, generator=generator)
    sketches = torch.zeros(cycle + 1, 3, 8, 8)
    sample_clip(
        networks,
        torch.full((1, 4, 2, 2), 0.5),
        sketches,
        noise,
        sigmas=noise_levels(steps),
        segments=segments,
        clock=DualClock(latents, moves, weak, 4),
    )
    shared, start, done = segments[-1].closes, segments[0].made[0], steps - weak
    for step in range(done):
        began, ends = networks.given[step][0], networks.given[step - done][0]
        assert torch.equal(ends[-shared:], began[start : start + shared])


@pytest.mark.parametrize("cycle", LENGTHS)
def test_surplus_frames_go_on_into_the_loop_instead_of_standing_still(cycle: int) -> None:
    before = plan_loop(cycle + 1)[-2]
    clip = before.sketches[before.layout.references :]
    assert all(1 + one % cycle == other for one, other in itertools.pairwise(clip))


class Recorder:
    """A predictor that mixes neighbours, and knows what it was given."""

    def __init__(self) -> None:
        self.given: list[tuple[Tensor, Tensor, FrameLayout]] = []

    def __call__(self, x: Tensor, condition: Tensor, sketches: Tensor, level: Tensor, layout: FrameLayout) -> Tensor:
        self.given.append((x.clone(), condition.clone(), layout))
        return torch.tanh(x + x.roll(1, 0) + condition + sketches.mean((1, 2, 3), keepdim=True))


@pytest.mark.parametrize("cycle", [2, 3, 5, 10, 12, 14, 20, 27])
def test_the_networks_are_given_the_first_frames_where_the_last_ones_end(cycle: int) -> None:
    """What goes in as the first frame is what comes out after the last: conditions, and latents in every step."""
    steps, networks = 4, Recorder()
    sketches = (torch.arange(cycle + 1) / cycle)[:, None, None, None].expand(-1, 3, 8, 8)
    noise = torch.randn(19, 4, 2, 2, generator=torch.Generator().manual_seed(1))
    seen: list[SampledStep] = []
    first = torch.full((1, 4, 2, 2), 0.5)
    got = sample_clip(networks, first, sketches, noise, sigmas=noise_levels(steps), loops=True, watch=seen.append)
    assert len(got) == cycle + 1
    segments = plan_loop(cycle + 1)
    closing = segments[-1]
    shared = closing.closes
    opening, last = networks.given[0], networks.given[-steps]
    start = opening[2].references
    for step in range(steps):
        began, ends = networks.given[step][0], networks.given[step - steps][0]
        assert torch.equal(ends[-shared:], began[start : start + shared]), "the latents of the step"
    np.testing.assert_allclose(last[1][1 + shared : 1 + 2 * shared], got[1 : 1 + shared] / LATENT_SCALE, rtol=1e-6)
    before = got[cycle - len(closing.made) - shared + 1 : cycle - len(closing.made) + 1]
    np.testing.assert_allclose(last[1][1 : 1 + shared], before / LATENT_SCALE, rtol=1e-6)
    assert seen[-1].done == seen[-1].total == steps * len(segments)


OPTIONS = SVDOptions(steps=2, area=64 * 64, seed=3)


def sketches(count: int) -> list[np.ndarray]:
    drawn = [np.ones((60, 70), np.float32) for _ in range(count)]
    for number, sketch in enumerate(drawn):
        sketch[:, 10 + 2 * number : 13 + 2 * number] = 0
    return drawn


@pytest.mark.parametrize("cycle", [2, 15])
def test_a_loop_has_as_many_frames_as_sketches(models: SVDModels, cycle: int) -> None:
    done: list[tuple[int, int]] = []
    renderer = SVDRenderer(models, options=replace(OPTIONS, decoded_together=6))
    given = np.full((60, 70, 3), 0.5, np.float32)
    report = done.append
    frames = list(renderer.frames(given, sketches(cycle + 1), loops=True, progress=lambda *now: report(now)))
    open_clip = list(renderer.frames(given, sketches(cycle + 1)))
    assert [frame.shape for frame in frames] == [(60, 70, 3)] * (cycle + 1)
    assert done == [(number, done[-1][1]) for number in range(1, done[-1][1] + 1)]
    assert np.abs(frames[-1] - open_clip[-1]).max() > 1e-3, "the end knows of the beginning"


def test_neighbours_are_decoded_around_the_wrap() -> None:
    assert around_the_wrap(7) == [0, 4, 5, 6, 1, 2, 3, 4, 5, 6, 1, 2, 3]
    assert around_the_wrap(3) == [0, 1, 2, 1, 2, 1, 2]
