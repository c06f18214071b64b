"""Networks in the library: what may be said of them, and frames by small random ones."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import random_networks
import torch
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.animation import Animation
from physanimator.rendering.networks.checkpoints import CheckpointError
from physanimator.rendering.neural import NetworkOptions, line_drawing
from physanimator.rendering.neural import drawing as neural_drawing
from physanimator.rendering.neural.checking import check_networks
from physanimator.rendering.neural.devices import device_of, dtype_of
from physanimator.rendering.options import Timing, Watch
from physanimator.rendering.pipeline import animate
from physanimator.rendering.segmentation import Prompt
from physanimator.rendering.segmentation.sam.segmenter import SamSegmenter
from physanimator.rendering.sketch import extract_sketch
from physanimator.rendering.svd import SVDOptions
from physanimator.rendering.tooncrafter import ToonCrafterOptions

WIDTH, HEIGHT = 96, 72
BAR = np.pad(np.ones((48, 24)), ((10, 14), (30, 42)))
PICTURE = np.where(BAR[..., None] > 0, 40, 220).repeat(3, axis=2).astype(np.uint8)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return random_networks.write(tmp_path_factory.mktemp("weights"), "folder")


@pytest.fixture
def drawing(files: dict[str, Path]) -> NetworkOptions:
    options = SVDOptions(steps=2, area=64 * 64)
    return NetworkOptions(renderer="svd", svd=files["svd"], lvcd=files["lvcd"], svd_options=options, soft_edge=2)


@pytest.fixture
def filling(files: dict[str, Path], monkeypatch: pytest.MonkeyPatch) -> NetworkOptions:
    random_networks.small_sizes(monkeypatch)
    options = ToonCrafterOptions(steps=1, area=64 * 64, control_scale=2.0)
    return NetworkOptions(
        interpolate_with="tooncrafter",
        tooncrafter=files["tooncrafter"],
        sketch_encoder=files["sketch_encoder"],
        tooncrafter_options=options,
    )


def moving(networks: NetworkOptions, **timing: Any) -> Animation:
    return animate(PICTURE, [BAR], timing=Timing(**timing), networks=networks)


def frames(animation: Animation, **how: Any) -> NDArray[Any]:
    return np.stack([np.asarray(each, np.float64) for each in animation.frames(**how)])


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ({"renderer": "oil"}, "renderer must be one of composite, svd, inpainting. Got: 'oil'"),
        ({"interpolate_with": "film"}, "interpolate_with must be one of motion, flow, blend, tooncrafter. Got: 'film'"),
        ({"extractor": None}, "extractor must be one of gaussians, informative. Got: None"),
        ({"segmenter": 1}, "segmenter must be one of grabcut, sam. Got: 1"),
        (
            {"renderer": "svd", "svd": "a"},
            "lvcd must be a file where renderer is svd, unless svd_options have follow=animation. Got: none",
        ),
        ({"sam": "a"}, "sam must be left out unless segmenter is sam. Got: a"),
        ({"renderer": "svd", "svd": 3, "lvcd": "a"}, "svd must be the path of a file. Got: int"),
        ({"dtype": "fp8"}, "dtype must be one of auto, fp32, fp16, bf16. Got: 'fp8'"),
        ({"soft_edge": -1}, "soft_edge must be a number from 0 to 10000 px. Got: -1"),
        ({"lines_size": 3}, "lines_size must be"),
    ],
)
def test_what_does_not_go_together_is_refused(said: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InvalidInputError) as refused:
        NetworkOptions(**said)
    assert str(refused.value).startswith(sentence)


def test_options_are_frozen() -> None:
    with pytest.raises(FrozenInstanceError):
        NetworkOptions().renderer = "svd"  # type: ignore[misc]


def test_devices_and_types() -> None:
    assert dtype_of("auto", torch.device("cpu")) == torch.float32
    assert dtype_of("auto", torch.device("cuda")) == torch.float16
    assert device_of("cpu") == torch.device("cpu")
    with pytest.raises(InvalidInputError, match=r"^device must be one that torch finds here"):
        check_networks(NetworkOptions(extractor="informative", lines="absent", device="tape"))


def test_every_frame_is_the_video_models_but_for_still_parts(drawing: NetworkOptions) -> None:
    kept = frames(moving(drawing, frames=4))
    free = frames(moving(replace(drawing, still_parts=False), frames=4))
    assert kept.shape == free.shape == (4, HEIGHT, WIDTH, 3)
    np.testing.assert_allclose(kept[:, :, :12], 220 / 255, atol=1e-6)
    assert np.abs(free[:, :, :12] - 220 / 255).mean() > 0.1
    inside = np.s_[:, 20:40, 36:48]
    np.testing.assert_allclose(kept[inside], free[inside], atol=1e-6)


@pytest.mark.parametrize(
    ("timing", "shown"), [({"frames": 4}, 4), ({"frames": 5, "skip": 2}, 3), ({"frames": 3, "skip": 2}, 1)]
)
def test_the_illustration_s_own_sketch_comes_first(
    drawing: NetworkOptions, timing: dict[str, int], shown: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where the clip does not begin at rest; the frame that shows the illustration then is not among its own."""
    rest = extract_sketch(PICTURE)
    given = led_by(monkeypatch)
    drawn = frames(moving(drawing, **timing))
    assert len(given) == shown + ("skip" in timing)
    assert np.abs(given[0] / 255 - cv2.GaussianBlur(rest, (0, 0), 0.8)).max() < 0.02
    first = "skip" in timing
    np.testing.assert_array_equal(drawn[:, 0, 0, 0], range(first, first + shown))


def test_a_loop_is_led_by_the_illustration_as_well(drawing: NetworkOptions, monkeypatch: pytest.MonkeyPatch) -> None:
    given = led_by(monkeypatch)
    drawn = frames(moving(drawing, loop=0.25))
    assert len(given) == len(drawn) + 1 == 7
    assert np.abs(given[0] / 255 - cv2.GaussianBlur(extract_sketch(PICTURE), (0, 0), 0.8)).max() < 0.02
    assert np.abs(given[1].astype(float) - given[0]).mean() > 0.5, "frame 0 of a loop has moved"


@pytest.fixture
def repainting(files: dict[str, Path]) -> NetworkOptions:
    options = replace(SVDOptions.following("animation"), steps=3, area=64 * 64)
    return NetworkOptions(renderer="svd", svd=files["svd"], svd_options=options, soft_edge=2)


@pytest.mark.parametrize(("timing", "before"), [({"frames": 4}, 0), ({"frames": 5, "skip": 2}, 1), ({"loop": 0.25}, 1)])
def test_the_animation_that_leads_is_composite_s_and_begins_with_the_illustration(
    repainting: NetworkOptions, timing: dict[str, Any], before: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    led: list[Any] = []

    def draw(models: object, image: object, sketches: list[Any], *, animation: Any, **how: object) -> Any:
        assert sketches == []
        led.append(animation)
        return (np.full((HEIGHT, WIDTH, 3), float(number)) for number in range(animation.count))

    monkeypatch.setattr(neural_drawing, "sketch_guided_frames", draw)
    monkeypatch.setattr(line_drawing, "line_extractor", lambda options: pytest.fail("no lines are needed"))
    drawn = frames(moving(repainting, **timing))
    composed = frames(moving(NetworkOptions(), **timing))
    (animation,) = led
    assert animation.count == len(composed) + before
    np.testing.assert_array_equal(drawn[:, 0, 0, 0], range(before, before + len(composed)))
    np.testing.assert_array_equal(animation.at(0)[0], PICTURE)
    assert (animation.at(0)[1][BAR > 0] > 0.9).mean() > 0.95
    for number, composite in enumerate(composed, start=before):
        picture, coverage = animation.at(number)
        np.testing.assert_array_equal(picture, composite)
        dark = composite.max(axis=2) < 60
        assert coverage[dark].min() > 0.5, "the mask moves along"


def test_the_video_model_alone_repaints_the_animation(repainting: NetworkOptions) -> None:
    led = frames(moving(repainting, frames=4))
    assert led.shape == (4, HEIGHT, WIDTH, 3)
    np.testing.assert_allclose(led[:, :, :12], 220 / 255, atol=1e-6)
    free = replace(repainting, svd_options=replace(repainting.svd_options, strong=1.0))
    assert np.abs(frames(moving(free, frames=4)) - led).max() > 1e-3


def led_by(monkeypatch: pytest.MonkeyPatch) -> list[NDArray[Any]]:
    """The sketches that a video model is given, which draws frames that are their own number."""
    given: list[NDArray[Any]] = []

    def draw(models: object, image: object, sketches: list[NDArray[Any]], **how: object) -> Any:
        given.extend(sketches)
        return (np.full((HEIGHT, WIDTH, 3), float(number)) for number in range(len(sketches)))

    monkeypatch.setattr(neural_drawing, "sketch_guided_frames", draw)
    return given


def test_keyframes_are_those_of_the_whole_clip(drawing: NetworkOptions, files: dict[str, Path]) -> None:
    animation = moving(replace(drawing, interpolate_with="blend"), frames=6)
    whole, some = frames(animation), frames(animation, keyframes_at=[1, 4])
    np.testing.assert_array_equal(some[[0, 1, 4, 5]], whole[[0, 1, 4, 5]])
    np.testing.assert_allclose(some[2], (2 * whole[1] + whole[4]) / 3, atol=1e-6)


@pytest.mark.parametrize("kind", ["folder", "single"])
def test_parts_are_cut_by_segment_anything(kind: str, tmp_path: Path) -> None:
    sam = random_networks.write(tmp_path, kind)["sam"]
    cut: list[NDArray[Any]] = []
    watch, points = Watch(on_cut=cut.extend), "42,30,1\n80,60,0\n"
    animate(
        PICTURE,
        points=[points],
        strands=False,
        timing=Timing(frames=1),
        watch=watch,
        networks=NetworkOptions(segmenter="sam", sam=sam),
    )
    (expected,), _ = SamSegmenter.load(sam).segment(PICTURE, [Prompt([(42, 30), (80, 60)], [1, 0])])
    np.testing.assert_array_equal(cut, [expected])
    assert 0.1 < expected.mean() < 0.9


def test_sketches_lead_the_in_betweens(filling: NetworkOptions) -> None:
    led = frames(moving(filling, frames=5), every=4)
    alone = frames(moving(replace(filling, sketch_encoder=None), frames=5), every=4)
    np.testing.assert_array_equal(led[[0, 4]], alone[[0, 4]])
    np.testing.assert_array_equal(led[0], PICTURE)
    assert np.abs(led[1:4] - alone[1:4]).mean() > 1


def test_progress_counts_the_steps_and_ends_the_work(drawing: NetworkOptions, tmp_path: Path) -> None:
    animation = moving(drawing, frames=4)
    heard: list[tuple[str, int, int]] = []
    list(animation.frames(progress=lambda *now: heard.append(now)))
    assert [now for now in heard if now[0] == "svd"] == [("svd", done, 3) for done in (1, 2, 3)]
    assert [now for now in heard if now[0] == "render"] == [("render", done, 4) for done in (1, 2, 3, 4)]

    def cancel(stage: str, done: int, total: int) -> None:
        if (stage, done) == ("svd", 1):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animation.save(tmp_path / "out.mp4", progress=cancel)
    assert list(tmp_path.iterdir()) == []


def test_frames_of_a_video_model_are_opaque(drawing: NetworkOptions, tmp_path: Path) -> None:
    animation = moving(drawing, frames=2)
    for background in ("transparent", "parts"):
        with pytest.raises(InvalidInputError, match="must be opaque"):
            animation.save(tmp_path / "out.webm", background=background)
    with pytest.raises(InvalidInputError, match=r"no pixel art. Got: pixel art"):
        animate(PICTURE, [BAR], pixel_art=True, networks=drawing)
    see_through = np.dstack([PICTURE, np.full((HEIGHT, WIDTH), 128, np.uint8)])
    drawn = animate(see_through, [BAR], timing=Timing(frames=2), networks=drawing)
    assert next(drawn.frames()).shape == (HEIGHT, WIDTH, 3)


def test_files_are_checked_before_anything_is_done(
    drawing: NetworkOptions, files: dict[str, Path], tmp_path: Path
) -> None:
    """Also those that are read last, and those that are swapped."""
    swapped = replace(drawing, svd=files["lvcd"], lvcd=files["lvcd"])
    with pytest.raises(CheckpointError, match=r"^svd: .*lvcd.ckpt does not fit: nothing in it is called"):
        animate(PICTURE, [np.zeros((HEIGHT, WIDTH))], networks=swapped)
    (tmp_path / "model.ckpt").write_bytes(b"<!doctype html>")
    with pytest.raises(CheckpointError, match=r"^tooncrafter: .*model.ckpt cannot be read; it is a web page"):
        check_networks(NetworkOptions(interpolate_with="tooncrafter", tooncrafter=tmp_path / "model.ckpt"))


def test_a_pruned_file_needs_its_encoders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    random_networks.small_sizes(monkeypatch)
    pruned = random_networks.write(tmp_path, "single")
    options = NetworkOptions(interpolate_with="tooncrafter", tooncrafter=pruned["tooncrafter"])
    with pytest.raises(CheckpointError, match=r"^image_encoder must be a file where tooncrafter is pruned"):
        check_networks(options)
    options = replace(options, image_encoder=pruned["image_encoder"])
    with pytest.raises(CheckpointError, match=r"^text_encoder must be a file where tooncrafter is pruned"):
        check_networks(options)
    check_networks(replace(options, text_encoder=pruned["text_encoder"]))
    check_networks(options)  # the embedding of no words has been kept
