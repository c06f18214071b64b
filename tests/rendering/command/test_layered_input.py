"""The command line with layered artwork, and with what stands in front of a flat picture's parts."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import physanimator.rendering.pipeline
import pytest
from command_status import status
from physanimator.rendering.artwork import ArtLayer, Artwork, flattened, save_layer_pngs, save_psd
from physanimator.rendering.pictures import load_image, read_clip, save_image
from PIL import Image

Output = pytest.CaptureFixture[str]

HAIR, FACE, PAPER = (120, 60, 20), (250, 210, 180), (200, 220, 240)


def layer(name: str, colour: tuple[int, int, int], rows: slice, columns: slice) -> ArtLayer:
    pixels = np.zeros((96, 128, 4), np.uint8)
    pixels[rows, columns] = (*colour, 255)
    return ArtLayer(name, pixels)


def artwork() -> Artwork:
    """A strand that hangs behind a face, over paper; a scarf whose name says that it moves."""
    every = slice(None)
    return Artwork(
        128,
        96,
        (
            layer("paper", PAPER, every, every),
            layer("back hair", HAIR, slice(10, 90), slice(40, 60)),
            layer("face", FACE, slice(30, 60), slice(30, 90)),
            layer("scarf", (20, 120, 60), slice(60, 90), slice(80, 100)),
        ),
    )


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    save_psd(artwork(), "girl.psd")
    save_layer_pngs(artwork(), "girl")
    return tmp_path


@pytest.fixture
def unsimulated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Simulating is an error."""

    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("simulated")

    monkeypatch.setattr(physanimator.rendering.pipeline, "simulate", refuse)


def frames_of(place: str) -> list[np.ndarray]:
    return [load_image(path) for path in sorted(Path(place).glob("frame_*.png"))]


@pytest.mark.parametrize("name", ["girl.psd", "girl"])
def test_a_layered_file_alone_is_animated(name: str) -> None:
    Path("out").mkdir()
    assert status("animate", name, "-o", "out/", "--frames", "8", "--wind", "3", "-q") == 0
    frames = frames_of("out")
    whole = flattened(artwork())[..., :3]
    assert len(frames) == 8
    assert (frames[0] == whole).all()
    assert (frames[-1] != whole).any()
    for frame in frames:
        assert (frame[32:58, 32:78] == FACE).all()  # in front of the hair, and still


def test_the_users_word_stands_above_the_names() -> None:
    Path("out").mkdir()
    calm = ("--still", "scarf", "--move", "face=jelly")
    assert status("animate", "girl.psd", "-o", "out/", "--frames", "8", "--wind", "3", "-q", *calm) == 0
    last = frames_of("out")[-1]
    scarf = artwork().layers[3].pixels[..., 3] > 0
    assert (last[scarf] == (20, 120, 60)).all()
    assert (last[32:58, 32:88] != FACE).any() or (last[61:70, 40:70] != flattened(artwork())[61:70, 40:70, :3]).any()


@pytest.mark.usefixtures("unsimulated")
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("girl.psd", "--mask", "girl/01 back hair.png"), "IMAGE must be a flat picture where --mask is given"),
        (("girl.psd", "--plate", "girl/00 paper.png"), "IMAGE must be a flat picture where --plate is given"),
        (("girl.psd", "--pixel-art"), "IMAGE must be a flat picture where --pixel-art is given"),
        (("girl.psd", "--in-front", "girl/00 paper.png"), "IMAGE must be a flat picture where --in-front is given"),
        (("girl/00 paper.png", "--move", "hair"), "--move and --still need layered artwork"),
        (("girl.psd", "--move", "beard"), "beard"),
        (("girl.psd", "--still", "back hair", "scarf"), "no layer"),
        (("girl.psd", "--background", "layers"), "--background layers needs --output to end in '/'"),
        (("girl/00 paper.png", "--mask", "girl/01 back hair.png", "--background", "layers"), "--background layers"),
    ],
)
def test_what_does_not_go_together_is_said_before_the_work(
    arguments: tuple[str, ...], said: str, capsys: Output
) -> None:
    assert status("animate", *arguments, "-o", "out.mp4", "--frames", "3", "-q") == 2
    printed = capsys.readouterr().err
    assert said in printed
    assert printed.count("\n") == 1


@pytest.mark.usefixtures("unsimulated")
def test_a_result_never_takes_the_place_of_a_layer(capsys: Output) -> None:
    before = Path("girl/01 back hair.png").read_bytes()
    assert status("animate", "girl", "-o", "girl/01 back hair.png", "--frames", "3", "-q") == 2
    assert status("animate", "girl", "-o", "out.mp4", "--save-tracks", "girl/01 back hair.png", "-q") == 2
    assert status("animate", "girl.psd", "-o", "girl.psd", "--frames", "3", "-q") == 2
    assert Path("girl/01 back hair.png").read_bytes() == before
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize("transparent", [False, True])
def test_each_part_of_a_flat_picture_is_written_as_a_sequence_of_its_own(transparent: bool, capsys: Output) -> None:
    flat = flattened(artwork())
    face = artwork().layers[2]
    if transparent:
        flat[:, :20, 3] = 0
    save_image("flat.png", flat if transparent else flat[..., :3])
    save_image("hair.png", artwork().layers[1].pixels[..., 3])
    save_image("front.png", face.pixels[..., 3])
    given = (
        "animate",
        "flat.png",
        "--mask",
        "hair.png",
        "--in-front",
        "front.png",
        "--wind",
        "3",
        "-q",
        "--frames",
        "5",
    )
    assert status(*given, "-o", "out/", "--background", "layers") == 0
    counts = {path.name: len(list(path.glob("frame_*.png"))) for path in Path("out").iterdir()}
    assert counts == {"00 background": 1, "01 part 1": 5, "02 in front": 1}
    assert status(*given, "-o", "whole/") == 0
    for t in (0, 4):
        numbers = {name: t if count > 1 else 0 for name, count in counts.items()}
        shown = [np.asarray(Image.open(f"out/{name}/frame_{numbers[name]:04}.png")) for name in sorted(counts)]
        layers = tuple(ArtLayer(name, pixels) for name, pixels in zip(sorted(counts), shown, strict=True))
        whole = np.asarray(Image.open(f"whole/frame_{t:04}.png").convert("RGBA"))
        apart = np.abs(flattened(Artwork(128, 96, layers)).astype(int) - whole)
        assert apart.max() <= 3
    moved = [Path(f"out/01 part 1/frame_{t:04}.png").read_bytes() for t in (0, 4)]
    assert moved[0] != moved[1]
    save_image("out/01 part 1/frame_0002.png", np.zeros((4, 4, 3), np.uint8))
    assert status(*given, "-o", "out/", "--background", "layers") == 2
    assert "01 part 1" in capsys.readouterr().err
    assert status(*given[:4], "-o", "art/", "--background", "layers", "--pixel-art", "-q") == 2
    assert "--pixel-art" in capsys.readouterr().err


def test_each_layer_is_written_as_a_sequence_of_its_own(capsys: Output) -> None:
    given = ("animate", "girl.psd", "-o", "out/", "--background", "layers", "--wind", "3", "-q", "--frames")
    assert status(*given, "6") == 0
    counts = {path.name: len(list(path.glob("frame_*.png"))) for path in Path("out").iterdir()}
    assert counts == {"00 paper": 1, "01 back hair": 6, "02 face": 1, "03 scarf": 6}
    shown = [np.asarray(Image.open(f"out/{name}/frame_0000.png").convert("RGBA")) for name in sorted(counts)]
    layers = tuple(ArtLayer(name, pixels) for name, pixels in zip(sorted(counts), shown, strict=True))
    assert (flattened(Artwork(128, 96, layers)) == flattened(artwork())).all()
    assert status(*given, "4") == 0
    assert len(list(Path("out/01 back hair").glob("frame_*.png"))) == 4
    save_image("out/01 back hair/frame_0002.png", np.zeros((4, 4, 3), np.uint8))
    assert status(*given, "4") == 2
    assert "01 back hair" in capsys.readouterr().err


def test_an_arm_stays_in_front_of_hair_in_a_flat_picture() -> None:
    picture = flattened(artwork())[..., :3]
    save_image("flat.png", np.ascontiguousarray(picture))
    hair = (picture == HAIR).all(axis=2).astype(np.uint8) * 255
    save_image("hair.png", hair)
    save_image("face.png", artwork().layers[2].pixels[..., 3])
    Path("out").mkdir()
    given = ("flat.png", "--mask", "hair.png", "--in-front", "face.png", "--preset", "hair", "--wind", "3")
    assert status("animate", *given, "-o", "out/", "--frames", "8", "-q", "--save-tracks", "tracks.json") == 0
    for frame in frames_of("out"):
        assert np.abs(frame[33:57, 33:87].astype(int) - FACE).max() <= 2
    assert len(json.loads(Path("tracks.json").read_text())) > 8


def test_a_layer_that_cannot_move_stands_still_and_is_told_of_unless_it_was_asked_for(capsys: Output) -> None:
    """Of one pixel, or beyond the canvas."""
    dot, off = layer("hair dot", HAIR, slice(5, 6), slice(5, 6)), layer("tail", HAIR, slice(5, 60), slice(5, 30))
    odd = (dot, ArtLayer("tail", off.pixels, left=130))
    save_psd(Artwork(128, 96, (*artwork().layers, *odd)), "odd.psd")
    assert status("animate", "odd.psd", "-o", "out.gif", "--frames", "3", "-q") == 0
    said = capsys.readouterr().err
    assert said.count("it stands still") == 2
    for name in ("hair dot", "tail"):
        assert f"layer {name}: " in said
        assert status("animate", "odd.psd", "-o", "out.gif", "--frames", "3", "-q", "--move", name) == 2
    assert capsys.readouterr().err.count("\n") == 2


def test_16_bits_keep_their_frames_sketches_and_layers() -> None:
    deep = [ArtLayer(each.name, each.pixels.astype(np.uint16) * 257) for each in artwork().layers]
    save_psd(Artwork(128, 96, tuple(deep)), "deep.psd")
    assert status("animate", "deep.psd", "-o", "out.mp4", "--save-sketch", "sketch.mp4", "--frames", "3", "-q") == 0
    assert len(list(read_clip("sketch.mp4"))) == 3


def test_a_video_of_layers_is_as_long_and_large_as_asked() -> None:
    assert status("animate", "girl.psd", "-o", "out.webm", "--frames", "5", "--width", "64", "-q") == 0
    frames = list(read_clip("out.webm"))
    assert len(frames) == 5
    assert frames[0].shape[:2] == (48, 64)
