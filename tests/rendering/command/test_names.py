"""Whatever is wrong with the value of an option, the message names the option, before anything is simulated."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

import av
import numpy as np
import physanimator.rendering.pipeline
import pytest
from command_status import status
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.command.names import named_by_options, parts_in_options
from physanimator.rendering.pictures import save_image

Output = pytest.CaptureFixture[str]

NUMBERS = ("0", "-1", "1e30", "-1e30", "1e-300", "nan", "inf", "-inf", "1e400", "many", "")
USABLE = {
    "--wind": ("0", "-1", "1e-300"),
    "--wind-angle": ("0", "-1", "1e-300"),
    "--turbulence": ("0", "1e-300"),
    "--max-minutes": ("1e-300",),
    "--mu": ("1e-300",),
    "--lambda": ("0", "1e-300"),
    "--youngs-modulus": ("1e-300",),
    "--poisson-ratio": ("0", "1e-300"),
    "--density": ("1e-300",),
    "--damping": ("0", "1e-300"),
    "--stretch-limit": ("0",),
    "--wind-response": ("0", "1e-300"),
    "--time-step": ("0",),
    "--skip": ("0",),
    "--track-static": ("0",),
}
LAME = ("--mu", "--lambda")
MATERIAL = ("--youngs-modulus", "--poisson-ratio", "--density", "--damping", "--stretch-limit", "--wind-response",
            "--root-stiffness", *LAME)  # fmt: skip
FRACTIONS = (
    *MATERIAL,
    "--time-step",
    "--sway",
    "--wind",
    "--wind-angle",
    "--turbulence",
    "--spacing",
    "--loop",
    "--fps",
    "--max-minutes",
)
WHOLE = ("--frames", "--skip", "--interpolate", "--width", "--track-points", "--track-static", "--track-frames")


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder, made the current one, with a picture, its mask, and files that are none."""
    monkeypatch.chdir(tmp_path)
    mask = np.zeros((48, 64), np.uint8)
    mask[8:40, 20:36] = 255
    save_image("girl.png", np.where(mask[..., None] > 0, 40, 200).repeat(3, axis=2).astype(np.uint8))
    save_image("hair.png", mask)
    save_image("tiny.png", np.pad(np.full((1, 1), 255, np.uint8), ((20, 27), (30, 33))))
    Path("text.png").write_text("none of these", encoding="utf-8")
    Path("cut.png").write_bytes(Path("girl.png").read_bytes()[:60])
    Path("drawings").mkdir()
    return tmp_path


@pytest.fixture
def unsimulated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Simulating is an error."""

    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("simulated")

    monkeypatch.setattr(physanimator.rendering.pipeline, "simulate", refuse)


def animate(*arguments: str) -> int:
    output = () if "--output" in arguments else ("--output", "out.mp4")
    frames = () if "--frames" in " ".join(arguments).replace("=", " ").split() else ("--frames", "3")
    return status("animate", "girl.png", "--mask", "hair.png", "-q", *frames, *output, *arguments)


@pytest.mark.usefixtures("unsimulated")
@pytest.mark.parametrize("option", [*FRACTIONS, *WHOLE])
def test_numbers_are_refused_by_the_options_name(option: str, capsys: Output) -> None:
    extra = ("--save-tracks", "t.json") if "track" in option else ()
    if option in LAME:
        extra = next((other, "1") for other in LAME if other != option)
    for value in NUMBERS:
        if value in USABLE.get(option, ()) or (option == "--interpolate" and value == "1"):
            continue
        assert animate(*extra, f"{option}={value}") == 2, value
        said = capsys.readouterr().err
        assert said.startswith(f"physanimator: {option} must "), said
        assert said.count("\n") == 1


def test_remedies_name_options(capsys: Output) -> None:
    assert animate("--max-minutes", "1e-9") == 2
    said = capsys.readouterr().err
    assert "set --max-minutes to" in said
    assert "a larger --spacing" in said
    assert "a lower --sway" in said
    assert "max_minutes" not in said


INPUTS = ("IMAGE", "--mask", "--points", "--scene", "--collider", "--plate", "--clip", "--reference")


@pytest.mark.usefixtures("unsimulated")
@pytest.mark.parametrize("option", INPUTS)
@pytest.mark.parametrize("path", ["none.png", "drawings", "text.png", "cut.png", "girl.png/x", "", "x" * 300 + ".png"])
def test_files_are_refused_by_the_options_name(option: str, path: str, capsys: Output) -> None:
    image = path if option == "IMAGE" else "girl.png"
    given = () if option == "IMAGE" else (option, path)
    if option in ("--clip", "--reference"):
        Path("weights.pth").touch()
        other = ("--fid", "weights.pth") if option == "--reference" else ()
        ended = status("measure", image, "--mask", "hair.png", "-q", "--frames", "3", *given, *other)
    else:
        ended = status("animate", image, "--mask", "hair.png", "-q", "--frames", "3", "-o", "out.mp4", *given)
    said = capsys.readouterr().err
    assert ended == 2
    assert said.startswith(f"physanimator: {option}"), said
    assert "Errno" not in said
    assert said.count("\n") == 1


@pytest.mark.usefixtures("unsimulated")
def test_the_file_of_the_part_that_cannot_move_is_named(capsys: Output) -> None:
    assert animate("--mask", "hair.png", "tiny.png") == 2
    assert capsys.readouterr().err.startswith("physanimator: --mask tiny.png: mask must have a white part of at least")
    assert status("animate", "girl.png", "--mask", "tiny.png", "-q", "--frames", "3", "-o", "out.mp4") == 2
    assert capsys.readouterr().err.startswith("physanimator: --mask tiny.png: mask must have a white part of at least")
    Path("beside.txt").write_text("20,20,0", encoding="utf-8")
    assert animate("--points", "beside.txt") == 2
    assert capsys.readouterr().err.startswith("physanimator: --points beside.txt: points must be with one on the part")


@pytest.mark.usefixtures("unsimulated")
@pytest.mark.parametrize(
    ("option", "suffix"),
    [
        *((name, ".mp4") for name in ("--output", "--save-sketch", "--save-flow", "--preview")),
        *(("--save-tracks", ".json"), ("--save-motion", ".json"), ("--save-svg", ".svg")),
        *(("--save-uncovered", ".png"), ("--save-plate", ".png")),
    ],
)
def test_outputs_are_refused_by_the_options_name(option: str, suffix: str, capsys: Output) -> None:
    Path(f"folder{suffix}").mkdir()
    for path in ("", f"none/x{suffix}", "x.xyz", f"girl.png/x{suffix}", f"folder{suffix}", "x" * 300 + suffix):
        assert animate(option, path) == 2, path
        said = capsys.readouterr().err
        assert said.startswith(f"physanimator: {option}"), said


@pytest.mark.parametrize("new", [True, False])
def test_results_may_be_written_into_the_folder_of_frames(new: bool) -> None:
    if not new:
        Path("d").mkdir()
    extra = "--save-tracks d/t.json --save-motion d/m.json --save-svg d/s.svg --preview d/p.gif --save-sketch d/e/"
    assert animate("--output", "d/", *extra.split()) == 0
    assert sorted(os.listdir("d")) == [
        ".physanimator.json", "e", *(f"frame_000{t}.png" for t in range(3)), "m.json", "p.gif", "s.svg", "t.json"
    ]  # fmt: skip
    assert len(list(Path("d/e").glob("frame_*.png"))) == 3
    assert animate("--output", "d/", *extra.split()) == 0  # and again


def test_the_clip_may_be_written_into_the_folder_of_another_result() -> None:
    assert animate("--output", "d/out.mp4", "--save-sketch", "d/") == 0
    assert Path("d/out.mp4").stat().st_size > 0
    assert len(list(Path("d").glob("frame_*.png"))) == 3


@pytest.mark.usefixtures("unsimulated")
@pytest.mark.parametrize("path", ["d/frame_0001.png/", "d/FRAME_12345.png/"])
def test_no_result_takes_a_frames_name(path: str, capsys: Output) -> None:
    assert animate("--output", "d/", "--preview", path) == 2
    assert "--preview must not be named as the frames" in capsys.readouterr().err
    assert not Path("d").exists()


@pytest.mark.usefixtures("unsimulated")
@pytest.mark.parametrize("path", ["d/e/t.json", "e/t.json"])
def test_other_folders_must_exist(path: str, capsys: Output) -> None:
    assert animate("--output", "d/", "--save-tracks", path) == 2
    assert "--save-tracks: the folder for" in capsys.readouterr().err
    assert not Path("d").exists()


@pytest.mark.usefixtures("unsimulated")
@pytest.mark.parametrize("kept", [0, 20, 400])
def test_a_damaged_video_is_refused_in_one_sentence(kept: int, capsys: Output) -> None:
    with av.open("clip.mp4", "w") as container:
        stream = container.add_stream("libx264", rate=24, width=64, height=48, pix_fmt="yuv420p")
        for _ in range(3):
            container.mux(stream.encode(av.VideoFrame.from_ndarray(np.zeros((48, 64, 3), np.uint8), format="rgb24")))
        container.mux(stream.encode())
    Path("clip.mp4").write_bytes(Path("clip.mp4").read_bytes()[:kept])
    assert status("measure", "girl.png", "--mask", "hair.png", "-q", "--frames", "3", "--clip", "clip.mp4") == 2
    said = capsys.readouterr().err
    assert said.startswith("physanimator: --clip clip.mp4 cannot be read: ")
    assert "Errno" not in said
    assert said.count("\n") == 1


def test_bodies_and_points_are_named_by_their_files() -> None:
    options = argparse.Namespace(mask=["hair.png"], points=["cape.json"])
    loose = "bodies[1] has one separate part that no rig point holds: it may drift away"
    assert parts_in_options(loose, options) == loose.replace("bodies[1]", "--points cape.json")
    assert parts_in_options(loose.replace("1", "7"), options).startswith("bodies[7]"), "a scene file has more"
    outside = "points[3] must lie inside the picture of 64 x 48 px. Got: (900, 4)"
    with pytest.raises(InvalidInputError) as caught, named_by_options(options):
        raise InvalidInputError(outside)
    assert str(caught.value) == f"--points cape.json: {outside}"


def test_a_cut_is_judged_by_the_name_of_its_file(folder: Path, capsys: Output) -> None:
    points = {"a.json": "[[28, 24, 1]]", "b.json": "[[50, 24, 1], [28, 24, 0]]"}
    for name, text in points.items():
        (folder / name).write_text(text)
    given = ["animate", "girl.png", "--points", "a.json", "--points", "b.json", "--frames", "2", "-o", "a.gif"]
    status(*given)  # what is left of the picture after such a cut is refused later
    told = capsys.readouterr().err
    assert "warning: --points b.json: The cut is " in told
    assert "warning: --points b.json covers " in told
    assert "Part " not in told
