"""The command line as a person meets it: results, messages and exit statuses."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import av
import numpy as np
import physanimator
import pytest
from command_status import status
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.linear_algebra import THREADS_OF_ALGEBRA
from physanimator.physics.material import PRESETS
from physanimator.rendering.command import EXAMPLE
from physanimator.rendering.pictures import load_image, save_image
from PIL import Image

ROOT = Path(__file__).resolve().parents[3]
WIDTH, HEIGHT = 160, 120


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder, made the current one, with a picture, a mask and the files for all options."""
    monkeypatch.chdir(tmp_path)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    strip = (np.abs(x - 70) < 10) & (y > 15) & (y < 95)
    image = np.stack([80 + x * 0.8, 200 - y * 0.9, 160 + 0 * x], axis=-1).astype(np.uint8)
    save_image("plate.png", image)
    image[strip] = (70, 40, 30)
    save_image("girl.png", image)
    save_image("hair.png", strip.astype(np.uint8) * 255)
    save_image("small.png", np.full((6, 8), 255, np.uint8))
    save_image("narrow.png", np.full((6, 6), 255, np.uint8))
    save_image("empty.png", np.zeros((HEIGHT, WIDTH), np.uint8))
    (tmp_path / "points.txt").write_text("70,50,1\n120,50,0\n")
    pin = {"position": [70, 20], "region": {"type": "circle", "radius": 20}, "motion": {"type": "pinned"}}
    scene = {"version": 1, "width": WIDTH, "height": HEIGHT, "frame_rate": 12, "rig_points": [pin]}
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    (tmp_path / "broken.json").write_text('{"version": 1,')
    (tmp_path / "wrong.json").write_text(json.dumps({**scene, "strokes": [{"kind": "storm"}]}))
    return tmp_path


def frames_of(path: str | Path) -> int:
    with av.open(str(path)) as container:
        return sum(1 for _ in container.decode(video=0))


Output = pytest.CaptureFixture[str]


def test_mask_to_video(folder: Path, capsys: Output) -> None:
    assert status("animate", "girl.png", "--mask", "hair.png", "--frames", "4", "--output", "out.mp4") == 0
    assert frames_of("out.mp4") == 4
    captured = capsys.readouterr()
    assert captured.out == "out.mp4: 4 frames at 24 frames a second\n"
    assert "simulate" in captured.err
    assert "render" in captured.err


def test_points_scene_and_folder(folder: Path) -> None:
    arguments = ["animate", "girl.png", "--points", "points.txt", "--scene", "scene.json", "--frames", "3"]
    assert status(*arguments, "--output", "frames/") == 0
    assert sorted(path.name for path in (folder / "frames").glob("*.png")) == [f"frame_000{t}.png" for t in range(3)]
    first = load_image(folder / "frames" / "frame_0000.png")
    assert np.abs(first.astype(int) - load_image("girl.png")).max() <= 1


@pytest.mark.parametrize("text", ["null", "NaN", '"calm"', "[]", "5", ""])
def test_a_file_without_a_scene_is_refused(folder: Path, capsys: Output, text: str) -> None:
    Path("other.json").write_text(text, encoding="utf-8")
    arguments = ["animate", "girl.png", "--mask", "hair.png", "--scene", "other.json", "--frames", "2", "-o", "out.mp4"]
    assert status(*arguments) == 2
    assert "scene" in capsys.readouterr().err
    assert not Path("out.mp4").exists()


def test_every_option_at_once(folder: Path, capsys: Output) -> None:
    arguments = "animate girl.png --mask hair.png --preset cloth --sway 2 --attach top --wind 2 --wind-angle 180"
    arguments += " --spacing 8 --frames 5 --fps 12.5 --background picture --interpolate 2 --plate plate.png --verbose"
    arguments += " --save-sketch sketch/ --save-flow flow.webp --preview preview.gif --output out.webm"
    assert status(*arguments.split()) == 0
    assert frames_of("out.webm") == 5
    assert frames_of("preview.gif") == 5
    assert len(list((folder / "sketch").glob("*.png"))) == 5
    assert (folder / "flow.webp").exists()
    report = capsys.readouterr().err
    for word in ("triangles", "steps of the simulation a frame", "prepare", "write"):
        assert word in report


def test_webm_is_transparent_unless_told_otherwise(folder: Path) -> None:
    arguments = ["animate", "girl.png", "--mask", "hair.png", "--frames", "2", "--quiet"]
    assert status(*arguments, "--output", "clear.webm") == 0
    assert status(*arguments, "--background", "picture", "--output", "full.webm") == 0
    assert status(*arguments, "--output", "clear.mov") == 0
    with av.open("clear.mov") as container:
        first = next(container.decode(video=0)).to_ndarray(format="rgba")
    assert (first[..., 3].min(), first[..., 3].max()) == (0, 255)
    for name, expected in (("clear.webm", True), ("full.webm", False)):
        with av.open(name) as container:
            assert ("1" in container.streams.video[0].metadata.values()) == expected


@pytest.fixture
def sprite(folder: Path) -> Path:
    """A picture with transparency: a body with a strip across its silhouette, colours hidden under alpha 0."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    strip, body = (np.abs(x - 70) < 10) & (y > 15) & (y < 95), (np.abs(x - 60) < 30) & (y > 50)
    image = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    image[..., :3] = (255, 0, 255)
    image[body], image[strip] = (200, 160, 90, 255), (70, 40, 30, 255)
    Image.fromarray(image).save(folder / "sprite.png")
    return folder / "sprite.png"


@pytest.mark.parametrize(
    ("background", "corner", "on_body"),
    [
        (None, [0, 0, 0, 0], [200, 160, 90, 255]),
        ("transparent", [0, 0, 0, 0], [200, 160, 90, 255]),
        ("parts", [0, 0, 0, 0], [0, 0, 0, 0]),
        ("picture", [255, 255, 255], [200, 160, 90]),
        ("#204060", [32, 64, 96], [200, 160, 90]),
    ],
)
def test_a_sprite_on_every_background(
    sprite: Path, background: str | None, corner: list[int], on_body: list[int]
) -> None:
    said = ["--background", background] if background else []
    arguments = ["animate", "sprite.png", "--mask", "hair.png", "--frames", "2", "--quiet", *said]
    assert status(*arguments, "--output", "frames/") == 0
    frame = np.array(Image.open("frames/frame_0001.png"))
    assert frame[2, 2].tolist() == corner
    assert frame[110, 40].tolist() == on_body
    assert frame[60, 70, :3].tolist() == [70, 40, 30]


def test_a_sprite_keeps_its_transparency_where_the_file_can(sprite: Path, capsys: Output) -> None:
    arguments = ["animate", "sprite.png", "--mask", "hair.png", "--frames", "2", "--quiet"]
    for name in ("a.webm", "a.webp", "a.gif", "a.apng"):
        assert status(*arguments, "--output", name) == 0
    with av.open("a.webm") as container:
        assert "1" in container.streams.video[0].metadata.values()
    for name in ("a.webp", "a.gif", "a.apng"):
        with Image.open(name) as clip:
            assert np.array(clip.convert("RGBA"))[2, 2, 3] == 0
    assert status(*arguments, "--output", "a.mp4", "--save-svg", "a.svg", "--preview", "b.gif") == 0
    with av.open("a.mp4") as container:
        first = next(container.decode(video=0)).to_ndarray(format="rgb24")
    assert first[2, 2].min() > 245  # white, not what is hidden there
    assert status(*arguments, "--output", "c.webm", "--interpolate", "2") == 2
    assert "one by one" in capsys.readouterr().err


def test_pixel_art_stays_pixel_art(folder: Path, capsys: Output) -> None:
    art = np.full((32, 32, 3), (90, 150, 220), np.uint8)
    art[20:], art[4:24, 12:17] = (70, 160, 70), (90, 50, 20)
    mask = np.zeros((32, 32), np.uint8)
    mask[4:24, 12:17] = 255
    save_image("hero.png", art)
    save_image("strand.png", mask)
    arguments = ["animate", "hero.png", "--mask", "strand.png", "--frames", "20", "--wind", "4", "--width", "96"]
    assert status(*arguments, "--pixel-art", "--output", "pixels/") == 0
    frames = [np.array(Image.open(path)) for path in sorted(Path("pixels").glob("*.png"))]
    assert (frames[0] == art.repeat(3, axis=0).repeat(3, axis=1)).all()
    assert len(np.unique(np.concatenate(frames).reshape(-1, 3), axis=0)) == 3
    assert any((frame != frames[0]).any() for frame in frames)
    assert "looks like pixel art" not in capsys.readouterr().err
    assert status(*arguments, "--output", "smooth/") == 0
    assert "--pixel-art keeps its pixels hard" in capsys.readouterr().err
    assert status(*arguments, "--pixel-art", "--interpolate", "2", "--output", "c.gif") == 2


def test_data_for_other_programs(folder: Path) -> None:
    arguments = "animate girl.png --mask hair.png --frames 6 --skip 2 --width 80 --quiet --output o.mp4"
    arguments += " --save-tracks tracks.json --track-points 5 --track-static 3 --track-frames 9"
    assert status(*arguments.split(), "--save-motion", "motion.json", "--save-svg", "motion.svg") == 0
    arguments = arguments.replace("--track-frames 9", "").replace("tracks.json", "plain.json")
    assert status(*arguments.split()) == 0
    plain = json.loads((folder / "plain.json").read_text(encoding="utf-8"))
    assert [len(track) for track in plain] == [4] * 8  # the frames that are shown
    tracks = json.loads((folder / "tracks.json").read_text(encoding="utf-8"))
    assert [len(track) for track in tracks] == [9] * 8
    assert all(0 <= point["x"] < 80 and 0 <= point["y"] < 60 for track in tracks for point in track)
    motion = json.loads((folder / "motion.json").read_text(encoding="utf-8"))
    assert (motion["format"], motion["width"], motion["frames"]) == ("physanimator-motion", WIDTH, 4)
    text = (folder / "motion.svg").read_text(encoding="utf-8")
    assert text.startswith("<svg")
    assert "data:image/jpeg;base64," in text


@pytest.mark.parametrize("name", ["stiffness", "strokes", "collision"])
def test_figures_are_written(folder: Path, capsys: Output, name: str) -> None:
    assert status("figure", name, "--output", f"{name}.png") == 0
    height, width = load_image(f"{name}.png").shape[:2]
    assert capsys.readouterr().out == f"{name}.png: {width} x {height} px\n"
    assert height * width > 1_500_000


def test_quiet_says_nothing(folder: Path, capsys: Output) -> None:
    arguments = "animate girl.png --mask hair.png --frames 12 --wind 3 --quiet --output o.mp4"
    assert status(*arguments.split()) == 0
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("animate girl.png --output o.mp4", "needs --mask or --points"),
        ("animate none.png --mask hair.png --output o.mp4", "existing file. Got: none.png"),
        ("animate girl.png --mask none.png --output o.mp4", "existing file. Got: none.png"),
        ("animate girl.png --mask narrow.png --output o.mp4", "160 x 120 px). Got: 6 x 6 px"),
        ("animate girl.png --mask empty.png --output o.mp4", "empty mask"),
        ("animate points.txt --mask hair.png --output o.mp4", "PNG, JPEG or WebP"),
        ("animate girl.png --mask hair.png --output o.avi", "--output must end in .mp4"),
        ("animate girl.png --mask hair.png --output none/o.mp4", "folder for none/o.mp4 must exist"),
        ("animate girl.png --mask hair.png --output o.mp4 --background transparent", "must end in .webm"),
        ("animate girl.png --mask hair.png --output o.mp4 --background parts", "must end in .webm"),
        ("animate girl.png --mask hair.png --output o.mp4 --background purpel", "background must be picture"),
        ("animate girl.png --mask hair.png --output o.gif --background parts --interpolate 2", "one by one"),
        ("animate girl.png --mask hair.png --output o.mp4 --preview p.txt", "--preview must end in .mp4"),
        ("animate girl.png --mask hair.png --output o.mp4 --preview o.mp4", "its own name"),
        ("animate girl.png --mask hair.png --output o.mp4 --preset steel", "preset must be one of"),
        ("animate girl.png --mask hair.png --output o.mp4 --frames 0", "frames must be at least 1"),
        ("animate girl.png --mask hair.png --output o.mp4 --fps 0", "frame"),
        ("animate girl.png --mask hair.png --output o.mp4 --interpolate 0", "--interpolate must be at least 1"),
        ("animate girl.png --mask hair.png --output o.mp4 --plate small.png", "plate must have the picture's size"),
        ("animate girl.png --mask hair.png --output o.mp4 --scene none.json", "none.json: No such file"),
        ("animate girl.png --mask hair.png --output o.mp4 --scene girl.png", "it is not text"),
        ("animate girl.png --mask hair.png --output o.mp4 --scene broken.json", "line 1"),
        ("animate girl.png --mask hair.png --output o.mp4 --scene wrong.json", "strokes[0]"),
        ("animate girl.png --mask hair.png --output o.mp4 --scene scene.json --wind 2", "without --scene"),
        ("animate girl.png --points none.txt --output o.mp4", "points must be a readable text file"),
        ("animate girl.png --mask hair.png", "--output"),
        ("animate girl.png --mask hair.png --output o.mp4 --frames many", "--frames must be a whole number"),
        ("animate girl.png --mask hair.png --out o.mp4", "among those of --help|--output/-o must be given"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-tracks t.txt", "must end in .json"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-motion none/m.json", "none/m.json must exist"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-svg m.png", "must end in .svg"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-uncovered m.jpg", "must end in .png"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-plate hair.png", "a file that is read"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-plate m.png --save-uncovered m.png", "its own name"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-uncovered m.png --pixel-art", "--pixel-art"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-uncovered m.png --soft-edge 1001", "0 to 1000 px"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-tracks a.json --save-motion a.json", "its own name"),
        ("animate girl.png --mask hair.png --output o.mp4 --track-points 3", "need --save-tracks"),
        ("animate girl.png --mask hair.png --output o.mp4 --save-tracks t.json --track-points 0", "points must be 1"),
        ("figure ballet --output f.png", "must be one of"),
        ("figure stiffness --output f.mp4", "must end in .png"),
        ("figure stiffness --output none/f.png", "folder for none/f.png must exist"),
        ("figure stiffness", "--output/-o must be given"),
        ("dance", "COMMAND must be one of"),
        ("", "COMMAND must be given"),
    ],
)
def test_bad_input_is_one_sentence_and_status_2(folder: Path, capsys: Output, arguments: str, words: str) -> None:
    before = sorted(folder.iterdir())
    assert status(*arguments.split()) == 2
    captured = capsys.readouterr()
    assert any(word in captured.err for word in words.split("|"))
    assert "Traceback" not in captured.err
    assert captured.out == ""
    assert captured.err.splitlines()[-1].startswith("physanimator")
    assert sorted(folder.iterdir()) == before


def test_bad_output_is_found_before_any_work(folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object, **__: object) -> None:
        pytest.fail("the picture was loaded")

    monkeypatch.setattr("physanimator.rendering.pictures.load_image", never)
    assert status("animate", "girl.png", "--mask", "hair.png", "--output", "o.avi") == 2
    assert status("demo", "--output", "o.avi") == 2
    assert status("animate", "girl.png", "--mask", "hair.png", "--scene", "broken.json", "--output", "o.mp4") == 2


@pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process on Windows")
def test_ctrl_c_that_a_library_turns_into_an_error_is_status_130(
    monkeypatch: pytest.MonkeyPatch, capsys: Output
) -> None:
    def loading(*_: object, **__: object) -> None:
        try:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(5)
        except KeyboardInterrupt as interrupt:
            raise ImportError("initialization failed") from interrupt

    monkeypatch.setattr("physanimator.rendering.command.commands.command_parser", loading)
    assert status() == 130
    assert capsys.readouterr().err.splitlines() == ["physanimator: interrupted"]


@pytest.mark.parametrize("stage", ["simulate", "render"])
def test_interruption_is_status_130_and_keeps_the_earlier_file(
    folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch, stage: str
) -> None:
    def interrupting(_: object) -> Callable[[str, int, int], None]:
        def advance(name: str, done: int, total: int) -> None:
            if name == stage and done == 2:
                raise KeyboardInterrupt

        return advance

    monkeypatch.setattr("physanimator.rendering.command.messages.progress_bars", interrupting)
    (folder / "out.mp4").write_bytes(b"earlier")
    before = sorted(folder.iterdir())
    assert status("animate", "girl.png", "--mask", "hair.png", "--frames", "4", "--output", "out.mp4") == 130
    assert (folder / "out.mp4").read_bytes() == b"earlier"
    assert sorted(folder.iterdir()) == before
    assert "Traceback" not in capsys.readouterr().err


def test_full_disk_is_status_1_and_one_sentence(folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("physanimator.rendering.animation.write_animation", full)
    arguments = "animate girl.png --mask hair.png --frames 12 --wind 3 --quiet --output o.mp4"
    assert status(*arguments.split()) == 1
    assert capsys.readouterr().err == "physanimator: No space left on device\n"


def test_schema_is_the_published_one(capsys: Output) -> None:
    assert status("schema") == 0
    published = json.loads((ROOT / "physics" / "document" / "scene.schema.json").read_text(encoding="utf-8"))
    assert json.loads(capsys.readouterr().out) == published


def test_version(capsys: Output) -> None:
    assert status("--version") == 0
    assert capsys.readouterr().out == f"physanimator {physanimator.__version__}\n"


def test_help_names_every_preset_and_loads_nothing(capsys: Output) -> None:
    assert status("animate", "--help") == 0
    words = capsys.readouterr().out.replace(",", " ").replace(";", " ").split()
    assert set(PRESETS) <= set(words)
    script = (
        "import runpy, sys\n"
        f"runpy.run_path({str(ROOT / 'tests' / 'conftest.py')!r})\n"
        "from physanimator.rendering.command import main\n"
        "try: main(['animate', '--help'])\n"
        "except SystemExit: pass\n"
        "print(sorted({'numpy', 'cv2', 'taichi', 'torch'} & set(sys.modules)))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize(("told", "used"), [({}, "1"), ({THREADS_OF_ALGEBRA: "3"}, "3")])
def test_linear_algebra_has_one_thread_unless_told_otherwise(told: dict[str, str], used: str) -> None:
    script = (
        "import os, runpy, sys\n"
        f"runpy.run_path({str(ROOT / 'tests' / 'conftest.py')!r})\n"
        "from physanimator.rendering.command import main\n"
        "late = 'numpy' in sys.modules\n"
        "main(['animate', 'nothing.png', '--mask', 'nothing.png', '--output', 'a.gif'])\n"
        f"print(late, 'numpy' in sys.modules, os.environ[{THREADS_OF_ALGEBRA!r}])\n"
    )
    environment = {name: value for name, value in os.environ.items() if name != THREADS_OF_ALGEBRA} | told
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True", used]


def test_the_simulation_begins_before_pictures_are_read_and_after_options(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun: list[bool] = []
    monkeypatch.setattr("physanimator.physics.simulation.begin_aside", lambda: begun.append(True))
    (folder / "girl.png").write_bytes(b"no picture")
    assert status("animate", "girl.png", "--output", "girl.mp4") == 2
    assert not begun
    assert status("animate", "girl.png", "--mask", "hair.png", "--pixel-art", "--output", "girl.mp4") == 2
    assert not begun
    assert status("animate", "girl.png", "--mask", "hair.png", "--output", "girl.mp4") == 2
    assert begun


def test_demo(folder: Path) -> None:
    assert status("demo", "--frames", "3", "--output", "demo.mp4", "--quiet") == 0
    with av.open("demo.mp4") as container:
        stream = container.streams.video[0]
        assert (stream.width, stream.height) == load_image(EXAMPLE / "illustration.png").shape[1::-1]
    assert frames_of("demo.mp4") == 3


def test_what_may_not_be_meant_in_a_mask_is_said(folder: Path, capsys: Output) -> None:
    mask = np.full((HEIGHT, WIDTH), 255, np.uint8)
    mask[20:50, 60:90] = 0
    save_image("inverted.png", mask)
    assert status(*["animate", "girl.png", "--mask", "inverted.png", "--frames", "1", "--quiet", "--output", "o/"]) == 0
    (warning,) = capsys.readouterr().err.splitlines()
    assert warning.startswith("physanimator: warning: --mask inverted.png covers 95 % of the picture")
    assert warning.endswith("invert it")


def test_an_implausible_cut_is_said_before_the_simulation(
    folder: Path, capsys: Output, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One point on the ground before which everything stands."""

    def stopped(*_: object, **__: object) -> None:
        raise InvalidInputError("simulation reached")

    monkeypatch.setattr("physanimator.rendering.pipeline.simulate", stopped)
    wall = np.full((HEIGHT, WIDTH, 3), 200, np.uint8)
    wall[20:95, 60:80] = (70, 40, 30)
    save_image("wall.png", wall)
    Path("wall.txt").write_text("5,5,1")
    assert status("animate", "wall.png", "--points", "wall.txt", "--quiet", "--output", "o.mp4") == 2
    warning, *_, error = capsys.readouterr().err.splitlines()
    assert warning.startswith("physanimator: warning: The cut is")
    assert "of the picture from one point" in warning
    assert error.endswith("simulation reached")


def test_points_in_the_encoding_of_a_windows_pipe(folder: Path) -> None:
    Path("utf16.txt").write_text("x;y;label\r\n70;50;1\r\n120;50;0\r\n", encoding="utf-16")
    assert status(*["animate", "girl.png", "--points", "utf16.txt", "--frames", "1", "--quiet", "--output", "o/"]) == 0
