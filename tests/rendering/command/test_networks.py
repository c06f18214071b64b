"""The paper's way as a command: from points to a video by small random networks; what is refused before the work."""

from __future__ import annotations

import pickle
import re
from dataclasses import fields
from pathlib import Path

import av
import numpy as np
import physanimator.rendering.pipeline
import pytest
import random_networks
from command_status import status
from physanimator.rendering.command import network_options
from physanimator.rendering.inpainting import InpaintingOptions
from physanimator.rendering.neural import options
from physanimator.rendering.pictures import save_image
from physanimator.rendering.svd import SVDOptions
from physanimator.rendering.tooncrafter import ToonCrafterOptions
from random_networks import FORMATS, small_sizes

WIDTH, HEIGHT = 96, 72
QUICK = ("--svd-options", "steps=2,area=64x64", "--device", "cpu")
FILLED = ("--tooncrafter-options", "steps=1,area=4096,solver=dpm++ 2m", "--interpolate", "3")

Output = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder, made the current one, with a picture, points on its dark bar, and a mask of it."""
    monkeypatch.chdir(tmp_path)
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    mask[10:58, 30:54] = 255
    save_image("girl.png", np.where(mask[..., None] > 0, 40, 220).repeat(3, axis=2).astype(np.uint8))
    save_image("hair.png", mask)
    Path("hair.txt").write_text("42,30,1\n80,60,0\n", encoding="utf-8")
    return tmp_path


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, Path]]:
    folder = tmp_path_factory.mktemp("weights")
    return {kind: random_networks.write(folder / kind, kind) for kind in FORMATS}


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    small_sizes(monkeypatch)


@pytest.fixture
def unsimulated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Simulating is an error."""

    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("simulated")

    monkeypatch.setattr(physanimator.rendering.pipeline, "simulate", refuse)


def test_the_options_are_those_of_the_library() -> None:
    """They are written down once more for the help text, which may not cost the import of the networks' rooms."""
    assert network_options.CHOICES == options.CHOICES
    assert network_options.DTYPES == options.DTYPES
    for told, usual in (
        (network_options.SVD_SETTINGS, SVDOptions()),
        (network_options.INPAINTING_SETTINGS, InpaintingOptions()),
        (network_options.TOONCRAFTER_SETTINGS, ToonCrafterOptions()),
    ):
        assert told == ", ".join(f"{each.name}={getattr(usual, each.name)}" for each in fields(usual))


def given(files: dict[str, Path], *names: str) -> list[str]:
    return [word for name in names if name in files for word in (f"--{name.replace('_', '-')}", str(files[name]))]


def shown(path: str) -> np.ndarray:
    with av.open(path) as container:
        return np.stack([frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]).astype(int)


@pytest.mark.parametrize("kind", FORMATS)
def test_from_points_to_a_video(kind: str, files: dict[str, dict[str, Path]], small: None, capsys: Output) -> None:
    ours = files[kind]
    chosen = ["--renderer", "svd", "--interpolate-with", "tooncrafter", "--extractor", "informative"]
    weights = given(ours, *(name for name in ours if name != "sam"))
    assert (
        status("animate", "girl.png", "--points", "hair.txt", *chosen, *weights, *QUICK, *FILLED, "--frames", "6",
               "--soft-edge", "2", "-v", "-o", "out.mp4") == 0
    )  # fmt: skip
    frames = shown("out.mp4")
    assert frames.shape == (6, HEIGHT, WIDTH, 3)
    beside, inside = frames[:, :, :12], frames[:, 14:54, 34:50]
    assert np.abs(beside[[0, 3, 5]] - 220).max() < 12, "in keyframes, what no part ever covers is the illustration"
    assert np.abs(beside[[1, 2, 4]] - 220).mean(axis=(1, 2, 3)).min() > 13, "all of an in-between is drawn"
    assert np.abs(inside - 40).mean() > 20, "random weights draw something else than the illustration has there"
    told = capsys.readouterr().err
    for stage in ("check", "svd", "tooncrafter", "networks on cpu with at most"):
        assert stage in told


@pytest.mark.parametrize("kind", FORMATS)
def test_segment_anything_cuts_at_points(kind: str, files: dict[str, dict[str, Path]], capsys: Output) -> None:
    usual = ["animate", "girl.png", "--points", "hair.txt", "--no-strands", "--frames", "2", "-v", "-o", "out.mp4"]
    told = []
    for segmenter in ([], ["--segmenter", "sam", *given(files[kind], "sam")]):
        assert status(*usual, *segmenter) == 0
        said = capsys.readouterr().err
        assert "Loading weights" not in said
        told.append(re.findall(r"part 1: \d+ vertices", said))
    assert told[0] != told[1]


def test_sketches_by_the_network_are_written(files: dict[str, dict[str, Path]]) -> None:
    usual = ["animate", "girl.png", "--mask", "hair.png", "--frames", "2", "-q", "-o", "out.mp4"]
    assert status(*usual, "--save-sketch", "usual.mp4") == 0
    network = ["--extractor", "informative", *given(files["folder"], "lines"), "--lines-size", "48"]
    assert status(*usual, *network, "--save-sketch", "drawn.mp4") == 0
    assert np.abs(shown("usual.mp4") - shown("drawn.mp4")).mean() > 1


def test_keyframes_may_be_listed_and_frames_around_them_are_drawn() -> None:
    usual = ["animate", "girl.png", "--mask", "hair.png", "--frames", "9", "--wind", "3", "-q"]
    assert status(*usual, "-o", "all/") == 0
    assert status(*usual, "--keyframes-at", "3, 6", "--interpolate-with", "blend", "-o", "some/") == 0

    def frame(folder: str, number: int) -> bytes:
        return (Path(folder) / f"frame_{number:04d}.png").read_bytes()

    assert len(list(Path("some").glob("*.png"))) == 9
    same = [frame("all", number) == frame("some", number) for number in range(9)]
    assert same == [True, True, True, True, False, False, True, True, True]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--renderer", "svd"], "--svd must be a file where --renderer is svd. Got: none"),
        (
            ["--renderer", "svd", "--svd", "absent"],
            "--lvcd must be a file where --renderer is svd, unless --svd-options have follow=animation. Got: none",
        ),
        (
            ["--renderer", "svd", "--svd", "absent", "--lvcd", "no", "--svd-options", "follow=animation"],
            "--lvcd must be left out where --renderer is svd and --svd-options have follow=animation. Got: no",
        ),
        (
            ["--renderer", "svd", "--svd", "absent", "--svd-options", "follow=film"],
            "--svd-options: follow must be one of sketches, animation, both. Got: 'film'",
        ),
        (
            ["--renderer", "svd", "--svd", "absent", "--svd-options", "weak=0.2"],
            "--svd-options: weak must be left out unless follow is animation or both. Got: 0.2",
        ),
        (
            ["--renderer", "svd", "--svd", "absent", "--svd-options", "follow=animation,strong=0.2"],
            "--svd-options: strong must be weak, which is 0.32, or more. Got: 0.2",
        ),
        (
            ["--renderer", "svd", "--svd", "absent", "--svd-options", "follow=animation", "--extractor", "informative",
             "--lines", "no.pth"],
            "--extractor informative needs --save-sketch, --renderer svd or --sketch-encoder, for which it draws.",
        ),
        (["--svd", "absent"], "--svd must be left out unless --renderer is svd. Got: absent"),
        (["--sketch-encoder", "a"], "--sketch-encoder must be left out unless --interpolate-with is tooncrafter."),
        (["--renderer", "svd", "--svd", "absent", "--lvcd", "no"], "--svd: absent does not exist. Wanted: Stable"),
        (["--renderer", "svd", "--svd", "girl.png", "--lvcd", "no"], "--svd: girl.png cannot be read; it is"),
        (["--renderer", "oil"], "--renderer must be one of"),
        (["--extractor", "informative", "--lines", "no.pth", "--save-sketch", "s.mp4"], "--lines: no.pth does not"),
        (["--extractor", "informative", "--lines", "no.pth"], "--extractor informative needs --save-sketch, "),
        (["--segmenter", "sam", "--sam", "no.pth"], "--segmenter sam needs --points"),
        (["--points", "hair.txt", "--segmenter", "sam", "--sam", "no.pth"], "--sam: no.pth does not exist. SAM: put"),
        (["--points", "hair.txt", "--segmenter", "sam"], "--sam must be a file where --segmenter is sam. Got: none"),
        (["--interpolate-with", "flow"], "--interpolate-with needs --interpolate N or --keyframes-at"),
        (["--interpolate", "3", "--interpolate-with", "tooncrafter"], "--tooncrafter must be a file where"),
        (["--interpolate", "3", "--keyframes-at", "0,2"], "--keyframes-at and --interpolate say the same"),
        (["--keyframes-at", "0,one"], "--keyframes-at must be frame numbers from 0 with commas between them"),
        (["--keyframes-at", ""], "--keyframes-at must be frame numbers from 0"),
        (["--keyframes-at", "0,3"], "--keyframes-at must be frame numbers from 0 to 2. Got: [0, 3]"),
        (["--keyframes-at", "1", "--pixel-art"], "frames of pixel art must be drawn one by one"),
        (["--keyframes-at", "1", "--background", "parts", "-o", "o.webm"], "transparent frames must be drawn one by"),
        (["--svd-options", "steps=3"], "--svd-options needs --renderer svd. Got: without"),
        (["--inpainting-options", "steps=3"], "--inpainting-options needs --renderer inpainting. Got: without"),
        (["--grow", "3"], "--grow needs --renderer inpainting or --save-uncovered. Got: without"),
        (["--inpainting", "m"], "--inpainting must be left out unless --renderer is inpainting. Got: m"),
        (["--renderer", "inpainting"], "--inpainting must be a folder where --renderer is inpainting. Got: none"),
        (["--renderer", "inpainting", "--inpainting", "no"], "--inpainting: no is no folder. Wanted: the diffusers"),
        (["--renderer", "inpainting", "--inpainting", "girl.png"], "--inpainting: girl.png is no folder."),
        (["--soft-edge", "3"], "--soft-edge needs --renderer svd or inpainting, or --save-uncovered. Got: without"),
        (["--lines-size", "30"], "--lines-size needs --extractor informative. Got: without"),
        (["--device", "cpu"], "--device needs a network, such as --renderer svd. Got: none"),
        (["--dtype", "fp16"], "--dtype needs a network"),
        (["--dtype", "fp8"], "--dtype must be one of"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_before_the_work(
    arguments: list[str], sentence: str, unsimulated: None, capsys: Output
) -> None:
    output = () if "-o" in arguments else ("-o", "out.mp4")
    mask = () if "--points" in arguments else ("--mask", "hair.png")
    assert status("animate", "girl.png", *mask, "--frames", "3", "-q", *output, *arguments) == 2
    told = capsys.readouterr().err
    assert sentence in told
    assert len(told.strip().splitlines()) == 1


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--background", "transparent", "-o", "o.webm"], "--renderer: frames that a model draws must be opaque"),
        (["--background", "parts", "-o", "o/"], "--renderer: frames that a model draws must be opaque"),
        (
            ["--pixel-art"],
            "--renderer: frames that a model draws must be opaque, and no pixel art. Got: pixel art",
        ),
        (["--svd-options", "steps=0"], "--svd-options: steps must be"),
        (["--svd-options", "steps=many"], "--svd-options: steps must be a whole number. Got: 'many'"),
        (["--svd-options", "speed=2"], "--svd-options: settings must be NAME=VALUE with steps,"),
        (["--svd-options", "steps=2,steps=3"], "--svd-options: settings must each be given once"),
        (["--svd-options", "area=8x8"], "--svd-options: area must be"),
        (["--soft-edge", "-1"], "--soft-edge must be a number from 0 to 10000 px. Got: -1.0"),
        (["--device", "tape"], "--device must be one that torch finds here, such as auto, cpu"),
        (["--device", "meta"], "--device must be one that torch finds here"),
        (["--device", "cuda:99"], "--device must be one that torch finds here"),
        (["--frames", "1"], "--frames must be at least 2 where a video model draws them. Got: 1"),
    ],
)
def test_what_the_video_model_cannot_do_is_refused_before_the_work(
    arguments: list[str], sentence: str, files: dict[str, dict[str, Path]], unsimulated: None, capsys: Output
) -> None:
    output = () if "-o" in arguments else ("-o", "out.mp4")
    weights = ["--renderer", "svd", *given(files["folder"], "svd", "lvcd")]
    assert (
        status("animate", "girl.png", "--mask", "hair.png", "--frames", "3", "-q", *weights, *output, *arguments) == 2
    )
    assert sentence in capsys.readouterr().err


class Harm:
    def __reduce__(self) -> tuple[object, tuple[str]]:
        return (eval, ("open('harmed', 'w')",))


@pytest.mark.parametrize(
    ("option", "others"),
    [
        ("svd", ["--renderer", "svd", "--lvcd", "bad"]),
        ("lvcd", ["--renderer", "svd", "--svd", "SVD"]),
        ("tooncrafter", ["--interpolate-with", "tooncrafter", "--interpolate", "2"]),
        ("lines", ["--extractor", "informative", "--save-sketch", "s.mp4"]),
        ("sam", ["--segmenter", "sam"]),
    ],
)
@pytest.mark.parametrize("suffix", [".ckpt", ".pth", ".bin", ".safetensors"])
def test_weights_run_no_code(
    option: str, others: list[str], suffix: str, files: dict[str, dict[str, Path]], unsimulated: None, capsys: Output
) -> None:
    Path(f"bad{suffix}").write_bytes(pickle.dumps({"state_dict": Harm()}))
    words = [str(files["folder"]["svd"]) if word == "SVD" else word for word in others]
    arguments = ["girl.png", "--points", "hair.txt", "--frames", "3", "-q", "-o", "out.mp4", *words]
    assert status("animate", *arguments, f"--{option}", f"bad{suffix}") == 2
    assert not Path("harmed").exists()
    told = capsys.readouterr().err
    assert f"--{option}: bad{suffix}" in told
    assert "weights_only" not in told


def test_weights_are_never_written_over(files: dict[str, dict[str, Path]], unsimulated: None, capsys: Output) -> None:
    config = files["folder"]["svd"] / "unet" / "config.json"
    before = config.read_bytes()
    weights = ["--renderer", "svd", *given(files["folder"], "svd", "lvcd")]
    arguments = ["girl.png", "--mask", "hair.png", "-o", "out.mp4", *weights, "--save-motion", str(config)]
    assert status("animate", *arguments) == 2
    assert "--save-motion must not be a file that is read" in capsys.readouterr().err
    assert config.read_bytes() == before


def test_a_video_is_opaque_where_a_video_model_draws(files: dict[str, dict[str, Path]], small: None) -> None:
    weights = ["--renderer", "svd", *given(files["single"], "svd", "lvcd")]
    arguments = ["girl.png", "--mask", "hair.png", "--frames", "3", "-q", *weights, *QUICK, "--no-still-parts"]
    assert status("animate", *arguments, "-o", "out.webm") == 0
    assert shown("out.webm").shape == (3, HEIGHT, WIDTH, 3)
    assert np.abs(shown("out.webm")[:, :, :12] - 220).mean() > 20, "the model draws all of it"
