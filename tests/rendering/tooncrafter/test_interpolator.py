"""In-betweens by small random networks: whole clips, from files to frames."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import random_tooncrafter as tiny
import torch
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.inbetweens import interpolate, keyframe_indices
from physanimator.rendering.networks.checkpoints import CheckpointError
from physanimator.rendering.networks.placement import Placement
from physanimator.rendering.tooncrafter import ToonCrafterOptions
from physanimator.rendering.tooncrafter.conditioning import Tokens
from physanimator.rendering.tooncrafter.gap_plan import clips_in, drawn_in_clip, inner_keyframes, sketched_in_clip
from physanimator.rendering.tooncrafter.interpolator import ToonCrafterInterpolator
from physanimator.rendering.tooncrafter.models import ToonCrafterModels, load_models

WIDTH, HEIGHT = 90, 70
QUICK: dict[str, Any] = {"steps": 1, "area": 64 * 64}


def pictures(count: int, *, dtype: Any = np.uint8) -> list[NDArray[Any]]:
    random = np.random.default_rng(3)
    found = random.random((count, HEIGHT, WIDTH, 3), dtype=np.float32)
    return list((found * 255).astype(np.uint8) if dtype == np.uint8 else found)


def sketches(count: int, *, seed: int = 4) -> list[NDArray[Any]]:
    random = np.random.default_rng(seed)
    return list((random.random((count, HEIGHT, WIDTH)) < 0.8).astype(np.float32))


def drawn(models: ToonCrafterModels, indices: list[int], **options: Any) -> list[NDArray[Any]]:
    given = options.pop("sketches", ())
    backend = ToonCrafterInterpolator(models, options=ToonCrafterOptions(**{**QUICK, **options}))
    return list(interpolate(pictures(len(indices)), indices, backend=backend, sketches=given))


@pytest.mark.parametrize("every", range(2, 17))
def test_every_gap_fills_and_keeps_its_keyframes(models: ToonCrafterModels, every: int) -> None:
    indices, keyframes = [0, every], pictures(2)
    frames = drawn(models, indices, guidance=1.0)
    assert len(frames) == every + 1
    assert all(frame.shape == (HEIGHT, WIDTH, 3) and frame.dtype == np.uint8 for frame in frames)
    for index, keyframe in zip(indices, keyframes, strict=True):
        np.testing.assert_array_equal(frames[index], keyframe)
    between = frames[1:-1]
    assert all(np.abs(a.astype(int) - b).max() > 0 for a, b in pairwise(between))


def test_irregular_keyframes_and_a_remainder(models: ToonCrafterModels) -> None:
    indices = [0, 3, 4, 11]
    for index, frame in zip(indices, pictures(4), strict=True):
        np.testing.assert_array_equal(drawn(models, indices, guidance=1.0)[index], frame)
    assert keyframe_indices(12, 5) == [0, 5, 10, 11]
    assert len(drawn(models, keyframe_indices(12, 5), guidance=1.0)) == 12


def test_one_and_two_frames_need_no_networks(models: ToonCrafterModels) -> None:
    backend = ToonCrafterInterpolator(models, watch=never)
    for count in (1, 2):
        given = pictures(count, dtype=np.float32)
        frames = list(interpolate(given, list(range(count)), backend=backend))
        np.testing.assert_array_equal(np.stack(frames), np.stack(given))


def test_frames_around_the_keyframes_stay_as_given(models: ToonCrafterModels) -> None:
    given, reports = pictures(9), []
    backend = ToonCrafterInterpolator(models, options=ToonCrafterOptions(**{**QUICK, "control_scale": 2.0}))
    frames = list(
        interpolate(
            [given[3], given[6]],
            [3, 6],
            backend=backend,
            sketches=sketches(9),
            before=given[:3],
            after=given[7:],
            progress=lambda *now: reports.append(now),
        )
    )
    assert reports[-1] == (9, 9)
    same = [bool((drawn == kept).all()) for drawn, kept in zip(frames, given, strict=True)]
    assert same == [True, True, True, True, False, False, True, True, True]


def never(_: Any) -> None:
    raise AssertionError("sampled")


def test_seeds(models: ToonCrafterModels) -> None:
    first, again, other = (np.stack(drawn(models, [0, 4, 8], seed=seed)) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first[1].astype(int) - other[1]).mean() > 1
    assert np.abs(first[1].astype(int) - first[5]).mean() > 1


def test_pairs_together_draw_what_they_draw_alone(models: ToonCrafterModels) -> None:
    given = sketches(13)
    alone, together = (np.stack(drawn(models, [0, 4, 8, 12], pairs_together=n, sketches=given)) for n in (1, 2))
    assert np.abs(alone.astype(int) - together).max() <= 1


def test_sketches_lead_as_far_as_the_scale_says(models: ToonCrafterModels) -> None:
    def change(scale: float) -> float:
        one, other = (drawn(models, [0, 4], control_scale=scale, sketches=sketches(5, seed=seed)) for seed in (4, 5))
        return float(np.abs(np.stack(one).astype(int) - np.stack(other)).mean())

    assert change(0) == 0
    assert 0 < change(0.1) < change(2)


def test_pictures_stay_in_their_place(models: ToonCrafterModels) -> None:
    """The frame that the networks work in adds margins; they are cut off, and nothing is turned or mirrored."""
    seen: list[torch.Tensor] = []

    def look(given: Any) -> Tokens:
        seen.extend(given)
        width = tiny.TINY.image_encoder.width
        return Tokens(torch.zeros(len(given), 5, width), torch.zeros(1, 5, width))

    backend = ToonCrafterInterpolator(models, options=ToonCrafterOptions(**QUICK), look=look)
    gradient = np.linspace(0, 1, WIDTH, dtype=np.float32)[None, :, None].repeat(HEIGHT, 0).repeat(3, 2)
    list(interpolate([gradient, gradient], [0, 2], backend=backend))
    row = seen[0][0, 32]
    assert seen[0].shape == (3, 64, 64)
    assert row[0] == pytest.approx(-1, abs=0.05)
    assert row[-1] == pytest.approx(1, abs=0.05)
    assert (row.diff() > -1e-3).all()


def test_progress_ends_at_its_total_and_cancels(models: ToonCrafterModels) -> None:
    reports: list[tuple[int, int]] = []

    def backend(progress: Callable[[int, int], None]) -> ToonCrafterInterpolator:
        options = ToonCrafterOptions(**{**QUICK, "steps": 2})
        return ToonCrafterInterpolator(models, options=options, progress=progress)

    list(interpolate(pictures(3), [0, 17, 19], backend=backend(lambda *now: reports.append(now))))
    assert reports == [(done, 8) for done in range(1, 9)]

    def cancel(done: int, _: int) -> None:
        if done == 3:
            raise KeyboardInterrupt

    frames = interpolate(pictures(3), [0, 4, 8], backend=backend(cancel))
    with pytest.raises(KeyboardInterrupt):
        list(frames)


def test_networks_leave_the_device_when_cancelled(models: ToonCrafterModels) -> None:
    asked: list[int] = []
    gone: list[bool] = []
    placement = Placement(torch.device("cpu"), make_room=asked.append, left=lambda: gone.append(True))

    def cancel(_: Any) -> None:
        raise KeyboardInterrupt

    options = ToonCrafterOptions(**QUICK)
    backend = ToonCrafterInterpolator(models, options=options, placement=placement, watch=cancel)
    with pytest.raises(KeyboardInterrupt):
        list(interpolate(pictures(2), [0, 4], backend=backend))
    assert len(asked) == len(gone) == 4
    assert min(asked) > 0


def test_half_precision_from_the_pruned_file(pruned_file: Path, weights: Any, tmp_path: Path) -> None:
    picture = tiny.write_image_encoder(tmp_path / "vision.safetensors", weights)
    text = tiny.write_text_encoder(tmp_path / "text.safetensors", weights)
    given = {"image_encoder": picture, "text_encoder": text, "sizes": tiny.TINY}
    whole, half = (
        np.stack(drawn(load_models(pruned_file, dtype=dtype, **given), [0, 4])).astype(int)
        for dtype in (torch.float32, torch.bfloat16)
    )
    assert 0 < np.abs(whole - half).mean() < 8


def test_missing_encoders_and_sketch_models_are_named(pruned_file: Path, weights: Any, tmp_path: Path) -> None:
    with pytest.raises(CheckpointError, match=r"No picture encoder.*ViT-H"):
        drawn(load_models(pruned_file, sizes=tiny.TINY), [0, 4])
    picture = tiny.write_image_encoder(tmp_path / "vision.safetensors", weights)
    models = load_models(pruned_file, image_encoder=picture, sizes=tiny.TINY)
    with pytest.raises(CheckpointError, match=r"No text encoder.*Stable Diffusion 2\.1"):
        drawn(models, [0, 4])
    with pytest.raises(CheckpointError, match=r"sketch_encoder\.ckpt"):
        drawn(models, [0, 4], sketches=sketches(5))


def test_sketches_must_fit(models: ToonCrafterModels) -> None:
    with pytest.raises(InvalidInputError, match=r"sketches must be one for each of the 5 frames"):
        drawn(models, [0, 4], sketches=sketches(4))
    with pytest.raises(InvalidInputError, match=r"sketches must be of the keyframes' size, 90 x 70 px"):
        drawn(models, [0, 4], sketches=[each[:9] for each in sketches(5)])


def test_gaps_are_planned_so_that_times_stay_even() -> None:
    assert inner_keyframes(15, 15) == []
    assert inner_keyframes(30, 15) == [15]
    assert inner_keyframes(16, 15) == [8]
    assert [drawn_in_clip(frame, 5, 15) for frame in range(1, 5)] == [3, 6, 9, 12]
    assert [drawn_in_clip(frame, 15, 15) for frame in range(1, 15)] == list(range(1, 15))
    assert sketched_in_clip(15, 15) == list(range(16))
    assert sketched_in_clip(3, 15) == [0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3]
    assert [clips_in(gap, 15) for gap in (1, 2, 15, 16, 30, 45)] == [0, 1, 1, 3, 3, 4]
    for gap in range(2, 16):
        for frame in range(1, gap):
            assert sketched_in_clip(gap, 15)[drawn_in_clip(frame, gap, 15)] == frame
