"""Soft inpainting as a command: from a mask to a video by a small random model; what is refused before the work."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import physanimator.rendering.pipeline
import pytest
from command_status import status
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.artwork import ArtLayer, Artwork
from physanimator.rendering.command.networks import _settings
from physanimator.rendering.inpainting import InpaintingOptions
from physanimator.rendering.neural import NetworkOptions
from physanimator.rendering.options import Timing
from physanimator.rendering.pictures import load_image, save_image
from physanimator.rendering.pipeline import animate

WIDTH, HEIGHT, FRAMES = 96, 72, 6
BAR = np.s_[10:58, 30:54]

Output = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("transformers")
    from random_inpainting import write_inpainting_folder

    return write_inpainting_folder(tmp_path_factory.mktemp("models") / "seeing", sees_holes=True)


@pytest.fixture(autouse=True)
def picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder, made the current one, with a picture of a dark bar and a mask of it."""
    monkeypatch.chdir(tmp_path)
    mask, image = np.zeros((HEIGHT, WIDTH), np.uint8), np.full((HEIGHT, WIDTH, 3), 220, np.uint8)
    mask[BAR], image[BAR] = 255, 40
    save_image("girl.png", image)
    save_image("hair.png", mask)


def animated(output: str, *more: str) -> int:
    moved = ("--mask", "hair.png", "--no-strands", "--wind", "6", "--frames", str(FRAMES), "--max-minutes", "60")
    return status("animate", "girl.png", *moved, *more, "-o", output)


def painting(model: Path, *more: str) -> tuple[str, ...]:
    settings = "prompt=girl, girls,steps=2,guidance=1,area=64x64"
    edges = ("--grow", "1", "--soft-edge", "4", "--device", "cpu")
    return ("--renderer", "inpainting", "--inpainting", str(model), "--inpainting-options", settings, *edges, *more)


def frames(folder: str) -> np.ndarray:
    return np.stack([load_image(path) for path in sorted(Path(folder).glob("*.png"))]).astype(int)


def test_holes_are_painted_and_all_else_is_the_composite(model: Path, capsys: Output) -> None:
    assert animated("usual/", "-q") == 0
    assert animated("painted/", *painting(model), "-v") == 0
    told = capsys.readouterr().err
    for words in ("check", "inpainting: 100%", f"{2 * FRAMES}/{2 * FRAMES}", "networks on cpu with at most"):
        assert words in told
    apart = np.abs(frames("painted") - frames("usual")).max(axis=-1)
    assert len(apart) == FRAMES
    assert not apart[0].any(), "nothing is uncovered at rest"
    assert (apart[-1] > 40).sum() > 20
    assert not apart[-1][:, :12].any()
    assert not apart[-1][:, -12:].any()


def test_a_video_of_keyframes_and_in_betweens(model: Path) -> None:
    """Keyframes are painted as in the whole clip, in-betweens follow them, and a video is opaque."""
    assert animated("whole/", *painting(model), "-q") == 0
    assert animated("some/", *painting(model), "--keyframes-at", "0,3", "--interpolate-with", "blend", "-q") == 0
    apart = np.abs(frames("some") - frames("whole")).reshape(FRAMES, -1).max(axis=1)
    assert [difference == 0 for difference in apart] == [True, False, False, True, True, True]
    assert animated("out.mp4", *painting(model), "-q") == 0
    assert Path("out.mp4").stat().st_size > 0


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--background", "parts", "-o", "o.webm"], "--renderer: frames that a model draws must be opaque"),
        (["--background", "transparent"], "--renderer: frames that a model draws must be opaque"),
        (["--pixel-art"], "--renderer: frames that a model draws must be opaque, and no pixel art. Got: pixel art"),
        (["--plate", "girl.png"], "--plate must be left out where --renderer is inpainting"),
        (["--still-parts"], "--still-parts needs --renderer svd. Got: without"),
        (["--svd-options", "steps=3"], "--svd-options needs --renderer svd. Got: without"),
        (["--svd", "a"], "--svd must be left out unless --renderer is svd. Got: a"),
        (["--soft-edge", "1001"], "--soft-edge must be a number from 0 to 1000 px. Got: 1001.0"),
        (["--grow", "-1"], "--grow must be a number from 0 to 1000 px. Got: -1.0"),
        (["--device", "tape"], "--device must be one that torch finds here"),
        (["--inpainting-options", "steps=0"], "--inpainting-options: steps must be"),
        (["--inpainting-options", "steps=2,strength=0.4"], "--inpainting-options: strength must be 0.5 to 1"),
        (["--inpainting-options", "shared_noise=maybe"], "--inpainting-options: shared_noise must be yes or no."),
        (["--inpainting-options", "prompt=girl,stepz=2"], "--inpainting-options: settings must be NAME=VALUE with"),
        (["--inpainting-options", "strength=all"], "--inpainting-options: strength must be a number. Got: 'all'"),
        (["--inpainting-options", "area=8x8"], "--inpainting-options: area must be"),
        (["--inpainting-options", "area=big"], "--inpainting-options: area must be a whole number. Got: 'big'"),
        (["--inpainting-options", "steps=1001"], "--inpainting-options: steps must be a whole number from 1 to 1000"),
        (["--inpainting-options", "steps=1000"], "--inpainting-options: steps must be 10 or less with this model."),
        (["--save-motion", "MODEL/unet/config.json"], "--save-motion must not be a file that is read."),
    ],
)
def test_what_cannot_be_is_refused_before_the_work(
    arguments: list[str], sentence: str, model: Path, monkeypatch: pytest.MonkeyPatch, capsys: Output
) -> None:
    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("simulated")

    monkeypatch.setattr(physanimator.rendering.pipeline, "simulate", refuse)
    if "10 or less" in sentence:
        model = trained_with(model, steps=10)
    before = (model / "unet" / "config.json").read_bytes()
    words = [word.replace("MODEL", str(model)) for word in arguments]
    assert animated("o/", "-q", *painting(model), *words) == 2
    told = capsys.readouterr().err
    assert sentence in told
    assert len(told.strip().splitlines()) == 1
    assert (model / "unet" / "config.json").read_bytes() == before


def trained_with(model: Path, *, steps: int) -> Path:
    """A copy of a model in whose schedule there are so many steps."""
    copied = Path(shutil.copytree(model, "copied"))
    schedule = copied / "scheduler" / "scheduler_config.json"
    schedule.write_text(json.dumps(json.loads(schedule.read_text()) | {"num_train_timesteps": steps}))
    return copied


def test_part_of_a_model_that_is_damaged_is_named(model: Path, capsys: Output) -> None:
    for part, file in (("unet", "config.json"), ("text_encoder", "model.safetensors"), ("scheduler", None)):
        copied = Path(shutil.copytree(model, f"without_{part}"))
        if file is None:
            shutil.rmtree(copied / part)
        else:
            (copied / part / file).write_text("<!doctype html>")
        assert animated("o/", "-q", *painting(Path(f"{copied}/"))) == 2
        told = capsys.readouterr().err
        assert told.count("--inpainting: ") == len(told.splitlines()) == 1
        assert part in told


def test_layers_are_refused_and_transparent_pictures_become_opaque(model: Path) -> None:
    networks = NetworkOptions(
        renderer="inpainting", inpainting=model, inpainting_options=InpaintingOptions(steps=1, guidance=1), device="cpu"
    )
    image = load_image("girl.png")
    pixels = np.dstack([image, np.full(image.shape[:2], 255, np.uint8)])
    layers = Artwork(WIDTH, HEIGHT, (ArtLayer("hair", pixels),))
    with pytest.raises(InvalidInputError, match=r"^image must be flat where renderer is inpainting, .* Got: layers"):
        animate(layers, networks=networks)
    pixels[:, :10, 3] = 0
    mask = np.zeros(image.shape[:2])
    mask[BAR] = 1
    animation = animate(pixels, [mask], strands=False, timing=Timing(frames=3, skip=1), networks=networks)
    drawn = list(animation.frames())
    assert [frame.shape for frame in drawn] == [(HEIGHT, WIDTH, 3)] * 2
    assert (drawn[-1][:, :10] == 1).all(), "white is behind a transparent picture"
    with pytest.raises(InvalidInputError, match="must be opaque"):
        animation.frames(transparent=True)


def test_texts_may_have_commas() -> None:
    said = _settings(
        InpaintingOptions(), "prompt=girl with long hair, clean lines , steps=7,shared_noise=no, area=none"
    )
    assert said == InpaintingOptions(prompt="girl with long hair, clean lines", steps=7, shared_noise=False)
    assert _settings(InpaintingOptions(), "area=512x320,negative_prompt=").area == 512 * 320
